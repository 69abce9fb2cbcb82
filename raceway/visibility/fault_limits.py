"""Limits of sight: the sizes of the faults of each class that a twin and a trained classifier see in half and in nine of ten records.

The twin sees a fault where `detectable` of the corpus is 1: an analyst who also knows the machine without the fault would see it. The
classifier sees it where the probability of a fault, by a training without the rig of the record, is above that of 99 % of the healthy
records. Both sizes hold for records of this length.
"""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from features import feature_table
from features.baselines import DEFAULT_ESTIMATOR
from features.baselines.cross_calibration import calibration_splits
from features.baselines.detection import WidthBin, detection
from features.baselines.fitting import fits
from features.baselines.own import Maker
from features.baselines.records import DEFAULT_GROUPS, HEALTHY_CODE, records_of
from gen.corpus import FAULTS, UNKNOWN_CODE, class_counts, is_single_file, open_corpus, temporary_folder
from gen.corpus.fault_classes import HEALTHY
from gen.corpus.simulated import UNJUDGED
from gen.drawing.section import plain
from gen.mechanisms.faults.kinds import KINDS
from gen.mechanisms.mechanism_labels import label_values
from gen.recipe import Recipe, read_recipe
from gen.support.errors import CorpusError
from gen.support.progress import Progress, counter
from gen.support.units import shown_unit
from raceway.reports.templates import three_digits
from raceway.visibility.size_curves import sizes_seen

LEAST = 20  # records of a class
SIZES = ("width", *(label.name for kind in KINDS for label in kind.labels))
"""Variables that tell the size of a fault, 0 without it."""


@dataclass(frozen=True)
class FaultLimit:
    """What one criterion sees of the faults of one class; sizes are in SI units.

    Attributes
    ----------
    fault, criterion
        Class, and ``twin`` or ``classifier``.
    variable, unit
        Variable of the corpus that is the size, such as ``width``, and its unit.
    bins
        Shares seen in ranges of the size, with their intervals; ``width`` is the mean size.
    extent
        Smallest and largest size.
    curve
        Middle and slope of the share seen, ``1 / (1 + (middle / size) ** slope)``.
    seen_50, seen_90
        Size from which the fault is seen in 50 or 90 % of the records, and both ends of its 95 % interval; 0 if it is at the smallest
        size already, and infinity if it is not at the largest.
    """

    fault: str
    criterion: str
    variable: str
    unit: str
    bins: tuple[WidthBin, ...]
    extent: tuple[float, ...]
    curve: tuple[float, ...]
    seen_50: tuple[float, ...]
    seen_90: tuple[float, ...]

    def text(self, seen: tuple[float, ...]) -> str:
        """Size in the unit in which people read it, and its interval, such as ``0.16 mm (0.142 to 0.2)``."""
        unit, factor = shown_unit(self.variable, self.unit)
        smallest, largest = (three_digits(end / factor) for end in self.extent)
        beyond = {0.0: f"< {smallest}", np.inf: f"> {largest}"}
        size, low, high = (beyond.get(end, three_digits(end / factor)) for end in seen)
        return f"{size} {unit} ({low} to {high})"


def limit(
    source: Path | str | xr.Dataset,
    *,
    estimator: str | Maker = DEFAULT_ESTIMATOR,
    seed: int = 0,
    workers: int = 1,
    progress: Progress | None = None,
) -> list[FaultLimit]:
    """Sizes of faults that can be seen: how small a fault of each class is seen in half, and in nine of ten, of the records.

    Parameters
    ----------
    source
        Recipe, of which a corpus is made for the time of the call, or a corpus, by its path or name; or a feature table.
    estimator
        Name of a baseline, or a classifier of your own. It is tested on rigs outside its training, or on specimens if there are too few
        rigs; the intervals are over the same.
    seed
        Of the classifier, its splits and the bootstrap.
    workers
        Number of processes that make records and compute features.
    progress
        Called while records are made, again while features are computed, and while classifiers and curves are fitted, with the number done
        and of all.

    Returns
    -------
    A limit for each class, each of its sizes that varies, and each criterion; ``twin`` where it was judged.

    Raises
    ------
    RacewayError
        If the recipe or the corpus cannot be read, has no healthy records, no class whose size varies, too few records or specimens of
        a class, or faults that were drawn again because they could not be seen.
    """
    if not isinstance(source, xr.Dataset):
        with corpus_of(source, workers=workers, progress=progress) as corpus:
            source = feature_table(corpus, DEFAULT_GROUPS, workers=workers, progress=progress)
    records = records_of(source, DEFAULT_GROUPS)
    check_records(source, records.title)
    table = source.isel(record=source["fault"].values != UNKNOWN_CODE)
    cross_validation = calibration_splits(records, seed)
    if cross_validation is None:
        raise CorpusError(f"{records.title}: a class is on one specimen alone; make two or more of each class.")
    # each record gets its probability from a training without its unit
    by, splits = cross_validation
    scales, criteria = sizes_of(table), 1 + ("detectable" in table)
    done = counter(progress, len(splits) + len(scales) * criteria)
    folds = fits(records.features, records.fault, estimator, splits, seed, done=done)
    suspicion = np.empty(len(records.fault))
    for (_, tested), (_, probabilities) in zip(splits, folds, strict=True):
        suspicion[tested] = 1 - probabilities[:, 0]  # healthy is the first class, and no training lacks it
    scores = {"classifier": suspicion}
    if "detectable" in table:
        scores = {"twin": table["detectable"].where(table["detectable"] != UNJUDGED).values} | scores
    # a curve for each class, size and criterion
    unit, healthy, limits = getattr(records, by), records.fault == HEALTHY_CODE, list[FaultLimit]()
    for fault, variable in scales:
        for criterion, score in scores.items():
            own = (records.fault == FAULTS.index(fault)) & np.isfinite(score)
            size = np.where(own, np.nan_to_num(table[variable].values), 0)
            if size.any():
                seen, curve, sizes = sizes_seen(size, score, unit, healthy, seed)
                bins, ends = detection(seen, size, records.specimen), (size[size > 0].min(), size.max())
                numbers = (tuple(map(float, some)) for some in (ends, curve, *sizes))
                limits.append(FaultLimit(fault, criterion, variable, table[variable].attrs["units"], bins, *numbers))
            done(1)
    return limits


