"""The rig: bearing, machine and lubricant; and the deviations of one physical bearing from its drawing."""

import difflib
import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import AliasChoices, BeforeValidator, ConfigDict, Field, StrictInt, field_validator, model_validator

from gen.drawing import Distribution, Draws, Name, Number, Section, within
from gen.physics.bearing import Bearing
from gen.physics.catalogue import CATALOGUE, known_designation
from gen.physics.extent import MAX_BALLS
from gen.support.errors import RecipeError
from gen.support.rounding import rounded_down
from gen.support.units import UNITS, from_si, to_si

_KNOWN = tuple(
    name for name, bearing in CATALOGUE.items() if bearing.rolling_element == "ball" or bearing.roller_length
)


SMALLEST_BALL, LARGEST_BALL = 0.05, 0.45
"""Diameters of balls over the pitch diameter."""


OF_ROLLERS = {"n_rollers": "n_balls", "roller_diameter_mm": "ball_diameter_mm"}
"""Keys of the dimensions of a roller bearing, each for the same field as a key of balls."""
_COUNT, _DIAMETER = (Field(validation_alias=AliasChoices(of_balls, key)) for key, of_balls in OF_ROLLERS.items())


def _check_rollers(dimensions: Any) -> Any:
    """Dimensions as they are given; ValueError for keys of rollers without a length, or beside the same of balls."""
    if not isinstance(dimensions, Mapping) or not (keys := dimensions.keys() & OF_ROLLERS.keys()):
        return dimensions
    if "roller_length_mm" not in dimensions:
        raise ValueError(
            f"{min(keys)}: a bearing with rollers needs roller_length_mm; balls have n_balls and ball_diameter_mm."
        )
    if twice := dimensions.keys() & {OF_ROLLERS[key] for key in keys}:
        raise ValueError(f"{min(keys)}: {min(twice)} says the same; give one of them.")
    return dimensions


def _describe_rollers(schema: dict[str, Any]) -> None:
    """Add the keys of rollers to the JSON schema of a section, each in place of the same key of balls."""
    keys = schema["properties"]
    for key, of_balls in OF_ROLLERS.items():
        keys[key] = dict(keys[of_balls])
        schema["required"].remove(of_balls)
    schema["allOf"] = [
        {"oneOf": [{"required": [key]}, {"required": [of_balls]}]} for key, of_balls in OF_ROLLERS.items()
    ]
    schema["dependentRequired"] = {key: ["roller_length_mm"] for key in OF_ROLLERS}


class OwnBearing(Section):
    """A bearing that is not in the catalogue."""

    model_config = ConfigDict(json_schema_extra=_describe_rollers)

    n_balls: Annotated[StrictInt, Field(ge=5, le=MAX_BALLS), _COUNT]
    """Number of balls, or of rollers (`n_rollers`); BPFO and BPFI grow with it."""
    pitch_diameter_mm: Annotated[Number, Field(ge=5, le=1000)]
    """Diameter of the circle through the centres of the balls."""
    ball_diameter_mm: Annotated[Number, Field(ge=0.25, le=500), _DIAMETER]
    """Diameter of a ball, or of a roller (`roller_diameter_mm`); all of them must fit on the pitch circle."""
    contact_angle_deg: Annotated[Number, Field(ge=-40, le=40)] = 0.0
    """Contact angle on the drawing; it enters the fault frequencies."""
    roller_length_mm: Annotated[Number, Field(ge=0.25, le=1000)] | None = None
    """Length of a roller that touches the raceways; if given, the bearing has rollers instead of balls."""

    _keys = model_validator(mode="before")(_check_rollers)

    @model_validator(mode="after")
    def _fits(self) -> Self:
        check_room(self.n_balls, self.ball_diameter_mm, self.pitch_diameter_mm)
        return self

    def bearing(self, designation: str) -> Bearing:
        """Bearing in SI units."""
        rollers = self.roller_length_mm
        return Bearing(
            designation,
            self.n_balls,
            to_si(self.pitch_diameter_mm, "mm"),
            to_si(self.ball_diameter_mm, "mm"),
            to_si(self.contact_angle_deg, "deg"),
            rolling_element="ball" if rollers is None else "roller",
            roller_length=None if rollers is None else to_si(rollers, "mm"),
            source="recipe",
        )


