"""Cost of a corpus that is generated in this process, as JSON: ``python -m benchmarks.cost RECIPE FOLDER RECORDS``."""

import json
import sys
import time
from pathlib import Path

from gen.generation.corpus import generate


def main() -> None:
    """Print CPU time [ms] and file size [bytes] per record, and peak memory [MB]."""
    recipe, folder, records = sys.argv[1], Path(sys.argv[2]), int(sys.argv[3])
    generate(recipe, folder / "first", records=1)
    start = time.process_time()
    generated = generate(recipe, folder / "corpus", records=records)
    took = time.process_time() - start
    # VmHWM instead of ru_maxrss of getrusage, which a process inherits from its parent
    status = Path("/proc/self/status").read_text().split()
    size = sum(path.stat().st_size for path in generated.path.rglob("*") if path.is_file())
    peak = int(status[status.index("VmHWM:") + 1]) / 1e3
    print(json.dumps({"ms": 1e3 * took / records, "MB": peak, "bytes": size / generated.records}))


if __name__ == "__main__":
    main()
