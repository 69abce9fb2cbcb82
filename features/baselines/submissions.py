"""Predictions of a cross-validation in a file, which anybody who has the corpus can score again.

``classifiers -> class of each tested record -> CSV``, and ``CSV -> scores against the labels of the corpus``. The folds follow from the
corpus, the track, their number and the seed; the file repeats them, so that predictions of any program can be put beside them.
"""

from collections.abc import Mapping, Sequence
from io import BytesIO
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from features.baselines.calibration import UNCALIBRATED
from features.baselines.fitting import fits
from features.baselines.own import Maker
from features.baselines.predictions import fault_names, predictions
from features.baselines.records import DEFAULT_GROUPS, UNKNOWN_CODE, Records, records_of
from features.baselines.scores import Scores, score
from features.baselines.splits import grouped_case
from features.baselines.tracks import Split, Track
from features.table.waveforms import Waveforms
from gen.corpus import FAULTS, IDENTITY, check_result, write_text_durably
from gen.support.display import cell_text
from gen.support.errors import CorpusError

TESTED = ["record", "identity", "fold"]
LONGEST_LINE = 4000  # bytes, enough for a hundred classifiers


def write_submission(
    table: xr.Dataset,
    estimators: Mapping[str, str | Maker],
    path: Path,
    *,
    waveforms: Waveforms | None = None,
    track: Track = "rig",
    folds: int = 3,
    seed: int = 0,
) -> None:
    """Write the classes that classifiers predict for the records outside their training, a column for each classifier.

    Parameters
    ----------
    table
        Feature table of the corpus.
    estimators
        Classifiers by the name of their column, as for `features.baselines.cross_validate`.
    path
        The file, .csv.
    waveforms
        Of the same corpus, for the classifiers of the user in place of the features.
    track, folds, seed
        As for `features.baselines.benchmark`.

    Raises
    ------
    CorpusError
        If the table cannot be split so, or the disk refuses the file.
    """
    check_result(path, None)
    records = records_of(table, DEFAULT_GROUPS)
    _, splits = grouped_case(records, track, folds, seed)
    frame = _tested(table, splits)
    for name, estimator in estimators.items():
        data = table if waveforms is None or isinstance(estimator, str) else waveforms
        features = records_of(data, DEFAULT_GROUPS).features
        for (_, test), (fitted, probabilities) in zip(
            splits, fits(features, records.fault, estimator, splits, seed), strict=True
        ):
            frame.loc[test, name] = np.array(FAULTS)[fitted.classes_[probabilities.argmax(axis=1)]]
    write_text_durably(frame.to_csv(index=False), path)


def check_submission(
    table: xr.Dataset, path: Path, *, track: Track = "rig", folds: int = 3, seed: int = 0
) -> dict[str, Scores]:
    """Scores of each column of predictions in a file, against the labels of the corpus.

    Raises
    ------
    CorpusError
        If the file does not have the tested records of this corpus in the folds of this track, or a class that does not exist.
    """
    records = records_of(table, DEFAULT_GROUPS)
    frame = _tested(table, grouped_case(records, track, folds, seed)[1])
    # the names, and one row more than there are records, which shows a file that is too long
    content = _first_lines(path, len(frame) + 2)
    try:
        submitted = pd.read_csv(BytesIO(content), dtype=str, keep_default_na=False)
    except ValueError:
        raise CorpusError(
            f"{path}: is no table of predictions; give a file with the predictions of a submission."
        ) from None
    if [*submitted.columns[: len(TESTED)]] != TESTED:
        raise CorpusError(
            f"{path}: does not begin with the columns {', '.join(TESTED)}; give the file of a submission."
        )
    # numbers, identities and folds prove that the tested records are those of the protocol, in whatever order they stand
    wanted = frame.astype(str).sort_values("record")
    submitted = submitted.sort_values("record", ignore_index=True)
    if (twice := submitted["record"].duplicated()).any():
        raise CorpusError(f"{path}: has record {submitted['record'][twice].iloc[0]:.20} twice; leave one row of each.")
    missing = wanted["record"][~wanted["record"].isin(submitted["record"])].head(1)
    example = "".join(f" (no record {number})" for number in missing)
    reasons = (
        f"does not have the {len(frame)} records that are tested{example}",
        "has records of another corpus",
        f"has other folds than the {folds} by {track} with seed {seed}",
    )
    for column, reason in zip(TESTED, reasons, strict=True):
        if not submitted[column].equals(wanted[column].reset_index(drop=True)):
            raise CorpusError(f"{path}: {reason}; give the corpus and the options that it was made with.")
    if len(submitted.columns) == len(TESTED):
        raise CorpusError(f"{path}: has no predictions; add a column of classes, named after the classifier.")
    # in the order of the corpus, on which the bootstrap depends
    submitted = submitted.set_index(wanted.index).loc[frame.index]
    tested = records.at(frame.index.to_numpy())
    return {str(name): _scores(tested, submitted[name], f"{path}: {name}", seed) for name in submitted.columns[3:]}


def _first_lines(path: Path, count: int) -> bytes:
    """First lines of a file, which may be a stranger's: no more is read, and none longer than predictions need."""
    lines: list[bytes] = []
    try:
        with path.open("rb") as stream:
            while len(lines) < count and (line := stream.readline(LONGEST_LINE)):
                lines.append(line)
                if len(line) == LONGEST_LINE:
                    raise CorpusError(
                        f"{path}: line {len(lines)} has {LONGEST_LINE:,} bytes or more; give a file of fewer classifiers."
                    )
    except OSError as error:
        raise CorpusError(f"{path}: could not be read ({error.strerror}); check the path.") from None
    return b"".join(lines)


def _tested(table: xr.Dataset, splits: Sequence[Split]) -> pd.DataFrame:
    """Number in the corpus, identity and fold of each tested record, by its place among the records of known class."""
    number = np.flatnonzero(table["fault"].values != UNKNOWN_CODE)
    fold = np.full(len(number), -1)
    for place, (_, test) in enumerate(splits):
        fold[test] = place
    identity = [cell_text(str(text)) for text in table[IDENTITY].values[number]]
    columns = {"record": number, "identity": identity, "fold": fold}
    return pd.DataFrame(columns)[fold >= 0]


def _scores(tested: Records, predicted: pd.Series, where: str, seed: int) -> Scores:
    wrong = sorted({*predicted} - {*FAULTS})
    if wrong:
        raise CorpusError(f"{where}: {wrong[0]!r:.60} is no class; allowed are {', '.join(FAULTS)}.")
    codes = np.array([FAULTS.index(name) for name in predicted])
    _, recording = np.unique(tested.recording, return_inverse=True)
    told = predictions(np.eye(len(FAULTS))[codes], fault_names(np.arange(len(FAULTS))), recording, UNCALIBRATED)
    return score(tested, told, seed)[0]
