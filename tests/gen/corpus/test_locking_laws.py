"""Of two calls one writes into a folder; a lock ends with its process."""

import subprocess
import sys

import pytest

from gen.corpus.locking import lock
from gen.support.errors import CorpusError

HOLD = (
    "import sys, time; from pathlib import Path; from gen.corpus.locking import lock\n"
    "with lock(Path(sys.argv[1])): print('held', flush=True); time.sleep(60)"
)


def test_a_folder_is_refused_while_another_process_holds_its_lock_and_free_once_that_is_killed(tmp_path):
    process = subprocess.Popen([sys.executable, "-c", HOLD, tmp_path], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "held\n"
    with (
        pytest.raises(CorpusError, match="another raceway command is writing into it; wait until it ends"),
        lock(tmp_path),
    ):
        pass
    process.kill()
    process.communicate()
    with lock(tmp_path):
        assert list(tmp_path.iterdir()) == []
