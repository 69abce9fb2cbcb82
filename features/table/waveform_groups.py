"""Groups ``bands`` and ``time``: energies of the signal in bands of frequency and of order, and statistics of its waveform.

Both depend on gain and spectral colour, and strongly on the machine.
"""

from collections.abc import Iterator
from functools import partial
from itertools import pairwise
from math import inf

import numpy as np

from features.signal.rows import FloatArray
from features.signal.shape import time_statistics
from features.signal.spectra import band_energies, power_density
from features.table.band import Band
from features.table.feature_group import Feature, FeatureGroup
from features.table.record_batch import RecordBatch

ENERGY_ORDERS = (0.5, 1.5, 2.5, 3.5, 5.5, 10.5, 20.5, 40.5)
FAINTEST_ENERGY = 1e-12  # of the total energy, 120 dB below it

_energy = partial(Feature, unit="ln(re 1 m2 s-4)", source="Welch, IEEE Trans. Audio Electroacoust. 15 (1967)")
_time = partial(Feature, parameters="none", source="Lei et al., Expert Syst. Appl. 35 (2008)", least=1.0)

TIMES = (
    _time("time_rms", "root mean square", "sqrt(E x^2)", unit="m s-2", least=0.0),
    _time("time_peak", "largest modulus", "max|x|", unit="m s-2", least=0.0),
    _time("time_crest_factor", "peak over rms", "max|x| / sqrt(E x^2)"),
    _time("time_kurtosis", "fourth moment over the squared second, 3 for Gaussian noise", "E x^4 / (E x^2)^2"),
    _time("time_skewness", "third moment over the cubed rms, 0 for Gaussian noise", "E x^3 / (E x^2)^1.5", least=-inf),
    _time("time_shape_factor", "rms over the mean modulus", "sqrt(E x^2) / E|x|"),
    _time("time_impulse_factor", "peak over the mean modulus", "max|x| / E|x|"),
    _time("time_clearance_factor", "peak over the squared mean root of the modulus", "max|x| / (E sqrt|x|)^2"),
)


def _energies(band: Band) -> Iterator[Feature]:
    """Yield the energies between frequencies, and then those between orders."""
    for edges, unit, place, parameters in (
        (band.energy_edges, "Hz", "Hz", "band end"),
        (ENERGY_ORDERS, "orders", "fr", "band end, shaft rate"),
    ):
        for low, high in pairwise(edges):
            yield _energy(
                f"energy_{low:g}-{high:g}_{unit}",
                f"logarithm of the energy from {low:g} to {high:g} {place}",
                "ln of the integral of the power spectral density over the band",
                parameters=parameters,
            )


def _log_energies(batch: RecordBatch) -> FloatArray:
    """Natural logarithm of energies [unit of x squared] in bands of frequency, then in bands of order."""
    frequencies, density = power_density(batch.x, batch.fs)
    density[:, frequencies > batch.band.high] = 0.0
    in_hz = band_energies(density, frequencies, batch.band.energy_edges)
    in_orders = band_energies(density, frequencies, np.multiply.outer(batch.shaft_rate, ENERGY_ORDERS))
    least = FAINTEST_ENERGY * (frequencies[1] - frequencies[0]) * density.sum(axis=-1, keepdims=True)
    energies = np.concatenate([in_hz, in_orders], axis=-1)
    return np.log(np.maximum(energies, least + np.finfo(float).tiny))


ENERGY_GROUP = FeatureGroup(lambda band: tuple(_energies(band)), _log_energies)
TIME_GROUP = FeatureGroup(TIMES, lambda batch: time_statistics(batch.x))
