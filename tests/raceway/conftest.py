"""The command line, called in this process or in a process of its own."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from click.testing import CliRunner, Result

from features import feature_table
from features.baselines import Model
from gen import open_corpus
from gen.corpus import FAULTS
from raceway.cli import cli
from tests.diagnoses import corpus

_START = """
import os, signal, sys
signal.signal(signal.SIGINT, signal.SIG_DFL)  # tests in the background ignore it, and so would the process
for variable, limit in (("LARGEST_FILE", "RLIMIT_FSIZE"), ("LARGEST_MEMORY", "RLIMIT_AS")):
    if os.environ.get(variable):
        import resource
        resource.setrlimit(getattr(resource, limit), (int(os.environ[variable]),) * 2)
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


@pytest.fixture(scope="module")
def tables_once() -> Iterator[None]:
    """Commands that ask for the same feature table again get the first one: what they do with it is tested."""
    made: dict[str, xr.Dataset] = {}

    def table_of(corpus: Path, *given: Any, **options: Any) -> xr.Dataset:
        key = repr((corpus, given, {name: value for name, value in options.items() if name != "progress"}))
        if key not in made:
            made[key] = feature_table(corpus, *given, **options)
        return made[key].copy(deep=True)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("features.feature_table", table_of)
        yield


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


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pictures on data cards take no time: they are not what is tested."""
    monkeypatch.setattr("raceway.sharing.card_pictures.small_png", lambda _figure: b"picture" * 10_000)


@pytest.fixture(scope="session")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Model file for recordings of `tests.diagnoses`."""
    folder = tmp_path_factory.mktemp("training")
    table = feature_table(corpus(folder, seed=5, rigs=6, records=2, duration=0.5))
    Model("logistic_regression").fit(table).save(folder / "model.skops")
    return folder / "model.skops"


@pytest.fixture(scope="session")
def recordings(tmp_path_factory: pytest.TempPathFactory) -> dict[str, tuple[np.ndarray, float]]:
    """Signal [m s-2] and speed [rpm] of one recording of each class."""
    found = {}
    with open_corpus(corpus(tmp_path_factory.mktemp("tested"), seed=11, rigs=1, records=1, duration=2.0)) as opened:
        for number, code in enumerate(opened["fault"].values):
            signal = opened["acceleration"][number, 0].values.astype(float)
            found[FAULTS[code]] = signal, 60 * float(opened["shaft_rate"][number])
    return found
