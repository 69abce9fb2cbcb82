"""Write a scenario as the JSON text that a corpus stores with each record, and read it."""

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from pydantic import TypeAdapter, ValidationError

from gen.corpus import DRAWS
from gen.scenarios.checks import check_scenario
from gen.scenarios.model import Scenario
from gen.support.errors import CorpusError, RecipeError

if TYPE_CHECKING:
    import xarray as xr

_SCENARIO = TypeAdapter(Scenario)
_LONGEST_PLACE = 100
_ADVICE = "read the corpus with the version that wrote it."


def scenario_texts(scenarios: Sequence[Scenario]) -> list[str]:
    """One JSON object for each scenario, with its settings, rig, specimen and record; :func:`read_scenario` reads it."""
    # many records share settings, rig or specimen, so each of these is encoded once
    shared = {id(item): item for one in scenarios for item in (one.settings, one.rig, one.specimen)}
    texts = {number: json.dumps(item, default=vars) for number, item in shared.items()}
    return [
        f'{{"settings": {texts[id(one.settings)]}, "rig": {texts[id(one.rig)]}, "specimen": {texts[id(one.specimen)]}, '
        f'"record": {json.dumps(one.record, default=vars)}}}'
        for one in scenarios
    ]


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
            check_scenario(scenarios[-1])
        except (CorpusError, RecipeError) as error:
            raise CorpusError(f"record {place}: {error}") from None
    return scenarios


def read_scenario(text: str) -> Scenario:
    """The scenario that :func:`scenario_texts` wrote as ``text``.

    Raises
    ------
    CorpusError
        If the text is not a scenario.
    """
    try:
        scenario = _SCENARIO.validate_json(text, strict=True)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        # a key of the text may have any length and any characters
        place = repr(".".join(str(part) for part in first["loc"]) or "the whole text")[1:-1][:_LONGEST_PLACE]
        raise CorpusError(f"stored scenario: {place}: {first['msg']}; {_ADVICE}") from None
    if not _holds_exactly(text, scenario):
        raise CorpusError(f"stored scenario: it has keys or numbers that no scenario has; {_ADVICE}")
    return scenario


def _holds_exactly(text: str, scenario: Scenario) -> bool:
    """True if a text has the keys and numbers of a scenario and no others, and every number is finite.

    pydantic ignores keys that a dataclass does not have, and accepts NaN and infinity.
    """
    try:
        values = json.loads(text)
        json.dumps(values, allow_nan=False)
    except ValueError:
        return False
    return values == json.loads(scenario_texts([scenario])[0])
