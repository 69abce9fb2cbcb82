"""Variables of the corpus that follow from what the simulation knows of a record by construction."""

import math
from collections.abc import Callable

import numpy as np

from gen.corpus.schema import Variable
from gen.corpus.simulated import with_values
from gen.physics.kernel_input import Spall
from gen.physics.profile import mean_share, share_at
from gen.scenarios import Scenario
from gen.simulation.damage import largest_drop_over
from gen.simulation.hits import loaded_hits
from gen.simulation.simulate import Run
from gen.simulation.timeline import timeline


def lines_of_faults(run: Run) -> tuple[float, ...]:
    """Orders at which the faults of a record repeat; none for a worn race, which hits nothing [1]."""
    components = run.scenario.components
    lines = dict.fromkeys(fault.lines[fault.part] for fault in components if fault.part in fault.lines)
    return tuple(multiple * getattr(run.motion.means[1], order) for order, multiple in lines)


def _duration(run: Run) -> float:
    return timeline(run.scenario.recipe).duration


def _shaft_rate(run: Run) -> float:
    """Mean of the speed profile, with the drawn error of the label [Hz]."""
    conditions = run.scenario.conditions
    mean = conditions["shaft_rate"] * mean_share(run.scenario.speed_profile, _duration(run))
    return mean * (1 + conditions["label_error"])


def _shaft_rate_at(run: Run, time: float) -> float:
    profile = run.scenario.speed_profile
    share = 1.0 if profile is None else share_at(profile, np.array([time]))[0]
    return run.scenario.conditions["shaft_rate"] * share


def _of_widest(value: Callable[[Scenario, Spall], float], without: float = 0.0) -> Callable[[Run], float]:
    """Function of a run that gives a value of the widest spall, or ``without`` a spall another one."""

    def of_run(run: Run) -> float:
        widest = max(run.scenario.spalls, key=lambda spall: spall.width, default=None)
        return without if widest is None else value(run.scenario, widest)

    return of_run


def width_share(scenario: Scenario, spall: Spall) -> float:
    """Width of a spall over the distance from ball to ball, or round a ball [1]."""
    bearing = scenario.bearing
    circumference = 2 * math.pi * bearing.radius(spall.site)
    return spall.width / (circumference if spall.site == "ball" else circumference / bearing.n_balls)


def _loaded_hits(run: Run) -> int:
    if not run.scenario.recipe.truth.twins:
        return -1
    if not run.scenario.spalls:
        return 0
    rate, orders = run.motion.means
    return loaded_hits(run.kernel_input, orders, rate * _duration(run))


LABELS = (
    *with_values(
        shaft_rate=_shaft_rate,
        # mean of the load profile
        load=lambda run: run.scenario.conditions["load"] * mean_share(run.scenario.load_profile, _duration(run)),
        width=_of_widest(lambda _, spall: spall.width),
        depth=_of_widest(lambda _, spall: spall.depth),
        angle=_of_widest(lambda _, spall: spall.angle, math.nan),
        true_shaft_rate=lambda run: run.motion.means[0],
        first_shaft_rate=lambda run: _shaft_rate_at(run, 0.0),
        last_shaft_rate=lambda run: _shaft_rate_at(run, _duration(run)),
    ),
    Variable("largest_drop", "f8", "m", "label", "largest drop of a rigid ball over the widest spall, 0 without a spall",
        _of_widest(lambda scenario, spall: largest_drop_over(scenario, scenario.spalls.index(spall)))),
    Variable("width_share", "f8", "1", "label", "width of the widest spall over that from ball to ball, or round a ball; 0 without",
        _of_widest(width_share)),
    *(
        Variable(f"true_{name}", "f8", "1", "latent", f"mean {meaning}", lambda run, name=name: getattr(run.motion.means[1], name))
        for name, meaning in (
            ("ftf", "fundamental train frequency in shaft orders, slip included"),
            ("bpfo", "ball pass frequency of the outer race in shaft orders, slip included"),
            ("bpfi", "ball pass frequency of the inner race in shaft orders, slip included"),
            ("bsf", "ball spin frequency in shaft orders"),
        )
    ),
    Variable("operating_clearance", "f8", "m", "latent", "diametral clearance in operation: warm, oiled, under axial load",
        lambda run: 2 * run.kernel_input.machine.half_clearance),
    Variable("loaded_hits", "i4", "1", "latent", "expected number of passages of loaded balls over spalls, -1 if not known",
        _loaded_hits),
    *with_values(oversampling=None),
    Variable("step_phase", "f8", "rad", "provenance", "bound of the fastest angular frequency of the record times the step"),
)  # fmt: skip
"""Each is computed from a :class:`Run`; those without a function are attributes of it."""
