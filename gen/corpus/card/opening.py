"""How to open a corpus: short programs in Python, MATLAB, Octave, R and Julia, for its data card.

Each prints the root of the mean square of the first channel of the first record. Readers without the virtual dataset of ``corpus.nc``
open the parts, which are complete netCDF-4 files.
"""

from pathlib import Path

import h5py

from gen.corpus.hdf5 import LIBRARY_LOCK, own_dataset
from gen.corpus.schema import FAULTS, SIGNAL, listed_flags

_FAULTY = listed_flags({code: name for code, name in enumerate(FAULTS) if code > 0})
_ZSTD = 32015  # number of the filter, registered with The HDF Group

_PYTHON = """\
import gen   # pip install raceway

corpus = gen.open_corpus(".")   # an xarray.Dataset; the files are checked, and signals are read when they are used
healthy = corpus.isel(record=corpus["fault"].values == 0)   # {faults}
signal = corpus["acceleration"][0, 0].values   # dimensions record, channel, elapsed_time, in m/s^2
print((signal**2).mean() ** 0.5)
"""

_XARRAY = """\
import xarray

corpus = xarray.open_dataset("corpus.nc")   # it reads the signals from the folder parts
signal = corpus["acceleration"][0, 0].values
print((signal**2).mean() ** 0.5)
"""

_MATLAB = """\
% in Octave first: pkg load netcdf
part = 'parts/{part}';
fault = ncread(part, 'fault');   % 0 healthy, {faults}
fs = ncread(part, 'sample_rate');
% acceleration has dimensions elapsed_time, channel, record, in m/s^2
signal = double(ncread(part, 'acceleration', [1 1 1], [Inf 1 1]));
fprintf('%.6g\\n', sqrt(mean(signal(:) .^ 2)));
"""

_R = """\
library(ncdf4)
part <- nc_open("parts/{part}")
fault <- ncvar_get(part, "fault")   # 0 healthy, {faults}
# acceleration has dimensions elapsed_time, channel, record, in m/s^2
signal <- ncvar_get(part, "acceleration", start = c(1, 1, 1), count = c(-1, 1, 1))
cat(sqrt(mean(signal^2)), "\\n")
nc_close(part)
"""

_JULIA = """\
using NCDatasets
part = NCDataset("parts/{part}")
fault = part["fault"][:]   # 0 healthy, {faults}
signal = part["acceleration"][:, 1, 1]   # elapsed_time, channel, record, in m/s^2
println(sqrt(sum(abs2, signal) / length(signal)))
"""

_PROGRAMS = (
    ("Python", "python", _PYTHON),
    ("Python with xarray alone", "python", _XARRAY),
    ("MATLAB and Octave", "matlab", _MATLAB),
    ("R", "r", _R),
    ("Julia", "julia", _JULIA),
)


def opening(first_part: Path) -> list[str]:
    """Section with one program per language, to be run in the folder of the corpus; ``first_part`` is one of its files."""
    lines = [
        "",
        "## How to open it",
        "",
        "Run these in this folder. They print the rms of the first channel of the first record.",
    ]
    if _needs_plugin(first_part):
        lines += ["", "The signals are compressed with zstd: readers other than Python need the zstd plugin of HDF5."]
    for title, language, program in _PROGRAMS:
        text = program.replace("{part}", first_part.name).replace("{faults}", _FAULTY)
        lines += ["", f"### {title}", "", f"```{language}", *text.splitlines(), "```"]
    return lines


def _needs_plugin(part: Path) -> bool:
    with LIBRARY_LOCK, h5py.File(part, "r", locking=False) as file:
        return own_dataset(file, SIGNAL).id.get_create_plist().get_filter_by_id(_ZSTD) is not None
