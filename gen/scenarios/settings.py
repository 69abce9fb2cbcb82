"""Settings of the scenarios of a recipe, and of scenarios that are simulated together."""

import functools
from collections.abc import Sequence
from dataclasses import fields

from gen.recipe import Recipe, corpus_identity
from gen.scenarios.model import Scenario, Settings
from gen.support.errors import SimulationError


@functools.lru_cache(maxsize=16)
def settings_of(recipe: Recipe) -> Settings:
    """Values that a recipe fixes for all of its records."""
    recording, converter = recipe.recording, recipe.recording.converter
    return Settings(
        recipe=recipe.name,
        corpus=corpus_identity(recipe),
        seed=recipe.seed,
        sample_rate=recording.sample_rate_hz,
        samples=recipe.n_samples,
        settle=recording.settle_s,
        oversampling=recording.oversampling,
        channels=tuple(channel.name for channel in recording.channels),
        full_scale=None if converter.kind == "float32" else converter.full_scale_m_s2,
        twins=recipe.truth.twins,
        undetected=recipe.truth.undetected,
    )


def common_settings(scenarios: Sequence[Scenario]) -> Settings:
    """Settings that some scenarios share.

    Raises
    ------
    SimulationError
        If there is none, or one of them has other settings than the first.
    """
    if not scenarios:
        raise SimulationError("scenarios: there are none; give at least one.")
    settings = scenarios[0].settings
    for place, scenario in enumerate(scenarios):
        # nearly always the same object
        if scenario.settings is not settings and scenario.settings != settings:
            names = (field.name for field in fields(Settings))
            other = [name for name in names if getattr(scenario.settings, name) != getattr(settings, name)]
            raise SimulationError(
                f"scenarios[{place}]: its settings are not those of scenarios[0] ({', '.join(other)}); simulate each kind on its own."
            )
    return settings
