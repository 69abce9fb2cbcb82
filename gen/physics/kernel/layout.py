"""Every array of the kernel, and every row in it, by name.

An array holds one batch: value ``row`` of the record in ``lane`` stands at ``row * LANES + lane``. :mod:`gen.physics.kernel.batch` fills
the arrays by the row names below, and the kernel reads them by the same names.
"""

from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.physics.extent import HIGHEST_ORDER
from gen.physics.kernel.compiling import in_both

FloatArray = NDArray[np.float64]

AXES = 6  # coordinates x1 y1 x2 y2 xr yr: shaft, housing, sensor


class Shape(NamedTuple):
    """What all records of a batch have in common: a record is computed with the parts of the model that it needs and no others.

    One compiled kernel serves all shapes.
    """

    balls: int
    channels: int
    displacement: bool = False
    """Whether channels measure displacements instead of accelerations."""
    damped: bool = False
    """Whether contacts have a viscous damping."""
    wavy: bool = False
    """Whether races or balls are wavy, so that gaps change from knot to knot."""
    jittered: bool = False
    """Whether balls leave their place in the cage."""
    forced: bool = False
    """Whether outer forces change between knots: load profiles, misalignment, cage knocks."""
    roller: bool = False
    """Whether contacts are lines, with the exponent 10/9."""


class State(IntEnum):
    """First row of each quantity in ``state``, which the steps advance."""

    COORDINATES = 0  # AXES rows [m]
    RATES = 6  # AXES rows [m/s]
    CAGE_COS = 12  # direction of the cage, cosine and sine
    CAGE_SIN = 13
    SHAFT_COS = 14  # direction of the shaft
    SHAFT_SIN = 15
    STEEPEST = 16  # largest sum over all balls of squeeze**(n - 1) so far; it bounds the contact stiffness
    BEGINNING = 17  # of the step under way: coordinates and rates at its start, N_DYNAMIC rows
    SLOPES = 29  # of the step under way: weighted sum of its slopes, N_DYNAMIC rows
    RELATIVE = (
        41  # of the stage under way: motion of the shaft relative to the housing in the frame of the cage, x, y, x', y'
    )
    PUSH = 45  # of the stage under way: force of the balls over K along and across the cage, and the sum of squeeze**(n - 1)


N_DYNAMIC = 2 * AXES
STATE_ROWS = State.PUSH + 3


class Param(IntEnum):
    """Rows of ``params``: constants of the record, then quantities that hold until the next knot.

    After them: pickup weights, rows of :class:`Contact` of each ball, drops into spalls (see :func:`contact_row`, :func:`drop_row`).
    """

    LOAD_DEFLECTION_FACTOR = 0  # K, of one ball [N m^-n]
    CONTACT_DAMPING = 1  # of one ball over K [s m^(n - 1)]: the sum over all balls is multiplied by K
    CONTACT_COSINE = 2  # cosine of the contact angle [1]
    PER_SHAFT_MASS = 3  # 1 / m1 [1/kg]
    PER_HOUSING_MASS = 4  # 1 / m2
    PER_SENSOR_MASS = 5  # 1 / mr, 0 without a sensor mass
    RING_DAMPING = 6  # c1, between shaft and housing [N s/m]
    SHAFT_DAMPING = 7  # c0, between shaft and ground
    SHAFT_STIFFNESS = 8  # k0 [N/m]
    RING_STIFFNESS_X = 9  # k1
    RING_STIFFNESS_Y = 10
    SUPPORT_STIFFNESS_X = 11  # k2, between housing and ground
    SUPPORT_STIFFNESS_Y = 12
    SUPPORT_DAMPING_X = 13  # c2
    SUPPORT_DAMPING_Y = 14
    SENSOR_STIFFNESS_X = 15  # kr, between sensor and housing
    SENSOR_STIFFNESS_Y = 16
    SENSOR_DAMPING = 17  # cr
    LOOSENESS = 18  # half the play of the housing in its support [m]
    CAGE_TURN_COS = 19  # rotation of the cage in half a step
    CAGE_TURN_SIN = 20
    SHAFT_TURN_COS = 21  # rotation of the shaft in half a step
    SHAFT_TURN_SIN = 22
    UNBALANCE_RADIAL = 23  # p, force along the mark of the shaft [N]
    UNBALANCE_TANGENTIAL = 24  # q, force across it while the speed changes [N]
    SHAFT_FORCE_X = 25  # outer forces at the knot [N]
    SHAFT_FORCE_Y = 26
    HOUSING_FORCE_X = 27
    HOUSING_FORCE_Y = 28
    SHAFT_FORCE_X_SLOPE = 29  # and their change per half step
    SHAFT_FORCE_Y_SLOPE = 30
    HOUSING_FORCE_X_SLOPE = 31
    HOUSING_FORCE_Y_SLOPE = 32


