"""The command line, called in this process or in a process of its own."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from raceway.cli import cli

_START = """
import os, signal, sys
signal.signal(signal.SIGINT, signal.SIG_DFL)  # tests in the background ignore it, and so would the process
if os.environ.get("LARGEST_FILE"):
    import resource
    resource.setrlimit(resource.RLIMIT_FSIZE, (int(os.environ["LARGEST_FILE"]),) * 2)
from raceway.cli import main
if __name__ == "__main__":
    main()
"""


@pytest.fixture
def run() -> Callable[..., Result]:
    """Call a command in this process: ``run("info", folder)``."""

    def call(*arguments: object) -> Result:
        return CliRunner().invoke(cli, [str(argument) for argument in arguments], prog_name="raceway")

    return call


@pytest.fixture
def told(run: Callable[..., Result]) -> Callable[..., dict[str, Any]]:
    """Call a command with ``--json``, and return the one object it prints."""

    def call(*arguments: object, exit_code: int = 0) -> dict[str, Any]:
        result = run(*arguments, "--json")
        assert result.exit_code == exit_code, result.output
        return json.loads(result.stdout)

    return call


@pytest.fixture
def start(tmp_path: Path) -> Callable[..., subprocess.Popen[str]]:
    """Start a command as a process group of its own, as a terminal does."""
    script = tmp_path / "run_in_a_process.py"
    script.write_text(_START, encoding="utf-8")
    started = []

    def call(*arguments: object, **environment: str) -> subprocess.Popen[str]:
        process = subprocess.Popen(
            [sys.executable, script, *map(str, arguments)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
            env=os.environ | environment,
        )
        started.append(process)
        return process

    yield call
    for process in started:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
