"""CPU time and peak memory of select and merge for corpora of short records that are made without a simulation.

python benchmarks/cutting.py --records 100000
"""

import argparse
import tempfile
from pathlib import Path

from benchmarks.packing import measured, write_noise

STEPS = {
    "import gen, nothing else": "gen.select",
    "select a quarter": "gen.select({0!r}, {2!r} + '/quarter', where='fault == \"inner\"')",
    "select one channel": "gen.select({0!r}, {2!r} + '/channel', channels=['a'])",
    "merge both": "gen.merge([{0!r}, {1!r}], {2!r} + '/both')",
}


def main(records, samples):
    """Print a row of the table for each command."""
    with tempfile.TemporaryDirectory() as room:
        folders = [str(Path(room) / name) for name in ("one", "other")]
        for seed, folder in enumerate(folders):
            write_noise(Path(folder), records, samples, seed=seed)
        print(f"two corpora of {records:,} records of 2 x {samples} samples")
        for name, call in STEPS.items():
            cpu, wall, memory = measured(f"import gen; {call.format(*folders, room)}")
            print(f"{name:26} {cpu:7.1f} s CPU {wall:7.1f} s wall {memory:7.0f} MB")


def test_selections_and_merges_of_the_noise_are_made(capsys):
    main(8, 40)
    assert "merge both" in capsys.readouterr().out


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--records", type=int, default=10_000)
    parser.add_argument("--samples", type=int, default=1200)
    options = parser.parse_args()
    main(options.records, options.samples)
