"""What other people's programs read of a corpus: of a part, and of a corpus in one file.

``python -m tests.readers`` prints the table of docs/sharing.md, for the programs that this machine has.
"""

import re
import shutil
import subprocess
import sys
import tempfile
from importlib.metadata import version
from pathlib import Path

import h5py
import netCDF4
import numpy as np
import xarray as xr

from gen.corpus import part_name
from raceway import copy
from tests.corpora import COUNTS_PER_UNIT, dataset, write_parts

COUNTS = (20, 10)  # records of the parts
EVERYTHING, NO_TEXT, NOTHING = "everything", "everything but text", "nothing: it ends with an error"


def write_forms(folder):
    """Write a corpus, and return the paths of a part and of its copy in one file; in a smaller one nccopy meets no chunks."""
    parts = [dataset(first, n, samples=1000) for first, n in zip((0, COUNTS[0]), COUNTS, strict=True)]
    write_parts(folder / "c", parts)
    copy(folder / "c", folder / "c.nc")
    return [folder / "c" / "parts" / part_name(0), folder / "c.nc"]


def truth(records):
    """Last sample of each record on its last channel [counts], shaft rates [Hz] and bearings of the first records of the corpus."""
    found = [dataset(first, n, samples=1000) for first, n in zip((0, COUNTS[0]), COUNTS, strict=True)]
    counts = np.concatenate([part["acceleration"].values[:, -1, -1] for part in found])[:records]
    rates = np.concatenate([part["shaft_rate"].values for part in found])[:records]
    bearings = [str(text) for part in found for text in part["bearing"].values][:records]
    return counts, rates, bearings


def verdict(read, path):
    """Verdict about a reader: ``read(path)`` gives accelerations [m s-2] or counts, shaft rates and bearings (None: not read)."""
    counts, rates, bearings = truth(COUNTS[0] if path.parent.name == "parts" else sum(COUNTS))
    try:
        signal, found, texts = read(path)
    except (OSError, RuntimeError, ValueError, KeyError, subprocess.CalledProcessError):
        return NOTHING
    signal = np.asarray(signal, float)
    right = np.allclose(signal, counts / COUNTS_PER_UNIT, rtol=1e-4) or np.array_equal(signal, counts)
    if not (right and np.allclose(found, rates, rtol=1e-4)):
        return "wrong values"
    return EVERYTHING if texts is not None and [text.strip() for text in texts] == bearings else NO_TEXT


def said(*command):
    return subprocess.run([*map(str, command)], check=True, capture_output=True, text=True, timeout=60).stdout


def dumped(path):
    """Values that ncdump prints."""
    text = said("ncdump", "-v", "acceleration,shaft_rate,bearing", path).partition("\ndata:\n")[2]
    found = dict(re.findall(r"^ (acceleration|shaft_rate|bearing) =\s+(.*?) ;$", text, re.DOTALL | re.MULTILINE))
    numbers = [np.array(found[name].split(","), float) for name in ("acceleration", "shaft_rate")]
    return numbers[0].reshape(-1, 2, 1000)[:, -1, -1], numbers[1], re.findall(r'"([^"]*)"', found["bearing"])


def copied(*command):
    """Values of a copy that a program makes, read by netCDF4."""

    def read(path):
        with tempfile.TemporaryDirectory() as folder:
            said(*command, path, Path(folder) / "copy.nc")
            return by_netcdf4(Path(folder) / "copy.nc")

    return read


def by_netcdf4(path):
    with netCDF4.Dataset(path) as file:
        return file["acceleration"][:, -1, -1], file["shaft_rate"][:], [str(text) for text in file["bearing"][:]]


def by_h5py(path):
    with h5py.File(path) as file:
        texts = [bytes(row.tobytes()).rstrip(b"\0").decode() for row in file["bearing"][:]]
        return file["acceleration"][:, -1, -1], file["shaft_rate"][:], texts


def by_xarray(engine):
    def read(path):
        with xr.open_dataset(path, engine=engine, decode_times=False) as file:
            return (
                file["acceleration"][:, -1, -1].values,
                file["shaft_rate"].values,
                [str(v) for v in file["bearing"].values],
            )

    return read


def by_cdo(path):
    """Numbers from CDO, which takes the records for points in time and leaves text out."""
    rates = np.array(said("cdo", "-s", "output", "-selname,shaft_rate", path).split(), float)
    signal = np.array(said("cdo", "-s", "output", "-selname,acceleration", path).split(), float)
    return signal.reshape(-1, 2, 1000)[:, -1, -1], rates, None


def by_octave(path):
    script = f"""pkg load netcdf; f = '{path}'; x = ncread(f, 'acceleration'); printf('%.9g ', x(end, end, :)); printf('\\n');
printf('%.9g ', ncread(f, 'shaft_rate')); b = ncread(f, 'bearing');
for i = 1:columns(b), printf('\\n%s', strrep(b(:, i)', char(0), '')); end"""
    lines = said("octave", "-qfW", "--eval", script).split("\n")
    return np.array(lines[0].split(), float), np.array(lines[1].split(), float), lines[2:]


def by_r(path):
    script = f"""library(ncdf4); f <- nc_open("{path}"); x <- ncvar_get(f, "acceleration")
cat(x[dim(x)[1], dim(x)[2], ], "\\n"); cat(ncvar_get(f, "shaft_rate"), "\\n"); cat(ncvar_get(f, "bearing"), sep = "\\n")"""
    lines = said("Rscript", "-e", script).strip().split("\n")
    return np.array(lines[0].split(), float), np.array(lines[1].split(), float), lines[2:]


def version_of(*command):
    """Version that a program states; None where it, or the package that it needs, is missing."""
    if shutil.which(command[0]) is None:
        return None
    told = subprocess.run(command, check=False, capture_output=True, text=True, timeout=60)
    found = re.search(r"\d+\.\d+(\.\d+)?", told.stdout + told.stderr)
    return found[0] if found and told.returncode in (0, 1) else None


READERS = {
    "ncdump": (dumped, ("ncdump",)),
    "nccopy": (copied("nccopy"), ("nccopy",)),
    "ncks (NCO)": (copied("ncks", "-O"), ("ncks", "--version")),
    "CDO": (by_cdo, ("cdo", "--version")),
    "R, ncdf4": (by_r, ("Rscript", "-e", 'cat(as.character(packageVersion("ncdf4")))')),
    "Octave, netcdf": (
        by_octave,
        ("octave", "-qfW", "--eval", "pkg load netcdf; x = pkg('list', 'netcdf'); disp(x{1}.version)"),
    ),
    "Python, netCDF4": (by_netcdf4, "netCDF4"),
    "Python, h5py": (by_h5py, "h5py"),
    'Python, xarray, engine="netcdf4"': (by_xarray("netcdf4"), "xarray"),
    'Python, xarray, engine="h5netcdf"': (by_xarray("h5netcdf"), "h5netcdf"),
}


def found_version(name):
    how = READERS[name][1]
    return version(how) if isinstance(how, str) else version_of(*how)


def table(folder):
    """Rows of the table: reader with its version, and its verdict on each form."""
    paths, rows = write_forms(folder), []
    for name, (read, _) in READERS.items():
        number = found_version(name)
        if number is not None:
            rows.append((name, number, *(verdict(read, path) for path in paths)))
    return rows


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as room:
        for row in table(Path(room)):
            sys.stdout.write(f"| {' | '.join(row)} |\n")
