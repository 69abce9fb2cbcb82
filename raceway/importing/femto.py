"""PRONOSTIA, the run-to-failure tests of the IEEE PHM 2012 challenge: snapshots of 0.1 s every 10 s, two channels.

A folder such as ``Bearing1_1`` holds one life, with files ``acc_00001.csv``: hour, minute, second, microsecond, horizontal and vertical
acceleration [g], with commas in some folders and semicolons in others [1]_. Lives end at 20 g. Those below a folder ``Test_set`` are
truncated, and so censored; ``Full_Test_Set`` has all of them.

.. [1] P. Nectoux et al., "PRONOSTIA: an experimental platform for bearings accelerated degradation tests", IEEE Int. Conf. Prognostics and
   Health Management, Denver, 2012.
"""

import math
import re
from collections import defaultdict
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gen.corpus import LIFE, UNKNOWN
from gen.physics.catalogue import CATALOGUE
from gen.support.errors import CorpusError
from gen.support.progress import Progress
from gen.support.units import STANDARD_GRAVITY, rpm_to_hertz
from raceway.importing.array_files import UnusableError, guarded
from raceway.importing.assemble import Collection, Import, import_recordings
from raceway.importing.recordings import Candidate, Recording, files_below, name_of

FS = 25_600.0
SNAPSHOT = 0.1  # s
EVERY = 10.0  # s
_DAY = 86_400
_FOLDER, _FILE = re.compile(r"bearing([123])_(\d+)$", re.IGNORECASE), re.compile(r"acc_(\d+)$", re.IGNORECASE)
_CONDITIONS = {"1": (1800, 4000.0), "2": (1650, 4200.0), "3": (1500, 5000.0)}  # rpm, N
_COLLECTION = Collection(
    importer="femto",
    title="PRONOSTIA run-to-failure tests",
    origin="FEMTO-ST Institute, Besancon; IEEE PHM 2012 data challenge.",
    fs=FS,
    channels=("horizontal", "vertical"),
    facts=("Speed and load are nominal; a life ends at its last snapshot, unless its folder is below Test_set.",),
    extra=LIFE,
)


def import_femto(source: Path, output: Path, *, progress: Progress | None = None) -> Import:
    """Convert the snapshots below ``source`` into a corpus of lives.

    Parameters
    ----------
    source : Path
        Folder of the published folders; subfolders are searched.
    output : Path
        New corpus: a file if the name ends in ``.nc``, else a folder that is empty or does not exist.
    progress : callable, optional
        Called with the number of files done and the number of all.

    Raises
    ------
    CorpusError
        If nothing can be imported, or the output is taken.
    """
    source = source.resolve()  # whose names tell which lives are censored
    lives = defaultdict[Path, dict[int, Path]](dict)
    for path in files_below(source, ".csv"):
        number = _FILE.match(path.stem)
        if number and _FOLDER.match(path.parent.name):
            lives[path.parent][int(number[1])] = path
    if not lives:
        raise CorpusError(
            f"{source}: has no folder such as Bearing1_1 with files acc_00001.csv; give the one that holds them."
        )
    candidates, warnings = list[Candidate](), list[str]()
    longest = {
        folder.name.lower(): folder
        for folder in sorted(lives, key=lambda folder: (len(lives[folder]), not _censored(folder)))
    }
    for folder in sorted(lives.keys() - longest.values()):
        other = name_of(longest[folder.name.lower()], source)
        warnings.append(f"{name_of(folder, source)}: is left out, since {other} holds more of the same life.")
    for specimen, (folder, files) in enumerate(sorted((folder, lives[folder]) for folder in longest.values())):
        missing = [number for number in range(min(files), max(files)) if number not in files]
        if missing:
            warnings.append(
                f"{name_of(folder, source)}: {len(missing)} snapshots are missing, the first is acc_{missing[0]:05d}."
            )
        # filled by the first file of the life that is read
        clock = dict[str, float]()
        candidates += [
            Candidate(name_of(path, source), partial(_read, path, number, max(files), specimen, clock))
            for number, path in sorted(files.items())
        ]
    return import_recordings(_COLLECTION, candidates, output, window=SNAPSHOT, warnings=warnings, progress=progress)


def _censored(path: Path) -> bool:
    return any(part.lower() == "test_set" for part in path.parts)


def _read(path: Path, number: int, last: int, specimen: int, clock: dict[str, float]) -> Recording:
    """One snapshot; ``clock`` has the time of day at which the life would have begun by its first file."""
    values, folder = _numbers(path), path.parent.name
    rpm, load = _CONDITIONS[folder[len("bearing")]]
    age, censored = EVERY * (number - 1), _censored(path)
    begun = float(values[0, :4] @ (3600, 60, 1, 1e-6)) - age
    away = math.remainder(begun - clock.setdefault("begun", begun), _DAY)
    unknown = dict.fromkeys((variable.name for variable in LIFE), math.nan)
    # the test ended with the last file, at the failure unless the set was cut off
    left = math.nan if censored else EVERY * (last - number)
    known = {
        "age": age,
        "rul": left,
        "rul_revolutions": left * rpm_to_hertz(rpm),
        "event": 0 if censored else 1,
        "stage": 3,
        "overloaded": 1,
    }
    return Recording(
        number=number,
        rig=0,
        specimen=specimen,
        bearing=replace(CATALOGUE["6804"], designation=f"6804 {folder}"),
        shaft_rate=rpm_to_hertz(rpm),
        fault=UNKNOWN,
        signal=np.ascontiguousarray(STANDARD_GRAVITY * values[:, 4:].T),
        load=load,
        n_spalls=-1,
        width=math.nan,
        depth=math.nan,
        extra=unknown | known,
        warnings=(f"its clock is {away:+.0f} s from its number; its age is that of its number",)
        if abs(away) > EVERY / 2
        else (),
    )


def _numbers(path: Path) -> NDArray[np.float64]:
    """Numbers of a snapshot, shape (time, column)."""
    with guarded(path, "PRONOSTIA"):
        lines = path.read_text(encoding="ascii").replace(";", ",").split()
        values = np.array([line.split(",") for line in lines], np.float64)
    if values.ndim != 2 or values.shape[1] != 6:
        raise UnusableError("has not the six columns of a snapshot")
    return values
