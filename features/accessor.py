"""The functions of `features.signal` on xarray: ``records.acceleration.raceway.envelope_spectrum()``.

``import features.accessor`` gives every DataArray with the dimension ``elapsed_time`` the accessor ``raceway``. A
result keeps all other dimensions and coordinates, and has a name and units of its own. A signal in chunks of dask
(``chunk({"record": 64})``, whole along time) gives a lazy result, computed chunk by chunk. ``records.raceway`` tells
what a corpus holds and what can be done with it.
"""

from collections.abc import Callable, Mapping

import numpy as np
import xarray as xr

from features.signal.cyclic import enhanced_envelope_spectrum, spectral_coherence
from features.signal.envelopes import band_envelope_spectrum
from features.signal.impulsive import kurtogram, spectral_kurtosis
from features.signal.orders import order_spectrum, resample_to_angle
from features.signal.rows import FloatArray
from features.signal.spectra import cepstrum, psd
from features.signal.velocity import HIGH_PASS, displacement, velocity
from features.table.band import DEFAULT_BAND
from gen.corpus import class_counts, unit_counts
from gen.support.display import Shown

TIME = "elapsed_time"

Compute = Callable[[FloatArray], tuple[FloatArray, FloatArray]]


@xr.register_dataset_accessor("raceway")
class CorpusAccessor(Shown):
    """Classes and signals of records, and the next steps.

    Raises
    ------
    ValueError
        If these are not the records of a corpus.
    """

    def __init__(self, records: xr.Dataset) -> None:
        if not {"fault_name", TIME} <= set(records.coords):
            raise ValueError("raceway: needs the records of a corpus, such as gen.open_corpus gives.")
        self._records = records

    def _heading(self) -> str:
        count = np.size(self._records["fault_name"])
        return f"{count:,} record{'s' * (count != 1)} of {self._records.attrs.get('title', 'a corpus')}"

    def _facts(self) -> Mapping[str, object]:
        records = self._records
        return {
            "classes": ", ".join(f"{name} {count:,}" for name, count in class_counts(records["fault"]).items()),
            "rigs": unit_counts(records).rigs,
            "signals": f"{len(records[TIME]) / float(records['sample_rate'].values.flat[0]):g} s of {', '.join(records['channel'].values)}",
            "choose": 'records.sel(record=records.fault_name == "inner")',
            "look": "records.acceleration[0].plot(), records.acceleration[0].raceway.envelope_spectrum().plot()",
            "learn": "features.feature_table(folder), gen.torch_dataset(folder), features.open_waveforms(folder)",
            "browse": "raceway explore FOLDER -o explore.html",
        }


