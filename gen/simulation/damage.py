"""Spalls, with the paths of the balls over them, and waviness, as the kernel takes them."""

import functools
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gen.drawing import stream
from gen.mechanisms.faults.bearing_fault import RACES
from gen.mechanisms.faults.worn_race import DistributedFault
from gen.physics.bearing import Bearing, orders
from gen.physics.extent import BALL_ORDERS, HIGHEST_ORDER, LOWEST_ORDER
from gen.physics.hertz import footprints
from gen.physics.kernel.compiling import compiled_to_disk
from gen.physics.kernel.drop import GEOMETRIC, PROFILES, drop
from gen.physics.kernel_input import ROUND, Spall, Waviness
from gen.physics.trace import ball_path, contact_mean, rough_surface, spall_positions
from gen.scenarios import Scenario

FloatArray = NDArray[np.float64]

FASTEST_WAVE = (
    0.4  # of the sample rate: gaps are computed once per sample, so waviness that passes a ball faster is left out
)

GROWING_FLOOR = 10e-3
"""Length of the rough floor of which a growing spall lays bare ever more, from its middle on [m]: its waves are 0.1 to 1 mm long."""


def spall_inputs(scenario: Scenario, ball_load: float) -> tuple[Spall, ...]:
    """Spalls as the kernel takes them: rough floors and wide contacts need a table."""
    spalls = scenario.spalls
    if not spalls:
        return ()
    # a spall keeps its edges while it grows
    edges = scenario.stream("edges", "record" if scenario.origin.life is None else "specimen")
    seeds, has_width = edges.integers(2**52, size=len(spalls)).tolist(), scenario.recipe.contact.footprint == "hertz"
    inputs = list[Spall]()
    for number, spall in enumerate(spalls):
        changed = dict[str, Any](seed=seeds[number])
        # smooth paths of a rigid ball have a formula, all others a table
        if has_width or spall.profile == "trace" or spall.roughness > 0:
            paths, widths = spall_paths(scenario, number), (0.0,)
            if has_width:
                widths = _met(spall.site, *footprints(scenario.bearing, ball_load))
                margins = zip(paths, widths, strict=True)
                # the pressure of a contact of some width averages the path
                paths = [contact_mean(path, spall.width, width, max(widths)) for path, width in margins]
            changed |= {"profile": "table", "width": spall.width + 2 * max(widths), "table": tuple(map(tuple, paths))}
        inputs.append(spall._replace(**changed))
    return tuple(inputs)


def _met(site: str, inner: float, outer: float) -> tuple[float, ...]:
    """Value of each race that a spall meets, from those of both."""
    return {"inner": (inner,), "outer": (outer,), "ball": (inner, outer)}[site]


def spall_paths(scenario: Scenario, number: int) -> tuple[FloatArray, ...]:
    """Path of the middle of a contact over a spall, shape (point,) [m]: on its race, or for a ball spall on both races."""
    spall, bearing = scenario.spalls[number], scenario.bearing
    # radii of the races: a convex one (inner) is positive, a concave one (outer) negative
    races = _met(spall.site, bearing.inner_radius, -bearing.outer_radius)
    floor = spall.width if scenario.origin.life is None else max(GROWING_FLOOR, spall.width)
    place = scenario.recipe.seed, scenario.origin.specimen, number
    return _paths(spall, floor, bearing.ball_diameter / 2, races, place)


def largest_drop_over(scenario: Scenario, number: int) -> float:
    """Largest drop of a rigid ball over a spall, on the race where it is larger [m]."""
    spall, bearing = scenario.spalls[number], scenario.bearing
    if spall.profile != "geometric" or spall.roughness > 0:
        return max(float(path.max()) for path in spall_paths(scenario, number))
    race = -bearing.outer_radius if spall.site == "outer" else bearing.inner_radius
    arc = bearing.radius(spall.site)
    return cached_drop(GEOMETRIC, 0.0, 0.5 * spall.width / arc, arc, bearing.radius("ball"), race, spall.depth)


@compiled_to_disk
def cached_drop(profile: int, offset: float, half: float, arc: float, ball: float, race: float, depth: float) -> float:
    """:func:`drop` for calls from Python; compiling it takes 0.5 s."""
    return drop(profile, offset, half, arc, ball, race, depth)


