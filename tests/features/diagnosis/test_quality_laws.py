"""Laws of the checks of a recording: what counts as clipped."""

import numpy as np
import pytest

from features.diagnosis.quality import clipped_share


def test_a_sine_whose_peaks_are_single_samples_is_not_clipped():
    assert clipped_share(np.round(1000 * np.sin(2 * np.pi * np.arange(4000) / 8))) == 0


@pytest.mark.parametrize("limit", [0.5, 1.0, 2.0])
def test_the_share_of_clipped_samples_is_told(limit):
    x = np.random.default_rng(0).standard_normal(4000)
    assert clipped_share(np.clip(x, -limit, limit)) == np.mean(np.abs(x) >= limit)
    assert clipped_share(x) == 0
