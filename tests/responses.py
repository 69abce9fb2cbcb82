"""Responses whose bodies move as a test wants; labels do not depend on the motion."""

import numpy as np

from gen.simulation.inputs import kernel_input
from gen.simulation.motion import draw_motion
from gen.simulation.simulate import Response
from gen.simulation.timeline import timeline
from gen.simulation.truth import LABELS, truth_of


def input_of(scenario):
    """Kernel input of a scenario."""
    return kernel_input(scenario, timeline(scenario.recipe))


def still(recipe, n_records):
    """Accelerations of bodies at rest, shape (record, channel, time) [m s-2]."""
    return np.zeros((n_records, len(recipe.recording.channels), timeline(recipe).returned), np.float32)


def response_of(scenarios, recipe, *, impossible=()):
    """Response of bodies at rest with the truth of every scenario; places in ``impossible`` have no machine."""
    n, axis = len(scenarios), timeline(recipe)
    motions = [draw_motion(scenario) for scenario in scenarios]
    inputs = [None if place in impossible else input_of(scenario) for place, scenario in enumerate(scenarios)]
    truth = [truth_of(motion, axis, given) for motion, given in zip(motions, inputs, strict=True)]
    steps = np.arange(n) + 2, np.linspace(0.1, 0.3, n)
    return Response(still(recipe, n), *steps, {}, motions, truth, [])


def truth(scenario):
    """Truth of a scenario."""
    return truth_of(draw_motion(scenario), timeline(scenario.recipe), input_of(scenario))


def label(scenario, name):
    """Value of a variable of the corpus that follows from the truth of a scenario."""
    (variable,) = (variable for variable in LABELS if variable.name == name)
    return variable.column([truth(scenario)])[0]
