"""The recipe: a frozen model of the YAML file that a corpus is made from."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Self

from pydantic import ValidationError, model_validator

from gen.drawing import plain
from gen.recipe.checks import check_recipe
from gen.recipe.faults import class_of
from gen.recipe.sections import Sections
from gen.support.display import Shown
from gen.support.errors import RecipeError
from gen.support.sentences import sentences

_NO_KEYS: Mapping[str, Any] = MappingProxyType({})


class Recipe(Shown, Sections):
    """All that a corpus is made from."""

    def __init__(self, data: Mapping[str, Any] = _NO_KEYS, /, **keys: Any) -> None:
        """Check a recipe given as a dict or by its keys; sections are mappings, as in YAML.

        Raises
        ------
        RecipeError
            If there are wrong keys or values; one sentence for each of them.
        """
        if not isinstance(data, Mapping) or not all(isinstance(key, str) for key in data):
            raise RecipeError("a recipe is a mapping that starts with name:, title: and corpus:; see raceway recipes.")
        try:
            super().__init__(**plain({**data, **keys}))
        except ValidationError as error:
            raise RecipeError("\n".join(sentences(error, Recipe))) from None

    def _heading(self) -> str:
        return f"Recipe {self.name}: {self.n_records:,} records, {len(self.faults)} faults, seed {self.seed}"

    def _facts(self) -> Mapping[str, object]:
        return {
            "title": self.title,
            "records": f"{self.n_records:,} of {self.recording.duration_s:g} s at {self.recording.sample_rate_hz:,g} Hz",
            "channels": ", ".join(channel.name for channel in self.recording.channels),
            "rigs": f"{self.n_rigs:,}, with {self.n_specimens:,} bearings",
            "bearing": self.bearing,
            "speed": f"{self.operation.shaft_rpm} rpm",
            "load": f"{self.operation.load_n} N",
            "classes": ", ".join(dict.fromkeys(map(class_of, self.faults))),
            "next": 'gen.generate(recipe, "corpus"), gen.draw_scenarios(recipe), gen.write_recipe(recipe, "my_recipe.yaml")',
        }

    def __hash__(self) -> int:
        """Hash of name and seed; the hash of pydantic fails on the dictionaries of some sections."""
        return hash((self.name, self.seed))

    @model_validator(mode="after")
    def _can_be_made(self) -> Self:
        check_recipe(self)
        return self
