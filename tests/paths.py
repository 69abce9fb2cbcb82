"""Where tests find the project, its golden numbers and, if they are there, real recordings."""

import os
from pathlib import Path

ROOT = Path(__file__).parents[1]
GOLDEN = ROOT / "tests" / "golden"
REAL = Path(os.environ.get("RACEWAY_REAL", ROOT.parent / "shared" / "real"))
