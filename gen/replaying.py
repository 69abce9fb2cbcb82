"""What a generated corpus knows of its records: each can be simulated again, and has its scenario and the true angle of its shaft."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus import DRAWS, SIGNAL, Manifest, open_corpus, read_manifest, temporary_folder
from gen.corpus.manifest_fields import Numbers, Origin
from gen.corpus.record_hashes import stored_signal
from gen.errors import CorpusError
from gen.families import Records, made_again, made_from, picked
from gen.labels import part_dataset
from gen.recipe import Recipe, read_recipe, recipe_hash
from gen.scenarios import Scenario, read_scenario
from gen.sharing.copying import in_floating_point, renumbered, small_file
from gen.simulation.shaft import shaft_angles as angles_of
from gen.simulation.timeline import timeline


def corpus_recipe(directory: Path, record: int = 0) -> Recipe:
    """Recipe of a record of a generated corpus, with the seed, the number of records and the extensions of its corpus.

    All records of a corpus have the same recipe, unless it was merged from several corpora.

    Raises
    ------
    CorpusError
        If the record was not generated, or its recipe does not have the hash in the manifest.
    """
    manifest = read_manifest(directory)
    _check_record(directory, manifest.records, record)
    origin = _origin_of(manifest, record)
    facts, name = (manifest, "recipe.yaml") if origin is None else (origin, origin.recipe_file)
    text = None if name is None else small_file(directory, name)
    if text is None or facts.overrides is None or facts.recipe_sha256 is None:
        if origin is not None:
            title = origin.title or "without a title"
            raise CorpusError(f"{directory}: record {record} comes from a corpus ({title}) that was not generated.")
        raise CorpusError(f"{directory}: holds no recipe.yaml, so it was not generated and cannot be replayed.")
    with temporary_folder() as folder:  # a packed file has no path of its recipe
        path = folder / "recipe.yaml"
        path.write_bytes(text)
        recipe = read_recipe(path, seed=facts.overrides.seed, records=facts.overrides.records)
    if recipe_hash(recipe) != facts.recipe_sha256:
        raise CorpusError(f"{directory / str(name)}: is not the recipe of the corpus; restore it to replay.")
    return recipe.extended(facts.overrides.extensions)


def _origin_of(manifest: Manifest, record: int) -> Origin | None:
    """Corpus that a record of a merged corpus comes from; None if the corpus was not merged."""
    rows = iter(manifest.parts)
    for origin in manifest.origins:
        record -= sum(next(rows).records for _ in range(origin.parts))
        if record < 0:
            return origin
    return None


@dataclass(frozen=True)
class Replayed:
    """A record that was simulated again."""

    dataset: xr.Dataset
    """The new record, one row, with the channels and numbers of the corpus (undecoded)."""
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
    with open_corpus(directory, check="size") as corpus:
        manifest, recipe = read_manifest(directory), corpus_recipe(directory, record)
        origin = _origin_of(manifest, record)
        added = Numbers() if origin is None else origin.added
        number = int(corpus["recording"][record]) - added.recording
        stored, scale = stored_signal(corpus[SIGNAL].variable[record : record + 1])
        channels = [str(name) for name in corpus["channel"].values]
        tries = int(corpus["fault_tries"][record]), int(corpus["level_tries"][record])
        if (origin or manifest).scenarios == "given":
            made = _made_as_given(directory, recipe, corpus, record)
        else:
            made = made_again(recipe, number, *tries)
    whole = part_dataset(made.measured, made.measured.scenarios, recipe, made.response)
    names = [str(name) for name in whole["channel"].values]
    dataset = renumbered(whole.isel(channel=[names.index(name) for name in channels]), added)
    # counts are compared as counts: an older corpus decodes them to double precision
    new = dataset if scale is not None else in_floating_point(dataset)
    again = new[SIGNAL].values
    return Replayed(dataset, bool(np.array_equal(stored, again, equal_nan=True)))


def _made_as_given(directory: Path, recipe: Recipe, corpus: xr.Dataset, record: int) -> Records:
    """Make a record again from its stored scenario; the largest severity of a group of records sets the level of the group."""
    pairs = corpus["pair"].values
    group = [record] if pairs[record] < 0 else np.flatnonzero(pairs == pairs[record]).tolist()
    group.sort(key=lambda one: int(corpus["rung"][one]))
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
        _check_record(directory, corpus.sizes["record"], record)
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
    recipe, scenario = corpus_recipe(Path(directory), record), stored_scenario(directory, record)
    axis = timeline(recipe)
    return angles_of(scenario, axis)[axis.kept]


def _check_record(directory: Path, n_records: int, record: int) -> None:
    if not 0 <= record < n_records:
        raise CorpusError(f"{directory}: record {record} is not in it; it has records 0 to {n_records - 1}.")
