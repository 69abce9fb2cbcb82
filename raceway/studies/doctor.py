"""Facts of this machine and installation that decide whether and how fast Raceway works, each with advice where something is amiss."""

import os
import platform
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, requires, version
from importlib.util import find_spec
from pathlib import Path
from typing import Literal, NamedTuple

from packaging.requirements import Requirement

from gen.support.workers import cores

State = Literal["fine", "note", "problem"]

PUBLISHED = {"amd-26-2": 48e6}
"""Record-steps per second and core of the kernel, as ``raceway doctor --speed quickstart`` measures them, by processor."""
SLOW = 0.7  # of the published figure; a shared machine changes its speed by a third from minute to minute
TIMED_RECORDS = 112
LEAST_DISK = 5e9  # bytes; the quickstart takes 30 MB, domain_randomised 300 MB

READERS = {
    "ncdump": "lists any netCDF file (Debian: netcdf-bin)",
    "nccopy": "copies and compresses netCDF files (Debian: netcdf-bin)",
    "ncks": "cuts netCDF files (Debian: nco)",
    "cdo": "calculates on netCDF files (Debian: cdo)",
    "octave": "reads netCDF with the package netcdf (Debian: octave octave-netcdf)",
    "Rscript": "reads netCDF with ncdf4 (Debian: r-cran-ncdf4)",
    "julia": "reads netCDF with NCDatasets",
    "matlab": "reads netCDF with ncread",
}
OPTIONAL = {
    "pyarrow": "feature tables and exports as Parquet: pip install 'raceway[parquet]'",
    "python-calamine": "recordings in Excel files: pip install 'raceway[excel]'",
    "zarr": "exports to Zarr: pip install 'raceway[zarr]'",
    "torch": "training networks on records: pip install torch",
    "datasets": "loading the Hugging Face layout: pip install datasets",
}


class Finding(NamedTuple):
    """One fact: its subject, its value, and advice, which is empty if nothing is to be done."""

    subject: str
    value: str
    state: State = "fine"
    advice: str = ""


def findings() -> Iterator[Finding]:
    """All facts, the quick ones first; the last one, the speed, takes some seconds."""
    plugins = os.environ.get("HDF5_PLUGIN_PATH")  # before netCDF4 is imported, which sets it for this process
    yield _python()
    yield from _requirements()
    yield from _processor()
    yield _memory()
    yield from _folders()
    yield from _codecs(plugins)
    yield from _optional()
    yield from _readers()
    yield _speed()


def _python() -> Finding:
    text = f"{platform.python_version()} ({sys.executable})"
    return Finding("Python", text)


def _requirements() -> Iterator[Finding]:
    yield Finding("raceway", version("raceway"))
    for text in requires("raceway") or ():
        needed = Requirement(text)
        if needed.marker is not None:  # of an extra
            continue
        try:
            present = version(needed.name)
        except PackageNotFoundError:
            yield Finding(needed.name, "missing", "problem", f"pip install '{needed}'.")
            continue
        if needed.specifier.contains(present, prereleases=True):
            yield Finding(needed.name, present)
        else:
            wanted = f"{needed.name}{needed.specifier}"
            yield Finding(needed.name, present, "problem", f"Raceway needs {wanted}: pip install '{wanted}'.")


def _processor() -> Iterator[Finding]:
    from llvmlite import binding

    from raceway.studies.timing import machine

    usable, present = cores(), os.cpu_count() or 1
    advice = (
        "" if usable == present else f"{present - usable} cores are taken from this process (taskset, container, job)."
    )
    counted = f"{usable} of {present}" if advice else f"{present}"
    yield Finding("cores", counted, "note" if advice else "fine", advice)
    features = binding.get_host_cpu_features()
    vectors = next((name for name in ("avx512f", "avx2", "neon") if features.get(name)), "none known")
    name = machine()["processor"]
    if platform.machine() in ("x86_64", "AMD64") and not features.get("fma"):
        advice = (
            "without fused multiply-add, records differ in their last bits from those of other machines; labels do not."
        )
        yield Finding("processor", f"{name}, {vectors}", "note", advice)
    else:
        yield Finding("processor", f"{name}, {vectors}")


def _memory() -> Finding:
    try:
        free = int(os.sysconf("SC_AVPHYS_PAGES")) * int(os.sysconf("SC_PAGE_SIZE"))
    except (ValueError, OSError):  # a system that does not tell
        return Finding("free memory", "not known")
    enough = free > 1e9
    advice = "" if enough else "a worker needs half a gigabyte: use --workers 1, or lower storage.records_per_part."
    return Finding("free memory", f"{free / 1e9:.1f} GB", "fine" if enough else "note", advice)


