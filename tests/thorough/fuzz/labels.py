"""Tables of labels altered as a stranger may alter them: each is read, or refused in a sentence.

The changes are those of :mod:`recipes`, with values that only a table has.
"""

from pathlib import Path

import numpy as np

from gen.physics.bearing import orders
from gen.support.errors import RacewayError
from raceway.importing.label_tables import read_table_of_labels
from tests.thorough.fuzz import recipes

SEEDS = {
    "german.csv": "path;fault;specimen;rig;bearing;unit;sample_rate_hz;shaft_rpm;load_n;width_mm;n_spalls;column\n"
    "new/1.csv;healthy;007;1;6205;g;25600;1480;0,5;;;ax\n\n;;;\nold/2.csv;outer;w;1;NU206;g;25600;1475,5;800;1,016;2;0\n",
    "commas.csv": "path,fault,specimen,bearing,shaft_rpm,recording,channels,title,delimiter,angle_deg\n"
    'a.wav,ball,1,"n_balls=8,pitch_diameter_mm=40,ball_diameter_mm=8,contact_angle_deg=15",1800.5,r,'
    '"[{name: de, column: 0, unit: g}, {name: fe, column: ay, unit: mV, sensitivity_mv_per_m_s2: 10.2}]",Pump,"\t",-90\n',
}
VALUES = (
    "40000", "-1", "18446744073709551616", "1e308", "nan", "1.480", "1'000,5", ".", "..", "/etc/passwd", "*/*/*", "[", "\0", "a\tb",
    '"', "<script>alert(1)</script>", "|", ";;", "6205", "n_balls=9,pitch_diameter_mm=1e308,ball_diameter_mm=1e-308", "compound",
    "m/s2", "[{name: x, unit: g}]", "[[[", "V", "unknown", "\u202ex", "a" * 3000, "x" * 200_000,
)  # fmt: skip


def seeds(folder: Path) -> list[Path]:
    """Valid tables, written into a folder."""
    for name, text in SEEDS.items():
        (folder / name).write_text(text, encoding="utf-8")
    return [folder / name for name in SEEDS]


def mutate(content: bytes, rng: np.random.Generator) -> bytes:
    """A change as for a recipe, or another value in a cell."""
    if rng.random() < 0.5:
        mark = b";" if content.count(b";") > 5 else b","
        cells = content.split(mark)
        cells[int(rng.integers(len(cells)))] = VALUES[int(rng.integers(len(VALUES)))].encode()
        return mark.join(cells)
    return recipes.mutate(content, rng)


def check(path: Path) -> None:
    """Read the labels and what follows from them; any exception except a RacewayError is a finding."""
    try:
        found = read_table_of_labels(path, {})
    except RacewayError:
        return
    for _, labels in found:
        if not np.isfinite(orders(labels.bearing)).all() or not labels.sensors:
            message = f"orders of {labels.bearing} are not finite"
            raise ValueError(message)
