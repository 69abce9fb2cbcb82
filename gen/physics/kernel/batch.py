"""Records laid out in lanes for the kernel.

A batch holds at most ``LANES`` records of one shape; free lanes have copies of its first record, and only those that fill up a vector of
the processor are computed. Every row starts as NaN and is set by its name in :mod:`gen.physics.kernel.layout`, so a row that is forgotten
makes a record diverge instead of bending its physics.
"""

import numpy as np

from gen.physics.extent import BALL_ORDERS, HIGHEST_ORDER, LOWEST_ORDER, TABLE_POINTS
from gen.physics.kernel.compiling import LANES
from gen.physics.kernel.contacts import COS, SIN
from gen.physics.kernel.drop import PROFILES
from gen.physics.kernel.layout import (
    AXES,
    CONTACT_ROWS,
    JITTER_TERMS,
    PICKUPS,
    STATE_ROWS,
    Angle,
    Batch,
    Contact,
    Drive,
    FloatArray,
    Param,
    Shape,
    Site,
    SpallRow,
    State,
    contact_row,
    n_folds,
    race_rows,
)  # fmt: skip
from gen.physics.kernel.spalls import NEVER
from gen.physics.kernel.turning import STRIDE
from gen.physics.kernel_input import KernelInput, Turning, farthest_jitter, is_wavy, spall_span, walk_slip_rms
from gen.physics.rotor import Machine, as_columns

_SITES = {"inner": Site.INNER, "outer": Site.OUTER, "ball": Site.BALL}


def input_shape(record: KernelInput) -> Shape:
    """Shape of a record; it depends on nothing but the record."""
    turning = record.turning
    return Shape(
        int(record.bearing.n_balls),
        len(record.pickups),
        displacement=record.displacement,
        damped=record.machine.contact_damping > 0,
        wavy=is_wavy(record.waviness),
        jittered=turning.jitter_rms > 0 or turning.late_by != 0,
        forced=record.schedule.size > 0 or bool(turning.twice_x or turning.twice_y or turning.knock),
        roller=record.bearing.roller_length is not None,
    )


def lay_out(records: list[KernelInput], shape: Shape, knot: float) -> Batch:
    """Records in lanes, at most ``LANES`` of them and all of ``shape``.

    ``knot`` is the time between two knots [s].
    """
    padded = records + [records[0]] * (LANES - len(records))
    machines = as_columns([record.machine for record in padded])
    turnings = as_columns([record.turning for record in padded])
    spalls, tables = _spalls(padded)
    return Batch(
        n_records=len(records),
        state=_state(padded, turnings).ravel(),
        params=_params(padded, machines, shape).ravel(),
        drive=_drive(padded, turnings, machines, knot).ravel(),
        angles=_angles(turnings).ravel(),
        spalls=spalls.ravel(),
        phasors=_phasors(padded, knot).ravel(),
        slow=np.empty(0),
        waves=_waves(padded, shape).ravel(),
        schedule=_schedules(padded),
        tables=tables,
    )


def unset(*shape: int) -> FloatArray:
    """Array of NaN, of which every row is to be set by its name."""
    return np.full(shape, np.nan)


def _state(records: list[KernelInput], turning: Turning) -> FloatArray:
    state = np.zeros((STATE_ROWS, LANES))
    state[:4] = np.array([record.start for record in records]).T
    state[4:AXES] = state[2:4]  # the sensor starts with the housing
    state[State.CAGE_COS], state[State.CAGE_SIN] = np.cos(turning.cage_angle), np.sin(turning.cage_angle)
    state[State.SHAFT_COS], state[State.SHAFT_SIN] = np.cos(turning.shaft_angle), np.sin(turning.shaft_angle)
    return state


def _angles(turning: Turning) -> FloatArray:
    angles = unset(len(Angle), LANES)
    angles[Angle.SHAFT], angles[Angle.CAGE], angles[Angle.SPIN] = (
        turning.shaft_angle,
        turning.cage_angle,
        turning.spin_angle,
    )
    return angles


