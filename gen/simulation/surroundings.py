"""Constants of the machine around one bearing in one record.

Temperature, oil and axial load act here, once per record: they change clearance, contact stiffness and contact damping.
"""

import functools
import math
from collections import defaultdict
from collections.abc import Sequence

import numpy as np

from gen.physics.axial import axial_approach, check_axial_load
from gen.physics.hertz import contact_exponent, load_deflection_factor
from gen.physics.kernel_input import KernelInput
from gen.physics.lubricant import Lubricant, film, lubricated_factor, warm_clearance
from gen.physics.rating import LEAST_SAFETY, equivalent_load, static_rating
from gen.physics.rotor import STRIBECK, Machine, as_columns, ball_angles, sensor_springs
from gen.scenarios import Scenario
from gen.support.errors import SimulationError

THICKEST_FILM = 10e-6  # m, both contacts together; measured films are below 2 um

stiffness_of = functools.lru_cache(maxsize=4096)(load_deflection_factor)


def check_load(scenario: Scenario) -> None:
    """Raise ValueError if the equivalent static load of a record is far above the static rating of its bearing."""
    drawing, conditions = scenario.drawing, scenario.conditions
    radial = conditions["load"] * _largest_share(scenario)
    load = equivalent_load(radial, conditions["axial_load"], scenario.bearing.contact_angle)
    rating = static_rating(drawing)
    if load * LEAST_SAFETY > rating:
        raise ValueError(
            f"an equivalent static load of {load:.4g} N is more than {1 / LEAST_SAFETY:g} times the static rating of its bearing "
            f"{drawing.designation}, {rating:.4g} N; lower operation.load_n and axial_load_n, or take a larger bearing."
        )


def machine_of(scenario: Scenario) -> Machine:
    """Constants of the equations of motion of a record; :func:`with_axial_loads` adds the squeeze by its axial load.

    Raises
    ------
    ValueError
        If the oil film is too thick for film formulas, or the axial load too small to hold the rings together.
    """
    drawn, bearing, load = scenario.machine, scenario.bearing, scenario.conditions["load"]
    resonator = None if scenario.recipe.machine.resonator is None else scenario.recipe.machine.resonator.si()
    mass = drawn["shaft_mass"] + drawn["housing_mass"]
    # the recipe gives frequencies, the equations take springs
    stiffness_x = mass * (2 * math.pi * drawn["support_frequency"]) ** 2
    stiffness_y = stiffness_x * drawn["support_ratio"]
    spring = damper = 0.0
    # without a resonance of the sensor its body is absent
    if resonator is not None:
        spring, damper = sensor_springs(resonator["mass"], resonator["frequency"], resonator["damping"])
    factor, damping, half_clearance = _contact(scenario)
    machine = Machine(
        load_deflection_factor=factor,
        contact_damping=drawn["contact_damping"] + damping,
        contact_cosine=math.cos(bearing.contact_angle),
        half_clearance=half_clearance,
        ball_radius=bearing.ball_diameter / 2,
        shaft_mass=drawn["shaft_mass"],
        housing_mass=drawn["housing_mass"],
        sensor_mass=0.0 if resonator is None else resonator["mass"],
        ring_damping=drawn["ring_damping"],
        shaft_damping=drawn["shaft_damping"],
        shaft_stiffness=drawn["shaft_stiffness"],
        ring_stiffness_x=drawn["ring_stiffness"],
        ring_stiffness_y=drawn["ring_stiffness"],
        support_stiffness_x=stiffness_x,
        support_stiffness_y=stiffness_y,
        support_damping_x=2 * drawn["support_damping"] * math.sqrt(stiffness_x * mass),
        support_damping_y=2 * drawn["support_damping"] * math.sqrt(stiffness_y * mass),
        sensor_stiffness_x=spring,
        sensor_stiffness_y=spring,
        sensor_damping=damper,
        load_x=load * math.cos(drawn["load_angle"]),
        load_y=load * math.sin(drawn["load_angle"]),
        looseness=drawn["looseness"],
        contact_exponent=contact_exponent(bearing),
    )
    if scenario.conditions["axial_load"] != 0:
        check_axial_load(machine, scenario.conditions["axial_load"], _largest_share(scenario))
    return machine


def _largest_share(scenario: Scenario) -> float:
    """Largest value of the load profile [1]."""
    return 1.0 if scenario.load_profile is None else max(scenario.load_profile.shares)


def with_axial_loads(
    inputs: Sequence[KernelInput | SimulationError], loads: Sequence[float]
) -> list[KernelInput | SimulationError]:
    """Inputs whose balls are squeezed by the axial ``loads`` [N] too."""
    loaded, alike = list(inputs), defaultdict[float, list[tuple[int, KernelInput, float]]](list)
    for place, (kernel_input, load) in enumerate(zip(inputs, loads, strict=True)):
        if isinstance(kernel_input, KernelInput) and load != 0:
            alike[kernel_input.machine.contact_exponent].append((place, kernel_input, load))
    # balances of bearings with one contact law are solved together
    for group in alike.values():
        places, some, loads_of = zip(*group, strict=True)
        balls = ball_angles(
            [kernel_input.bearing.n_balls for kernel_input in some],
            [kernel_input.turning.cage_angle for kernel_input in some],
        )
        squeezes = axial_approach(
            as_columns([kernel_input.machine for kernel_input in some]), np.array(loads_of), balls
        )
        for place, kernel_input, squeeze in zip(places, some, squeezes, strict=True):
            half_clearance = kernel_input.machine.half_clearance - squeeze
            loaded[place] = kernel_input._replace(machine=kernel_input.machine._replace(half_clearance=half_clearance))
    return loaded


def _contact(scenario: Scenario) -> tuple[float, float, float]:
    """Load-deflection factor [N m^-n], damping [N s/m] and half the clearance [m] of one ball, with thermal expansion and oil film."""
    bearing, conditions, lubricant = scenario.bearing, scenario.conditions, scenario.recipe.contact.lubricant
    factor, clearance = stiffness_of(bearing), scenario.properties["diametral_clearance"]
    # the inner ring grows more than the outer one
    clearance = warm_clearance(bearing, clearance, conditions["inner_ring_hotter"])
    if lubricant is None:
        return factor, 0.0, clearance / 2
    heaviest, oil = heaviest_ball_load(scenario), lubricant.si()
    lubricant = Lubricant(oil["viscosity_40"], oil["viscosity_100"], oil["density"], oil["pressure_viscosity"])
    # the film of the most loaded ball, in series with the contact
    oil_film = film(bearing, lubricant, conditions["temperature"], conditions["shaft_rate"], heaviest)
    if oil_film.thickness > THICKEST_FILM:
        raise ValueError(
            f"an oil film of {oil_film.thickness * 1e6:.3g} um is above the {THICKEST_FILM * 1e6:g} um for which film formulas hold; "
            f"take thinner or warmer oil."
        )
    softer = lubricated_factor(factor, contact_exponent(bearing), heaviest, oil_film.stiffness)
    return softer, oil_film.damping, clearance / 2 - oil_film.thickness


def heaviest_ball_load(scenario: Scenario) -> float:
    """Static load of the most loaded ball after Stribeck, plus its share of the axial load, without preload [N]."""
    bearing, conditions = scenario.bearing, scenario.conditions
    total = STRIBECK * conditions["load"]
    if conditions["axial_load"] > 0 and bearing.contact_angle != 0:
        total += conditions["axial_load"] / abs(math.sin(bearing.contact_angle))
    return total / bearing.n_balls
