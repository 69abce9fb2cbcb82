"""What is uneven in a bearing, as the kernel takes it: spalls with the paths of balls over them, and waviness."""

import functools
import math

import numpy as np
from numpy.typing import NDArray

from gen.physics.bearing import Bearing, orders
from gen.physics.hertz import footprints
from gen.physics.kernel import turning as motion
from gen.physics.kernel.batch import Spall as KernelSpall
from gen.physics.kernel.drop import PROFILES, drop, largest_drop
from gen.physics.trace import felt, places, rolled, roughened
from gen.scenarios import Purpose, Scenario, Spall, Wear, stream

FloatArray = NDArray[np.float64]

# of the sample rate: waviness that passes a ball faster is left out, for gaps are known once per sample
FASTEST_WAVE = 0.4


def kernel_spalls(scenario: Scenario, ball_load: float) -> tuple[KernelSpall, ...]:
    """Spalls as the kernel knows them; outer race angles count from x there, and rough or wide contacts make tables."""
    return tuple(
        _tabulated(scenario, number, plain, ball_load) if _needs_table(scenario, spall) else plain
        for number, (spall, plain) in enumerate(zip(scenario.specimen.spalls, plain_spalls(scenario), strict=True))
    )


def plain_spalls(scenario: Scenario) -> tuple[KernelSpall, ...]:
    """Spalls as the kernel knows those that need no table."""
    shift = scenario.rig.machine["load_angle"]
    return tuple(
        KernelSpall(
            spall.site, spall.width, spall.depth, spall.angle + (shift if spall.site == "outer" else 0.0), spall.ball, spall.profile
        )
        for spall in scenario.specimen.spalls
    )  # fmt: skip


def _needs_table(scenario: Scenario, spall: Spall) -> bool:
    return scenario.rig.footprint or spall.profile == "trace" or spall.roughness > 0


def _tabulated(scenario: Scenario, number: int, plain: KernelSpall, ball_load: float) -> KernelSpall:
    paths = spall_paths(scenario, number)
    if not scenario.rig.footprint:
        return plain._replace(profile="table", table=tuple(tuple(path) for path in paths))
    inner, outer = footprints(scenario.specimen.bearing, ball_load)
    widths = {"inner": (inner,), "outer": (outer,), "ball": (inner, outer)}[plain.site]
    margin = max(widths)
    table = tuple(tuple(felt(path, plain.width, b, margin)) for path, b in zip(paths, widths, strict=True))
    return plain._replace(profile="table", width=plain.width + 2 * margin, table=table)


def spall_paths(scenario: Scenario, number: int) -> tuple[FloatArray, ...]:
    """Path of the middle of a contact over a spall, shape (point,), on each race that its balls roll on there [m]."""
    specimen, spall = scenario.specimen, scenario.specimen.spalls[number]
    bearing = specimen.bearing
    inner, outer = bearing.inner_radius, -bearing.outer_radius
    races = {"inner": (inner,), "outer": (outer,), "ball": (inner, outer)}[spall.site]
    place = scenario.seed, scenario.rig.number, specimen.number, number
    return _paths(spall, bearing.ball_diameter / 2, races, place)


def deepest(scenario: Scenario, number: int) -> float:
    """Largest drop of a rigid ball over a spall, on whichever race is deeper [m]."""
    spall, bearing = scenario.specimen.spalls[number], scenario.specimen.bearing
    if spall.profile != "geometric" or spall.roughness > 0:
        return max(float(path.max()) for path in spall_paths(scenario, number))
    ball = bearing.ball_diameter / 2
    arc = {"inner": bearing.inner_radius, "outer": bearing.outer_radius, "ball": ball}[spall.site]
    race = -bearing.outer_radius if spall.site == "outer" else bearing.inner_radius
    return largest_drop(spall.width, arc, ball, race, spall.depth)


