"""The reference model of ``diagnose``, which is trained at its first use and kept per user.

It is trained on records of the recipe domain_randomised that last 2 s, in which lines rise higher above the floor than in the half seconds
of the recipe. It holds a model trained on those for shorter recordings, and one for recordings that are sampled at 20 kHz or more, of a
wider band. The feature tables of all three ship with Raceway, so that the training takes half a minute. ``make reference`` writes them
(`benchmarks.reference_table`); unlike a model file they depend on no version of scikit-learn.

The kept file is named after the versions of Raceway and scikit-learn, and a hash of all that it was made from: table, sources and
libraries. A damaged one is made again. A lock keeps two processes from making it at once.
"""

import hashlib
import os
from collections.abc import Iterator
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
from raceway.console.options import USUAL, USUAL_ANALYSIS, Analysis, Team
from raceway.console.progress_bar import notice, progress

if TYPE_CHECKING:
    import xarray as xr

    from features.baselines import Model, Scores

REFERENCE = "domain_randomised"
CACHE_VARIABLE = "RACEWAY_CACHE"
LONG = 2.0  # s, duration of the records of the reference model
HASH_LETTERS = 16
SHIPPED_TABLE = Path(__file__).with_name(f"{REFERENCE}.nc")
WIDE_TABLE = Path(__file__).with_name(f"{REFERENCE}_wide.nc")
_TABLES = (f"raceway/{SHIPPED_TABLE.name}", f"raceway/{WIDE_TABLE.name}")
_SOURCES = ("gen/corpus", "gen/support", "features", "raceway/kept_models.py", *_TABLES)
_LIBRARIES = ("scikit-learn", "skops", "numpy", "scipy", "numba")  # whose versions make other models or files


def train_and_score(
    table: "xr.Dataset", estimator: str, team: Team = USUAL, analysis: Analysis = USUAL_ANALYSIS
) -> tuple["Model", "Scores | None"]:
    """Model trained on a feature table without its test split, and its scores on that split, with progress.

    A table without a test split, or with nothing else, is trained on as a whole and not scored.

    Raises
    ------
    CorpusError
        If the training has only one class, or the table lacks features.
    """
    from features.baselines import DEFAULT_GROUPS, Model
    from gen.corpus import SPLITS

    test = table["split"].values == SPLITS.index("test")
    # without both kinds of records there is nothing to score
    whole = not test.any() or test.all()
    with progress("training", "fits") as report:
        workers = team.options(len(test))["workers"]
        model = Model(estimator, groups=analysis.with_groups(DEFAULT_GROUPS))
        model.fit(table if whole else table.isel(record=~test), workers=workers, progress=report)
    return model, None if whole else model.score(table.isel(record=test))


def train_reference(long: "xr.Dataset", short: "xr.Dataset", wide: "xr.Dataset", estimator: str) -> "Model":
    """Model of long records, with one for shorter records and one for a wider band, each from its table."""
    model, shorter, wider = (train_and_score(table, estimator)[0] for table in (long, short, wide))
    model.shorter, model.wide = shorter, wider
    return model


def shipped_tables() -> "tuple[xr.Dataset, xr.Dataset, xr.Dataset]":
    """Feature tables that ship with Raceway, of records of 2 s, of those of half a second, and of 2 s in a wider band."""
    from features.table.table_files import read_table

    shipped = read_table(SHIPPED_TABLE)
    long = shipped[DURATION].values == LONG
    return shipped.isel(record=long), shipped.isel(record=~long), read_table(WIDE_TABLE)


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
    notice(f"training the reference model; it is kept as {path}.")
    model = train_reference(*shipped_tables(), DEFAULT_ESTIMATOR)
    path.unlink(missing_ok=True)
    model.save(path)
    return model


def reference_path() -> Path:
    """File of the reference model of this user, whether it exists or not."""
    made_from = [hash_sources(*_SOURCES), *map(version, _LIBRARIES)]
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
            message = f"{path.parent}: this cache folder cannot be written ({error.strerror}); set {CACHE_VARIABLE} to another folder."
            raise CorpusError(message) from error
        yield
