"""Variables stored with each record: each is declared once, beside the stage or mechanism that knows its value."""

from collections.abc import Sequence
from dataclasses import replace
from importlib.metadata import version
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from gen.corpus import DRAWS, LIFE, make_dataset
from gen.corpus.simulated import with_values
from gen.measurement import gains
from gen.measurement.measure import Measured, counts_per_unit
from gen.mechanisms.mechanism import plugins_of
from gen.mechanisms.mechanism_labels import label_values, labels_with
from gen.recipe import Recipe
from gen.scenarios import scenario_texts, variables
from gen.simulation import truth

LABELS = (
    *variables.LABELS,
    *truth.LABELS,
    *gains.LABELS,
    *labels_with(),
    *with_values(step_error=None, draws=None),
)
"""Variables of every simulated record, those of all corpora among them."""


def part_dataset(
    recipe: Recipe, records: Sequence[Measured], step_error: NDArray[np.float64] | None = None
) -> xr.Dataset:
    """Records with their labels, in the layout of the corpus; ``step_error`` is NaN throughout if it is not given."""
    hidden = recipe.truth.undetected == "healthy"
    # labels of a fault that nobody can see are those of its record without it
    scenarios = [
        record.scenario if record.detectable or not hidden else record.scenario.without_fault() for record in records
    ]
    runs = [replace(record.run, scenario=scenario) for record, scenario in zip(records, scenarios, strict=True)]
    # what only records of lives have
    lives = [life for scenario in scenarios if (life := scenario.origin.life) is not None]
    life_labels = LIFE if lives or recipe.life is not None else ()
    of_mechanisms = [
        label_values(scenario.recipe, record.chain_labels) for scenario, record in zip(scenarios, records, strict=True)
    ]
    # each stage gives the labels of what it knows
    columns: dict[str, ArrayLike] = {
        DRAWS: scenario_texts([record.scenario for record in records]),
        "step_error": np.full(len(records), np.nan) if step_error is None else step_error,
    }
    for labels, rows in (
        (variables.LABELS, scenarios),
        (truth.LABELS, runs),
        (life_labels, lives),
        (gains.LABELS, records),
    ):
        columns |= {label.name: label.column(rows) for label in labels}
    # 0 in a record without the mechanism
    mechanism_labels = labels_with(plugins_of(recipe, *(scenario.recipe for scenario in scenarios)))
    columns |= {label.name: [values.get(label.name, 0) for values in of_mechanisms] for label in mechanism_labels}
    per_unit, n_channels = counts_per_unit(recipe), len(recipe.recording.channels)
    # filled row by row, so that memory holds each signal once
    signal: Any = np.empty((len(records), n_channels, recipe.n_samples), np.float32 if per_unit is None else np.int16)
    for row, record in zip(signal, records, strict=True):
        row[:] = record.signal
    return make_dataset(
        signal,
        recipe.recording.sample_rate_hz,
        tuple(channel.name for channel in recipe.recording.channels),
        columns,
        extra=LABELS + mechanism_labels + life_labels,
        counts_per_unit=per_unit,
        attributes={
            "title": f"Records of recipe {recipe.name}",
            "history": f"simulated by raceway {version('raceway')} with recipe {recipe.name}, seed {recipe.seed}",
            "source": "simulation: Hertz contact shaft-bearing model, classical Runge-Kutta",
        },
    )
