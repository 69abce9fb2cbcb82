"""Models trained on a recipe, and the reference model, which is trained once per user and kept.

``recipe -> corpus in a temporary folder -> feature table -> model``

The reference model is that of the recipe `REFERENCE` as shipped. Its file is named after the hash of the recipe and the
versions of Raceway and scikit-learn, so that another version makes another file. It is written whole or not at all, and
a lock keeps two processes from making it at once. A file that is damaged is made again.
"""

import fcntl
import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

from gen.errors import CorpusError
from raceway.console.progress import compilation_noticed, notice, progress

if TYPE_CHECKING:
    from features.baselines import Model

REFERENCE = "domain_randomised"
CACHE_VARIABLE = "RACEWAY_CACHE"
HASH_LETTERS = 16
_HOW_LONG = "about three minutes on two cores"


def train_on_recipe(recipe: Path | str, estimator: str | None = None) -> "Model":
    """Model trained on a corpus that is generated in a temporary folder and removed again, with progress.

    Raises
    ------
    RecipeError, SimulationError
        If the recipe cannot be simulated.
    CorpusError
        If the disk refuses the corpus, or it has only one class.
    """
    from features import feature_table
    from features.baselines import DEFAULT_ESTIMATOR, train
    from gen import generate

    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    with tempfile.TemporaryDirectory(prefix="raceway-") as folder:
        corpus = Path(folder) / "corpus"
        with compilation_noticed(), progress("generating", "records") as report:
            generate(recipe, corpus, workers=cores, progress=report)
        with progress("computing features", "parts") as report:
            table = feature_table(corpus, scheduler="local", progress=report)
    notice("training the classifier.")
    return train(table, estimator or DEFAULT_ESTIMATOR)


def load_reference_model() -> tuple["Model", Path]:
    """Reference model of this user and its file; it is made if there is none, or if the file is damaged.

    Raises
    ------
    CorpusError
        If the cache cannot be written.
    """
    from features.baselines.models import load_model

    path = reference_path()
    if path.is_file():
        try:
            return load_model(path), path
        except CorpusError as error:
            notice(f"{error} It is made again.")
            return load_model(make_reference_model(again=True)), path
    return load_model(make_reference_model()), path


def make_reference_model(*, again: bool = False) -> Path:
    """Train the reference model and keep it in the cache of this user, unless it is there; with ``again`` even then.

    Raises
    ------
    CorpusError
        If the cache cannot be written.
    """
    from features.baselines import save_model

    path = reference_path()
    before = _stamp(path)
    with _locked(path):
        if path.is_file() and (not again or _stamp(path) != before):
            return path  # another process has made it meanwhile
        notice(f"training the reference model on the recipe {REFERENCE}; it takes {_HOW_LONG} and is kept as {path}.")
        save_model(train_on_recipe(_shipped()), path)
    return path


def reference_path() -> Path:
    """File of the reference model of this user, whether it exists or not."""
    from gen.recipe import read_recipe, recipe_hash

    digest = recipe_hash(read_recipe(_shipped()))[:HASH_LETTERS]
    name = f"{REFERENCE}-{digest}-raceway-{version('raceway')}-scikit-learn-{version('scikit-learn')}.skops"
    return cache_folder() / name


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


def _shipped() -> Path:
    """Recipe file of this installation, whatever lies in the working folder."""
    from gen.recipe import shipped_recipes

    return shipped_recipes()[REFERENCE]


def _stamp(path: Path) -> tuple[int, int] | None:
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_ino


@contextmanager
def _locked(path: Path) -> Iterator[None]:
    """Hold the lock of a file in the cache, whose folder is created."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        descriptor = os.open(path.with_suffix(".lock"), os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
    except OSError as error:
        message = (
            f"{path.parent}: this cache folder cannot be written ({error.strerror}); set {CACHE_VARIABLE} to another folder, or make a "
            f"model with raceway train {REFERENCE} -o MODEL and give it with --model."
        )
        raise CorpusError(message) from error
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            notice("waiting for another process that trains the reference model.")
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)
