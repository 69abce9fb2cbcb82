"""Variables stored with each record: each is declared once, beside the stage or mechanism that knows its value."""

from importlib.metadata import version

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from gen.corpus import DRAWS, LIFE, make_dataset
from gen.corpus.simulated import with_values
from gen.measurement import levels
from gen.measurement.measure import Measured
from gen.mechanisms import labels as mechanisms
from gen.scenarios import same_recording, scenario_texts, variables
from gen.simulation import steps, truth
from gen.simulation.simulate import Response

LABELS = (
    *variables.LABELS,
    *truth.LABELS,
    *steps.LABELS,
    *levels.LABELS,
    *mechanisms.LABELS,
    *with_values(step_error=None, draws=None),
)
"""Variables of every simulated record, those of all corpora among them."""


def part_dataset(measured: Measured, response: Response, step_error: NDArray[np.float64] | None = None) -> xr.Dataset:
    """Measured records with their labels, in the layout of the corpus; ``step_error`` is NaN throughout if it is not given."""
    recipe = same_recording(measured.scenarios)
    scenarios = [
        scenario.without_fault() if recipe.truth.undetected == "healthy" and not detectable else scenario
        for scenario, detectable in zip(measured.scenarios, measured.detectable, strict=True)
    ]
    truths = [known._replace(scenario=one) for known, one in zip(response.truth, scenarios, strict=True)]
    lives = [life for one in scenarios if (life := one.origin.life) is not None]
    life_labels = LIFE if lives else ()
    of_mechanisms = [
        mechanisms.label_values(one.recipe, chain) for one, chain in zip(scenarios, measured.chain_labels, strict=True)
    ]
    columns: dict[str, ArrayLike] = {
        DRAWS: scenario_texts(measured.scenarios),
        "step_error": np.full(len(scenarios), np.nan) if step_error is None else step_error,
    }
    for labels, records in ((variables.LABELS, scenarios), (truth.LABELS, truths), (life_labels, lives)):
        columns |= {label.name: label.column(records) for label in labels}
    for labels, arrays in ((steps.LABELS, response), (levels.LABELS, measured)):
        columns |= {label.name: getattr(arrays, label.name) for label in labels}
    columns |= {label.name: [values[label.name] for values in of_mechanisms] for label in mechanisms.LABELS}
    return make_dataset(
        measured.signal,
        recipe.recording.sample_rate_hz,
        tuple(channel.name for channel in recipe.recording.channels),
        columns,
        extra=LABELS + life_labels,
        counts_per_unit=measured.counts_per_unit,
        attributes={
            "title": f"Records of recipe {recipe.name}",
            "history": f"simulated by raceway {version('raceway')} with recipe {recipe.name}, seed {recipe.seed}",
            "source": "simulation: Hertz contact shaft-bearing model, classical Runge-Kutta",
        },
    )
