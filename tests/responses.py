"""Records whose bodies move as a test wants, and what is known of them; labels do not depend on the motion."""

import numpy as np

from gen.simulation.batches import Integration
from gen.simulation.inputs import kernel_inputs
from gen.simulation.motion import draw_motion
from gen.simulation.simulate import Run
from gen.simulation.timeline import timeline
from gen.simulation.truth import LABELS
from gen.support.errors import SimulationError


def input_of(scenario):
    """Kernel input of a scenario; the error of a machine that is not possible is raised."""
    (given,) = kernel_inputs([draw_motion(scenario)])
    if isinstance(given, SimulationError):
        raise given
    return given


def runs_of(scenarios, accelerations=None, healthy=None):
    """Records with these accelerations, shape (record, channel, time), of bodies at rest by default; and those without a fault."""
    runs = []
    for place, scenario in enumerate(scenarios):
        still = np.zeros((len(scenario.recipe.recording.channels), timeline(scenario.recipe).returned), np.float32)
        whole, sound = (None if some is None else some[place] for some in (accelerations, healthy))
        given, steps = input_of(scenario), place + 2
        own = Integration(given, steps, still if whole is None else whole)
        runs.append(
            Run(scenario, draw_motion(scenario), own, None if sound is None else Integration(given, steps, sound))
        )
    return runs


def accelerations_of(runs):
    """Shape (record, channel, time)."""
    return np.stack([run.acceleration for run in runs])


def failures_of(runs):
    """Sentence of each record that cannot be used, by its place."""
    return {place: run.failure for place, run in enumerate(runs) if run.failure is not None}


def means_of(scenario):
    """Mean shaft rate [Hz] and fault orders [1] of a record."""
    return draw_motion(scenario).means


def label(scenario, name):
    """Value of a variable of the corpus that follows from the simulation of a scenario."""
    (variable,) = (variable for variable in LABELS if variable.name == name)
    return variable.column(runs_of([scenario]))[0]