class CatalogueBearing(Section):
    """Bearings by designation, one of which is drawn per rig."""

    drawn_per = "rig"

    kind: Literal["catalogue"]
    """Takes bearings by their designations."""
    designations: Annotated[tuple[Name, ...], Field(min_length=1)]
    """Names of bearings in `docs/catalogue.md` or in `entries`; each rig gets one of them, all equally likely."""
    entries: dict[Name, OwnBearing] = Field(default={})
    """Further bearings by name, for this recipe only."""

    @field_validator(
        "designations", mode="before", json_schema_input_type=str | Annotated[list[str], Field(min_length=1)]
    )
    @classmethod
    def _without_suffixes(cls, names: Any) -> Any:
        names = [names] if isinstance(names, str) else names
        if not isinstance(names, list | tuple):
            return names
        return tuple((known_designation(name) or name) if isinstance(name, str) else name for name in names)

    @model_validator(mode="after")
    def _known(self) -> Self:
        for name in self.entries:
            if name in CATALOGUE:
                raise ValueError(f"entries: {name} is in the catalogue already; give your own bearing another name.")
        unknown = next((name for name in self.designations if name not in self.entries and name not in _KNOWN), None)
        if unknown in CATALOGUE:
            raise ValueError(
                f"designations: {unknown} is in the catalogue without the length of its rollers; add it to entries under another name, "
                "with roller_length_mm."
            )
        if unknown is not None:
            near = difflib.get_close_matches(unknown, [*self.entries, *_KNOWN], 3)
            guess = f"did you mean {' or '.join(near)}?" if near else "docs/catalogue.md lists them."
            raise ValueError(f"designations: {unknown!r} is neither in the catalogue nor in entries; {guess}")
        return self

    def draw(self, of: Draws) -> Self:
        """One of the designations."""
        chosen = self.designations[int(of.u("designations") * len(self.designations))]
        return self.model_copy(update={"designations": (chosen,)})

    def drawing(self) -> Bearing:
        """The drawn bearing, as on its drawing."""
        return self.bearings()[0]

    def bearings(self) -> list[Bearing]:
        """Bearing of each designation, from the entries or from the catalogue."""
        return [
            self.entries[name].bearing(name) if name in self.entries else CATALOGUE[name] for name in self.designations
        ]


class GeometryBearing(Section):
    """A bearing given by its dimensions, drawn per rig."""

    model_config = ConfigDict(json_schema_extra=_describe_rollers)
    drawn_per = "rig"

    kind: Literal["geometry"] = "geometry"
    """Takes a bearing by its dimensions, each of which can vary from rig to rig."""
    designation: Name = "geometry"
    """Name of the bearing in the corpus."""
    n_balls: Annotated[Distribution, _COUNT] = within(5, MAX_BALLS, whole=True)
    """Number of balls, or of rollers (`n_rollers`), of a range rounded to a whole number; BPFO and BPFI grow with it."""
    pitch_diameter_mm: Distribution = within(5, 1000, open_low=True)
    """Diameter of the circle through the centres of the balls."""
    ball_diameter_mm: Annotated[Distribution, _DIAMETER] = within(0.25, 500)
    """Diameter of a ball, or of a roller (`roller_diameter_mm`): 0.05 to 0.45 of the pitch diameter; of a range, reduced where neighbours
    would leave no room for a cage."""
    contact_angle_deg: Distribution = within(-40, 40, default=0.0)
    """Contact angle on the drawing; it enters the fault frequencies."""
    roller_length_mm: Distribution = within(0, 1000, default=0.0)
    """Length of a roller that touches the raceways; 0 for balls."""

    _keys = model_validator(mode="before")(_check_rollers)

    @model_validator(mode="after")
    def _fits(self) -> Self:
        ball, pitch = self.ball_diameter_mm, self.pitch_diameter_mm
        low, high = ball.support()
        if ball.share_of == "roller_length_mm":
            low, high = (end * length for end, length in zip((low, high), self.roller_length_mm.support(), strict=True))
        if ball.share_of != "pitch_diameter_mm":
            low, high = low / pitch.support()[1], high / pitch.support()[0]
        if low * (1 + 1e-9) < SMALLEST_BALL or high > LARGEST_BALL * (1 + 1e-9):
            raise ValueError(
                f"ball_diameter_mm: can be {low:.3g} to {high:.3g} of pitch_diameter_mm, and {SMALLEST_BALL:g} to {LARGEST_BALL:g} is "
                f"allowed; a range that fits is uniform(0.15, 0.28) * pitch_diameter_mm."
            )
        # whether drawn balls fit shows when they are drawn
        if self.n_balls.support()[0] == self.n_balls.support()[1] and low == high:
            check_room(round(self.n_balls.support()[0]), high * pitch.support()[0], pitch.support()[0])
        return self

    def draw(self, of: Draws) -> Self:
        """The dimensions, with balls that fit beside each other."""
        drawn = super().draw(of)
        values, n_balls = drawn.si(), round(drawn.n_balls)
        ball = self.fitting_ball(n_balls, values["pitch_diameter"], values["ball_diameter"])
        fitting = {} if ball == values["ball_diameter"] else {"ball_diameter_mm": ball / UNITS["mm"].factor}
        return drawn.model_copy(update={"n_balls": float(n_balls), **fitting})

    def drawing(self) -> Bearing:
        """The drawn bearing, as on its drawing."""
        drawn = self.si()
        rollers = drawn["roller_length"]
        return Bearing(
            designation=self.designation,
            n_balls=round(drawn["n_balls"]),
            pitch_diameter=drawn["pitch_diameter"],
            ball_diameter=drawn["ball_diameter"],
            contact_angle=drawn["contact_angle"],
            rolling_element="roller" if rollers > 0 else "ball",
            roller_length=rollers or None,
        )

    def fitting_ball(self, n_balls: int, pitch: float, ball: float) -> float:
        """Ball diameter; of a range, reduced where neighbours would leave no room for cage bars [m]."""
        ranges = (self.n_balls, self.pitch_diameter_mm, self.ball_diameter_mm, self.roller_length_mm)
        fixed = all(low == high for low, high in (some.support() for some in ranges))
        return ball if fixed else min(ball, 0.85 * math.pi * pitch / n_balls)


