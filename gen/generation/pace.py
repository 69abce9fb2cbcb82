"""Pace of this machine: how long some records of a recipe take, from the drawn scenario to the written part.

The records are made as :func:`gen.generate` makes them, in this process and into a temporary folder. Kernels that are not compiled yet are
not compiled for this: that takes longer than many a corpus. The pace of a kind of records is measured once per machine, and kept beside the
compiled kernels.
"""

import json
import os
import platform
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

from numba.core import event

from gen.corpus import Codec
from gen.generation.sources import sources_sha256
from gen.physics.kernel.compiling import LANES
from gen.scenarios import Scenario, Settings, common_settings
from gen.simulation.batches import Group, filled_lanes
from gen.simulation.kernels import cache_folder
from gen.simulation.simulate import integrations, simulate
from gen.simulation.timeline import timeline

LARGEST_SAMPLE = 30e6  # steps of all lanes, about 2 s
REPEATS = 2  # the first run also loads the kernels from the cache


class Pace(NamedTuple):
    """Seconds per unit of work, with one process."""

    lane_step: float
    """Integration of one step of one lane, with the preparation of its record [s]."""
    record: float
    """Measurement, labels and writing of one record [s]."""


class _NotCompiledError(Exception):
    """A kernel is not in numba's cache on disk."""


class _Refusal(event.Listener):
    """Stops the compilation of every kernel that is kept in the cache on disk."""

    def on_start(self, event: Any) -> None:
        if event.data["dispatcher"].stats.cache_path is not None:
            raise _NotCompiledError

    def on_end(self, event: Any) -> None:
        """Do nothing."""


@contextmanager
def _refuse_compilation() -> Iterator[None]:
    with event.install_listener("numba:compile", _Refusal()):
        yield


def measured_pace(scenarios: list[Scenario], group: Group, codec: Codec) -> Pace | None:
    """Seconds that the records of one batch take, all of ``group``; such records are timed once on a machine.

    None if a kernel is not compiled yet, or if the batch has more than ``LARGEST_SAMPLE`` steps.
    """
    steps = timeline(common_settings(scenarios)).integrated * group.steps
    if LANES * steps > LARGEST_SAMPLE:
        return None
    kept = _kept_file(common_settings(scenarios), group, codec)
    with suppress(OSError, ValueError, TypeError):  # there is none, or it is damaged
        return Pace(**json.loads(kept.read_text()))
    try:
        with _refuse_compilation():
            runs = [_time(scenarios, codec) for _ in range(REPEATS)]
    except _NotCompiledError:
        return None
    integration, rest = (min(times) for times in zip(*runs, strict=True))
    pace = Pace(integration / (filled_lanes(integrations(scenarios)) * steps), rest / len(scenarios))
    with suppress(OSError):
        kept.write_text(json.dumps(pace._asdict()))
    return pace


def _kept_file(settings: Settings, group: Group, codec: Codec) -> Path:
    """File of the pace of a kind of records on this machine; where kernels have no folder, one that can be neither read nor written."""
    kind = settings.samples, settings.settle, settings.channels, settings.twins, group, codec
    key = repr((platform.node(), sources_sha256(), kind))
    return (cache_folder() or Path(os.devnull)) / f"pace-{sha256(key.encode()).hexdigest()[:16]}.json"


def _time(scenarios: list[Scenario], codec: Codec) -> tuple[float, float]:
    """Seconds of the simulation, and of measurement, labels and writing: CPU time, since other programs may be busy at the moment."""
    from gen.corpus import write_part  # these three load xarray and SciPy for 0.7 s
    from gen.generation.labels import part_dataset
    from gen.measurement.measure import measure
    from gen.measurement.other_bearing import with_other_faults

    start = time.process_time()
    response = simulate(scenarios)
    simulated = time.process_time()
    measured = measure(response.acceleration, scenarios, response.twins)
    measured = with_other_faults(measured, response.acceleration, response.twins)
    with tempfile.TemporaryDirectory() as folder:
        dataset = part_dataset(measured, response)
        write_part(dataset, Path(folder) / "part-00000.nc", codec)
    return simulated - start, time.process_time() - simulated