def _params(records: list[KernelInput], machine: Machine, shape: Shape) -> FloatArray:
    params = unset(contact_row(shape) + CONTACT_ROWS * shape.balls, LANES)
    sensor = np.asarray(machine.sensor_mass)
    held = sensor > 0  # without a mass, nothing pulls at the housing
    params[Param.LOAD_DEFLECTION_FACTOR] = machine.load_deflection_factor
    params[Param.CONTACT_DAMPING] = np.divide(machine.contact_damping, machine.load_deflection_factor)
    params[Param.CONTACT_COSINE] = machine.contact_cosine
    params[Param.PER_SHAFT_MASS] = 1 / np.asarray(machine.shaft_mass)
    params[Param.PER_HOUSING_MASS] = 1 / np.asarray(machine.housing_mass)
    params[Param.PER_SENSOR_MASS] = np.divide(1.0, sensor, out=np.zeros(LANES), where=held)
    params[Param.RING_DAMPING] = machine.ring_damping
    params[Param.SHAFT_DAMPING] = machine.shaft_damping
    params[Param.SHAFT_STIFFNESS] = machine.shaft_stiffness
    params[Param.RING_STIFFNESS_X], params[Param.RING_STIFFNESS_Y] = machine.ring_stiffness_x, machine.ring_stiffness_y
    params[Param.SUPPORT_STIFFNESS_X] = machine.support_stiffness_x
    params[Param.SUPPORT_STIFFNESS_Y] = machine.support_stiffness_y
    params[Param.SUPPORT_DAMPING_X], params[Param.SUPPORT_DAMPING_Y] = (
        machine.support_damping_x,
        machine.support_damping_y,
    )
    params[Param.SENSOR_STIFFNESS_X] = np.where(held, machine.sensor_stiffness_x, 0.0)
    params[Param.SENSOR_STIFFNESS_Y] = np.where(held, machine.sensor_stiffness_y, 0.0)
    params[Param.SENSOR_DAMPING] = np.where(held, machine.sensor_damping, 0.0)
    params[Param.LOOSENESS] = machine.looseness
    params[Param.SHAFT_FORCE_X], params[Param.SHAFT_FORCE_Y] = machine.load_x, machine.load_y
    params[Param.HOUSING_FORCE_X : Param.HOUSING_FORCE_Y_SLOPE + 1] = 0.0
    for lane, record in enumerate(records):
        params[PICKUPS : contact_row(shape), lane] = record.pickups.ravel()
    contacts = params[contact_row(shape) :].reshape(shape.balls, CONTACT_ROWS, LANES)
    contacts[:, Contact.COS] = COS[shape.balls, : shape.balls, None]
    contacts[:, Contact.SIN] = SIN[shape.balls, : shape.balls, None]
    contacts[:, Contact.GAP] = machine.half_clearance
    contacts[:, Contact.COS_SLOPE :] = 0.0
    return params


def _drive(records: list[KernelInput], turning: Turning, machine: Machine, knot: float) -> FloatArray:
    bearings = [record.bearing for record in records]
    gamma = np.array([bearing.gamma for bearing in bearings])
    size = np.array([bearing.pitch_diameter / bearing.ball_diameter for bearing in bearings])
    x, y = np.asarray(turning.twice_x), np.asarray(turning.twice_y)
    square = np.maximum(x * x + y * y, 1e-300)
    drive = unset(len(Drive), LANES)
    drive[Drive.SHAFT_STEP] = 2 * np.pi * knot * np.asarray(turning.shaft_rate)
    drive[Drive.CAGE_RATIO] = 0.5 * (1 - gamma)
    drive[Drive.SPIN_RATIO] = 0.5 * size * (1 - gamma**2)
    drive[Drive.MEAN_SLIP] = turning.mean_slip
    drive[Drive.SPEED_RMS], drive[Drive.SLIP_RMS] = turning.speed_rms, turning.slip_rms
    drive[Drive.SPIN_RMS], drive[Drive.JITTER_RMS] = turning.spin_rms, turning.jitter_rms
    drive[Drive.AXIS_OFFSET], drive[Drive.AXIS_RMS] = turning.axis_offset, turning.axis_rms
    drive[Drive.AXIS_LIMIT] = turning.axis_limit
    drive[Drive.UNBALANCE] = turning.unbalance
    drive[Drive.HALF_CLEARANCE] = machine.half_clearance
    drive[Drive.BALL_RADIUS] = machine.ball_radius
    drive[Drive.INNER_RADIUS] = [bearing.inner_radius for bearing in bearings]
    drive[Drive.OUTER_RADIUS] = [bearing.outer_radius for bearing in bearings]
    drive[Drive.LOAD_X], drive[Drive.LOAD_Y] = machine.load_x, machine.load_y
    drive[Drive.TWICE_X], drive[Drive.TWICE_Y] = turning.twice_x, turning.twice_y
    # cosine and sine of twice the direction of (x, y)
    drive[Drive.TWICE_COS], drive[Drive.TWICE_SIN] = (x * x - y * y) / square, 2 * x * y / square
    drive[Drive.BOW] = turning.bow
    drive[Drive.KNOCK], drive[Drive.KNOCK_ANGLE] = turning.knock, turning.knock_angle
    drive[Drive.KNOCK_SEED] = turning.knock_seed
    drive[Drive.LATE_BALL], drive[Drive.LATE_BY] = turning.late_ball, turning.late_by
    _set_chances(drive, records, turning, knot)
    return drive


def _set_chances(drive: FloatArray, records: list[KernelInput], turning: Turning, knot: float) -> None:
    """Set the rows of the random walk of the cage and of the jumps of a spin axis."""
    held = STRIDE * knot
    drive[Drive.WALK] = [walk_slip_rms(record.bearing, record.turning, held) for record in records]
    drive[Drive.WALK_NOW], drive[Drive.WALK_SEED] = 0.0, turning.walk_seed
    apart = 2 * np.pi / np.array([record.bearing.n_balls for record in records])
    carriers = [next((spall.ball for spall in record.spalls if spall.site == "ball"), 0) for record in records]
    opposite = np.arctan2(-drive[Drive.LOAD_Y], -drive[Drive.LOAD_X])
    drive[Drive.AXIS_JUMPS], drive[Drive.AXIS_SPREAD] = turning.axis_jumps, turning.axis_spread
    drive[Drive.AXIS_ANGLE], drive[Drive.AXIS_SEED] = opposite - apart * carriers, turning.axis_seed
    drive[Drive.AXIS_TURN], drive[Drive.AXIS_TILT], drive[Drive.AXIS_SHIFT] = NEVER, 0.0, 0.0