def check_room(n_balls: int, ball_mm: float, pitch_mm: float) -> None:
    """Raise ValueError if so many balls do not fit on the pitch circle."""
    largest = min(LARGEST_BALL * pitch_mm, 0.95 * math.pi * pitch_mm / n_balls)
    if ball_mm > largest * (1 + 1e-9):
        raise ValueError(
            f"{n_balls} of {ball_mm:g} mm do not fit a pitch circle of {pitch_mm:g} mm; keep ball_diameter_mm below "
            f"{rounded_down(largest)}."
        )


def _with_kind(value: Any) -> Any:
    """A bearing with its kind, from a designation, a list of them, or dimensions."""
    if isinstance(value, str | int | list | tuple):
        several = value if isinstance(value, list | tuple) else [value]
        return {"kind": "catalogue", "designations": [str(name) if type(name) is int else name for name in several]}
    if (
        isinstance(value, Mapping)
        and "kind" not in value
        and value.keys() & {"n_balls", "pitch_diameter_mm", "ball_diameter_mm", *OF_ROLLERS}
    ):
        return {"kind": "geometry", **value}
    return value


_Short = str | int | Annotated[list[str | int], Field(min_length=1)]
BearingSection = Annotated[
    Annotated[CatalogueBearing | GeometryBearing, Field(discriminator="kind")],
    BeforeValidator(_with_kind, json_schema_input_type=_Short | CatalogueBearing | GeometryBearing),
]
"""Designation, list of designations, or dimensions; ``kind`` can be left out."""


class Resonator(Section):
    """Sensor resonance: a mass on a spring and a damper on the housing."""

    mass_kg: Distribution = within(0, 10, open_low=True, default=0.2)
    """Mass that vibrates on the housing; a channel with `body: sensor` measures its acceleration."""
    frequency_hz: Distribution = within(100, 50_000, default=3000.0)
    """Natural frequency of the mass on a fixed housing: impacts excite the signal around it."""
    damping_percent: Distribution = within(0.1, 50, default=3.0)
    """Damping ratio of the resonance; the lower it is, the longer each impact decays."""


