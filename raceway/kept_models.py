"""Models trained on a recipe; the reference model of ``diagnose`` is one of them, and is kept per user.

``recipe -> corpus in a temporary folder -> feature table -> model``

The reference model is trained on records of 2 s, in which lines rise higher above the floor than in the half seconds of its recipe, and
holds a model trained on those for shorter recordings. The feature table of both corpora ships with Raceway, so that its first use takes
seconds. ``make reference`` writes it (`benchmarks.reference_table`); unlike a model file it depends on no version of scikit-learn.

The kept file is named after the versions of Raceway and scikit-learn, and a hash of all that it was made from: the recipe, sources and
libraries. A damaged one is made again. A lock keeps two processes from making it at once.
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
    if shipped.attrs["recipes"] != identities(both_lengths(read_recipe(recipe))):
        return [make_table(recipe, team)]
    long = shipped[DURATION].values == LONG
    return [shipped.isel(record=long), shipped.isel(record=~long)]


def both_lengths(recipe: "Recipe") -> tuple["Recipe", "Recipe"]:
    """A recipe with records of 2 s, and as it is."""
    return lasting(recipe, LONG), recipe


def lasting(recipe: "Recipe", seconds: float) -> "Recipe":
    """A recipe with records of another duration."""
    return recipe.model_copy(update={"recording": recipe.recording.model_copy(update={"duration_s": seconds})})


def identities(recipes: Iterable["Recipe"]) -> str:
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


def open_model(path: Path | None = None) -> tuple["Model", Path]:
    """Model of a file, and the file; without one the reference model of this user, which is trained if there is none as it was made.

    Raises
    ------
    CorpusError
        If the file is no model, or the cache cannot be written.
    """
    from features.baselines.models import Model

    if path is not None:
        return Model.load(path), path
    path = reference_path()
    model = _kept(path)
    if model is None:
        with _lock(path):
            model = _kept(path) or _trained(path)  # another process may have made it meanwhile
    return model, path


def reference_model() -> "Model":
    """Reference model of ``raceway diagnose``; the first call trains it, as `open_model`."""
    return open_model()[0]


def _kept(path: Path) -> "Model | None":
    from features.baselines.models import Model

    try:
        return Model.load(path) if path.is_file() else None
    except CorpusError:
        notice(f"{path}: is damaged. It is made again.")
        return None


def _trained(path: Path) -> "Model":
    from gen.recipe import shipped_recipes

    notice(f"training a model on the recipe {REFERENCE}; it is kept as {path}.")
    # of this installation, whatever lies in the working folder
    model, _ = train_and_score(recipe_tables(shipped_recipes()[REFERENCE]), DEFAULT_ESTIMATOR)
    path.unlink(missing_ok=True)
    model.save(path)
    return model


def reference_path() -> Path:
    """File of the reference model of this user, whether it exists or not."""
    from features.baselines.score_sources import score_sources
    from gen.generation.record_sources import sources_sha256
    from gen.recipe import shipped_recipes

    made_from = [hashlib.sha256(shipped_recipes()[REFERENCE].read_bytes()).hexdigest()]  # reading it takes 0.3 s
    made_from += [sources_sha256(), score_sources(), hash_sources(*_OWN_SOURCES)]
    made_from += [version(library) for library in _LIBRARIES]
    digest = hashlib.sha256("\n".join(made_from).encode()).hexdigest()[:HASH_LETTERS]
    versions = f"raceway-{version('raceway')}-scikit-learn-{version('scikit-learn')}"
    return cache_folder() / f"{REFERENCE}-{digest}-{versions}.skops"


def cache_folder() -> Path:
    """Folder for files that can be made again: ``RACEWAY_CACHE``, or raceway in the cache folder of the user."""
    chosen = os.environ.get(CACHE_VARIABLE)
    return Path(chosen) if chosen else user_cache_path("raceway")


@contextmanager
def _lock(path: Path) -> Iterator[None]:
    """Hold the lock of a file in the cache, whose folder is created."""
    lock = FileLock(path.with_suffix(".lock"))
    with ExitStack() as held:
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
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
