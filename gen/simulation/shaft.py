"""Angle of the shaft at every sample of a response: the time integral of its speed, as the kernel turns it.

The speed is the drawn rate, times the speed profile, times the speed wander. Bearing, unbalance, and everything of the machine that is
locked to the shaft turn by this one angle.
"""

import math

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus import DRAWS
from gen.physics.kernel.layout import SPEED_TERMS
from gen.physics.kernel.turning import STRIDE
from gen.physics.profile import share_at
from gen.scenarios import read_scenarios
from gen.simulation.motion import Motion, cosine_sum, draw_motion
from gen.simulation.timeline import timeline
from gen.support.errors import CorpusError

FloatArray = NDArray[np.float64]


def shaft_angles(records: xr.Dataset) -> xr.DataArray:
    """Angle of the shaft at every sample of records [rad], with the dimensions ``record`` and ``elapsed_time``.

    Simulated records have the angle by which bearing and machine turned. Recordings of real machines have that of their
    labelled rate, as if it were constant, from 0 at their first sample: where the speed varies, give a tacho or the
    course of the speed to `features.signal.angles_from_tacho` or `features.signal.angles_from_speed` instead.

    Parameters
    ----------
    records : Dataset
        Records, all or some, of :func:`gen.record`, :func:`gen.records` or :func:`gen.open_corpus`.

    Raises
    ------
    CorpusError
        If a simulated record has no scenario because its signal was changed, or the shaft rate of a recording is not known.
    """
    rows = records if "record" in records.dims else records.expand_dims("record")
    angles = np.empty((rows.sizes["record"], rows.sizes["elapsed_time"]))
    for place in range(len(angles)):
        angles[place] = _record_angles(rows.isel(record=[place]), place)
    shaft_angle = xr.DataArray(angles, dims=("record", "elapsed_time"), name="shaft_angle")
    shaft_angle.attrs = {"long_name": "angle of the shaft", "units": "rad"}
    shaft_angle = shaft_angle.assign_coords(elapsed_time=records["elapsed_time"])
    return shaft_angle if rows is records else shaft_angle[0]


def _record_angles(row: xr.Dataset, place: int) -> FloatArray:
    """Angle at every sample of one record, shape (time,)."""
    if DRAWS in row and (str(row[DRAWS].item()) or np.isfinite(row["true_shaft_rate"].item())):
        try:
            (scenario,) = read_scenarios(row)
        except CorpusError as error:
            raise CorpusError(f"record {place}{str(error).removeprefix('record 0')}") from None
        return angles_of(draw_motion(scenario))[timeline(scenario.recipe).kept]
    rate = row["shaft_rate"].item()
    if not rate > 0:
        raise CorpusError(f"record {place} has no shaft rate, so that the angle of its shaft is not known.")
    return 2 * math.pi * rate / row["sample_rate"].item() * np.arange(row.sizes["elapsed_time"])


def angles_of(motion: Motion) -> FloatArray:
    """Angle of the shaft of a record from the lead ahead of it on, shape (time,) [rad].

    With a constant nominal speed it is ``angle + omega (t + s integral(eta))``, with the rms ``s`` of the wander and its cosine sum
    ``eta``. With a speed profile the product of profile and wander is summed from sample to sample, at the middle of each, as in the
    kernel.
    """
    start, omega, wander = motion.turning.shaft_angle, 2 * math.pi * motion.turning.shaft_rate, motion.turning.speed_rms
    profile, axis = motion.scenario.speed_profile, timeline(motion.scenario.recipe)
    # terms of the wander of unit rms, at times since the kernel started
    rates, phases = 2 * np.pi * motion.frequencies[:SPEED_TERMS], motion.phases[:SPEED_TERMS]
    size = math.sqrt(2 / SPEED_TERMS)
    if profile is None:
        # the integral of a cosine sum is known at every node; between nodes it is interpolated
        nodes = np.arange(axis.dropped, axis.dropped + axis.returned + STRIDE, STRIDE) / axis.fs
        integral = 0.0
        if wander > 0:
            sines = cosine_sum(nodes, rates, phases - math.pi / 2, 1 / rates)
            integral = wander * (size * (sines - float(np.sum(np.sin(phases) / rates))))
        angles = _between(omega * (nodes + integral))[: axis.returned]
        angles += start
        return angles
    # with a profile the speed is summed from sample to sample
    middles = (np.arange(axis.dropped + axis.returned - 1) + 0.5) / axis.fs
    speed = share_at(profile, middles - axis.settle / axis.fs)
    if wander > 0:
        speed *= 1 + wander * (size * cosine_sum(middles, rates, phases))
    turned = np.concatenate([[0.0], np.cumsum(speed)]) * (omega / axis.fs)
    return start + turned[axis.dropped :]


def _between(nodes: FloatArray) -> FloatArray:
    """Values on straight lines between nodes that are ``STRIDE`` samples apart, without the last node.

    The error is below 1e-5 rad for a wander of 1 % at 50 Hz, and the nodes take an eighth of the cosines.
    """
    slopes = np.diff(nodes) / STRIDE
    between = slopes[:, None] * np.arange(STRIDE)
    between += nodes[:-1, None]
    return between.ravel()
