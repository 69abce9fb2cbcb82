"""Folders of the project, of its golden numbers and of real recordings, if there are any."""

import os
from pathlib import Path

ROOT = Path(__file__).parents[1]
GOLDEN = ROOT / "tests" / "golden"
REAL = Path(os.environ.get("RACEWAY_REAL", ROOT.parent / "shared" / "real"))
