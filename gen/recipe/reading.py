"""Find, read and check a recipe file.

A recipe is given as a path, or by the name of one that ships with Raceway. The model compares counts and sizes with the limits.
"""

import difflib
import hashlib
import json
from importlib.resources import files
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from gen.errors import RecipeError
from gen.recipe.model import Recipe
from gen.recipe.sentences import sentences
from gen.yaml_files import read_yaml


def shipped_recipes() -> dict[str, Path]:
    """Names and paths of the recipes that ship with Raceway."""
    folder = Path(str(files("raceway_recipes")))
    return {path.stem: path for path in sorted(folder.glob("*.yaml"))}


def recipe_purpose(path: Path) -> str:
    """Purpose of a recipe: its opening comment, on one line."""
    comment = []
    for line in path.read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            break
        comment.append(line.lstrip("# "))
    return " ".join(comment)


def find_recipe(recipe: Path | str) -> Path:
    """Path of a recipe given as a path or by name.

    Raises
    ------
    RecipeError
        If there is no such file and no recipe of that name.
    """
    path = Path(recipe)
    if path.is_file():
        return path
    shipped = shipped_recipes()
    if str(recipe) in shipped:
        return shipped[str(recipe)]
    if path.is_dir():
        raise RecipeError(f"{recipe}: is a folder; give a recipe file, or the name of one of {', '.join(shipped)}.")
    near = difflib.get_close_matches(str(recipe), shipped, 1)
    guess = f"did you mean {near[0]}?" if near else "raceway recipes lists the names."
    raise RecipeError(f"{recipe}: neither a file nor one of the recipes {', '.join(shipped)}; {guess}")


def read_recipe(recipe: Path | str, *, seed: int | None = None, records: int | None = None) -> Recipe:
    """Read and check a recipe.

    Parameters
    ----------
    recipe : path or str
        File, or name of a recipe that ships with Raceway.
    seed, records : int, optional
        Replace those of the recipe.

    Raises
    ------
    RecipeError
        If the file is missing, is not YAML, or has wrong keys or values; one sentence for each of them.
    """
    path = find_recipe(recipe)
    data = _load(path)
    overrides = {"seed": seed, "records": records}
    data |= {key: value for key, value in overrides.items() if value is not None}
    try:
        return Recipe.model_validate(data)
    except ValidationError as error:
        raise RecipeError("\n".join(f"{path}: {sentence}" for sentence in sentences(error))) from None


def recipe_hash(recipe: Recipe) -> str:
    """SHA-256 of the values of a recipe; layout and comments do not count."""
    text = json.dumps(recipe.model_dump(mode="json"), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def recipe_schema() -> str:
    """JSON schema of a recipe, for editors."""
    schema = Recipe.model_json_schema()
    return json.dumps({"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}, indent=1) + "\n"


def _load(path: Path) -> dict[str, Any]:
    data = read_yaml(path, RecipeError)
    if not isinstance(data, dict) or not all(isinstance(key, str) for key in data):
        raise RecipeError(
            f"{path}: a recipe is a mapping that starts with name:, title: and corpus:; see raceway recipes."
        )
    return data