@functools.lru_cache(maxsize=256)
def _paths(
    spall: Spall, floor: float, ball: float, races: tuple[float, ...], place: tuple[int, int, int]
) -> tuple[FloatArray, ...]:
    # a table of the path, since a wide contact will be averaged over it
    at = spall_positions(spall.width)
    if spall.profile not in ("geometric", "trace"):
        arc = ball if spall.site == "ball" else abs(races[0])
        profile, half = PROFILES.index(spall.profile), 0.5 * spall.width / arc
        path = np.array([cached_drop(profile, x / arc, half, arc, ball, races[0], spall.depth) for x in at])
        return (path,) * len(races)
    depths = np.full(len(at), spall.depth)
    if spall.profile == "trace":
        depths = np.interp(at, np.linspace(at[0], at[-1], len(spall.trace)), spall.trace)
    # a rough floor belongs to the specimen: it stays from record to record
    if spall.roughness > 0:
        seed, specimen, number = place
        rough = rough_surface(spall.roughness, stream(seed, "specimen", specimen, f"roughness {number}"))
        depths = np.maximum(depths + np.interp(at, spall_positions(floor), rough), 0.0)
    return tuple(ball_path(depths, spall.width, ball, race) for race in races)


def waviness_of(scenario: Scenario) -> Waviness:
    """Fourier amplitudes of races and balls of the specimen of a record, without waves that pass a ball too fast for its sample rate."""
    rms, of_balls = scenario.properties["waviness"], scenario.properties["ball_waviness"]
    worn = tuple(
        (part.site, part.si()["waviness"], part.order)
        for part in scenario.components
        if isinstance(part, DistributedFault)
    )
    if not (rms or of_balls or worn):
        return ROUND
    place, profile = (scenario.recipe.seed, scenario.origin.specimen), scenario.speed_profile
    # the races are those of the specimen; only the fast waves depend on the speed of the record
    whole, passages = _waves(place, scenario.bearing, rms, of_balls, worn)
    # the fastest moment of a profile decides
    highest_rate = scenario.conditions["shaft_rate"] * (1.0 if profile is None else max(profile.shares))
    highest_order = FASTEST_WAVE * scenario.recipe.recording.sample_rate_hz / highest_rate
    return Waviness(
        *(np.where(often <= highest_order, waves, 0j) for often, waves in zip(passages, whole, strict=True))
    )


@functools.lru_cache(maxsize=256)
def _waves(
    place: tuple[int, int],
    bearing: Bearing,
    rms: float,
    of_balls: float,
    worn: tuple[tuple[str, float, int | None], ...],
) -> tuple[Waviness, tuple[NDArray[np.floating], NDArray[np.floating]]]:
    """Amplitudes of a specimen, with random phases, and how often each wave of races and balls passes a ball in a turn of the shaft."""
    (seed, specimen), n_balls, spinning = place, bearing.n_balls, orders(bearing)
    rng = stream(seed, "specimen", specimen, "waviness")
    every, even = np.arange(LOWEST_ORDER, HIGHEST_ORDER + 1), 2 * np.arange(1, BALL_ORDERS + 1)
    races = _falling(every) * rms * _phasors(rng, (2, len(every)))
    # in even orders the two contacts of a ball have the same height: together twice as much
    balls = 2 * of_balls * _falling(even)[:, None] * _phasors(rng, (len(even), n_balls))
    for site, wear, only in worn:
        rng = stream(seed, "specimen", specimen, "wear")
        shape = _falling(every) if only is None else math.sqrt(2) * (every == only)
        races[RACES.index(site)] += shape * wear * _phasors(rng, (len(every),))
    passing = np.stack([every * (1 - spinning.ftf), every * spinning.ftf])
    if of_balls == 0:
        return Waviness(races, ROUND.balls), (passing, ROUND.balls.real)
    return Waviness(races, balls), (passing, (even * spinning.bsf)[:, None])


def _phasors(rng: np.random.Generator, shape: tuple[int, ...]) -> Any:
    """Complex numbers of size 1 with random phases."""
    return np.exp(1j * rng.uniform(0, 2 * np.pi, shape))


def _falling(orders_of_turn: NDArray[np.int_]) -> FloatArray:
    """Amplitudes that fall as 1/order, of unit rms together [1]."""
    falling = 1 / orders_of_turn
    return falling * (math.sqrt(2) / np.linalg.norm(falling))