@contextmanager
def corpus_of(
    source: Path | str, *, records: int | None = None, workers: int = 1, progress: Progress | None = None
) -> Iterator[Path]:
    """Corpus of a path; or that of a recipe, in a folder that is removed, with all faults whether they can be seen or not.

    Raises
    ------
    RacewayError
        As `limit`, before features are computed.
    """
    path = Path(source)
    if path.is_dir() or is_single_file(path):
        if records is not None:
            raise CorpusError(f"{path}: is a corpus, whose number of records is fixed; give --records with a recipe.")
        with open_corpus(path, check="size") as opened:
            check_records(opened, str(path))
        yield path
        return
    from gen.generation.corpus import generate  # the simulator, which takes a second to load
    from gen.scenarios import draw_scenarios

    truth = {"truth": {"twins": True, "undetected": "keep"}}
    recipe = Recipe(plain(read_recipe(source, records=records)) | truth)
    drawn = [
        {"fault": FAULTS.index(scenario.fault), "width": max((spall.width for spall in scenario.spalls), default=0)}
        | label_values(scenario.recipe, {})
        for scenario in draw_scenarios(recipe)
    ]
    # no record is made of sizes that give no limit
    check_records(pd.DataFrame(drawn).rename_axis("record").to_xarray(), str(source))
    with temporary_folder() as folder:
        yield generate(recipe, folder / "corpus", workers=workers, progress=progress).path


def check_counts(classes: Mapping[str, int], name: str) -> None:
    """Refuse numbers of records by class that give no limit, with a ``name`` for the sentence."""
    if HEALTHY not in classes or len(classes) < 2:
        lacking = "faulty" if HEALTHY in classes else "healthy"
        raise CorpusError(
            f"{name}: has no {lacking} records; make more, or add kind: healthy, and others with a width_mm, to faults."
        )
    for fault, count in classes.items():
        if count < LEAST:
            raise CorpusError(f"{name}: {count} {fault} record(s) are too few; make {LEAST} or more of each class.")


def check_records(records: xr.Dataset, name: str) -> None:
    """Refuse records, or their table, that give no limit, with a ``name`` for the sentence."""
    fault = records["fault"].values
    check_counts(class_counts(fault[fault != UNKNOWN_CODE]), name)
    # with faults that were drawn again, or labelled healthy, those that are left are seen more often
    altered = {"fault_tries": fault, "level_tries": fault, "fault_share": fault == HEALTHY_CODE}
    if any(column in records and (records[column].values * rows > 0).any() for column, rows in altered.items()):
        raise CorpusError(
            f"{name}: faults that cannot be seen were drawn again, or labelled healthy (truth.undetected); give the recipe in place of "
            f"the corpus."
        )
    if not sizes_of(records):
        raise CorpusError(f"{name}: no class has a size that varies; draw it, such as width_mm: loguniform(0.1, 2).")


def sizes_of(records: xr.Dataset) -> list[tuple[str, str]]:
    """Classes, and variables that are the sizes of their faults: those that vary."""
    sizes = {name: records[name].where(records[name] > 0) for name in SIZES if name in records}
    return [
        (fault, name)
        for code, fault in enumerate(FAULTS)
        for name, size in sizes.items()
        if len(np.unique(size[records["fault"].values == code].dropna("record"))) > 1
    ]
