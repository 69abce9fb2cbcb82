"""Durations of records: lines rise higher above the floor in longer ones, so a model suits records as long as those it was trained on."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol, Self, TypeVar

if TYPE_CHECKING:
    import xarray as xr

DURATION = "duration"  # of each record of a feature table [s]
SAME_DURATION = 1.01  # ratio


class Trained(Protocol):
    """What is asked of a model: shortest and longest of its training records [s], if known, and a model for shorter ones."""

    @property
    def durations(self) -> tuple[float, ...]:
        """See `features.baselines.Model`."""
        ...

    @property
    def shorter(self) -> Self | None:
        """See `features.baselines.Model`."""
        ...


Model = TypeVar("Model", bound=Trained)


def durations_of(table: "xr.Dataset") -> tuple[float, ...]:
    """Shortest and longest duration of the records of a feature table [s]; empty if it does not tell them."""
    known = DURATION in table and table.sizes["record"]
    return (float(table[DURATION].min()), float(table[DURATION].max())) if known else ()


def suited(model: Model, durations: Sequence[float]) -> Model:
    """The model, or its model for shorter records if the shortest of these durations [s] is below that of its training."""
    shorter = model.shorter
    return shorter if shorter and durations and SAME_DURATION * min(durations) < min(model.durations) else model