def _folders() -> Iterator[Finding]:
    from gen.simulation.kernels import cache_folder as kernel_folder
    from raceway.studies.reference_model import CACHE_VARIABLE, ESTIMATOR, REFERENCE, cache_folder, is_kept, kept_path

    folder = kernel_folder()
    if folder is None:
        advice = "kernels are compiled anew by each process; set NUMBA_CACHE_DIR to a folder that you can write."
        yield Finding("compiled kernels", "no folder for them", "problem", advice)
    else:
        files = list(folder.glob("integrate*.nbc"))
        size = sum(path.stat().st_size for path in files) / 1e6
        writable = os.access(folder, os.W_OK)
        advice = "" if writable else "it cannot be written; set NUMBA_CACHE_DIR to a folder that you can write."
        kept = f"{len(files)}, {size:.0f} MB in {folder}"
        yield Finding("compiled kernels", kept, "fine" if writable else "problem", advice)
    models = cache_folder()
    place = next((path for path in (models, *models.parents) if path.exists()), models)
    if not os.access(place, os.W_OK):
        yield Finding(
            "kept models", f"{models}", "problem", f"it cannot be written; set {CACHE_VARIABLE} to another folder."
        )
    elif is_kept(kept_path(REFERENCE, ESTIMATOR)):
        yield Finding("kept models", f"{models}, with the reference model of raceway diagnose")
    else:
        advice = f"raceway train {REFERENCE} trains the reference model of raceway diagnose (minutes, once)."
        yield Finding("kept models", f"{models}, without the reference model", "note", advice)
    for what, path in (("this folder", Path.cwd()), ("temporary files", Path(tempfile.gettempdir()))):
        free = shutil.disk_usage(path).free
        advice = (
            ""
            if free > LEAST_DISK
            else "a corpus of a million one-second records takes 17 GB; raceway plan RECIPE tells."
        )
        yield Finding(f"free disk, {what}", f"{free / 1e9:.0f} GB at {path}", "note" if advice else "fine", advice)


def _codecs(plugins: str | None) -> Iterator[Finding]:
    """Whether zstd, the only codec that needs a plugin, can be written here and read by other programs."""
    import netCDF4

    with netCDF4.Dataset("in memory", "w", memory=1024) as file:
        writes = bool(file.has_zstd_filter())
    advice = "storage.codec: zstd cannot be written or read here; zlib works everywhere. Install netCDF4 again for its plugins."
    yield Finding("codec zlib", "built in")
    yield Finding(
        "codec zstd", "plugin found" if writes else "no plugin", "fine" if writes else "note", "" if writes else advice
    )
    if writes:
        advice = (
            ""
            if plugins
            else "other programs (ncdump, MATLAB, h5py alone) need HDF5_PLUGIN_PATH to read zstd; zlib needs nothing."
        )
        yield Finding("HDF5_PLUGIN_PATH", plugins or "not set", "fine" if plugins else "note", advice)


def _optional() -> Iterator[Finding]:
    for name, purpose in OPTIONAL.items():
        if find_spec(name) is None:
            yield Finding(name, "not installed", "note", f"for {purpose}.")
        else:
            yield Finding(name, version(name))


def _readers() -> Iterator[Finding]:
    for name, purpose in READERS.items():
        path = shutil.which(name)
        advice = "" if path else f"{purpose}; Raceway does not need it."
        yield Finding(f"reader {name}", path or "not found", "fine" if path else "note", advice)
    if path := shutil.which("Rscript"):
        command = [path, "-e", "quit(status = !requireNamespace('ncdf4', quietly = TRUE))"]
        missing = subprocess.run(command, check=False, capture_output=True, timeout=60).returncode  # noqa: S603 - a fixed expression
        advice = "install.packages('ncdf4') in R." if missing else ""
        yield Finding("R package ncdf4", "missing" if missing else "installed", "note" if missing else "fine", advice)


def _speed() -> Finding:
    """Speed of the kernel on quickstart, if its kernels are compiled, against the published figure."""
    from gen.generation.compilation import needed_shapes
    from gen.recipe import read_recipe
    from gen.simulation.kernels import is_compiled

    missing = sum(not is_compiled(shape) for shape in needed_shapes(read_recipe("quickstart")))
    if missing:
        advice = f"{missing} kernels of quickstart are not compiled; raceway doctor --speed quickstart compiles them, in about 10 s each."
        return Finding("speed of the kernel", "not measured", "note", advice)
    from raceway.studies.timing import bench

    rate = bench("quickstart", TIMED_RECORDS).kernel_record_steps_per_second
    speed = f"{rate / 1e6:.0f} million record-steps/s on one core"
    published = PUBLISHED.get(processor_key())
    if published is None:
        listed = ", ".join(f"{name} {value / 1e6:.0f}" for name, value in PUBLISHED.items())
        return Finding(
            "speed of the kernel", f"{speed}; no figure is published for {processor_key()} (others: {listed} million)"
        )
    share = rate / published
    advice = (
        ""
        if share >= SLOW
        else "other programs are busy, or the processor runs at a lower clock; try again when it is idle."
    )
    compared = f"{speed}, {share:.2f} of the published {published / 1e6:.0f} million"
    return Finding("speed of the kernel", compared, "note" if advice else "fine", advice)


def processor_key() -> str:
    """Vendor, family and model of the processor, or its architecture where they are not known."""
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        text = ""
    return key_of(text) or platform.machine().lower()


def key_of(cpuinfo: str) -> str | None:
    r"""Vendor, family and model in the text of ``/proc/cpuinfo``.

    >>> key_of("vendor_id : AuthenticAMD\ncpu family : 26\nmodel : 2\nmodel name : AMD EPYC")
    'amd-26-2'
    """
    lines = (line.partition(":") for line in cpuinfo.splitlines())
    fields = {key.strip(): value.strip() for key, _, value in lines}
    if not {"vendor_id", "cpu family", "model"} <= set(fields):
        return None
    vendors = {"GenuineIntel": "intel", "AuthenticAMD": "amd"}
    vendor = vendors.get(fields["vendor_id"], fields["vendor_id"].lower())
    return f"{vendor}-{fields['cpu family']}-{fields['model']}"
