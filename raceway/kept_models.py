"""Models trained on a recipe, and kept per user; the reference model of ``diagnose`` is one of them.

``recipe -> corpus in a temporary folder -> feature table -> model``

The reference model is trained on records of 2 s, in which lines rise higher above the floor than in the half seconds of its recipe, and
holds a model trained on those for shorter recordings. The feature table of both corpora ships with Raceway, so that its first use takes
seconds. ``make reference`` writes it; unlike a model file it depends on no version of scikit-learn.

A kept model is named after the recipe, the estimator, the versions of Raceway and scikit-learn, and a hash of all that it was made from:
the file of the recipe, sources and libraries. The file beside it with its SHA-256 and name tells whether it is the one that was made
under this name; else it is made again. A lock keeps two processes from making it at once.
"""

import hashlib
import os
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

from filelock import FileLock, Timeout
from platformdirs import user_cache_path

from features.baselines.names import DEFAULT_ESTIMATOR
from features.table.durations import DURATION
from gen.corpus import write_durably
from gen.support.errors import CorpusError
from gen.support.sources import hash_sources
from raceway.console.options import USUAL, Team
from raceway.console.progress_bar import notice, notice_compilation, progress

if TYPE_CHECKING:
    import xarray as xr

    from features.baselines import Model, Scores
    from gen.recipe import Recipe

REFERENCE = "domain_randomised"
CACHE_VARIABLE = "RACEWAY_CACHE"
LONG = 2.0  # s, duration of the records of the reference model
HASH_LETTERS = 16
SHIPPED_TABLE = Path(__file__).with_name(f"{REFERENCE}.nc")
_OWN_SOURCES = ("raceway/kept_models.py", f"raceway/{SHIPPED_TABLE.name}")
_LIBRARIES = ("scikit-learn", "skops", "numpy", "scipy", "numba")  # whose versions make other models or files
_LABELS = ("fault", "width", "rig", "specimen", "recording", "split", "shaft_rate", DURATION)  # what a training needs
_FACTS = ("title", "channel", "band_low_hz", "band_high_hz")


def train_and_score(
    tables: Sequence["xr.Dataset"], estimator: str, team: Team = USUAL
) -> tuple["Model", "Scores | None"]:
    """Model trained on a feature table without its test split, and its scores on that split, with progress.

    A table without a test split, or with nothing else, is trained on as a whole and not scored. From a second table, of shorter records,
    the model for these is trained; the scores are those of the first.

    Raises
    ------
    CorpusError
        If the training has only one class, or the table lacks features.
    """
    from features.baselines import Model
    from gen.corpus import SPLITS

    def trained(some: "xr.Dataset") -> "tuple[Model, Scores | None]":
        test = some["split"].values == SPLITS.index("test")
        # without both kinds of records there is nothing to score
        whole = not test.any() or test.all()
        with progress("training", "fits") as report:
            workers = team.options(len(test))["workers"]
            model = Model(estimator).fit(some if whole else some.isel(record=~test), workers=workers, progress=report)
        return model, None if whole else model.score(some.isel(record=test))

    (model, scores), *shorter = map(trained, tables)
    model.shorter = shorter[0][0] if shorter else None
    return model, scores


def recipe_tables(recipe: Path | str, team: Team = USUAL) -> "list[xr.Dataset]":
    """Feature table of the corpus of a recipe, made now, with progress; both shipped ones for the recipe of the reference model.

    Raises
    ------
    RecipeError, SimulationError, CorpusError
        As `make_table`.
    """
    from features.table.table_files import read_table
    from gen.recipe import read_recipe

    shipped = read_table(SHIPPED_TABLE)
    if shipped.attrs["recipes"] != _identities(both_lengths(read_recipe(recipe))):
        return [make_table(recipe, team)]
    long = shipped[DURATION].values == LONG
    return [shipped.isel(record=long), shipped.isel(record=~long)]


def write_reference_table(output: Path) -> None:
    """Write the feature table of the reference model."""
    from features.table.table_files import write_table
    from gen.recipe import read_recipe, shipped_recipes

    write_table(reference_table(read_recipe(shipped_recipes()[REFERENCE])), output)


def reference_table(recipe: "Recipe", team: Team = USUAL) -> "xr.Dataset":
    """Features that the reference model takes, and labels that its training needs, of the corpora of `both_lengths`."""
    import xarray as xr

    from features.baselines.records import DEFAULT_GROUPS
    from features.baselines.references import with_energies

    parts, recipes = list["xr.Dataset"](), both_lengths(recipe)
    for one in recipes:
        table = make_table(one, team)
        # nothing else is needed for a training, and what ships should be small
        kept = table.reset_coords()[["features", "group", *_LABELS]].set_coords("group")
        kept = kept.isel(feature=kept["group"].isin(with_energies(DEFAULT_GROUPS)))
        kept.attrs = {name: table.attrs[name] for name in _FACTS}
        parts.append(kept)
    both = xr.concat(parts, "record", data_vars="minimal", join="exact", combine_attrs="identical")
    return both.assign_attrs(recipes=_identities(recipes))


def both_lengths(recipe: "Recipe") -> tuple["Recipe", "Recipe"]:
    """A recipe with records of 2 s, and as it is."""
    return lasting(recipe, LONG), recipe


def lasting(recipe: "Recipe", seconds: float) -> "Recipe":
    """A recipe with records of another duration."""
    return recipe.model_copy(update={"recording": recipe.recording.model_copy(update={"duration_s": seconds})})


def _identities(recipes: Iterable["Recipe"]) -> str:
    """What the records of a table depend on, whatever the number and the files of the corpora that it was made from."""
    from gen.recipe import corpus_identity

    return " ".join(map(corpus_identity, recipes))