def _spalls(records: list[KernelInput]) -> tuple[FloatArray, FloatArray]:
    """Spalls, shape (spall, row, lane), and the tables of those that have one, shape (table, point)."""
    spalls = unset(max(len(record.spalls) for record in records), len(SpallRow), LANES)
    tables = [np.zeros(TABLE_POINTS)]
    for lane, record in enumerate(records):
        for place in range(len(spalls)):
            if place < len(record.spalls):
                _spall(spalls[place, :, lane], record, place, len(tables))
                tables += [_resampled(drops) for drops in record.spalls[place].table]
            else:
                _no_spall(spalls[place, :, lane])
    return spalls, np.stack(tables)


def _spall(rows: FloatArray, record: KernelInput, place: int, table: int) -> None:
    spall = record.spalls[place]
    half, arc = spall_span(record.bearing, spall)
    on_ball = spall.site == "ball"
    rows[SpallRow.WITH_CAGE] = 0 if on_ball else 1
    rows[SpallRow.WITH_SHAFT] = -1 if spall.site == "inner" else 0
    rows[SpallRow.WITH_SPIN] = 1 if on_ball else 0
    rows[SpallRow.POSITION] = spall.angle if on_ball else -spall.angle
    rows[SpallRow.PERIOD] = np.pi if on_ball else 2 * np.pi / record.bearing.n_balls
    rows[SpallRow.REACH] = half + farthest_jitter(record.turning, JITTER_TERMS)
    rows[SpallRow.SITE] = _SITES[spall.site]
    rows[SpallRow.CARRIER] = spall.ball
    rows[SpallRow.HALF], rows[SpallRow.ARC] = half, arc
    rows[SpallRow.DEPTH] = spall.depth
    rows[SpallRow.PROFILE] = PROFILES.index(spall.profile)
    rows[SpallRow.TABLE] = table
    rows[SpallRow.SCATTER], rows[SpallRow.SEED] = spall.scatter, spall.seed


def _no_spall(rows: FloatArray) -> None:
    """Padding of a record that has fewer spalls than another of its batch: no ball is ever within its reach."""
    rows[:] = 0.0
    rows[SpallRow.PERIOD] = 1.0
    rows[SpallRow.REACH] = -1.0
    rows[SpallRow.SITE] = Site.NONE


def _resampled(drops: tuple[float, ...]) -> FloatArray:
    points = np.linspace(0, len(drops) - 1, TABLE_POINTS)
    return np.interp(points, np.arange(len(drops)), drops)


def _waves(records: list[KernelInput], shape: Shape) -> FloatArray:
    """Waviness amplitudes as :class:`Batch` has them, shape (row, lane); rows of round surfaces are 0 or left out."""
    n_balls = shape.balls
    of_races = any(is_wavy(record.waviness) for record in records)
    of_balls = any(record.waviness.balls.size > 0 for record in records)
    waves = np.zeros((race_rows(shape) * of_races + 2 * BALL_ORDERS * n_balls * of_balls, LANES))
    for lane, record in enumerate(records):
        if record.waviness.races.size:
            races = np.zeros((2, n_folds(shape) * n_balls, 2))
            races[:, LOWEST_ORDER : HIGHEST_ORDER + 1, 0] = record.waviness.races.real
            races[:, LOWEST_ORDER : HIGHEST_ORDER + 1, 1] = record.waviness.races.imag
            waves[: races.size, lane] = races.ravel()
        if record.waviness.balls.size:
            balls = np.stack([record.waviness.balls.real, record.waviness.balls.imag], axis=2)
            waves[race_rows(shape) :, lane] = balls.ravel()
    return waves


def _schedules(records: list[KernelInput]) -> FloatArray:
    """Factors of shaft rate and load, shape (knot, 2, lane): the last ones hold, and 1 where there is no schedule."""
    length = max(len(record.schedule) for record in records)
    schedules = np.ones((length, 2, LANES))
    for lane, record in enumerate(records):
        if len(record.schedule):
            schedules[:, :, lane] = record.schedule[np.minimum(np.arange(length), len(record.schedule) - 1)]
    return schedules


def _phasors(records: list[KernelInput], knot: float) -> FloatArray:
    phases = np.stack([record.phases for record in records], axis=1)
    turns = 2 * np.pi * knot * STRIDE * np.stack([record.frequencies for record in records], axis=1)
    return np.stack([np.cos(phases), np.sin(phases), np.cos(turns), np.sin(turns)], axis=1)
