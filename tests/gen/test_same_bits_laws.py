"""The same bits from the process that compiled a kernel and from those that find it in the cache."""

import os
import subprocess
import sys

from tests.recipes import EVERYTHING

SCRIPT = """
import hashlib, sys
from gen import draw_scenarios, read_recipe, simulate
recipe = read_recipe(sys.argv[1])
print(hashlib.sha256(simulate(draw_scenarios(recipe), recipe).acceleration.tobytes()).hexdigest())
"""


def test_a_kernel_just_compiled_gives_the_bits_of_the_kernel_in_the_cache(tmp_path, write_recipe):
    recipe = write_recipe(tmp_path / "everything.yaml", EVERYTHING)
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    command = [sys.executable, "-c", SCRIPT, str(recipe)]
    compiled, cached = (
        subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout for _ in range(2)
    )
    assert len(compiled.strip()) == 64
    assert compiled == cached
