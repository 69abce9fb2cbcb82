"""Find a recipe file: by its path, or by the name of one that ships with Raceway. No recipe is read here."""

import difflib
from importlib.resources import files
from pathlib import Path

from gen.support.errors import RecipeError

LONGEST = 4096  # characters of a path


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
    path, text = Path(recipe), str(recipe)
    # a name this long is an error of the system
    if "\n" in text or len(text) > LONGEST:
        raise RecipeError(
            "recipe: is a text in place of a path or a name; write it to a file, or give its mapping of keys."
        )
    if path.is_file():
        return path
    shipped = shipped_recipes()
    if text in shipped:
        return shipped[text]
    if path.is_dir():
        raise RecipeError(f"{recipe}: is a folder; give a recipe file, or the name of one of {', '.join(shipped)}.")
    # help with a misspelt name
    near = difflib.get_close_matches(text, shipped, 1)
    guess = f"did you mean {near[0]}?" if near else "raceway recipes lists the names."
    raise RecipeError(f"{recipe}: neither a file nor one of the recipes {', '.join(shipped)}; {guess}")