@functools.lru_cache(maxsize=256)
def _paths(
    spall: Spall, ball: float, races: tuple[float, ...], place: tuple[int, int, int, int]
) -> tuple[FloatArray, ...]:
    at = places(spall.width)
    if spall.profile not in ("geometric", "trace"):
        arc = ball if spall.site == "ball" else abs(races[0])
        profile, half = PROFILES.index(spall.profile), 0.5 * spall.width / arc
        one = np.array([drop(profile, x / arc, half, arc, ball, races[0], spall.depth) for x in at])
        return (one,) * len(races)
    depths = np.full(len(at), spall.depth)
    if spall.profile == "trace":
        depths = np.interp(at, np.linspace(at[0], at[-1], len(spall.trace)), spall.trace)
    if spall.roughness > 0:
        depths = roughened(depths, spall.roughness, stream(*place, Purpose.ROUGHNESS))
    return tuple(rolled(depths, spall.width, ball, race) for race in races)


def is_wavy(scenario: Scenario) -> bool:
    """Whether races or balls of a specimen are wavy, as made or as worn."""
    properties = scenario.specimen.properties
    return bool(properties["waviness"] or properties["ball_waviness"] or scenario.specimen.wear is not None)


def waviness(scenario: Scenario, fs: float) -> FloatArray:
    """Fourier amplitudes of both races, and of the balls if they have some, shape (row,) [m]: the specimen's own, phases random."""
    specimen, properties = scenario.specimen, scenario.specimen.properties
    rms, of_balls = properties["waviness"], properties["ball_waviness"]
    if not is_wavy(scenario):
        return np.empty(0)
    place = scenario.seed, scenario.rig.number, specimen.number, 0
    rows, orders_at_balls = _waves(place, specimen.bearing, rms, of_balls, specimen.wear)
    profile = scenario.record.speed_profile
    highest_rate = scenario.record.conditions["shaft"] * (1.0 if profile is None else max(profile.shares))
    return rows * (orders_at_balls <= FASTEST_WAVE * fs / highest_rate)


@functools.lru_cache(maxsize=256)
def _waves(
    place: tuple[int, int, int, int], bearing: Bearing, rms: float, of_balls: float, wear: Wear | None
) -> tuple[FloatArray, NDArray[np.floating]]:
    """Amplitudes of a specimen, and how often each wave passes a ball in a turn of the shaft, shape (row,) [m, 1]."""
    rng, n_balls, spinning = stream(*place, Purpose.WAVINESS), bearing.n_balls, orders(bearing)
    every, even = np.arange(motion.LOWEST_ORDER, motion.HIGHEST_ORDER + 1), 2 * np.arange(1, motion.BALL_ORDERS + 1)
    races = _falling(every) * rms * np.exp(1j * rng.uniform(0, 2 * np.pi, (2, motion.N_ORDERS)))
    # a ball's two contacts see the same height in even orders: together twice as much
    balls = 2 * of_balls * _falling(even)[:, None] * np.exp(1j * rng.uniform(0, 2 * np.pi, (len(even), n_balls)))
    if wear is not None:
        rng = stream(*place, Purpose.WEAR)
        worn = _falling(every) if wear.order is None else math.sqrt(2) * (every == wear.order)
        races[("inner", "outer").index(wear.site)] += (
            worn * wear.waviness * np.exp(1j * rng.uniform(0, 2 * np.pi, len(every)))
        )
    rows = [np.stack([races.real, races.imag], axis=1).ravel()]
    passing = [every * (1 - spinning.ftf)] * 2 + [every * spinning.ftf] * 2
    if of_balls > 0:
        rows.append(np.stack([balls.real, balls.imag], axis=1).ravel())
        passing.append(np.repeat(even * spinning.bsf, 2 * n_balls))
    return np.concatenate(rows), np.concatenate(passing)


def _falling(orders_of_turn: NDArray[np.int_]) -> FloatArray:
    """Amplitudes that fall as 1/order, of unit rms together [1]."""
    falling = 1 / orders_of_turn
    return falling * (math.sqrt(2) / np.linalg.norm(falling))
