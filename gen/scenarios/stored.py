"""Scenarios as the JSON text that a corpus stores with each record, and back."""

import json
from collections.abc import Sequence

from pydantic import TypeAdapter, ValidationError

from gen.errors import CorpusError
from gen.scenarios.model import Scenario

_SCENARIO = TypeAdapter(Scenario)


def scenario_texts(scenarios: Sequence[Scenario]) -> list[str]:
    """One JSON object for each scenario, with its seed, rig, specimen and record; :func:`read_scenario` reads it."""
    # records share rigs and specimens: each of these is written once
    shared = {id(item): item for scenario in scenarios for item in (scenario.rig, scenario.specimen)}
    texts = {number: json.dumps(item, default=vars) for number, item in shared.items()}
    return [
        f'{{"seed": {scenario.seed}, "rig": {texts[id(scenario.rig)]}, "specimen": {texts[id(scenario.specimen)]}, '
        f'"record": {json.dumps(scenario.record, default=vars)}}}'
        for scenario in scenarios
    ]


def read_scenario(text: str) -> Scenario:
    """The scenario that :func:`scenario_texts` wrote as ``text``.

    Raises
    ------
    CorpusError
        If the text is not a scenario.
    """
    try:
        return _SCENARIO.validate_json(text, strict=True)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(part) for part in first["loc"]) or "the whole text"
        raise CorpusError(f"stored scenario: {place}: {first['msg']}; it was not written by this version.") from None