@xr.register_dataarray_accessor("raceway")
class SignalAccessor:
    """Analysis of signals along ``elapsed_time``; every method returns a DataArray.

    Raises
    ------
    ValueError
        If the array has no such dimension, or no coordinate along it.
    """

    def __init__(self, signals: xr.DataArray) -> None:
        if TIME not in signals.coords or signals.sizes[TIME] < 2:
            raise ValueError(f"raceway: needs signals with a coordinate {TIME}, such as records.acceleration.")
        self._signals = signals

    @property
    def fs(self) -> float:
        """Sample rate [Hz], from ``elapsed_time``."""
        times = self._signals[TIME].values
        return float((len(times) - 1) / (times[-1] - times[0]))

    def psd(self, segment: float = 0.25) -> xr.DataArray:
        """Power spectral density as of `features.signal.spectra.psd`, over ``frequency``."""
        return self._over(
            "power_spectral_density", "frequency", "Hz", "({0})2 Hz-1", lambda x: psd(x, self.fs, segment)
        )

    def envelope_spectrum(self, band: tuple[float, float] = DEFAULT_BAND, *, squared: bool = False) -> xr.DataArray:
        """Amplitude spectrum of the envelope of a band [Hz], or of the squared envelope, over ``frequency``."""
        return self._over(
            "squared_envelope_spectrum" if squared else "envelope_spectrum",
            "frequency",
            "Hz",
            "({0})2" if squared else "{0}",
            lambda x: band_envelope_spectrum(x, self.fs, band, squared=squared),
        )

    def kurtogram(self, narrowest: float = 0.0) -> xr.DataArray:
        """Kurtosis of bands as of `features.signal.kurtogram`, over ``band`` with the coordinates ``low`` and ``high`` [Hz]."""
        # edges of the bands follow from length and rate, not from the samples
        tree = kurtogram(self._probe(), self.fs, narrowest=narrowest)
        found = self._over(
            "kurtosis",
            "band",
            "1",
            "1",
            lambda x: (np.arange(float(len(tree.edges))), kurtogram(x, self.fs, narrowest=narrowest).score),
        )
        edges = {
            name: ("band", edge, {"units": "Hz"}) for name, edge in zip(("low", "high"), tree.edges.T, strict=True)
        }
        return found.assign_coords(edges)

    def spectral_kurtosis(self, segment: float = 0.005) -> xr.DataArray:
        """Spectral kurtosis as of `features.signal.spectral_kurtosis`, over ``frequency``."""
        return self._over(
            "spectral_kurtosis", "frequency", "Hz", "1", lambda x: spectral_kurtosis(x, self.fs, segment=segment)[:2]
        )

    def enhanced_envelope_spectrum(self, highest: float, band: tuple[float, float] | None = None) -> xr.DataArray:
        """Mean squared spectral coherence over all frequencies, or over a band [Hz], up to ``highest`` [Hz]."""

        def compute(x: FloatArray) -> tuple[FloatArray, FloatArray]:
            coherence = spectral_coherence(x, self.fs, highest)
            return coherence.cyclic, enhanced_envelope_spectrum(coherence, band)

        return self._over("enhanced_envelope_spectrum", "cyclic_frequency", "Hz", "1", compute)

    def cepstrum(self) -> xr.DataArray:
        """Real cepstrum over ``quefrency``."""
        return self._over("cepstrum", "quefrency", "s", "1", lambda x: (np.arange(x.shape[1]) / self.fs, cepstrum(x)))

    def velocity(self, high_pass: float = HIGH_PASS) -> xr.DataArray:
        """Velocity from accelerations, as of `features.signal.velocity`."""
        return self._along("velocity", "{0} s", lambda x: velocity(x, self.fs, high_pass))

    def displacement(self, high_pass: float = HIGH_PASS) -> xr.DataArray:
        """Displacement from accelerations, as of `features.signal.displacement`."""
        return self._along("displacement", "{0} s2", lambda x: displacement(x, self.fs, high_pass))

    def order_spectrum(self, angle: xr.DataArray, per_turn: int = 64) -> xr.DataArray:
        """Amplitude spectrum over ``order`` of the signals at equal angles of the shaft; it is never lazy.

        Parameters
        ----------
        angle
            Angle of the shaft at each sample [rad], as of `gen.shaft_angles`.
        per_turn
            Samples per turn of the shaft.
        """
        signals, angles = xr.broadcast(self._signals, angle)
        rows = np.reshape(signals.values, (-1, signals.sizes[TIME]))
        orders, found = order_spectrum(
            resample_to_angle(rows, np.reshape(angles.values, rows.shape), per_turn), per_turn
        )
        others = signals.isel({TIME: 0}, drop=True)
        made = xr.DataArray(found.reshape(*others.shape, -1), dims=(*others.dims, "order"), coords=others.coords)
        return self._described(made.assign_coords(order=("order", orders, {"units": "1"})), "order_spectrum", "{0}")

    def _along(self, name: str, units: str, compute: Callable[[FloatArray], FloatArray]) -> xr.DataArray:
        made = self._over(name, TIME, "s", units, lambda x: (self._signals[TIME].values, compute(x)))
        return made.assign_coords({TIME: self._signals[TIME]}).transpose(*self._signals.dims)

    def _over(self, name: str, axis: str, axis_units: str, units: str, compute: Compute) -> xr.DataArray:
        """Result of a function of arrays (record, time), with a new last dimension."""
        # a short signal tells axis and type, so that a lazy result needs no computation
        along, probed = compute(self._probe())

        def flat(x: FloatArray) -> FloatArray:
            return compute(x.reshape(-1, x.shape[-1]))[1].reshape(*x.shape[:-1], -1)

        made = xr.apply_ufunc(
            flat,
            self._signals,
            input_core_dims=[[TIME]],
            output_core_dims=[[axis]],
            exclude_dims={TIME},
            dask="parallelized",
            output_dtypes=[probed.dtype],
            dask_gufunc_kwargs={"output_sizes": {axis: len(along)}},
        )
        return self._described(made.assign_coords({axis: (axis, along, {"units": axis_units})}), name, units)

    def _described(self, made: xr.DataArray, name: str, units: str) -> xr.DataArray:
        """The result under its own name: name and attributes of the signal do not describe it."""
        units = units.format(self._signals.attrs.get("units", "1"))
        return made.rename(name).drop_attrs(deep=False).assign_attrs(long_name=name.replace("_", " "), units=units)

    def _probe(self) -> FloatArray:
        """One signal of noise, which tells the axis of a result before any record is read."""
        dtype = np.result_type(self._signals.dtype, np.float32)
        return np.random.default_rng(0).standard_normal((1, self._signals.sizes[TIME])).astype(dtype)