PICKUPS = len(Param)  # first row of the weights of the AXES accelerations in each channel


class Contact(IntEnum):
    """Rows of one ball in ``params``, from :func:`contact_row` on."""

    COS = 0  # direction of the ball in the frame of the cage
    SIN = 1
    GAP = 2  # [m]
    COS_SLOPE = 3  # and their change per half step
    SIN_SLOPE = 4
    GAP_SLOPE = 5


CONTACT_ROWS = len(Contact)


class Angle(IntEnum):
    """Rows of ``angles`` and of ``moves``, their change up to the next knot [rad]."""

    SHAFT = 0
    CAGE = 1
    SPIN = 2  # of every ball about its own axis


class Drive(IntEnum):
    """Rows of ``drive``: how fast shaft, cage and balls turn, and the outer forces."""

    SHAFT_STEP = 0  # nominal angle of the shaft per knot [rad]
    CAGE_RATIO = 1  # of the cage rate to the shaft rate in pure rolling
    SPIN_RATIO = 2  # of the ball spin to the shaft rate
    MEAN_SLIP = 3  # of the cage, as a share of its rolling speed
    SPEED_RMS = 4  # rms of the slow processes: speed and slip and spin [1], jitter and spin axis [rad]
    SLIP_RMS = 5
    SPIN_RMS = 6
    JITTER_RMS = 7
    AXIS_OFFSET = 8  # mean tilt of the spin axis [rad]
    AXIS_RMS = 9
    AXIS_LIMIT = 10  # tilt beyond which a ball spall misses the track [rad]; 0 if it never does
    UNBALANCE = 11  # mass times eccentricity [kg m]
    HALF_CLEARANCE = 12  # [m]
    BALL_RADIUS = 13  # [m]
    INNER_RADIUS = 14  # of the races at the groove bottom [m]
    OUTER_RADIUS = 15
    LOAD_X = 16  # [N]
    LOAD_Y = 17
    TWICE_X = 18  # force of misalignment at twice the shaft rate [N]
    TWICE_Y = 19
    TWICE_COS = 20  # cosine and sine of twice its direction
    TWICE_SIN = 21
    BOW = 22  # force of a bent shaft [N]
    KNOCK = 23  # typical force of a cage knock [N]
    KNOCK_ANGLE = 24  # at which the first pocket knocks [rad]
    LATE_BALL = 25  # number of the ball out of its place, -1 for none
    LATE_BY = 26  # [rad]
    KNOCK_SEED = 27
    WALK = 28  # rms of the random slip of the cage that is new every STRIDE knots [1]
    WALK_NOW = 29  # this slip now [1]
    WALK_SEED = 30
    AXIS_JUMPS = 31  # probability that the axis of the damaged ball jumps where this ball is opposite the load [1]
    AXIS_SPREAD = 32  # standard deviation of tilt and spin angle after a jump [rad]
    AXIS_ANGLE = 33  # of the cage, where the damaged ball is opposite the load [rad]
    AXIS_SEED = 34
    AXIS_TURN = 35  # of the cage since AXIS_ANGLE, a whole number, at the last knot
    AXIS_TILT = 36  # of the axis since its last jump [rad]
    AXIS_SHIFT = 37  # of the spin angle since the last jump [rad]


class SpallRow(IntEnum):
    """Rows of one spall in ``spalls``, which holds spall after spall.

    The spall passes ball 0 at ``WITH_CAGE * cage + WITH_SHAFT * shaft + WITH_SPIN * spin + POSITION`` [rad], every ``PERIOD``.
    """

    WITH_CAGE = 0
    WITH_SHAFT = 1
    WITH_SPIN = 2
    POSITION = 3  # [rad]
    PERIOD = 4  # angle from ball to ball, or from contact to contact of a ball [rad]
    REACH = 5  # largest angle at which a ball can meet the spall [rad], negative without a spall
    SITE = 6  # a Site
    CARRIER = 7  # number of the ball that carries a ball spall
    HALF = 8  # half the angle that the spall spans [rad]
    ARC = 9  # radius on which that angle is measured [m]
    DEPTH = 10  # [m]
    PROFILE = 11  # index into PROFILES
    TABLE = 12  # row in ``tables``
    SCATTER = 13  # standard deviation of the logarithm of the drop from passage to passage [1]
    SEED = 14


