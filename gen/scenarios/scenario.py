"""A scenario: the recipe of one record, with a number in place of every distribution, and the origin of its random streams."""

import functools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from gen.drawing import Level, plain, stream
from gen.mechanisms.faults.bearing_fault import BearingFault
from gen.physics.bearing import Bearing
from gen.physics.kernel_input import Spall
from gen.physics.profile import Profile
from gen.recipe import OriginSection, Recipe, class_of, recipe_text
from gen.support.display import Shown
from gen.support.errors import RecipeError, SimulationError

STEEPEST_CONTACT = math.radians(45)


@dataclass(frozen=True, repr=False)
class Scenario(Shown):
    """All drawn values of one record, as a recipe of this record alone."""

    recipe: Recipe

    def _heading(self) -> str:
        numbers = f"rig {self.origin.rig}, specimen {self.origin.specimen}, record {self.origin.record}"
        return f"Scenario of {self.recipe.name}: {numbers}, {self.fault}"

    def _facts(self) -> Mapping[str, object]:
        bearing, recording = self.bearing, self.recipe.recording
        damage = [
            f"spall of {1e3 * spall.width:.3g} mm, {1e6 * spall.depth:.3g} µm deep, in the {spall.site}"
            for spall in self.spalls
        ]
        return {
            "bearing": f"{bearing.designation}: {bearing.n_balls} {bearing.rolling_element}s of "
            f"{1e3 * bearing.ball_diameter:.4g} mm on {1e3 * bearing.pitch_diameter:.4g} mm",
            "damage": ", ".join(damage or self.damaged_parts) or "none",
            "speed": f"{self.recipe.operation.shaft_rpm:,.4g} rpm",
            "load": f"{self.conditions['load']:,.4g} N",
            "record": f"{recording.duration_s:g} s at {recording.sample_rate_hz:,g} Hz",
            "next": "gen.simulate([scenario]), scenario.without_fault(), scenario.at_severity(0.5)",
        }

    @property
    def text(self) -> str:
        """YAML text of the recipe."""
        return recipe_text(self.recipe)

    @functools.cached_property
    def origin(self) -> OriginSection:
        """Where the record comes from."""
        assert self.recipe.origin is not None  # noqa: S101
        return self.recipe.origin

    @functools.cached_property
    def fault(self) -> str:
        """Class of the fault."""
        return class_of(self.recipe.faults[0])

    @property
    def components(self) -> tuple[BearingFault, ...]:
        """Faults of one part each."""
        return self.recipe.faults[0].components

    @property
    def damaged_parts(self) -> list[str]:
        """Parts that are damaged, each once."""
        return list(dict.fromkeys(part.part for part in self.components))

    @functools.cached_property
    def spalls(self) -> list[Spall]:
        """Spalls of all parts; angles on the outer race count from the x axis."""
        return [spall for part in self.components for spall in part.spalls(self.machine["load_angle"])]

    @functools.cached_property
    def drawing(self) -> Bearing:
        """Bearing as on its drawing."""
        return self.recipe.bearing.drawing()

    @functools.cached_property
    def bearing(self) -> Bearing:
        """Bearing as built."""
        return as_built(self.drawing, self.properties)

    @property
    def machine(self) -> dict[str, Any]:
        """Values of the section ``machine`` [SI]."""
        return self.recipe.machine.si()

    @property
    def properties(self) -> dict[str, Any]:
        """Values of the section ``specimen`` [SI]."""
        return self.recipe.specimen.si()

    @property
    def conditions(self) -> dict[str, Any]:
        """Values of the section ``operation`` [SI]; ``shaft_rate`` is the drawn one, at 100 % of the speed profile."""
        return self.recipe.operation.si()

    @functools.cached_property
    def speed_profile(self) -> Profile | None:
        """Course of the shaft rate as shares of the drawn one; None if it is constant."""
        profile = self.recipe.operation.speed_profile
        return None if profile is None else profile.course(self.recipe.recording.duration_s)

    @functools.cached_property
    def load_profile(self) -> Profile | None:
        """Course of the load as shares of the drawn one; None if it is constant."""
        profile = self.recipe.operation.load_profile
        return None if profile is None else profile.course(self.recipe.recording.duration_s)

    def stream(self, name: str, level: Level = "record") -> np.random.Generator:
        """Random stream of the record, or of its specimen or rig, by name; all records of a group have the streams of the first."""
        of = {"rig": self.origin.rig, "specimen": self.origin.specimen, "record": self.origin.first_record}[level]
        return stream(self.recipe.seed, level, of, name)

    def without_fault(self) -> "Scenario":
        """The same record of the same specimen before it was damaged."""
        return self.at_severity(0)

    def at_severity(self, share: float) -> "Scenario":
        """The same record with a share of the sizes of its fault, such as width and depth of spalls; 0 is before the damage."""
        fault = sound() if share == 0 else self.recipe.faults[0].at_severity(share)
        return self.edited(faults=(fault,))

    def edited(self, **sections: Any) -> "Scenario":
        """The same with some other sections, which are not checked."""
        return replace(self, recipe=self.recipe.model_copy(update=sections))

    def with_(self, **sections: Any) -> "Scenario":
        """The same with some other keys, by section: ``with_(operation={"shaft_rpm": 1200})``; keys that are not given stay.

        Raises
        ------
        RecipeError
            If a key is wrong, as for a recipe.
        """
        return scenario_of(Recipe(_merged(plain(self.recipe), plain(sections))))


