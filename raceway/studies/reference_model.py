"""Models trained on a recipe, and kept per user; the reference model of ``diagnose`` is one of them.

``recipe -> corpus in a temporary folder -> feature table -> model``

The feature table of the reference model ships with Raceway, so that its first use takes seconds. ``make reference`` writes it; unlike a
model file it depends on no version of scikit-learn.

A kept model is named after the recipe, the hash of its file, the estimator and the versions of Raceway and
scikit-learn, so that another recipe or version makes another file. It is written whole or not at all, and a lock keeps
two processes from making it at once. A file that is damaged is made again.
"""

import fcntl
import hashlib
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

from gen.support.errors import CorpusError
from raceway.console.options import USUAL, Team
from raceway.console.progress import notice, notice_compilation, progress

if TYPE_CHECKING:
    import xarray as xr

    from features.baselines import Model, Scores
    from features.baselines.plain import PlainModel

REFERENCE = "domain_randomised"
ESTIMATOR = "ensemble"
CACHE_VARIABLE = "RACEWAY_CACHE"
HASH_LETTERS = 16
SHIPPED_TABLE = Path(__file__).with_name(f"{REFERENCE}.nc")
_LABELS = ("fault", "width", "rig", "specimen", "recording", "split", "shaft_rate")  # what a training needs
_FACTS = ("title", "recipe_sha256", "channel", "band_low_hz", "band_high_hz")


def train_and_score(table: "xr.Dataset", estimator: str, team: Team = USUAL) -> tuple["Model", "Scores | None"]:
    """Model trained on a feature table without its test split, and its scores on that split, with progress.

    A table without a test split, or with nothing else, is trained on as a whole and not scored.

    Raises
    ------
    CorpusError
        If the training has only one class, or the table lacks features.
    """
    from features.baselines import Model
    from gen.corpus import SPLITS

    test = table["split"].values == SPLITS.index("test")
    whole = not test.any() or test.all()
    with progress("training", "fits") as report:
        workers = team.options(len(test))["workers"]
        model = Model(estimator).fit(table if whole else table.isel(record=~test), workers=workers, progress=report)
    return model, None if whole else model.score(table.isel(record=test))


def recipe_table(recipe: Path | str, team: Team = USUAL) -> "xr.Dataset":
    """Feature table of the corpus of a recipe: the shipped one, or one that is made now, with progress.

    Raises
    ------
    RecipeError, SimulationError, CorpusError
        As `make_table`.
    """
    from features.table_files import read_table
    from gen.recipe import read_recipe, recipe_hash

    shipped = read_table(SHIPPED_TABLE)
    return shipped if shipped.attrs["recipe_sha256"] == recipe_hash(read_recipe(recipe)) else make_table(recipe, team)


def write_reference_table(output: Path) -> None:
    """Write the feature table of the reference model: features that the model takes, and labels that its training needs."""
    from features.baselines.records import DEFAULT_GROUPS
    from features.baselines.references import with_energies
    from features.table_files import write_table
    from gen.recipe import shipped_recipes

    table = make_table(shipped_recipes()[REFERENCE])
    kept = table.reset_coords()[["features", "group", *_LABELS]].set_coords("group")
    kept = kept.isel(feature=kept["group"].isin(with_energies(DEFAULT_GROUPS)))
    kept.attrs = {name: table.attrs[name] for name in _FACTS}
    write_table(kept, output)


def make_table(recipe: Path | str, team: Team = USUAL) -> "xr.Dataset":
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
    from gen.support.workers import cores

    workers = team.workers or cores()
    with temporary_folder() as folder:
        corpus = folder / "corpus"
        with notice_compilation(), progress("generating", "records") as report:
            generate(recipe, corpus, workers=workers, progress=report)
        with progress("computing features", "parts") as report:
            return feature_table(corpus, workers=workers, progress=report)


def load_reference_model() -> tuple["Model", Path]:
    """Reference model of this user and its file; it is made if there is none, or if the file is damaged.

    Raises
    ------
    CorpusError
        If the cache cannot be written.
    """
    from gen.recipe import shipped_recipes

    # of this installation, whatever lies in the working folder
    model, path, _ = kept_model(shipped_recipes()[REFERENCE])
    return model, path