class Site(IntEnum):
    """Where a spall is; ``NONE`` marks the padding of records with fewer spalls."""

    NONE = 0
    INNER = 1
    OUTER = 2
    BALL = 3


class Process(IntEnum):
    """Rows of ``slow``, the slow random processes; the jitter of ball ``i`` is in row ``JITTER + i``, and all slopes per knot follow."""

    SPEED = 0  # relative deviation of the shaft rate
    SLIP = 1
    SPIN = 2  # relative deviation of the ball spin
    TILT = 3  # of the spin axis [rad]
    JITTER = 4  # of each ball in its pocket [rad]


# Cosine terms of each process, and the first of each among all terms of a record
SPEED_TERMS, SLIP_TERMS, SPIN_TERMS, TILT_TERMS, JITTER_TERMS = 6, 12, 6, 8, 4
SLIP_FIRST = SPEED_TERMS
SPIN_FIRST = SLIP_FIRST + SLIP_TERMS
TILT_FIRST = SPIN_FIRST + SPIN_TERMS
JITTER_FIRST = TILT_FIRST + TILT_TERMS


def n_process_terms(n_balls: int) -> int:
    """Number of cosine terms of all processes, the jitter of every ball included."""
    return JITTER_FIRST + JITTER_TERMS * n_balls


class Batch(NamedTuple):
    """Records side by side, one per lane; arrays are flat, ``row * LANES + lane``, unless they say otherwise."""

    n_records: int
    """Number of records; the lanes behind them are not computed."""
    state: FloatArray
    """Rows of :class:`State`."""
    params: FloatArray
    """Rows of :class:`Param`, and what follows them."""
    drive: FloatArray
    """Rows of :class:`Drive`."""
    angles: FloatArray
    """Rows of :class:`Angle` [rad]."""
    spalls: FloatArray
    """Rows of :class:`SpallRow`, spall after spall."""
    phasors: FloatArray
    """Cosine, sine, and cosine and sine of the rotation per ``STRIDE`` knots: four rows for every term."""
    slow: FloatArray
    """Rows of :class:`Process`: values, then slopes per knot."""
    waves: FloatArray
    """Waviness amplitudes [m], real and imaginary part of each order. Of each race ``n_folds(shape) * n_balls`` orders from 0 on, the inner
    race first; then, for each even order, ball after ball. Empty without waviness."""
    schedule: FloatArray
    """Factors of shaft rate and load, shape (knot, 2, lane), or (0, 2, lane) if both are constant."""
    tables: FloatArray
    """Drops of tabulated spalls, shape (table, point) [m]; a ball spall has two, for the inner and the outer race."""


@in_both
def contact_row(shape: Shape) -> int:
    """First row of the contacts of the balls in ``params``: rows of :class:`Contact`, ball after ball."""
    return PICKUPS + shape.channels * AXES


@in_both
def drop_row(shape: Shape) -> int:
    """First row of the drops into spalls in ``params``: half step after half step, one row for each ball.

    The row before it is 1 in lane 0 if a ball of any lane drops before the next knot.
    """
    return contact_row(shape) + CONTACT_ROWS * shape.balls + 1


@in_both
def param_rows(shape: Shape, n_steps: int) -> int:
    """Number of rows of ``params``."""
    return drop_row(shape) + (2 * n_steps + 1) * shape.balls


@in_both
def n_folds(shape: Shape) -> int:
    """Number of waviness orders of a race that differ by a multiple of the number of balls."""
    return HIGHEST_ORDER // shape.balls + 1


@in_both
def race_rows(shape: Shape) -> int:
    """Number of rows of ``waves`` that belong to the races."""
    return 4 * n_folds(shape) * shape.balls


@in_both
def slow_rows(shape: Shape) -> int:
    """Number of processes."""
    return Process.JITTER + (shape.balls if shape.jittered else 0)
