"""Recipes altered as a stranger may alter them: each is read and drawn from, or refused in a sentence.

``seeds`` gives valid files, ``mutate`` alters one, ``check`` reads one.
"""

import re
import shutil
from pathlib import Path

import numpy as np

from gen.recipe import read_recipe, shipped_recipes
from gen.scenarios import draw_scenarios
from gen.support.errors import RacewayError

RECORDS = 3  # drawn of a recipe that is valid

SMALL = """\
name: small
title: A small corpus
seed: 3
corpus:
  {rigs: 3, specimens_per_rig: 4, records_per_specimen: 2, rungs: [0, 0.5, 1], split: {by: specimen, test: 0.25}}
storage: {records_per_part: 8}
recording:
  sample_rate_hz: 12000
  duration_s: 0.1
  channels: [{name: sensor, body: {sensor: 1, housing: 2}}]
bearing: {kind: catalogue, designations: ["6205"]}
machine: {bow_n: 'uniform(10, 20)'}
specimen:
  diametral_clearance_um: uniform(-4, 12)
  contact_angle_deg: 1 * free_contact_angle_deg
operation:
  shaft_rpm: normal(1750, 100, per=rig, scatter_percent=2, low=1500, high=2000)
  load_n: &load uniform(2, 4) * bow_n
  slip_percent: uniform(0.5, 2) * speed_wander_percent
  speed_profile: {kind: steps, levels_percent: [50, 100], step_s: 0.01}
faults:
  - {kind: healthy, weight: 4}
  - &inner {kind: inner, width_mm: 0.5, angle_deg: 'choice(0, 90, weights=(1, 3))', operation: {load_n: *load}}
  - {<<: *inner, kind: outer}
  - {kind: compound, parts: [{kind: cage}, {kind: ball, width_mm: 'loguniform(0.1, 1)'}]}
background: {tones: {probability: 0.5, count: 2, frequency_hz: 100, level_db: -10}}
"""

SCALARS = (
    "0", "-0", "-1", "1", "2", "0.5", "1e308", "-1e308", "1e999", "1e-300", "5e-324", ".inf", "-.inf", ".nan", "9" * 30, "9" * 200,
    "9" * 5000, "0x_", "0b", "0o17", "-_", "1_0", "2001-99-99", "2001-01-01", "12:30:45", "2147483648", "9223372036854775808",
    "true", "no", "null", "~", "''", "[]", "{}", "[[]]", "{a: 1}", "*inner", "*nowhere", "&x [*x]", "!!binary aGk=", "!!set {a}",
    "!!float 1", "!!python/name:os.system", '"\\ud800"', '"\\0"', '"\\UFFFFFFFF"', "\u202e", "\U0001f529", "'\u0000'", "=", "<<",
    "{<<: 1}", "6205", "grid", "grid(1, 2)", "uniform(0, 1e+308)",
    "normal(0, 1e-300, low=-1, high=1)", "choice(1, weights=(1e+308,))", "geometry", "compound",
)  # fmt: skip
FORMS = (
    "0", "1", "{i}", "{more}", "{half}", "{twice}", "-{i}", "{n}e-3", "{n}e3", "1e-300", "1e300",
    "'uniform({half}, {n})'", "'uniform({n}, {n})'", "'loguniform(1e-300, {n})'", "'grid({n}, {half})'",
    "'normal({n}, 1e-300, low={half}, high={twice})'", "'normal(1e300, 1e300, low={n}, high={n})'",
    "'normal(0, 1, low={half}, high={twice})'", "'choice({n}, {half}, weights=(1e308, 1e308))'",
    "'choice({n}, {n}, weights=(5e-324, 0))'", "'{n} * load_n'", "'uniform({half}, {n}, per=rig, scatter_percent=9)'", "'constant({n})'",
    "'uniform({n}'", "'uniform(({n},), [{half}])'", "'(lambda: {n})()'", "'uniform({n}, {n}) * load_n * load_n'",
)  # fmt: skip
NUMBER = re.compile(rb"(?<=[ \[(])-?[0-9.]+(?=[,}\])\n])")
WORD = re.compile(rb"[A-Za-z0-9_.\"'+-]+")
VALUE = re.compile(rb"(?<=: )[^,\]\[{}\n]+")


def seeds(folder: Path) -> list[Path]:
    """Valid recipes, written into a folder: those that ship with Raceway, and a small one."""
    paths = [Path(shutil.copy(path, folder)) for path in shipped_recipes().values()]
    small = folder / "small.yaml"
    small.write_text(SMALL, encoding="utf-8")
    return [*paths, small]


