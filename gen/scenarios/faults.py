"""Choose the fault class of every specimen of a rig, and draw its damage."""

import functools
import math
from dataclasses import replace

import numpy as np

from gen.corpus import FAULTS
from gen.errors import RecipeError
from gen.physics.bearing import Bearing
from gen.recipe import (
    BallFault,
    CageFault,
    CompoundFault,
    DistributedFault,
    Fault,
    Healthy,
    RaceFault,
    Recipe,
    fault_class,
)
from gen.recipe.distributions import weighted_index
from gen.scenarios.draws import Draws
from gen.scenarios.model import Purpose, Spall, Specimen, Wear, stream
from gen.units import to_si

_WIDEST = {"inner": 5.0, "outer": 5.0, "ball": 1.4}  # largest width of a spall over the radius of its surface


def damaged(draws: Draws, entry: Fault, specimen: Specimen) -> Specimen:
    """Specimen with the fault of one ``faults`` entry of the recipe."""
    if isinstance(entry, Healthy):
        return specimen
    if isinstance(entry, DistributedFault):
        return replace(specimen, wear=Wear(entry.site, to_si(draws.value(entry.waviness_um), "um"), entry.order))
    for part in entry.parts if isinstance(entry, CompoundFault) else (entry,):
        specimen = _with_part(draws, part, specimen)
    return specimen


def _with_part(draws: Draws, part: RaceFault | BallFault | CageFault, specimen: Specimen) -> Specimen:
    if isinstance(part, CageFault):
        return replace(specimen, cage=draws.section(part))
    spalls = specimen.spalls + _draw_spalls(draws, part, specimen.bearing, specimen.number)
    if isinstance(part, RaceFault):
        return replace(specimen, spalls=spalls)
    axis = draws.section(part)
    axis = {name: axis[name] for name in ("track", "axis_offset", "axis_wander")}
    if part.axis_jumps is not None:
        jumps = draws.section(part.axis_jumps)
        axis |= {"jumps": jumps["probability"], "spread": jumps["spread"]}
    return replace(specimen, spalls=spalls, axis=axis)


def _draw_spalls(draws: Draws, entry: RaceFault | BallFault, bearing: Bearing, specimen: int) -> tuple[Spall, ...]:
    carrier = int(draws.u() * bearing.n_balls)
    radius = bearing.radius(entry.kind)
    trace = tuple(to_si(depth, "um") for depth in entry.trace_um or ())
    spalls = []
    for _ in range(round(draws.value(entry.n_spalls))):
        width, depth = to_si(draws.value(entry.width_mm), "mm"), to_si(draws.value(entry.depth_um), "um")
        angle, roughness = to_si(draws.value(entry.angle_deg), "deg"), to_si(draws.value(entry.roughness_um), "um")
        edge = {} if entry.jagged_edge is None else draws.section(entry.jagged_edge)
        spalls.append(
            Spall(
                site=entry.kind,
                width=width,
                depth=max(trace, default=depth),
                angle=angle,
                ball=carrier,
                profile=entry.profile,
                trace=trace,
                roughness=roughness,
                scatter=edge.get("scatter", 0.0),
            )
        )
        if width > _WIDEST[entry.kind] * radius:
            raise RecipeError(
                f"specimen {specimen}: a spall of {width * 1e3:g} mm does not fit the {entry.kind} radius of {radius * 1e3:.3g} mm; "
                f"keep width_mm below {_WIDEST[entry.kind] * radius * 1e3:.3g}."
            )
    return tuple(spalls)


def fault_of_each_specimen(recipe: Recipe, rig: int) -> list[str]:
    """Fault class of each specimen of a rig, by weight; a rig has healthy and faulty specimens if the recipe has both."""
    weights: dict[str, float] = dict.fromkeys(FAULTS, 0.0)
    for entry in recipe.faults:
        weights[fault_class(entry)] += entry.weight
    total, count = sum(weights.values()), recipe.corpus.specimens_per_rig
    rng = stream(recipe.seed, rig, 0, 0, Purpose.CLASSES)
    shares = {kind: weight / total * count for kind, weight in weights.items() if weight > 0}
    chosen = [kind for kind, share in shares.items() for _ in range(math.floor(share + 1e-9))]
    rest = np.array([share - math.floor(share + 1e-9) for share in shares.values()])
    if len(chosen) < count:
        # systematic sampling in random order: each remaining class at most once, with a probability equal to its fraction
        order = rng.permutation(len(rest))
        edges = np.cumsum(np.maximum(rest[order], 0.0))
        picks = np.searchsorted(edges, rng.random() + np.arange(count - len(chosen)), side="right")
        chosen += [list(shares)[i] for i in order[np.minimum(picks, len(rest) - 1)]]
    faulty = [kind for kind in shares if kind != "healthy"]
    if "healthy" in shares and faulty:
        if "healthy" not in chosen:
            chosen[int(rng.integers(count))] = "healthy"
        elif all(kind == "healthy" for kind in chosen):
            chosen[0] = faulty[weighted_index(tuple(shares[kind] for kind in faulty), rng.random())]
    return [chosen[i] for i in rng.permutation(count)]


@functools.lru_cache(maxsize=16)
def first_specimens(recipe: Recipe) -> dict[str, int]:
    """Number of the first specimen of each fault class in the corpus; the search stops when it has found every class."""
    corpus = recipe.corpus
    n_specimens = -(-recipe.n_records // corpus.records_per_specimen)
    n_classes = len({fault_class(entry) for entry in recipe.faults if entry.weight > 0})
    found: dict[str, int] = {}
    for first in range(0, n_specimens, corpus.specimens_per_rig):
        faults = fault_of_each_specimen(recipe, first // corpus.specimens_per_rig)
        for number, fault in enumerate(faults[: n_specimens - first], first):
            found.setdefault(fault, number)
        if len(found) == n_classes:
            break
    return found
