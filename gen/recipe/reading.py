"""From a YAML file to a :class:`Recipe`, or to a sentence that says where the file is wrong.

A recipe is given as a path or by the name of one that ships with Raceway. Checks of counts and sizes against the limits are in the model.
"""

import difflib
import hashlib
import json
import reprlib
from importlib.resources import files
from pathlib import Path
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from gen.errors import RecipeError
from gen.recipe.model import Recipe
from gen.yaml_files import read_yaml

_MOST_SENTENCES = 20
_LONGEST_KEY = 60  # characters shown


def shipped_recipes() -> dict[str, Path]:
    """Names and paths of the recipes that ship with Raceway."""
    folder = Path(str(files("raceway_recipes")))
    return {path.stem: path for path in sorted(folder.glob("*.yaml"))}


def recipe_purpose(path: Path) -> str:
    """What a recipe is for: the comment it opens with, on one line."""
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
        If there is neither such a file nor such a name.
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
        Take the place of the recipe's own.

    Raises
    ------
    RecipeError
        If the file is missing, no YAML, or asks for what cannot be; one sentence for each thing that is wrong.
    """
    path = find_recipe(recipe)
    data = _load(path)
    overrides = {"seed": seed, "records": records}
    data |= {key: value for key, value in overrides.items() if value is not None}
    try:
        return Recipe.model_validate(data)
    except ValidationError as error:
        raise RecipeError("\n".join(f"{path}: {sentence}" for sentence in _sentences(error))) from None


def recipe_hash(recipe: Recipe) -> str:
    """SHA-256 of what the recipe says, whatever its layout and comments."""
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


def _sentences(error: ValidationError) -> list[str]:
    """One sentence per thing that is wrong; a key that is missing because it is misspelt is one thing."""
    items = error.errors()
    meant = {(*item["loc"][:-1], _guess(item["loc"])) for item in items if item["type"] == "extra_forbidden"}
    sentences: dict[str, None] = {}
    for place, item in enumerate(items):
        sentence = None if item["loc"] in meant else _sentence(item)
        if sentence and len(sentences) == _MOST_SENTENCES:
            return [*sentences, f"up to {len(items) - place} more things are wrong; correct these first."]
        if sentence:
            sentences[sentence] = None
    return list(sentences)


def _sentence(item: Any) -> str | None:
    """Sentence about one thing; None if others say more about it."""
    place, value, kind, context = _place(item["loc"]), item["input"], item["type"], item.get("ctx", {})
    shown = reprlib.repr(value) if isinstance(value, str | int | float) or value is None else "this"
    match kind:
        case "extra_forbidden":
            guess, allowed = _guess(item["loc"]), ", ".join(_siblings(item["loc"]))
            return f"{place}: no such key; " + (f"did you mean {guess}?" if guess else f"allowed are {allowed}.")
        case "invalid_key":
            return f"{_place(item['loc'][:-1])}: {reprlib.repr(value)} is no key; keys are words, and decimals have a point, no comma."
        case "missing":
            return f"{place}: is missing; give it."
        case "union_tag_invalid":
            expected = context["expected_tags"].replace("'", "")
            return f"{place}.kind: {reprlib.repr(context['tag'])} is not one of {expected}."
        case "union_tag_not_found":
            return f"{place}: {shown} needs a kind, such as kind: {_first_kind(item)}."
        case "value_error":
            text = item["msg"].removeprefix("Value error, ")
            if place.endswith("width_mm") and "is not in" in text:
                text = text.removesuffix(".") + "; for a bearing without a fault use kind: healthy."
            if not place:
                return text
            return f"{place}{'.' if text.partition(':')[0] in _siblings((*item['loc'], '')) else ': '}{text}"
        case "too_short":
            least = context["min_length"]
            size = len(item["input"])
            if size >= least:  # those that are wrong do not count, and are told on their own
                return None
            found = f"{size} is too few" if size else "is empty"
            return f"{place}: {found}; give at least {'one' if least == 1 else least}."
        case "too_long":
            return f"{place}: {len(item['input'])} is too many; give at most {context['max_length']}."
        case _:
            allowed = _ALLOWED.get(kind) or item["msg"].replace("Input should be ", "")
            return f"{place}: {shown} is not allowed here; it must be {allowed}."


_ALLOWED = {
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "float_type": "a number",
    "string_type": "text",
    "string_pattern_mismatch": "1 to 64 letters, digits, dots, dashes or underscores",
    "tuple_type": "a list",
    "model_type": "a section with keys of its own",
    "model_attributes_type": "a section with keys of its own",
    "dict_type": "a section with keys of its own",
}


def _first_kind(item: Any) -> str:
    known = {
        "bearing": "catalogue", "faults": "inner", "parts": "inner", "speed_profile": "run_up", "load_profile": "ramp"
    }  # fmt: skip
    place = [step for step in item["loc"] if isinstance(step, str)]
    whole = isinstance(item["loc"][-1], int) or item["loc"][-1] in known
    return known.get(place[-1], "uniform") if whole else "uniform"


def _place(location: tuple[int | str, ...]) -> str:
    """Path of a value as it stands in the file, without the names of the union branches pydantic puts in."""
    place, node = "", _Cursor(Recipe)
    for step in location:
        if isinstance(step, int):
            place += f"[{step}]"
        elif node.knows(step) or (step != "[key]" and not node.models) or step not in _BRANCHES:
            shown = step if step.isprintable() and len(step) <= _LONGEST_KEY else reprlib.repr(step)
            place += f".{shown}" if place else shown
            node = node.into(step)
    return place


_BRANCHES = {
    "constant", "uniform", "loguniform", "normal", "choice", "grid", "catalogue", "geometry", "adc", "float32", "physical", "snr",
    "healthy", "inner", "outer", "ball", "cage", "distributed", "compound", "ramp", "run_up", "steps", "table", "[key]",
}  # fmt: skip


class _Cursor:
    """Where in the recipe's sections a location has led so far."""

    def __init__(self, *models: type[BaseModel]) -> None:
        self.models = models

    def knows(self, key: str) -> bool:
        return any(key in model.model_fields for model in self.models)

    def into(self, key: str) -> "_Cursor":
        found = [model.model_fields[key].annotation for model in self.models if key in model.model_fields]
        return _Cursor(*_sections(found))

    def of_kind(self, kind: str) -> "_Cursor":
        found = [
            m for m in self.models if "kind" in m.model_fields and kind in get_args(m.model_fields["kind"].annotation)
        ]
        return _Cursor(*found) if found else self

    def keys(self) -> list[str]:
        return sorted({name for model in self.models for name in model.model_fields})


def _sections(annotations: list[Any]) -> list[type[BaseModel]]:
    sections: list[type[BaseModel]] = []
    for annotation in annotations:
        if isinstance(annotation, type) and issubclass(annotation, BaseModel):
            sections.append(annotation)
        sections += _sections(list(getattr(annotation, "__args__", ())))
    return sections


def _siblings(location: tuple[int | str, ...]) -> list[str]:
    """Keys that are allowed where ``location`` ends."""
    node = _Cursor(Recipe)
    for step in location[:-1]:
        if isinstance(step, str):
            node = node.into(step) if node.knows(step) else node.of_kind(step)
    return node.keys()


def _guess(location: tuple[int | str, ...]) -> str | None:
    """The allowed key most like the last of ``location``, if one is."""
    near = difflib.get_close_matches(str(location[-1]), _siblings(location), 1)
    return near[0] if near else None