def mutate(content: bytes, rng: np.random.Generator) -> bytes:
    """One to four changes of a YAML file; half of the files get only such as may leave it valid."""
    gentle = rng.random() < 0.5
    for _ in range(int(rng.integers(1, 3 if gentle else 5))):
        if gentle:
            content = _other_number(content, rng)
            continue
        content = CHANGES[int(rng.integers(len(CHANGES)))](content, rng)
    return content


def check(path: Path) -> None:
    """Read a recipe and draw its first records; any exception except a RacewayError is a finding."""
    try:
        draw_scenarios(read_recipe(path), 0, RECORDS)
    except RacewayError:
        return


def _pick(found: list[re.Match[bytes]], rng: np.random.Generator) -> tuple[int, int]:
    return found[int(rng.integers(len(found)))].span() if found else (0, 0)


def _odd_value(content: bytes, rng: np.random.Generator) -> bytes:
    start, stop = _pick(list(VALUE.finditer(content)), rng)
    return content[:start] + SCALARS[int(rng.integers(len(SCALARS)))].encode() + content[stop:]


def _other_number(content: bytes, rng: np.random.Generator) -> bytes:
    """Another number of the same size, or a distribution about it."""
    start, stop = _pick(list(NUMBER.finditer(content)), rng)
    try:
        number = float(content[start:stop])
    except ValueError:
        return content
    text = FORMS[int(rng.integers(len(FORMS)))].format(
        n=number, i=int(number), half=number / 2, twice=number * 2, more=int(number) + 1
    )
    return content[:start] + text.encode() + content[stop:]


def _scaled_number(content: bytes, rng: np.random.Generator) -> bytes:
    start, stop = _pick(list(NUMBER.finditer(content)), rng)
    try:
        number = float(content[start:stop]) * 10.0 ** int(rng.integers(-12, 13)) * rng.choice([-1, 1, 1, 1])
    except ValueError:
        return content
    text = str(int(number)) if rng.random() < 0.5 and np.isfinite(number) else repr(float(number))
    return content[:start] + text.encode() + content[stop:]


def _swapped_words(content: bytes, rng: np.random.Generator) -> bytes:
    words = list(WORD.finditer(content))
    if len(words) < 2:
        return content
    (a, b), (c, d) = sorted(words[int(place)].span() for place in rng.choice(len(words), 2, replace=False))
    return content[:a] + content[c:d] + content[b:c] + content[a:b] + content[d:]


def _line_change(content: bytes, rng: np.random.Generator) -> bytes:
    lines = content.split(b"\n")
    place = int(rng.integers(len(lines)))
    match int(rng.integers(4)):
        case 0:
            del lines[place]
        case 1:
            lines.insert(int(rng.integers(len(lines))), lines[place])
        case 2:
            lines[place] = b"  " + lines[place]
        case _:
            lines[place] = lines[place].lstrip()
    return b"\n".join(lines)


def _aliased(content: bytes, rng: np.random.Generator) -> bytes:
    start, stop = _pick(list(re.finditer(rb"\{[^{}\n]*\}", content)), rng)
    found = content[start:stop] or b"{}"
    layers = int(rng.integers(1, 9))
    head = b"a0: &a0 " + found + b"\n"
    form = [b"[%s]", b"{<<: [%s]}", b"{<<: *a0, k: [%s]}"][int(rng.integers(3))]
    for layer in range(1, layers):
        names = b", ".join([b"*a%d" % (layer - 1)] * int(rng.integers(1, 12)))
        head += b"a%d: &a%d " % (layer, layer) + form % names + b"\n"
    alias = [b"*a0", b"{<<: *a0}", b"*a%d" % (layers - 1), b"&b {<<: *b}"][int(rng.integers(4))]
    content = content[:start] + alias + content[stop:]
    return head + content if rng.random() < 0.8 else content


def _bytes(content: bytes, rng: np.random.Generator) -> bytes:
    changed = bytearray(content or b"\0")
    for _ in range(int(rng.integers(1, 5))):
        changed[int(rng.integers(len(changed)))] = int(rng.integers(256))
    return bytes(changed)


def _cut(content: bytes, rng: np.random.Generator) -> bytes:
    return content[: int(rng.integers(len(content) + 1))]


CHANGES = (
    _odd_value, _odd_value, _odd_value, _scaled_number, _scaled_number, _swapped_words, _line_change, _aliased, _bytes, _cut,
)  # fmt: skip
