"""Scenarios that were changed by hand or come from a file: their parts must fit each other, and values can be missing or absurd."""

from collections.abc import Iterator
from contextlib import contextmanager

from gen.corpus.fault_classes import CLASSES
from gen.mechanisms.background.section import KEYS
from gen.mechanisms.chain.measuring_chain import foreign
from gen.mechanisms.faults.race_spalls import check_fits
from gen.physics.bearing import Bearing
from gen.physics.extent import MAX_BALLS
from gen.scenarios.model import Scenario, Specimen
from gen.support.errors import RecipeError, SimulationError
from gen.support.limits import check_limit

_LINES = {name: row.lines for name, row in CLASSES.items()}


def check_scenario(scenario: Scenario) -> None:
    """Refuse a scenario that cannot be simulated or would get a wrong label.

    Raises
    ------
    RecipeError
        If its parts do not fit each other, or it asks for more memory than the limits allow.
    """
    settings, rig, record = scenario.settings, scenario.rig, scenario.record
    channels = len(settings.channels)
    samples = round(settings.settle * settings.sample_rate + settings.samples) * channels
    check_limit("record_samples", samples, "a record of all channels, settings.settle included, has", RecipeError)
    if len(rig.channels) != channels or len(rig.own_paths) != channels:
        raise RecipeError(f"rig.channels and rig.own_paths need one entry for each of {channels} settings.channels.")
    if (record.snr is None) != (record.rms is None):
        raise RecipeError("record.snr and record.rms must both be given, or both be None.")
    unknown = rig.background.keys() - KEYS
    if unknown:
        raise RecipeError(f"rig.background: {min(unknown)[:60]!r} is not drawn by any recipe; leave it out.")
    strange = foreign(rig.sensor_faults, record.sensor_faults, channels)
    if strange is not None:
        raise RecipeError(
            f"sensor_faults: {strange[:60]!r} is not as a recipe draws it; keep what was drawn, or leave it out."
        )
    _check_damage(rig.bearing, scenario.specimen)


def _check_damage(drawing: Bearing, specimen: Specimen) -> None:
    """Refuse a specimen that is of another bearing than on the drawing, or whose damage is impossible or differs from its label."""
    if not drawing.n_balls == specimen.bearing.n_balls <= MAX_BALLS:
        raise RecipeError(f"rig.bearing and specimen.bearing must have the same n_balls, {MAX_BALLS} at most.")
    parts = specimen.damaged_parts
    label = "compound" if len(parts) > 1 else (parts or ["healthy"])[0]
    if _LINES.get(specimen.fault, specimen.fault) != _LINES.get(label):
        raise RecipeError(
            f"specimen.fault is {specimen.fault}, and the damage of the specimen is {label!s:.60}; change one of the two."
        )
    for spall in specimen.spalls:
        if spall.width <= 0 or spall.depth <= 0:
            raise RecipeError(
                "specimen.spalls: width and depth of a spall must be above 0; leave out a spall that is not there."
            )
        check_fits(spall, specimen.bearing, f"specimen {specimen.number}")


@contextmanager
def simulation_errors() -> Iterator[None]:
    """Turn what missing or absurd drawn values raise into one sentence.

    Raises
    ------
    SimulationError
        In place of the error of Python or NumPy.
    """
    try:
        yield
    except (ArithmeticError, LookupError, MemoryError, TypeError, ValueError) as error:
        reason = f"{type(error).__name__}: {error}"
        raise SimulationError(
            f"the drawn values of a scenario cannot be simulated ({reason}); keep all of them, in the ranges of recipes."
        ) from None