def make_table(recipe: "Path | str | Recipe", team: Team = USUAL) -> "xr.Dataset":
    """Feature table of a corpus that is generated in a temporary folder and removed again, with progress.

    Raises
    ------
    RecipeError, SimulationError
        If the recipe cannot be simulated.
    CorpusError
        If the disk refuses the corpus.
    """
    from features import feature_table
    from gen import generate
    from gen.corpus import temporary_folder
    from gen.support.executor import cores

    workers = team.workers or cores()
    # the corpus takes gigabytes, its features megabytes
    with temporary_folder() as folder:
        corpus = folder / "corpus"
        with notice_compilation(), progress("generating", "records") as report:
            generate(recipe, corpus, workers=workers, progress=report)
        with progress("computing features", "parts") as report:
            return feature_table(corpus, workers=workers, progress=report)


def load_reference_model() -> tuple["Model", Path]:
    """Reference model of this user and its file; it is made if there is none as it was made.

    Raises
    ------
    CorpusError
        If the cache cannot be written.
    """
    from gen.recipe import shipped_recipes

    # of this installation, whatever lies in the working folder
    model, path, _ = kept_model(shipped_recipes()[REFERENCE])
    return model, path


def reference_model() -> "Model":
    """Reference model of ``raceway diagnose``; the first call trains it, as `load_reference_model`."""
    return load_reference_model()[0]


def kept_model(
    recipe: Path | str, estimator: str = DEFAULT_ESTIMATOR, *, team: Team = USUAL
) -> tuple["Model", Path, "Scores | None"]:
    """Kept model of a recipe, its file, and its scores if it was trained now.

    Raises
    ------
    RecipeError, SimulationError, CorpusError
        As `keep_model`.
    """
    from features.baselines.models import Model

    path, scores = keep_model(recipe, estimator, team=team)
    return Model.load(path), path, scores


def keep_model(
    recipe: Path | str, estimator: str = DEFAULT_ESTIMATOR, *, team: Team = USUAL
) -> tuple[Path, "Scores | None"]:
    """Train a model on a recipe and keep it in the cache of this user, unless it is there as it was made.

    Parameters
    ----------
    recipe
        File, or name of a recipe that ships with Raceway.
    estimator
        Name of a baseline.
    team
        Number of workers on this machine.

    Returns
    -------
    The file, and the scores on the test split if the model was trained now.

    Raises
    ------
    RecipeError, SimulationError
        If the recipe cannot be simulated.
    CorpusError
        If the cache cannot be written.
    """
    path = kept_path(recipe, estimator)
    if is_kept(path):
        return path, None
    with _lock(path):
        if is_kept(path):  # another process has made it meanwhile
            return path, None
        if path.is_file():
            notice(f"{path}: is altered, or was not made here. It is made again.")
            path.unlink()  # it may be no model, and nothing else is replaced
        notice(f"training a model on the recipe {recipe_name(recipe)}; it is kept as {path}.")
        model, scores = train_and_score(recipe_tables(recipe, team), estimator, team)
        model.save(path)
        _seal(path)
    return path, scores


def is_kept(path: Path) -> bool:
    """Whether a file in the cache is the one that was made under its name."""
    try:
        return _seal_of(path).read_bytes() == _seal_text(path)
    except OSError:
        return False


def _seal(path: Path) -> None:
    write_durably(_seal_text(path), _seal_of(path))


def _seal_of(path: Path) -> Path:
    return path.with_name(f"{path.name}.sha256")


def _seal_text(path: Path) -> bytes:
    """SHA-256 and name of a file, as ``sha256sum`` writes and checks them."""
    return f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n".encode()


def kept_path(recipe: Path | str, estimator: str = DEFAULT_ESTIMATOR) -> Path:
    """File of the kept model of a recipe, whether it exists or not."""
    from features.baselines.score_sources import score_sources
    from gen.generation.record_sources import sources_sha256
    from gen.recipe import find_recipe

    made_from = [hashlib.sha256(find_recipe(recipe).read_bytes()).hexdigest()]  # reading it takes 0.3 s
    made_from += [sources_sha256(), score_sources(), hash_sources(*_OWN_SOURCES)]
    made_from += [version(library) for library in _LIBRARIES]
    digest = hashlib.sha256("\n".join(made_from).encode()).hexdigest()[:HASH_LETTERS]
    versions = f"raceway-{version('raceway')}-scikit-learn-{version('scikit-learn')}"
    return cache_folder() / f"{recipe_name(recipe)}-{digest}-{estimator}-{versions}.skops"


def recipe_name(recipe: Path | str) -> str:
    """Name of the file of a recipe without its suffix."""
    return Path(recipe).stem


def cache_folder() -> Path:
    """Folder for files that can be made again: ``RACEWAY_CACHE``, or raceway in the cache folder of the user."""
    chosen = os.environ.get(CACHE_VARIABLE)
    return Path(chosen) if chosen else user_cache_path("raceway")


@contextmanager
def _lock(path: Path) -> Iterator[None]:
    """Hold the lock of a file in the cache, whose folder is created."""
    with ExitStack() as held:
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            lock = FileLock(path.with_suffix(".lock"))
            try:
                held.enter_context(lock.acquire(blocking=False))
            except Timeout:
                # a second process would train the same model again
                notice("waiting for another process that trains this model.")
                held.enter_context(lock)
        except OSError as error:
            message = (
                f"{path.parent}: this cache folder cannot be written ({error.strerror}); set {CACHE_VARIABLE} to another folder, or write "
                f"the model elsewhere with raceway train {REFERENCE} -o MODEL."
            )
            raise CorpusError(message) from error
        yield


if __name__ == "__main__":
    write_reference_table(SHIPPED_TABLE)
