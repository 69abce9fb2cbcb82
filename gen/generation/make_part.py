"""A part of a corpus: records drawn, simulated, measured and labelled, from the recipe and their numbers alone."""

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus.numbering import NUMBERS
from gen.corpus.schema import add_class_names
from gen.generation.identity import failures_of, part_attributes
from gen.generation.labels import part_dataset
from gen.generation.step_checks import step_errors
from gen.generation.undetected import Made, made_from, make_records
from gen.measurement.measure import Measured
from gen.recipe import Recipe
from gen.scenarios import draw_scenarios


def make_part(recipe: Recipe, numbers: range) -> xr.Dataset:
    """Make the records with the given numbers: no files, no threads, and the same for the same arguments.

    Returns
    -------
    Dataset
        Records with their labels in the layout of the corpus (undecoded). The attribute ``failures`` has one sentence for each record that
        is left out; all of them may be.

    Raises
    ------
    SimulationError
        If a record needs finer steps than the recipe allows.
    """
    outcomes = make_records(recipe, numbers) if recipe.origin is None else made_from(draw_scenarios(recipe))
    kept = [record for record in outcomes if isinstance(record, Measured)]
    part = labelled(recipe, outcomes, step_errors(recipe, numbers, kept))
    if recipe.origin is not None:  # the only record of its corpus, whatever its numbers in another one
        part = part.assign({name: part[name].copy(data=np.minimum(part[name], 0)) for name in NUMBERS})
    return part.assign_attrs(part_attributes(recipe, failures_of(part)))


def labelled(recipe: Recipe, outcomes: Sequence[Made], step_error: NDArray[Any] | None = None) -> xr.Dataset:
    """Records with their labels, without those that are left out; the attribute ``failures`` says why."""
    records = [record for record in outcomes if isinstance(record, Measured)]
    # a record behind the end of a life has no sentence
    sentences = [record for record in outcomes if isinstance(record, str) and record]
    return part_dataset(recipe, records, step_error).assign_attrs(failures=json.dumps(sentences))


def decoded(parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """Records of parts in m s-2, with their classes in words."""
    records = xr.decode_cf(joined(parts), decode_times=False).load()
    add_class_names(records)
    return records


def joined(parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """Records of parts of one recipe, one after the other."""
    if len(parts) == 1:
        return parts[0]
    return xr.concat(parts, "record", data_vars="minimal", coords="minimal", combine_attrs="override")
