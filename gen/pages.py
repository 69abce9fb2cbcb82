"""Pages generated from the code: ``python -m gen.pages ROOT`` writes them.

``recipes/README.md`` comes from the model of the recipe, ``docs/format.md`` from the schema of the corpus,
``docs/catalogue.md`` from the catalogue of bearings, ``docs/limits.md`` from the limits.
"""

import sys
import textwrap
from pathlib import Path

from gen.drawing import KINDS
from gen.format_page import format_page
from gen.generation.labels import LABELS
from gen.physics.catalogue import catalogue_page
from gen.recipe.finding import recipe_purpose, shipped_recipes
from gen.recipe.keys import Key, recipe_keys
from gen.support.limits import limits_page

_EXAMPLES = {
    "constant": "5",
    "uniform": "uniform(1000, 3000)",
    "loguniform": "loguniform(0.1, 2)",
    "normal": "normal(14, 9, low=-14, high=32)",
    "choice": "choice(7, 8, 9, weights=(1, 2, 1))",
    "grid": "grid(500, 1000, 1500)",
}

_HEAD = """# Recipes

A recipe is a YAML file. `raceway plan RECIPE` reports what it makes, `raceway generate RECIPE -o DIR` makes it, and
`raceway recipes --keys PREFIX` prints the keys of this page. Keys end in their unit. Where the allowed value is a
range alone, such as `[0, 10]`, the value is a number or a distribution. `raceway recipes --schema > recipe.schema.json`
writes a schema with which editors complete and check keys; a recipe names it in its first line,
`# yaml-language-server: $schema=recipe.schema.json`. The schema takes a distribution with any arguments,
such as `uniform(1800, 900)`, and any name after `*`, and checks no keys together. `raceway plan` checks all, with a
sentence for each error.

## A first recipe

Four machines with a bearing of 22 balls, healthy or with an outer race fault of one of five widths, and two sensors;
all keys that are left out have the defaults of the tables below.

```yaml
# Outer race faults of five widths in our own bearing, for a first look.
name: first
title: Outer race faults of five widths
corpus: {rigs: 4, specimens_per_rig: 12, records_per_specimen: 2, split: {test: 0.25}}
recording:
  sample_rate_hz: 25600
  duration_s: 1
  channels:
    - {name: vertical, angle_deg: 90}
    - {name: horizontal, angle_deg: 0}
bearing: {n_balls: 22, pitch_diameter_mm: 60, ball_diameter_mm: 6}
machine:
  support_frequency_hz: uniform(200, 600)     # of each machine
specimen: {waviness_nm: 20}                   # of each physical bearing
operation:
  shaft_rpm: uniform(1400, 1500)              # of each record
  load_n: 500
level: {kind: physical, background_m_s2: "loguniform(0.1, 3)"}
faults:
  - kind: healthy
  - {kind: outer, weight: 5, width_mm: "grid(0.2, 0.4, 0.6, 0.8, 1)"}
```

A fault makes its records louder here, and every score is near 1. Use
`level: {kind: snr, faulty_db: "uniform(-20, 0)", healthy_db: "uniform(-25, -5)"}`, which gives all records one rms, a
higher `background_m_s2`, or narrower spalls (`width_mm`) for a corpus that is worth learning from.

## Distributions
"""

