"""Recordings to diagnose, files of them, and calls of ``raceway diagnose``."""

import json

import numpy as np
from click.testing import CliRunner
from scipy.io import wavfile

from gen import generate
from raceway.cli import cli

FS = 12_000
RECIPE = """\
# Recordings to diagnose, for tests.
name: recordings
title: Recordings
seed: {seed}
corpus: {{rigs: {rigs}, specimens_per_rig: 4, records_per_specimen: {records}}}
storage: {{records_per_part: 48}}
recording: {{sample_rate_hz: 12000, duration_s: {duration}, settle_s: 0.05, converter: {{kind: float32}}}}
bearing: {{kind: catalogue, designations: ["6205"]}}
specimen: {{waviness_nm: 20}}
operation: {{shaft_rpm: 'uniform(1700, 1800)'}}
background: {{slope: 'uniform(0, 1)'}}
faults:
  - {{kind: healthy}}
  - {{kind: inner, width_mm: 'uniform(0.5, 1)'}}
  - {{kind: outer, width_mm: 'uniform(0.5, 1)'}}
  - {{kind: ball, width_mm: 'uniform(0.5, 1)'}}
"""


def corpus(folder, **values):
    recipe = folder / "recipe.yaml"
    recipe.write_text(RECIPE.format(**values), encoding="utf-8")
    return generate(recipe, folder / "corpus").path


def call(*arguments):
    return CliRunner().invoke(cli, ["diagnose", *map(str, arguments)], prog_name="raceway")


def told(*arguments):
    result = call(*arguments, "--json")
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


def write_csv(path, signal):
    time = np.arange(signal.size) / FS
    np.savetxt(
        path,
        np.stack([time, signal / 9.80665], axis=1),
        delimiter=",",
        header="time [s],drive_end",
        comments="",
        fmt="%.7g",
    )
    return path


def write_wav(path, *channels):
    wavfile.write(
        path, FS, np.stack(channels, axis=1).astype(np.float32) if len(channels) > 1 else channels[0].astype(np.float32)
    )
    return path
