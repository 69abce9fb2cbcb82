"""Responses whose bodies move as a test wants; labels do not depend on the motion."""

from types import SimpleNamespace

import numpy as np

from gen.scenarios import settings_of
from gen.simulation.inputs import kernel_input
from gen.simulation.motion import draw_motion
from gen.simulation.simulate import Response
from gen.simulation.timeline import timeline
from gen.simulation.truth import LABELS, truth_of


def input_of(scenario):
    """Kernel input of a scenario."""
    return kernel_input(scenario, timeline(scenario.settings))


def still(recipe, n_records):
    """Accelerations of bodies at rest, shape (record, channel, time) [m s-2]."""
    return np.zeros((n_records, len(recipe.recording.channels), timeline(settings_of(recipe)).returned), np.float32)


def response_of(scenarios, recipe, *, impossible=()):
    """Response of bodies at rest with the truth of every scenario; places in ``impossible`` have no machine."""
    n, axis = len(scenarios), timeline(settings_of(recipe))
    inputs = [None if n in impossible else kernel_input(scenario, axis) for n, scenario in enumerate(scenarios)]
    motions = [draw_motion(scenario) for scenario in scenarios]
    truth = [truth_of(motion, axis, given) for motion, given in zip(motions, inputs, strict=True)]
    steps = np.arange(n) + 2, np.linspace(0.1, 0.3, n)
    return Response(still(recipe, n), *steps, {}, motions, truth, [])


def truth(scenario):
    """Variables of the corpus that follow from the truth of a scenario, and its mean orders."""
    known = truth_of(draw_motion(scenario), timeline(scenario.settings), input_of(scenario))
    return SimpleNamespace(orders=known.orders, **{label.name: label.column([known])[0] for label in LABELS})
