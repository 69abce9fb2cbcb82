"""Responses whose bodies move as a test wants; labels do not depend on the motion."""

import numpy as np

from gen.simulation.inputs import kernel_input
from gen.simulation.simulate import Response
from gen.simulation.timeline import timeline
from gen.simulation.truth import Truth, truths_of


def still(recipe, n_records):
    """Accelerations of bodies at rest, shape (record, channel, time) [m s-2]."""
    return np.zeros((n_records, len(recipe.recording.channels), timeline(recipe).returned), np.float32)


def response_of(scenarios, recipe, *, impossible=()):
    """Response of bodies at rest with the truth of every scenario; places in ``impossible`` have no machine."""
    n, axis = len(scenarios), timeline(recipe)
    inputs = [None if n in impossible else kernel_input(scenario, axis) for n, scenario in enumerate(scenarios)]
    truth = truths_of(scenarios, axis, inputs)
    return Response(still(recipe, n), np.arange(n) + 2, np.linspace(0.1, 0.3, n), {}, inputs, truth, None)


def truth(scenario, recipe) -> Truth:
    """Truth of a scenario."""
    axis = timeline(recipe)
    return truths_of([scenario], axis, [kernel_input(scenario, axis)])[0]