def _merged(old: Any, new: Any) -> Any:
    if not (isinstance(old, dict) and isinstance(new, dict)):
        return new
    return {**old, **{key: _merged(old.get(key), value) for key, value in new.items()}}


@functools.cache
def sound() -> Any:
    """Entry of ``faults`` of a bearing without a fault."""
    from gen.recipe.faults import OF_KIND

    return OF_KIND["healthy"](kind="healthy", weight=1.0, operation=None, level=None)


def as_built(drawing: Bearing, properties: Mapping[str, Any]) -> Bearing:
    """Bearing of a specimen, with its contact angle and its grooves."""
    return replace(
        drawing,
        contact_angle=drawing.contact_angle + properties["contact_angle"],
        inner_conformity=properties["inner_conformity"],
        outer_conformity=properties["outer_conformity"],
    )


def scenario_of(recipe: Recipe) -> Scenario:
    """Scenario of a recipe that has an origin, and numbers alone.

    Raises
    ------
    RecipeError
        If the recipe has no origin, or a value that is no number, or its parts do not fit each other.
    """
    if recipe.origin is None:
        raise RecipeError(
            "origin: is missing, so this is not the recipe of one record; draw records with gen.draw_scenarios."
        )
    drawn = recipe.as_drawn()
    if drawn.machine.balance_rpm is None:
        # a hand-written recipe may leave it out: then its own speed is the highest
        rpm = {"balance_rpm": drawn.operation.shaft_rpm}
        drawn = drawn.model_copy(update={"machine": drawn.machine.model_copy(update=rpm)})
    scenario = Scenario(drawn)
    if drawn.contact.lubricant is not None:
        drawn.contact.lubricant.check(f"rig {scenario.origin.rig}")
    check_bearing(scenario.bearing, f"specimen {scenario.origin.specimen}")
    for part in scenario.components:
        part.check(scenario.bearing, f"specimen {scenario.origin.specimen}")
    return scenario


def check_bearing(bearing: Bearing, item: str) -> None:
    """RecipeError if the contact angle of the bearing of an ``item`` is too steep for a radial one."""
    if abs(bearing.contact_angle) > STEEPEST_CONTACT:
        raise RecipeError(
            f"{item}: a contact angle of {math.degrees(bearing.contact_angle):.3g} degrees is too large for a radial bearing; "
            f"keep the angles of bearing and specimen together below {math.degrees(STEEPEST_CONTACT):.0f}."
        )


def same_recording(scenarios: Sequence[Scenario]) -> Recipe:
    """Recipe of the first of some scenarios, which all have its recording.

    Raises
    ------
    SimulationError
        If there is none, or one of them has another recording than the first.
    """
    if not scenarios:
        raise SimulationError("scenarios: there are none; give at least one.")
    first = scenarios[0].recipe
    for place, scenario in enumerate(scenarios):
        if _common(scenario.recipe) != _common(first):
            raise SimulationError(
                f"scenarios[{place}]: its recording or truth is not that of scenarios[0]; simulate each kind on its own."
            )
    return first


def _common(recipe: Recipe) -> tuple[Any, ...]:
    """What scenarios that are simulated together have in common."""
    recording = recipe.recording
    names = tuple(channel.name for channel in recording.channels)
    times = recording.sample_rate_hz, recording.duration_s, recording.settle_s, recording.oversampling
    return recipe.seed, names, times, recording.converter, recipe.truth
