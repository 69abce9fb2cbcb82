"""The Case Western Reserve University set: seeded faults in the drive-end bearing of a 2 hp motor, 12 kHz.

Recordings are found by their published numbers, in any arrangement of folders. Known errors of the published files [1]_ are handled,
and each gives a warning; no label is corrected.

.. [1] W. A. Smith, R. B. Randall, "Rolling element bearing diagnostics using the Case Western Reserve
   University data: A benchmark study", Mech. Syst. Signal Process. 64-65 (2015) 100-131.
"""

import math
import re
from collections.abc import Mapping
from collections.abc import Set as AbstractSet
from functools import partial
from pathlib import Path
from typing import Literal, NamedTuple

from gen.corpus import Variable
from gen.physics.catalogue import CATALOGUE
from gen.support.errors import CorpusError
from gen.support.progress import Progress
from gen.support.units import HORSEPOWER, MIL, STANDARD_GRAVITY, rpm_to_hertz
from raceway.importing.array_files import FloatArray
from raceway.importing.assemble import Collection, Import, import_recordings
from raceway.importing.columns import signal_of
from raceway.importing.matlab import read_matlab
from raceway.importing.recordings import Candidate, Recording, files_below, name_of
from raceway.importing.resampling import resample
from raceway.importing.table import table_of

Subset = Literal["all", "wang"]

FS = 12_000.0
_NOMINAL_RPM = (1797, 1772, 1750, 1730)
_SPEED_TOLERANCE = 0.05  # of the nominal speed
_DEPTH = {7: 11 * MIL, 14: 11 * MIL, 21: 11 * MIL}
_CLOCK_ANGLE: dict[int | None, float] = {3: 0.0, 6: -math.pi / 2, 12: math.pi / 2}


class SeededBearing(NamedTuple):
    """One bearing: fault, diameter [mil] and clock position of the fault, and numbers of its recordings at 0, 1, 2 and 3 hp."""

    fault: str
    diameter: int
    clock: int | None
    numbers: tuple[int, int, int, int]


SPECIMENS = (
    SeededBearing("healthy", 0, None, (97, 98, 99, 100)),
    SeededBearing("inner", 7, None, (105, 106, 107, 108)),
    SeededBearing("inner", 14, None, (169, 170, 171, 172)),
    SeededBearing("inner", 21, None, (209, 210, 211, 212)),
    SeededBearing("inner", 28, None, (3001, 3002, 3003, 3004)),
    SeededBearing("ball", 7, None, (118, 119, 120, 121)),
    SeededBearing("ball", 14, None, (185, 186, 187, 188)),
    SeededBearing("ball", 21, None, (222, 223, 224, 225)),
    SeededBearing("ball", 28, None, (3005, 3006, 3007, 3008)),
    SeededBearing("outer", 7, 6, (130, 131, 132, 133)),
    SeededBearing("outer", 7, 3, (144, 145, 146, 147)),
    SeededBearing("outer", 7, 12, (156, 158, 159, 160)),
    SeededBearing("outer", 14, 6, (197, 198, 199, 200)),
    SeededBearing("outer", 21, 6, (234, 235, 236, 237)),
    SeededBearing("outer", 21, 3, (246, 247, 248, 249)),
    SeededBearing("outer", 21, 12, (258, 259, 260, 261)),
)

_HELD_AS = {3001: 56, 3002: 57, 3003: 58, 3004: 59, 3005: 48, 3006: 49, 3007: 50, 3008: 51}
_LONGEST_AT_12_KHZ = 200_000
_NOTES = (
    (158, 158, "the labelled speed differs by about 2 % from that of its fault line; the label is kept"),
    (197, 200, "these recordings show no outer-race line and look healthy; the label is kept"),
    (
        3001,
        3004,
        "a bearing of another maker, with lines at 3.68 and 5.32 orders; the nominal orders are those of the 6205",
    ),
    (3005, 3008, "a bearing of another maker; the nominal orders are those of the 6205"),
)
_COLLECTION = Collection(
    importer="cwru",
    title="CWRU bearing data, drive end",
    origin=(
        "Case Western Reserve University Bearing Data Center, seeded fault tests, drive-end accelerometer. "
        "The provider asks for acknowledgement; no licence text is stated."
    ),
    fs=FS,
    channels=("drive end",),
    extra=(Variable("motor_load", "f8", "W", "operating", "labelled power of the motor"),),
)


