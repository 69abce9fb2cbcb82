"""The MFPT fault data set of Bechhoefer: healthy, inner-race and outer-race recordings of one bearing type.

Each file holds a structure ``bearing`` with the acceleration ``gs`` [g], the sample rate ``sr`` [Hz], the
shaft rate ``rate`` [Hz] and the load ``load`` [lbf] [1]_. The set does not state which recordings share a
bearing: each file counts as a specimen of its own, so that cross-validation within the set may leak.

.. [1] E. Bechhoefer, *Condition Based Maintenance Fault Database for Testing of Diagnostic and Prognostics
   Algorithms*, MFPT Society, 2013.
"""

import math
from functools import partial
from pathlib import Path

from gen.physics.catalogue import CATALOGUE
from gen.support.progress import Progress
from gen.support.units import POUND_FORCE, STANDARD_GRAVITY
from raceway.importing.array_files import UnusableError
from raceway.importing.assemble import Collection, Import, import_recordings
from raceway.importing.columns import signal_of
from raceway.importing.matlab import read_matlab
from raceway.importing.recordings import Candidate, Recording, files_below, name_of
from raceway.importing.resampling import resample
from raceway.importing.table import table_of

FS = 48_828.0

_NOMINAL_RATE = 25.0
_FAULT_OF_PREFIX = {"baseline": "healthy", "innerracefault": "inner", "outerracefault": "outer"}
_COLLECTION = Collection(
    importer="mfpt",
    title="MFPT fault data set",
    origin="E. Bechhoefer, NRG Systems; Machinery Failure Prevention Technology Society. CC BY-NC-SA 4.0.",
    fs=FS,
    channels=("accelerometer",),
)
_NOTE = "all files: the shaft rate is nominal; where it was measured, it is 0.6 to 1.3 % lower."


def import_mfpt(source: Path, output: Path, *, window: float = 0.5, progress: Progress | None = None) -> Import:
    """Convert the recordings below ``source`` into a corpus at 48,828 Hz.

    The class is taken from the name of a file. A file at a multiple of this sample rate is resampled, with a warning.

    Parameters
    ----------
    source : Path
        Folder of the published MATLAB files; subfolders are searched.
    output : Path
        New corpus: a file if the name ends in ``.nc``, else a folder that is empty or does not exist.
    window : float
        Length of a record [s].
    progress : callable, optional
        Called with the number of files done and the number of all.

    Raises
    ------
    CorpusError
        If nothing can be imported, the output is taken, or the window is out of range.
    """
    candidates: dict[str, Candidate] = {}
    skipped: list[str] = []
    for path in files_below(source, ".mat"):
        name, stem = name_of(path, source), path.stem.lower()
        # the class stands at the beginning of a name
        fault = next((fault for prefix, fault in _FAULT_OF_PREFIX.items() if stem.startswith(prefix)), None)
        if fault is None:
            skipped.append(f"{name}: the name does not begin with baseline, InnerRaceFault or OuterRaceFault; skipped.")
        elif stem in candidates:
            skipped.append(f"{name}: is {path.stem} again, which {candidates[stem].source} holds; skipped.")
        else:
            candidates[stem] = Candidate(name, partial(_read, path, fault, len(candidates)))
    return import_recordings(
        _COLLECTION,
        list(candidates.values()),
        output,
        window=window,
        skipped=skipped,
        warnings=[_NOTE],
        progress=progress,
    )


def _read(path: Path, fault: str, number: int) -> Recording:
    _, values, numbers = read_matlab(path, "bearing.gs")
    signal = signal_of(table_of(values), None).values * STANDARD_GRAVITY
    fs, rate, load = (numbers.get(f"bearing.{name}", math.nan) for name in ("sr", "rate", "load"))
    factor = round(fs / FS) if math.isfinite(fs) else 0
    if factor < 1 or factor * FS != fs:
        message = f"was sampled at {fs:g} Hz, which is not a multiple of {FS:g} Hz"
        raise UnusableError(message)
    warnings: list[str] = []
    if factor > 1:
        signal, sentence = resample(signal, fs, FS)
        warnings.append(sentence)
    if not rate > 0:
        rate = _NOMINAL_RATE
        warnings.append(f"has no shaft rate: the nominal {_NOMINAL_RATE:g} Hz are used")
    if not load >= 0:
        load = math.nan
        warnings.append("has no load: it stays unknown")
    recording = Recording(
        number=number,
        rig=0,
        specimen=number,
        bearing=CATALOGUE["NICE"],
        shaft_rate=rate,
        fault=fault,
        signal=signal,
        load=load * POUND_FORCE,
        warnings=tuple(warnings),
    )
    return recording if fault == "healthy" else recording._replace(n_spalls=1, width=math.nan, depth=math.nan)
