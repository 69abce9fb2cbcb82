"""What a generated corpus knows of its records: each can be simulated again, and has its scenario and the true angle of its shaft."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus import DRAWS, SIGNAL, open_corpus, read_manifest
from gen.errors import CorpusError
from gen.families import Records, made_again, made_from, picked
from gen.labels import part_dataset
from gen.recipe import Recipe, read_recipe, recipe_hash
from gen.scenarios import Scenario, read_scenario
from gen.simulation.shaft import shaft_angles as angles_of
from gen.simulation.timeline import timeline


def corpus_recipe(directory: Path) -> Recipe:
    """Recipe of a generated corpus, with the seed and the number of records of the call that generated it.

    Raises
    ------
    CorpusError
        If the corpus was not generated, or its recipe does not have the hash in the manifest.
    """
    manifest = read_manifest(directory)
    path = directory / "recipe.yaml"
    if not path.is_file() or manifest.overrides is None:
        raise CorpusError(f"{directory}: holds no recipe.yaml, so it was not generated and cannot be replayed.")
    recipe = read_recipe(path, seed=manifest.overrides.seed, records=manifest.overrides.records)
    if recipe_hash(recipe) != manifest.recipe_sha256:
        raise CorpusError(f"{path}: is not the recipe of the corpus; restore it to replay.")
    return recipe


@dataclass(frozen=True)
class Replayed:
    """A record that was simulated again."""

    dataset: xr.Dataset
    """The new record, one row, in the layout of the corpus (undecoded)."""
    identical: bool
    """Whether its samples equal those of the stored record, bit for bit."""


def replay(directory: Path | str, record: int) -> Replayed:
    """Simulate one record of a generated corpus again, and compare it with the stored record.

    ``record`` is the number of the record in the corpus, from 0.

    Raises
    ------
    CorpusError
        If the corpus has no such record, or was not generated.
    """
    directory = Path(directory)
    recipe = corpus_recipe(directory)
    with open_corpus(directory, check="size") as corpus:
        _check_record(directory, corpus, record)
        number = int(corpus["recording"][record])
        stored = corpus[SIGNAL][record].values
        tries = int(corpus["fault_tries"][record]), int(corpus["level_tries"][record])
        if read_manifest(directory).scenarios == "given":
            made = _made_as_given(directory, recipe, corpus, record)
        else:
            made = made_again(recipe, number, *tries)
    dataset = part_dataset(made.measured, made.measured.scenarios, recipe, made.response)
    again = xr.decode_cf(dataset[[SIGNAL]], decode_times=False)[SIGNAL][0].values
    return Replayed(dataset, bool(np.array_equal(stored, again, equal_nan=True)))


def _made_as_given(directory: Path, recipe: Recipe, corpus: xr.Dataset, record: int) -> Records:
    """Make a record again from its stored scenario; the largest severity of a group of records sets the level of the group."""
    pairs = corpus["pair"].values
    group = [record] if pairs[record] < 0 else np.flatnonzero(pairs == pairs[record]).tolist()
    scenarios = [stored_scenario(directory, one) for one in group]
    if pairs[record] >= 0 and scenarios[-1].record.rung != recipe.corpus.n_rungs - 1:
        raise CorpusError(
            f"{directory}: record {record}: cannot be replayed, because the largest severity of its pair, which set its level, is not here."
        )
    return picked([(made_from(scenarios, recipe), group.index(record))])


def stored_scenario(directory: Path | str, record: int) -> Scenario:
    """Scenario that a generated corpus stores with a record.

    ``record`` counts the records of the corpus from 0.

    Raises
    ------
    CorpusError
        If there is no such record, or the corpus stores no scenario of it.
    """
    directory = Path(directory)
    with open_corpus(directory, check="size") as corpus:
        _check_record(directory, corpus, record)
        if DRAWS not in corpus:
            raise CorpusError(f"{directory}: has no variable {DRAWS}, so it was not generated and stores no scenarios.")
        text = str(corpus[DRAWS][record].values)
    try:
        return read_scenario(text)
    except CorpusError as error:
        raise CorpusError(f"{directory}: record {record}: {error}") from None


def shaft_angles(directory: Path | str, record: int) -> NDArray[np.float64]:
    """Angle of the shaft at every sample of a record of a generated corpus, shape (elapsed_time,) [rad].

    It is the true angle, by which bearing, unbalance and background turn: for order tracking and synchronous averages.

    Raises
    ------
    CorpusError
        If there is no such record, or the corpus was not generated.
    """
    recipe, scenario = corpus_recipe(Path(directory)), stored_scenario(directory, record)
    axis = timeline(recipe)
    return angles_of(scenario, axis)[axis.kept]


def _check_record(directory: Path, corpus: xr.Dataset, record: int) -> None:
    n_records = corpus.sizes["record"]
    if not 0 <= record < n_records:
        raise CorpusError(f"{directory}: record {record} is not in it; it has records 0 to {n_records - 1}.")
