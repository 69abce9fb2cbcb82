"""Mapping files altered as a stranger may alter them: each is read, or refused in a sentence.

The changes are those of :mod:`recipes`, with values that only a mapping file has.
"""

from contextlib import suppress
from pathlib import Path

import numpy as np
from pydantic import ValidationError

from gen.importers.mapping import read_mapping
from gen.importers.mapping_values import bearing_of
from gen.importers.paths import match_path
from gen.physics.bearing import orders
from gen.support.errors import RacewayError
from tests.thorough.fuzz import recipes

SEEDS = {
    "common.yaml": """\
title: Pump 7, drive side
origin: "A. Miller, CC BY 4.0"
channel: drive side
bearing: "6205"
unit: g
sample_rate_hz: 25600
shaft_rpm: 1480
files:
  - {path: healthy/*.csv, fault: healthy, specimen: new, column: 1}
  - {path: outer/*.csv, fault: outer, specimen: worn, width_mm: 0.5, angle_deg: -90, n_spalls: 2, delimiter: ";"}
""",
    "geometry.yaml": """\
variable: &v run.x
resample_hz: 12000
rig: 1
files:
  - &first
    path: a.mat
    unit: m/s2
    sample_rate_hz: 1.2e4
    shaft_rpm: 1800.5
    fault: ball
    specimen: 3
    load_n: 50
    depth_um: 20
    bearing: {designation: L8, n_balls: 8, pitch_diameter_mm: 40, ball_diameter_mm: 8, contact_angle_deg: 15}
  - {<<: *first, path: b.mat, variable: *v, column: ax}
""",
    "paths.yaml": """\
bearing: NICE
unit: V
sensitivity_mv_per_g: 100
sample_rate_hz: {variable: fs}
fault: {N: healthy, I: inner, O: outer}
shaft_rpm: {variable: X*RPM, times: 60}
load_n: {0: 0, 1: 746.5}
specimen: "{fault} {place}"
recording: "{run}"
width_mm: {"007": 0.1778}
files:
  - {path: "Data/{place}/{fault}_{load_n}_{run}*.mat", variable: "X{run}_*"}
  - {path: "**/{fault}-{width_mm}_{place}_{load_n}/{run}.mat"}
  - path: "{fault}/{shaft_rpm}_{load_n}_{place}[0-9]{run}.wav"
    shaft_rpm: {times: 60}
""",
    "channels.yaml": """\
bearing: "6205"
shaft_rpm: 1480
fault: unknown
specimen: "1"
sample_rate_hz: 25600
channels:
  - {name: drive end, column: 0, unit: g}
  - {name: fan end, column: ay, unit: mV, sensitivity_mv_per_m_s2: 10.2}
files: [{path: a.csv}]
""",
}
VALUES = (
    "40000", "-1", "18446744073709551616", "1e308", "1e-300", ".nan", ".", "..", "/etc/passwd", "'**/**/*'", "'a**b'", "'*'", "'['",
    '"\\0"', '"a\\tb"', "<script>alert(1)</script>", "'[x](javascript:y)'", "'|'", "';;'", "'\\n'", "6205", "NU206", "{n_balls: 9}",
    "{n_balls: 9, pitch_diameter_mm: 1e308, ball_diameter_mm: 1e-308}", "compound", "m/s2",
    "'{fault}'", "'{specimen}_{specimen}'", "'{x}{y}{a}{b}{c}{d}{e}{f}{g}'",
    "{variable: x}",
    "{times: 0}", "{N: 1}", "{}", "[{name: x, unit: g}]", "V", "unknown", "\u202ex", "a" * 3000,
)  # fmt: skip


def seeds(folder: Path) -> list[Path]:
    """Valid mapping files, written into a folder."""
    for name, text in SEEDS.items():
        (folder / name).write_text(text, encoding="utf-8")
    return [folder / name for name in SEEDS]


def mutate(content: bytes, rng: np.random.Generator) -> bytes:
    """A change as for a recipe, or a value that only a mapping file has."""
    if rng.random() < 0.4:
        found = list(recipes.VALUE.finditer(content))
        if found:
            start, stop = found[int(rng.integers(len(found)))].span()
            content = content[:start] + VALUES[int(rng.integers(len(VALUES)))].encode() + content[stop:]
        if rng.random() < 0.5:
            return content
    return recipes.mutate(content, rng)


def check(path: Path) -> None:
    """Read a mapping file, the bearing of each of its entries, and names of files; any exception except a RacewayError is a finding."""
    try:
        mapping = read_mapping(path)
    except RacewayError:
        return
    for section in mapping.sections:
        for name in ("Data/a/N_0_1.mat", "I/30_1_x7y.wav", "a" * 255, "_" * 255, "x/" * 60):
            groups = match_path(section.pattern, name, section.suits())
            if groups is not None:
                with suppress(ValidationError):
                    section.facts(groups)
                list(section.sensors(groups))
    for bearing in (section.keys.bearing for section in mapping.sections if section.keys.bearing is not None):
        if not np.isfinite(orders(bearing_of(bearing))).all():
            message = f"orders of {bearing} are not finite"
            raise ValueError(message)