def load_plain_reference_model() -> tuple["PlainModel", Path]:
    """Reference model without what compares with healthy recordings, and the file of the whole one, beside which it is kept."""
    from features.baselines.plain import PlainModel
    from gen.recipe import shipped_recipes

    path = kept_path(shipped_recipes()[REFERENCE])
    kept = PlainModel.read(path.with_suffix(".npz"))
    if kept is None:
        kept = PlainModel.of(load_reference_model()[0])
        kept.save(path.with_suffix(".npz"))
    return kept, path


def reference_model() -> "Model":
    """Reference model of ``raceway diagnose``; the first call trains it, as `load_reference_model`."""
    return load_reference_model()[0]


def kept_model(
    recipe: Path | str, estimator: str = ESTIMATOR, *, team: Team = USUAL
) -> tuple["Model", Path, "Scores | None"]:
    """Kept model of a recipe, its file, and its scores if it was trained now: if there was none, or the file was damaged.

    Raises
    ------
    RecipeError, SimulationError, CorpusError
        As `keep_model`.
    """
    from features.baselines.models import Model

    path, damaged = kept_path(recipe, estimator), False
    if path.is_file():
        try:
            return Model.load(path), path, None
        except CorpusError as error:
            notice(f"{error} It is made again.")
            damaged = True
    _, scores = keep_model(recipe, estimator, damaged=damaged, team=team)
    return Model.load(path), path, scores


def keep_model(
    recipe: Path | str, estimator: str = ESTIMATOR, *, damaged: bool = False, team: Team = USUAL
) -> tuple[Path, "Scores | None"]:
    """Train a model on a recipe and keep it in the cache of this user, unless it is there.

    Parameters
    ----------
    recipe
        File, or name of a recipe that ships with Raceway.
    estimator
        Name of a baseline.
    damaged
        Whether the file that is there is damaged, so that it is made again.
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
    before = _stamp(path)
    with _lock(path):
        if path.is_file() and not (damaged and _stamp(path) == before):
            return path, None  # it was there, or another process has made it meanwhile
        notice(f"training a model on the recipe {recipe_name(recipe)}; it is kept as {path}.")
        model, scores = train_and_score(recipe_table(recipe, team), estimator, team)
        path.unlink(missing_ok=True)  # what is damaged may be no model, and nothing else is replaced
        model.save(path)
    return path, scores


def kept_path(recipe: Path | str, estimator: str = ESTIMATOR) -> Path:
    """File of the kept model of a recipe, whether it exists or not."""
    from gen.recipe import find_recipe

    digest = hashlib.sha256(find_recipe(recipe).read_bytes()).hexdigest()[:HASH_LETTERS]  # reading it takes 0.3 s
    versions = f"raceway-{version('raceway')}-scikit-learn-{version('scikit-learn')}"
    return cache_folder() / f"{recipe_name(recipe)}-{digest}-{estimator}-{versions}.skops"


def recipe_name(recipe: Path | str) -> str:
    """Name of the file of a recipe without its suffix."""
    return Path(recipe).stem


def cache_folder() -> Path:
    """Folder for files that can be made again: ``RACEWAY_CACHE``, or raceway in the cache folder of the user."""
    chosen = os.environ.get(CACHE_VARIABLE)
    if chosen:
        return Path(chosen)
    common = os.environ.get("XDG_CACHE_HOME")
    if common and Path(common).is_absolute():  # a relative path is to be ignored
        return Path(common) / "raceway"
    usual = Path.home() / ("Library/Caches" if sys.platform == "darwin" else ".cache")
    return usual / "raceway"


def _stamp(path: Path) -> tuple[int, int] | None:
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_ino


@contextmanager
def _lock(path: Path) -> Iterator[None]:
    """Hold the lock of a file in the cache, whose folder is created."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        descriptor = os.open(path.with_suffix(".lock"), os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
    except OSError as error:
        message = (
            f"{path.parent}: this cache folder cannot be written ({error.strerror}); set {CACHE_VARIABLE} to another folder, or write the "
            f"model elsewhere with raceway train {REFERENCE} -o MODEL."
        )
        raise CorpusError(message) from error
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            notice("waiting for another process that trains this model.")
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


if __name__ == "__main__":
    write_reference_table(SHIPPED_TABLE)
