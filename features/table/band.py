"""The band of frequencies that features and envelopes are computed from.

The default ends at 5 kHz, so that features depend as little as possible on the recording equipment. A sensor with a higher
resonance can show more in another band.
"""

from collections.abc import Mapping
from itertools import pairwise
from typing import Any, NamedTuple

NARROW_EDGES = (500.0, 1500.0, 2500.0, 3500.0, 5000.0, 7000.0, 10_000.0, 14_000.0, 20_000.0, 28_000.0, 40_000.0)  # Hz
ENERGY_EDGES = (20.0, 100.0, 200.0, 400.0, 800.0, *NARROW_EDGES[1:])  # Hz
LEAST_WIDTH = 1000.0  # Hz, of a band: the envelope must hold the harmonics of a line
HIGHEST = 100_000.0  # Hz


class Band(NamedTuple):
    """Band of frequencies that features and envelopes are computed from [Hz]; energies and raw shape also use what lies below it."""

    low: float
    high: float

    @property
    def narrow(self) -> tuple[tuple[float, float], ...]:
        """Narrower bands within it: between the edges of `NARROW_EDGES`, the last up to its end.

        >>> Band(300, 9000).narrow[-2:]
        ((5000.0, 7000.0), (7000.0, 9000))
        """
        inner = [edge for edge in NARROW_EDGES if self.low <= edge <= self.high - LEAST_WIDTH / 2]
        return tuple(pairwise((*inner, self.high))) if inner else ((self.low, self.high),)

    @property
    def lowest_rate(self) -> float:
        """Sample rate below which not even its lowest narrow band is recorded, and no line is read in it [Hz]."""
        return 2 * self.narrow[0][1]

    @property
    def energy_edges(self) -> tuple[float, ...]:
        """Edges of the bands whose energies are features."""
        return (*(edge for edge in ENERGY_EDGES if edge < self.high), self.high)


DEFAULT_BAND = Band(300.0, 5000.0)


def checked_band(low: float, high: float) -> Band:
    """Band of two edges [Hz].

    Raises
    ------
    ValueError
        If it is too narrow, or an edge is out of range.
    """
    if not (low >= 0 and low + LEAST_WIDTH <= high <= HIGHEST):
        raise ValueError(
            f"band: {low:g}-{high:g} Hz is not allowed; give two edges from 0 to {HIGHEST:,.0f} Hz, at least {LEAST_WIDTH:g} Hz apart."
        )
    return Band(float(low), float(high))


def band_of(attributes: Mapping[str, Any]) -> Band:
    """Band that the features of a table were computed from, by the attributes of the table."""
    default = band_attributes(DEFAULT_BAND)
    return Band(*(float(attributes.get(name, edge)) for name, edge in default.items()))


def band_attributes(band: Band) -> dict[str, float]:
    """Attributes of a table whose features are computed from a band [Hz]; `band_of` reads them."""
    return {"band_low_hz": band.low, "band_high_hz": band.high}
