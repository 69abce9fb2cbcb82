"""Size, CPU time and peak memory of pack, unpack and validate for a corpus of short records that is made without a simulation.

python benchmarks/packing.py --records 100000
"""

import argparse
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from gen.corpus import SCHEMA, make_dataset, part_name, write_index, write_manifest, write_part

FS = 12_000.0


def write_noise(folder, records, samples, channels=2, part=500, seed=0):
    """Write a corpus of records of noise through a resonance, in parts, with index and manifest; half a second for 1000 records."""
    (folder / "parts").mkdir(parents=True)
    rng, rows = np.random.default_rng(seed), []
    for first in range(0, records, part):
        n = min(part, records - first)
        noise = rng.standard_normal((n, channels, samples + 2))
        counts = np.rint(2000 * (noise[..., 2:] + 1.2 * noise[..., 1:-1] + 0.6 * noise[..., :-2])).clip(-32767, 32767)
        numbers = np.arange(first, first + n)
        columns = {v.name: np.full(n, "noise", object) if v.dtype == "str" else np.zeros(n) for v in SCHEMA}
        columns |= {"shaft_rate": rng.uniform(10, 40, n), "sample_rate": np.full(n, FS), "fault": numbers % 4}
        columns |= {"recording": numbers, "specimen": numbers // 4, "rig": numbers // 32}
        dataset = make_dataset(
            counts.astype(np.int16), FS, tuple("abcdefgh"[:channels]), columns, counts_per_unit=100.0,
            attributes={"title": "Noise", "history": "made by benchmarks/packing.py"},
        )  # fmt: skip
        rows.append(write_part(dataset, folder / "parts" / part_name(len(rows))))
    write_index(folder, rows)
    write_manifest(folder, rows, complete=True)


def measured(code):
    """CPU seconds, wall seconds and peak memory [MB] of some Python in a process of its own."""
    peak = "next(int(line.split()[1]) for line in open('/proc/self/status') if line.startswith('VmHWM')) / 1e3"
    tail = f"import time\nprint(time.process_time(), {peak})"
    begun = time.monotonic()
    done = subprocess.run([sys.executable, "-c", f"{code}\n{tail}"], check=True, capture_output=True, text=True)
    cpu, memory = map(float, done.stdout.split()[-2:])
    return cpu, time.monotonic() - begun, memory


def main(records, samples):
    """Print a row of the table for each command."""
    with tempfile.TemporaryDirectory() as room:
        folder, file, again = Path(room) / "corpus", Path(room) / "corpus.nc", Path(room) / "again"
        write_noise(folder, records, samples)
        size = sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
        print(f"{records:,} records of 2 x {samples} samples: folder {size / 1e6:,.1f} MB, ", end="")
        steps = {
            "import gen, nothing else": "import gen; gen.pack",
            "pack": f"import gen; gen.pack({str(folder)!r}, {str(file)!r})",
            "validate of the file": f"import gen; assert gen.validate_corpus({str(file)!r}) == []",
            "unpack": f"import gen; assert gen.unpack({str(file)!r}, {str(again)!r}).same_bytes",
        }
        rows = {name: measured(code) for name, code in steps.items()}
        print(f"packed file {file.stat().st_size / 1e6:,.1f} MB")
        for name, (cpu, wall, memory) in rows.items():
            print(f"{name:26} {cpu:7.1f} s CPU {wall:7.1f} s wall {memory:7.0f} MB")
        shutil.rmtree(again)


def test_the_noise_is_a_corpus(tmp_path):
    from gen import pack, unpack, validate_corpus

    write_noise(tmp_path / "c", 5, 40, part=3)
    pack(tmp_path / "c", tmp_path / "c.nc")
    assert validate_corpus(tmp_path / "c.nc") == validate_corpus(tmp_path / "c") == []
    assert unpack(tmp_path / "c.nc", tmp_path / "d").same_bytes


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--records", type=int, default=10_000)
    parser.add_argument("--samples", type=int, default=512)
    given = parser.parse_args()
    main(given.records, given.samples)
