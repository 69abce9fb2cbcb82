"""The measured rows, one file per processor: ``benchmarks/results-<vendor>-<family>-<model>.json``.

A run replaces the rows that it measured and keeps the others, so each row has the facts of its own run.
"""

import json
import os
import platform
from collections.abc import Iterable, Mapping
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from benchmarks.pairs import Line, Row

FOLDER = Path(__file__).parent
PREFIX = "results-"

Rows = dict[str, dict[str, Any]]
"""Rows by name: the fields of :class:`Row`, and ``facts``."""


def facts() -> dict[str, Any]:
    """Processor, versions and settings that the values depend on."""
    facts = machine() | {"OMP_NUM_THREADS": os.environ.get("OMP_NUM_THREADS")}
    for name in ("xarray", "netCDF4", "h5py", "dask", "tsfel"):
        try:
            facts[name] = version(name)
        except PackageNotFoundError:
            facts[name] = None
    return facts


def machine() -> dict[str, Any]:
    """Processor, cores and versions, which determine the figures."""
    names = ("raceway", "numba", "numpy", "scipy")
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "python": platform.python_version(),
        **{name: version(name) for name in names},
    }


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor()
    return next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), platform.machine())


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


def results_file(name: str, folder: Path = FOLDER) -> Path:
    """File of a processor."""
    return folder / f"{PREFIX}{name}.json"


def every_result(folder: Path = FOLDER) -> dict[str, Rows]:
    """Rows of every processor, by its name."""
    paths = sorted(folder.glob(f"{PREFIX}*.json"))
    return {path.stem.removeprefix(PREFIX): json.loads(path.read_text(encoding="utf-8")) for path in paths}


def keep(lines: Iterable[Line], path: Path, facts: Mapping[str, Any]) -> None:
    """Replace the rows of ``lines`` in a file, and keep its other rows."""
    rows: Rows = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    for line in lines:
        if isinstance(line, Row):
            rows[line.name] = {key: value for key, value in line._asdict().items() if key != "name"} | {"facts": facts}
    text = ",\n".join(f" {json.dumps(name)}: {json.dumps(row)}" for name, row in rows.items())
    path.write_text(f"{{\n{text}\n}}\n", encoding="utf-8")
