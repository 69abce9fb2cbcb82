"""Pages generated from the code: ``python -m gen.pages ROOT`` writes them.

``recipes/schema.json`` and ``recipes/README.md`` come from the model of the recipe, ``docs/format.md`` from the schema of the corpus,
``docs/catalogue.md`` from the catalogue of bearings, ``docs/limits.md`` from the limits.
"""

import sys
from pathlib import Path
from typing import get_args

from gen.corpus import format_page
from gen.limits import limits_page
from gen.physics.catalogue import catalogue_page
from gen.recipe.distributions import DISTRIBUTIONS
from gen.recipe.keys import Key, recipe_keys
from gen.recipe.reading import recipe_purpose, recipe_schema, shipped_recipes

_HEAD = """# Recipes

A recipe is a YAML file. `raceway plan RECIPE` reports what it makes, `raceway generate RECIPE -o DIR` makes it, and
`raceway recipes --keys PREFIX` prints the keys of this page. Keys end in their unit. Where the allowed value is a
range alone, such as `[0, 10]`, the value is a number or a distribution:
"""

_KEYS = """A key belongs to the values of `kind` in its row, or to all if the row has none. A bracket includes the end of a
range, a parenthesis excludes it. `NAME` stands for a name of your choice.
"""


def readme() -> str:
    """Markdown page: the shipped recipes, the distributions, and every key with unit, range, default and meaning."""
    lines = [_HEAD, "| distribution | keys | values |", "|---|---|---|"]
    for distribution in DISTRIBUTIONS:
        keys = ", ".join(f"`{name}`" for name in distribution.model_fields if name != "kind")
        kind = get_args(distribution.model_fields["kind"].annotation)[0]
        lines.append(f"| `{kind}` | {keys} | {(distribution.__doc__ or '').splitlines()[0]} |")
    lines += ["", "## Shipped recipes", "", "| name | purpose |", "|---|---|"]
    lines += [f"| `{name}` | {recipe_purpose(path)} |" for name, path in shipped_recipes().items()]
    lines += ["", "## Keys", "", _KEYS]
    keys = recipe_keys()
    meanings = {key.key: key.meaning for key in keys}
    sections: dict[str, list[Key]] = {}
    for key in keys:
        sections.setdefault(key.key.rpartition(".")[0], []).append(key)
    for section, own in sections.items():
        about = [meanings[section], ""] if section in meanings else []
        lines += [f"### {section or 'Top level'}", "", *about]
        lines += ["| key | kind | unit | allowed | default | meaning |", "|---|---|---|---|---|---|"]
        lines += [_row(key) for key in own]
        lines += [""]
    return "\n".join(lines)


def _row(key: Key) -> str:
    name = key.key.rpartition(".")[2]
    return f"| `{name}` | {', '.join(key.kinds)} | {key.unit} | {key.allowed} | {key.default} | {key.meaning} |"


PAGES = {
    "recipes/schema.json": recipe_schema,
    "recipes/README.md": readme,
    "docs/format.md": format_page,
    "docs/catalogue.md": catalogue_page,
    "docs/limits.md": limits_page,
}

if __name__ == "__main__":
    for name, page in PAGES.items():
        (Path(sys.argv[1]) / name).write_text(page(), encoding="utf-8")
