"""What is built: the bearing, the machine around it, its lubricant, and how one physical bearing differs from its drawing."""

import difflib
import math
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from gen.physics.bearing import Bearing
from gen.physics.catalogue import CATALOGUE
from gen.physics.extent import MAX_BALLS
from gen.recipe.distributions import Distribution, Number, within
from gen.recipe.section import Count, Name, Section

_KNOWN = tuple(
    name for name, bearing in CATALOGUE.items() if bearing.rolling_element == "ball" or bearing.roller_length
)


class OwnBearing(Section):
    """A bearing of one's own beside those of the catalogue; ``ball_mm`` is the roller diameter of a roller bearing."""

    n_balls: Annotated[Count, Field(ge=5, le=MAX_BALLS)]
    pitch_mm: Annotated[Number, Field(ge=5, le=1000)]
    ball_mm: Annotated[Number, Field(gt=0, le=500)]
    contact_angle_deg: Annotated[Number, Field(ge=-40, le=40)] = 0.0
    roller_length_mm: Annotated[Number, Field(gt=0, le=1000)] | None = None
    """Makes it a roller bearing: length that touches the raceways."""

    @model_validator(mode="after")
    def _fits(self) -> Self:
        largest = min(0.45 * self.pitch_mm, 0.95 * math.pi * self.pitch_mm / self.n_balls)
        if self.ball_mm > largest:
            raise ValueError(
                f"{self.n_balls} of {self.ball_mm:g} mm do not fit a pitch circle of {self.pitch_mm:g} mm; "
                f"keep ball_mm below {largest:.4g}."
            )
        return self

    def bearing(self, designation: str) -> Bearing:
        """The same in SI units."""
        rollers = self.roller_length_mm
        return Bearing(
            designation,
            self.n_balls,
            self.pitch_mm * 1e-3,
            self.ball_mm * 1e-3,
            math.radians(self.contact_angle_deg),
            rolling_element="ball" if rollers is None else "roller",
            roller_length=None if rollers is None else rollers * 1e-3,
            source="recipe",
        )


class CatalogueBearing(Section):
    """Some bearings of the catalogue, and of one's own ``entries``, one of which is drawn per rig."""

    kind: Literal["catalogue"]
    designations: Annotated[tuple[Name, ...], Field(min_length=1)]
    entries: dict[Name, OwnBearing] = Field(default={})

    @model_validator(mode="after")
    def _known(self) -> Self:
        for name in self.entries:
            if name in CATALOGUE:
                raise ValueError(f"entries: {name} is in the catalogue already; give your own bearing another name.")
        for name in self.designations:
            if name not in self.entries and name not in _KNOWN:
                near = difflib.get_close_matches(name, [*self.entries, *_KNOWN], 3)
                guess = f"did you mean {' or '.join(near)}?" if near else "docs/catalogue.md lists them."
                raise ValueError(f"designations: {name!r} is neither in the catalogue nor in entries; {guess}")
        return self

    def bearing(self, designation: str) -> Bearing:
        """Bearing of a designation; one's own come first."""
        own = self.entries.get(designation)
        return CATALOGUE[designation] if own is None else own.bearing(designation)


class GeometryBearing(Section):
    """A bearing given by its geometry, each number drawn per rig; ``ball_share`` is ball, or roller, over pitch diameter."""

    kind: Literal["geometry"]
    designation: Name = "geometry"
    n_balls: Distribution = within(5, MAX_BALLS)
    pitch_mm: Distribution = within(5, 1000, open_low=True)
    ball_share: Distribution = within(0.05, 0.45)
    contact_angle_deg: Distribution = within(-40, 40, default=0.0)
    roller_length_mm: Distribution = within(0, 1000, default=0.0)
    """Length of the rollers that touches the raceways; 0 for balls."""

    @staticmethod
    def largest_ball(n_balls: int, pitch: float, share: float) -> float:
        """Ball diameter at a share of the pitch diameter, made smaller where neighbours would leave the cage no bars [m]."""
        return min(share * pitch, 0.85 * math.pi * pitch / n_balls)


class Resonator(Section):
    """Mass on a spring between housing and sensor."""

    mass_kg: Distribution = within(0, 10, open_low=True, default=0.2)
    frequency_hz: Distribution = within(100, 50_000, default=3000.0)
    damping_percent: Distribution = within(0.1, 50, default=3.0)


class Machine(Section):
    """Masses, springs and dampers, and what is wrong with the machine beside its bearing, drawn per rig."""

    shaft_mass_kg: Distribution = within(0, 1000, open_low=True, default=5.5)
    housing_mass_kg: Distribution = within(0, 1000, open_low=True, default=3.0)
    support_frequency_hz: Distribution = within(10, 5000, default=423.0)
    support_damping_percent: Distribution = within(0.1, 100, default=5.0)
    support_ratio: Distribution = within(0.1, 10, default=1.0)
    ring_damping_n_s_m: Distribution = within(0, 1e5, default=1000.0)
    ring_stiffness_n_m: Distribution = within(0, 1e9, default=0.0)
    shaft_damping_n_s_m: Distribution = within(0, 1e5, default=200.0)
    shaft_stiffness_n_m: Distribution = within(0, 1e9, default=0.0)
    contact_damping_n_s_m: Distribution = within(0, 1e4, default=0.0)
    balance_mm_s: Distribution = within(0, 100, default=1.0)
    load_angle_deg: Distribution = within(-360, 360, default=-90.0)
    bow_n: Distribution = within(0, 1e6, default=0.0)
    """Force that turns with the shaft whatever its speed: a bent shaft in its bearings."""
    misalignment_n: Distribution = within(0, 1e6, default=0.0)
    """Force at twice the shaft rate along ``misalignment_angle_deg``."""
    misalignment_angle_deg: Distribution = within(-360, 360, default=0.0)
    looseness_um: Distribution = within(0, 1000, default=0.0)
    """Half the play of the housing in its support."""
    resonator: Resonator | None = Resonator()


class Lubricant(Section):
    """Oil in the contacts, drawn per rig: its film takes up clearance, and yields and damps, as far as its temperature lets it."""

    viscosity_40_mm2_s: Distribution = within(2, 2000, default=68.0)
    viscosity_100_mm2_s: Distribution = within(1, 200, default=8.7)
    density_kg_m3: Distribution = within(700, 1200, default=880.0)
    pressure_viscosity_per_gpa: Distribution = within(5, 50, default=20.0)


class Contact(Section):
    """What is between ball and race: how wide they touch, and what lubricates them.

    With ``footprint: hertz`` a spall is felt over the width of the contact ellipse, with ``point`` at its middle alone.
    """

    footprint: Literal["point", "hertz"] = "point"
    lubricant: Lubricant | None = None


class Specimen(Section):
    """How one physical bearing differs from its drawing."""

    diametral_clearance_um: Distribution = within(-60, 500, default=10.0)
    inner_conformity: Distribution = within(0.505, 0.6, default=0.52)
    outer_conformity: Distribution = within(0.505, 0.6, default=0.52)
    waviness_nm: Distribution = within(0, 10_000, default=0.0)
    contact_angle_deg: Distribution = within(0, 30, default=0.0)
    """Contact angle beyond that of the drawing, as axial load brings it about: nominal orders do not know it."""
    ball_waviness_nm: Distribution = within(0, 1000, default=0.0)
