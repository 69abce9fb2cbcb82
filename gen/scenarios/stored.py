"""Write a scenario as the JSON text of its recipe, which a corpus stores with each record, and read it."""

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from gen.corpus import DRAWS
from gen.drawing import plain
from gen.recipe import Recipe
from gen.scenarios.scenario import Scenario, scenario_of
from gen.support.errors import CorpusError, RecipeError

if TYPE_CHECKING:
    import xarray as xr


def scenario_texts(scenarios: Sequence[Scenario]) -> list[str]:
    """Recipe of each scenario as a JSON object; :func:`read_scenario` reads it."""
    texts: dict[int, str] = {}  # many records share sections, so each is encoded once
    return [f"{{{', '.join(_section_texts(scenario.recipe, texts))}}}" for scenario in scenarios]


def _section_texts(recipe: Recipe, texts: dict[int, str]) -> list[str]:
    sections = []
    for key, value in recipe:
        if value is not None and key in recipe.model_fields_set:
            text = texts.get(id(value)) or texts.setdefault(id(value), json.dumps(plain(value)))
            sections += [f'"{key}": {text}'] if text != "{}" else []
    return sections


def read_scenarios(records: "xr.Dataset") -> list[Scenario]:
    """Scenario of each record of a Dataset, with every drawn value.

    Parameters
    ----------
    records : Dataset
        Simulated records, all or some: of :func:`gen.record`, :func:`gen.records` or :func:`gen.open_corpus`.

    Raises
    ------
    CorpusError
        If a record has no scenario, or one that cannot be simulated.
    """
    if not hasattr(records, "variables"):
        raise CorpusError(f"{type(records).__name__} given in place of a Dataset; give records that gen.records gave.")
    scenarios = []
    texts = np.atleast_1d(records[DRAWS].values) if DRAWS in records.variables else [""]
    for place, text in enumerate(texts):
        if not text:
            raise CorpusError(f"record {place} has no scenario: it was not simulated, or its signal was changed since.")
        try:
            scenarios.append(read_scenario(str(text)))
        except CorpusError as error:
            raise CorpusError(f"record {place}: {error}") from None
    return scenarios


def read_scenario(text: str) -> Scenario:
    """The scenario that :func:`scenario_texts` wrote as ``text``.

    Raises
    ------
    CorpusError
        If the text is not the recipe of one record.
    """
    try:
        data: Any = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise CorpusError(f"stored scenario: is not the JSON text of a recipe: {error}.") from None
    try:
        return scenario_of(Recipe(data))
    except RecipeError as error:
        first = str(error).split("\n")[0]
        raise CorpusError(f"stored scenario: {first}") from None