class MachineSection(Section):
    """Masses, springs and dampers of the machine, and its faults other than those of the bearing; drawn per rig."""

    drawn_per = "rig"

    shaft_mass_kg: Distribution = within(0, 1000, open_low=True, default=5.5)
    """Mass that moves with the inner ring."""
    housing_mass_kg: Distribution = within(0, 1000, open_low=True, default=3.0)
    """Mass that moves with the outer ring."""
    support_frequency_hz: Distribution = within(10, 5000, default=423.0)
    """Natural frequency of shaft and housing together on the support, in the horizontal direction."""
    support_damping_percent: Distribution = within(0.1, 100, default=5.0)
    """Damping ratio of shaft and housing together on the support."""
    support_ratio: Distribution = within(0.1, 10, default=1.0)
    """Vertical over horizontal stiffness of the support."""
    ring_damping_n_s_m: Distribution = within(0, 1e5, default=1000.0)
    """Damper between inner and outer ring; it damps the motion of the shaft in the bearing."""
    ring_stiffness_n_m: Distribution = within(0, 1e9, default=0.0)
    """Spring between inner and outer ring beside the contacts; real bearings have none, the seed paper has one."""
    shaft_damping_n_s_m: Distribution = within(0, 1e5, default=200.0)
    """Damper from shaft to ground."""
    shaft_stiffness_n_m: Distribution = within(0, 1e9, default=0.0)
    """Spring from shaft to ground, such as the other bearing of the shaft."""
    contact_damping_n_s_m: Distribution = within(0, 1e4, default=0.0)
    """Damper in each loaded contact, in addition to that of the oil film; it acts on the approach speed of the rings."""
    balance_mm_s: Distribution = within(0, 100, default=1.0)
    """Balance grade G of the rotor (ISO 21940-11) at `balance_rpm`; it gives a line at 1x."""
    balance_rpm: Annotated[Number, Field(gt=0)] | None = None
    """Speed for which `balance_mm_s` holds; the highest `shaft_rpm` of `operation` and `faults` if left out."""
    load_angle_deg: Distribution = within(-360, 360, default=-90.0)
    """Direction of the radial load, counter-clockwise from the horizontal; -90 is down. The load zone lies there."""
    bow_n: Distribution = within(0, 1e6, default=0.0)
    """Force of a bent shaft, which turns with it at constant size; it gives a line at 1x shaft rate at any speed."""
    misalignment_n: Distribution = within(0, 1e6, default=0.0)
    """Force along `misalignment_angle_deg` that alternates twice per turn; it gives a line at 2x shaft rate."""
    misalignment_angle_deg: Distribution = within(-360, 360, default=0.0)
    """Direction of the misalignment force, counter-clockwise from the horizontal."""
    looseness_um: Distribution = within(0, 1000, default=0.0)
    """Half the play of a loose housing: within it the support has no stiffness."""
    resonator: Resonator | None = Resonator()
    """Resonance between housing and sensor; `null` leaves it out."""

    @property
    def unbalance(self) -> float:
        """Mass times eccentricity of the drawn rotor after ISO 21940-11 [kg m]."""
        drawn = self.si()
        return drawn["shaft_mass"] * drawn["balance"] / (2 * math.pi * to_si(self.balance_rpm or math.nan, "rpm"))


class LubricantSection(Section):
    """Oil in the contacts, drawn per rig. Its film reduces the operating clearance, softens the contacts and damps them."""

    viscosity_40_mm2_s: Distribution = within(2, 2000, default=68.0)
    """Kinematic viscosity at 40 degrees Celsius; a higher one gives a thicker film."""
    viscosity_100_mm2_s: Distribution = within(1, 200, default=8.7)
    """Kinematic viscosity at 100 degrees Celsius; it must be below that at 40."""
    density_kg_m3: Distribution = within(700, 1200, default=880.0)
    """Density of the oil; it turns kinematic into dynamic viscosity."""
    pressure_viscosity_per_gpa: Distribution = within(5, 50, default=20.0)
    """Relative rise of the viscosity with pressure, the same at every temperature; it enters the film thickness."""

    def check(self, item: str) -> None:
        """RecipeError if the drawn oil of an ``item`` does not get thinner when it gets warmer."""
        drawn = self.si()
        if drawn["viscosity_100"] >= drawn["viscosity_40"]:
            raise RecipeError(
                f"{item}: oil of {from_si(drawn['viscosity_40'], 'mm2_s'):.3g} mm2/s at 40 C has no lower viscosity at 100 C; "
                f"keep viscosity_100_mm2_s below viscosity_40_mm2_s."
            )


class ContactSection(Section):
    """Contact of balls and races."""

    drawn_per = "rig"

    footprint: Literal["point", "hertz"] = "point"
    """Width over which a ball feels a spall: `hertz` averages over the contact ellipse, `point` takes its centre alone."""
    lubricant: LubricantSection | None = None
    """Oil in the contacts; dry if left out."""


class SpecimenSection(Section):
    """Deviations of one physical bearing from its drawing, drawn per specimen."""

    drawn_per = "specimen"

    diametral_clearance_um: Distribution = within(-60, 500, default=10.0)
    """Internal clearance as built, negative for preload; a larger one narrows the load zone."""
    inner_conformity: Distribution = within(0.505, 0.6, default=0.52)
    """Groove radius of the inner race over the ball diameter; a smaller one makes the contact stiffer."""
    outer_conformity: Distribution = within(0.505, 0.6, default=0.52)
    """Groove radius of the outer race over the ball diameter; a smaller one makes the contact stiffer."""
    waviness_nm: Distribution = within(0, 10_000, default=0.0)
    """Rms waviness of each race, over the orders 2 to 60 per turn, with amplitudes that fall as 1/order."""
    contact_angle_deg: Distribution = within(0, 30, default=0.0)
    """Contact angle beyond that of the drawing, as under axial load; the nominal fault orders do not include it."""
    ball_waviness_nm: Distribution = within(0, 1000, default=0.0)
    """Rms waviness of each ball, over the even orders 2 to 20 per turn of the ball."""
