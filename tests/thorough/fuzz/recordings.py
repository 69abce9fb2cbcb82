"""Recordings of every format altered by byte and by field: each is read as finite numbers, or refused in one sentence."""

import io
import zipfile
from pathlib import Path

import numpy as np

from gen.support.errors import RacewayError
from raceway.importing import read_signal
from tests.raceway.importing.file_writers import N, T, X, text
from tests.raceway.importing.people_files import RIGHT
from tests.raceway.importing.test_array_files import READ
from tests.raceway.importing.test_old_excel import xls
from tests.raceway.importing.test_people_files import write

SEEDS = (
    "german_titled.csv", "american_thousands.csv", "dates.csv", "units_below.csv", "comment.lvm.txt", "two.lvm.txt", "campbell.dat",
    "save_ascii_two.txt", "save_ascii_row.txt", "utf_16.csv", "german_latin_1.csv", "sheet_with_times.xlsx", "stereo.wav", "bits_24.wav",
    "many.mat", "level_4.mat", "level_7_3.mat", "two_rows.npy",
)  # fmt: skip
OF_PROGRAMS = ("one.tdms", "text.uff", "binary.unv", "sheet.ods", "frame.parquet", "archive.npz")
FIELDS = (
    "", "0", "-", "nan", "1e308", "1e999", "1.480", "1,000,5", "9" * 400, "OVL", "\0", '"', "'", "\n", "\r", ";", ",", "\t", " ", "[g]",
    "Sample rate: 1e999 Hz", "Unit: g", "2026-13-45", "\ufeff", "x" * 5000, "Samples\t99999999999999999999", "1048577", "-1", "XFD1048576",
    "2147483647", "table:number-rows-repeated=\"1048576\"",
)  # fmt: skip
CHOICES = (
    {}, {"column": 0}, {"column": 1, "rate": 12800.0}, {"column": 0, "unit": "g", "rate": 12800.0, "decimal": "."},
    {"column": 0, "rate": 12800.0, "speed_column": 1, "speed_unit": "Hz"}, {"variable": "x"},
    {"column": 0, "rate": 12800.0, "speed_column": 2, "speed_unit": "1"},
)  # fmt: skip
RUN_UP = text(X, T + 320, np.arange(N) % 40 // 20, header="x [g];speed;tacho\n")


def seeds(folder: Path) -> list[Path]:
    """Small valid recordings, written into a folder."""
    for name in SEEDS:
        write(folder / name, RIGHT[name][0])
    for name in OF_PROGRAMS:
        READ[name][0](folder / name)
    xls(folder / "old.xls", T, X)
    (folder / "run_up.csv").write_text(RUN_UP, encoding="utf-8")
    return [folder / name for name in (*SEEDS, *OF_PROGRAMS, "old.xls", "run_up.csv")]


def mutate(content: bytes, rng: np.random.Generator) -> bytes:
    """Recording with one to four changes; of an archive of one of its members, so that its checksums agree."""
    if content[:2] == b"PK" and rng.random() < 0.8:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            parts = {name: archive.read(name) for name in archive.namelist()}
        changed = [*parts][int(rng.integers(len(parts)))]
        target = io.BytesIO()
        with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, part in parts.items():
                archive.writestr(name, mutate(part, rng) if name == changed else part)
        return target.getvalue()
    for _ in range(int(rng.integers(1, 5))):
        # half of the changes are in the first bytes, where headers are
        end = len(content) if rng.random() < 0.5 else min(len(content), 400)
        first, last = sorted(rng.integers(0, end + 1, 2).tolist())
        last = min(last, first + int(rng.integers(1, 200)))
        field = FIELDS[int(rng.integers(len(FIELDS)))].encode()
        middle = (b"", field, rng.bytes(last - first), content[first:last] * int(rng.integers(2, 50)))[
            int(rng.integers(4))
        ]
        content = content[:first] + middle + content[last:]
    return content[: int(rng.integers(len(content) + 1))] if rng.random() < 0.1 else content


def check(path: Path) -> None:
    """Read the recording in one of several ways; any exception except a sentence is a finding."""
    keys = CHOICES[path.stat().st_size % len(CHOICES)]
    try:
        signal = read_signal(path, **keys)
    except RacewayError as error:
        if "\n" in str(error) or not str(error).endswith("."):
            raise ValueError(str(error)) from None
        return
    if signal.values.ndim != 1 or not np.isfinite(signal.values).all():
        message = f"{keys}: values that are not finite"
        raise ValueError(message)