def import_cwru(
    source: Path,
    output: Path,
    *,
    window: float = 0.5,
    subset: Subset = "all",
    progress: Progress | None = None,
) -> Import:
    """Convert the drive-end recordings below ``source`` into a corpus at 12 kHz.

    Each combination of fault, diameter and clock position is one specimen, recorded at four motor loads; its number is the same in every
    subset. The radial load is unknown; the load of the motor is stored as ``motor_load`` [W].

    Parameters
    ----------
    source : Path
        Folder of the published MATLAB files; subfolders are searched.
    output : Path
        New corpus: a file if the name ends in ``.nc``, else a folder that is empty or does not exist.
    window : float
        Length of a record [s].
    subset : {"all", "wang"}
        All 64 recordings, or the 40 of Wang, Taal and Fink (2021): no 28 mil, outer race at 6 o'clock only.
    progress : callable, optional
        Called with the number of files done and the number of all.

    Raises
    ------
    CorpusError
        If nothing can be imported, the output is taken, or an argument is out of range.
    """
    if subset not in ("all", "wang"):
        message = f"subset: {subset!r} is not known; choose all or wang."
        raise CorpusError(message)
    published, wanted = _labels("all"), _labels(subset)
    candidates: dict[int, Candidate] = {}
    skipped: list[str] = []
    # files are known by the published number in their name, whatever folder they are in
    for path in files_below(source, ".mat"):
        name, number = name_of(path, source), recording_number(path.stem)
        if number not in published:
            skipped.append(f"{name}: the name has no number of a drive-end recording at 12 kHz; skipped.")
        elif number in candidates:
            skipped.append(f"{name}: is recording {number} again, which {candidates[number].source} holds; skipped.")
        elif number in wanted:
            candidates[number] = Candidate(name, partial(_read, path, number, *wanted[number]))
    return import_recordings(
        _COLLECTION,
        [candidates[number] for number in sorted(candidates)],
        output,
        window=window,
        skipped=skipped,
        warnings=_warnings(candidates.keys(), wanted.keys()),
        progress=progress,
    )


def recording_number(stem: str) -> int | None:
    """Published number in a file name: at its beginning, or at its end after an underscore.

    >>> [recording_number(stem) for stem in ("130@6_0", "98_Normal_1_12k", "B007_0_118", "IR007")]
    [130, 98, 118, None]
    """
    match = re.match(r"(\d+)(?=[@_.]|$)", stem) or re.search(r"_(\d{2,4})$", stem)
    return int(match[1]) if match else None


def _labels(subset: Subset) -> dict[int, tuple[int, int]]:
    """Number of the specimen, and motor load [hp], of each recording by its number."""
    return {
        number: (index, load)
        for index, specimen in enumerate(SPECIMENS)
        if subset == "all" or (specimen.diameter != 28 and specimen.clock in (None, 6))
        for load, number in enumerate(specimen.numbers)
    }


def _warnings(present: AbstractSet[int], wanted: AbstractSet[int]) -> list[str]:
    """Known errors of the recordings found, and the numbers of those not found."""
    warnings = [
        f"{first if first == last else f'{first}-{last}'}: {note}."
        for first, last, note in _NOTES
        if any(first <= number <= last for number in present)
    ]
    missing = sorted(wanted - present)
    if missing:
        numbers = ", ".join(str(number) for number in missing)
        warnings.append(f"{len(missing)} of {len(wanted)} recordings were not found: {numbers}.")
    return warnings


def _read(path: Path, number: int, specimen: int, motor_load: int) -> Recording:
    fault, diameter, clock, _ = SPECIMENS[specimen]
    held = _HELD_AS.get(number, number)
    warnings: list[str] = []
    _, values, numbers = read_matlab(path, f"X{held:03d}_DE_time")
    signal = signal_of(table_of(values), None).values * STANDARD_GRAVITY
    if held != number:
        warnings.append(f"holds the variable X{held:03d}_DE_time, as published for recording {number}")
    if fault == "healthy":
        signal, warning = _at_12_khz(signal)
        warnings.append(warning)
    shaft_rpm, complaints = _labelled_rpm(numbers, f"X{held:03d}RPM", _NOMINAL_RPM[motor_load])
    recording = Recording(
        number=number,
        rig=0,
        specimen=specimen,
        bearing=CATALOGUE["6205"],
        shaft_rate=rpm_to_hertz(shaft_rpm),
        fault=fault,
        signal=signal,
        extra={"motor_load": motor_load * HORSEPOWER},
        warnings=(*warnings, *complaints),
    )
    if fault == "healthy":
        return recording
    return recording._replace(
        n_spalls=1,
        width=diameter * MIL,
        depth=_DEPTH.get(diameter, math.nan),
        angle=_CLOCK_ANGLE.get(clock, math.nan),
    )


def _at_12_khz(signal: FloatArray) -> tuple[FloatArray, str]:
    """Healthy recording at 12 kHz, and a sentence on how it was obtained.

    All four were published at 48 kHz; copies resampled to 12 kHz exist. The files do not state their sample rate, so it is taken from the
    length: 244,000 samples (97) or 484,000 at 48 kHz, at most 121,000 at 12 kHz.
    """
    if signal.size <= _LONGEST_AT_12_KHZ:
        return signal, f"its {signal.size} samples are taken as resampled from 48 to 12 kHz by somebody else"
    slower, sentence = resample(signal, 4 * FS, FS)
    return slower, f"its {signal.size} samples are taken as recorded at 48 kHz and {sentence}"


def _labelled_rpm(numbers: Mapping[str, float], variable: str, nominal: int) -> tuple[float, tuple[str, ...]]:
    """Speed in the file, or the nominal speed with a warning if the file has none or one far from it [rpm]."""
    shaft_rpm = numbers.get(variable, math.nan)
    if abs(shaft_rpm / nominal - 1) <= _SPEED_TOLERANCE:
        return shaft_rpm, ()
    held = f"has {shaft_rpm:g} rpm in {variable}" if variable in numbers else f"has no {variable}"
    return nominal, (f"{held}: the nominal {nominal} rpm of its motor load are used",)
