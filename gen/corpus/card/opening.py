"""How to open a corpus: short programs in Python, MATLAB, Octave, R and Julia, for its data card.

Each prints the root of the mean square of the first channel of the first record. All but ``gen`` open one file at a time: the single file
of the corpus, or one of its parts, which are complete netCDF-4 files.
"""

from pathlib import Path

import h5py

from gen.corpus.hdf5 import LIBRARY_LOCK, own_dataset
from gen.corpus.schema import FAULTS, SIGNAL, listed_flags

_FAULTY = listed_flags({code: name for code, name in enumerate(FAULTS) if code > 0})
_ZSTD = 32015  # number of the filter, registered with The HDF Group

_PYTHON = """\
import gen   # pip install raceway

corpus = gen.open_corpus("{path}")   # an xarray.Dataset; the files are checked, and signals are read when they are used
healthy = corpus.isel(record=corpus["fault"].values == 0)   # {faults}
signal = corpus["acceleration"][0, 0].values   # dimensions record, channel, elapsed_time, in m/s^2
print((signal**2).mean() ** 0.5)
"""

_XARRAY = """\
import xarray

corpus = xarray.open_dataset("{file}")
signal = corpus["acceleration"][0, 0].values
print((signal**2).mean() ** 0.5)
"""

_MATLAB = """\
% in Octave first: pkg load netcdf
file = '{file}';
fault = ncread(file, 'fault');   % 0 healthy, {faults}
fs = ncread(file, 'sample_rate');
% acceleration has dimensions elapsed_time, channel, record, in m/s^2
signal = double(ncread(file, 'acceleration', [1 1 1], [Inf 1 1]));
fprintf('%.6g\\n', sqrt(mean(signal(:) .^ 2)));
"""

_R = """\
library(ncdf4)
file <- nc_open("{file}")
fault <- ncvar_get(file, "fault")   # 0 healthy, {faults}
# acceleration has dimensions elapsed_time, channel, record, in m/s^2
signal <- ncvar_get(file, "acceleration", start = c(1, 1, 1), count = c(-1, 1, 1))
cat(sqrt(mean(signal^2)), "\\n")
nc_close(file)
"""

_JULIA = """\
using NCDatasets
file = NCDataset("{file}")
fault = file["fault"][:]   # 0 healthy, {faults}
signal = file["acceleration"][:, 1, 1]   # elapsed_time, channel, record, in m/s^2
println(sqrt(sum(abs2, signal) / length(signal)))
"""

_PROGRAMS = (
    ("Python", "python", _PYTHON),
    ("Python with xarray alone", "python", _XARRAY),
    ("MATLAB and Octave", "matlab", _MATLAB),
    ("R", "r", _R),
    ("Julia", "julia", _JULIA),
)


def opening(path: Path, first: Path) -> list[str]:
    """Section with one program per language for the corpus at ``path``, whose ``first`` file with signals they open."""
    whole, where = (path.name, f"in the folder of {path.name}") if path.is_file() else (".", "in this folder")
    file = path.name if path.is_file() else first.relative_to(path).as_posix()
    lines = [
        "",
        "## How to open it",
        "",
        f"Run these {where}. They print the rms of the first channel of the first record.",
    ]
    if not path.is_file():
        lines += [
            "Each file in `parts` has some of the records; `index.nc` has the variables of all records, without signals."
        ]
    if _needs_plugin(first):
        lines += ["", "The signals are compressed with zstd: readers other than Python need the zstd plugin of HDF5."]
    for title, language, program in _PROGRAMS:
        text = program.replace("{path}", whole).replace("{file}", file).replace("{faults}", _FAULTY)
        lines += ["", f"### {title}", "", f"```{language}", *text.splitlines(), "```"]
    return lines


def _needs_plugin(part: Path) -> bool:
    with LIBRARY_LOCK, h5py.File(part, "r", locking=False) as file:
        return own_dataset(file, SIGNAL).id.get_create_plist().get_filter_by_id(_ZSTD) is not None