_DRAWING = """A distribution is read like a call in Python, and never run. Within braces it needs quotes, as other text with commas:
`{kind: outer, width_mm: "uniform(0.1, 2)"}`.

**`* quantity`** makes the drawn number a share of another quantity, named by its key; 1 is all of it, and units are
converted. Here the axial load is 40 to 100 % of the radial load of the same record, the contact angle is the one that
clearance and grooves of the specimen allow, and a spall is 5 to 30 % as wide as the arc from ball to ball:

    operation:
      load_n: loguniform(60, 2000)
      axial_load_n: uniform(0.4, 1) * load_n
    specimen:
      contact_angle_deg: 1 * free_contact_angle_deg
    faults:
      - kind: outer
        width_mm: uniform(0.05, 0.3) * ball_spacing_mm

A quantity can name those of its own section and those of a level above it, if both are of the same kind of unit:

| section | can name quantities of |
|---|---|
| `machine`, `bearing`, `contact.lubricant` | itself |
| `machine.resonator` | itself, `machine` |
| `specimen` | itself, `machine`, `pitch_diameter_mm`, `ball_diameter_mm`, `free_contact_angle_deg` |
| an entry of `faults` | itself, `specimen`, `machine`, `pitch_diameter_mm`, `ball_diameter_mm`; a spall on a race also `ball_spacing_mm` |
| `operation` | itself, `specimen`, `machine`, `pitch_diameter_mm`, `ball_diameter_mm`, `static_rating_n`, `least_axial_load_n` |

`pitch_diameter_mm` and `ball_diameter_mm` are those of the bearing of the rig. `free_contact_angle_deg` is the contact
angle of a ball bearing whose rings are pushed apart along the axis without force: `cos(angle) = 1 - clearance / (2 A)`
with `A = (inner + outer conformity - 1) * ball diameter`. It is 0 without clearance, for rollers, and for a bearing
with a contact angle on its drawing. `ball_spacing_mm` is the arc on the damaged race from one ball to the next.
`static_rating_n` is the basic static load rating of the bearing, so that large bearings can carry large loads.
`least_axial_load_n` is the axial load at which half of the balls are loaded, `1.25 tan(contact angle) * load_n`; a
smaller one, other than 0, cannot hold the rings together:

    operation:
      load_n: loguniform(0.005, 0.3) * static_rating_n
      axial_load_n: choice(0, 1.1, 2) * least_axial_load_n

**`per`** (in `operation` alone) draws one value for a rig or a specimen instead of one for each record, and
**`scatter_percent`** lets its records deviate from it. A machine with one speed, held within 2 %:

    operation:
      shaft_rpm: uniform(900, 1800, per=rig, scatter_percent=2)

A grid counts the rigs or specimens.

**A list** gives the values of a key that is drawn for each of several items, one for each: resonances and tones that
were measured on a machine, or the spalls of a race. The count must be as long:

    path:
      modes: {count: 2, frequency_hz: [820, 2950], damping_percent: [3, 1.5], gain_db: [0, 12], sign: [1, -1]}

None of these moves another value: a random number follows from the seed, the number of its rig, specimen or record, and
the name of its key (with `sampling: random`). The same holds for the conditions of one fault, such as
`{kind: outer, width_mm: 1, operation: {load_n: 500}}`; a grid among them may move other grids of its records. Use these
with care: a classifier can learn the load instead of the fault.

## Pairs and ladders

With `corpus.rungs` every record of a faulty specimen is repeated at each of these shares of its severity: of width and
depth of every spall, the rms of wear, and the pitch error and knock of a cage. The records of a group are neighbours,
share the label `pair` and differ in `rung`, the place in the list; both are -1 for the records of healthy specimens. A
record at rung 0 has the class `healthy`. The weights of `faults` are shares of the records: as rung 0 gives healthy
records already, there are fewer healthy specimens. For a level that grows with the fault use `level.kind: physical`.
"""

_KEYS = """A key belongs to the values of `kind` in its row, or to all if the row has none. A bracket includes the end of a
range, a parenthesis excludes it. `NAME` stands for a name of your choice.
"""


def readme() -> str:
    """Markdown page: the shipped recipes, the distributions, and every key with unit, range, default and meaning."""
    lines = [_HEAD, "| distribution | values |", "|---|---|"]
    lines += [f"| `{_EXAMPLES[kind]}` | {(model.__doc__ or '').splitlines()[0]} |" for kind, model in KINDS.items()]
    lines += ["", _DRAWING, "## Shipped recipes", "", "| name | purpose |", "|---|---|"]
    lines += [f"| `{name}` | {recipe_purpose(path)} |" for name, path in shipped_recipes().items()]
    lines += ["", "## Keys", "", _KEYS]
    keys = recipe_keys()
    meanings = {key.key: key.meaning for key in keys}
    sections: dict[str, list[Key]] = {}
    for key in keys:
        sections.setdefault(key.key.rpartition(".")[0], []).append(key)
    for section, own in sections.items():
        about = [*textwrap.wrap(meanings[section], 120, break_on_hyphens=False), ""] if section in meanings else []
        lines += [f"### {section or 'Top level'}", "", *about]
        lines += [*_table(own), ""]
    return "\n".join(lines)


def _table(keys: list[Key]) -> list[str]:
    columns = {
        "key": [f"`{key.key.rpartition('.')[2]}`" for key in keys],
        "kind": [", ".join(key.kinds) for key in keys],
        "unit": [key.unit for key in keys],
        "allowed": [key.allowed for key in keys],
        "default": [key.default for key in keys],
        "meaning": [key.meaning for key in keys],
    }
    # many sections have no kinds or no units
    columns = {name: cells for name, cells in columns.items() if any(cells)}
    head, *rows = (f"| {' | '.join(cells)} |" for cells in (columns, *zip(*columns.values(), strict=True)))
    return [head, "|" + "---|" * len(columns), *rows]


PAGES = {
    "recipes/README.md": readme,
    "docs/format.md": lambda: format_page(LABELS),
    "docs/catalogue.md": catalogue_page,
    "docs/limits.md": limits_page,
}

if __name__ == "__main__":
    for name, page in PAGES.items():
        (Path(sys.argv[1]) / name).write_text(page(), encoding="utf-8")
