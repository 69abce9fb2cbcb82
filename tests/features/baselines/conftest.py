"""Few resamples of curves against false alarms, which take most of the time of a score."""

from collections.abc import Iterator

import pytest


@pytest.fixture(scope="module", autouse=True)
def few_resamples() -> Iterator[None]:
    """What is tested is true for any number of resamples."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("features.baselines.detection.RESAMPLES", 10)
        yield
