"""A corpus is opened, and its features are computed, where the system has no fork, no affinity of cores and no fcntl, as Windows."""

import os
import subprocess
import sys

import numpy as np

from features import feature_table
from gen import open_corpus
from raceway import copy

READ = """
import os, sys
for name in ("fork", "forkpty", "register_at_fork", "sched_getaffinity", "process_cpu_count", "getuid", "geteuid", "killpg"):
    if hasattr(os, name):
        delattr(os, name)
for name in ("fcntl", "resource", "pwd", "grp", "termios"):
    sys.modules[name] = None
import numpy as np
from features import feature_table
from gen import open_corpus
for path in sys.argv[1:]:
    print(float(np.abs(open_corpus(path)["acceleration"].values).max()), np.nansum(feature_table(path)["features"].values))
"""


def test_a_corpus_is_read_without_what_only_posix_systems_have(tiny_corpus, tmp_path):
    copy([tiny_corpus], tmp_path / "c.nc")
    command = [sys.executable, "-c", READ, tiny_corpus, tmp_path / "c.nc"]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    run = subprocess.run(command, capture_output=True, text=True, env=environment)
    assert run.returncode == 0, run.stderr
    largest = float(np.abs(open_corpus(tiny_corpus)["acceleration"].values).max())
    line = f"{largest} {np.nansum(feature_table(tiny_corpus)['features'].values)}\n"
    assert run.stdout == 2 * line
