"""The accessor gives what the pure functions give, with coordinates and units, lazily for lazy signals."""

import dask
import numpy as np
import pytest
import xarray as xr

import features.accessor  # noqa: F401
from features.signal import kurtogram, order_spectrum, psd, resample_to_angle, velocity

FS = 6000.0
SIGNAL = {"units": "m s-2", "long_name": "acceleration of the sensor", "role": "signal"}
METHODS = {
    "psd": {},
    "envelope_spectrum": {"band": (300.0, 2500.0)},
    "kurtogram": {},
    "spectral_kurtosis": {},
    "enhanced_envelope_spectrum": {"highest": 200.0},
    "cepstrum": {},
    "velocity": {},
    "displacement": {},
}


@pytest.fixture(scope="module")
def signals():
    x = np.random.default_rng(0).standard_normal((4, 2, 6000)).astype(np.float32)
    coords = {"channel": ["a", "b"], "fault": ("record", [0, 1, 2, 3]), "elapsed_time": np.arange(6000) / FS}
    return xr.DataArray(x, dims=("record", "channel", "elapsed_time"), coords=coords, attrs=SIGNAL, name="acceleration")


def rows(signals):
    return signals.values.reshape(-1, signals.shape[-1])


@pytest.mark.parametrize("method", METHODS)
def test_a_lazy_signal_gives_the_same_result_computed_when_it_is_needed(signals, method):
    direct = getattr(signals.raceway, method)(**METHODS[method])
    lazy = getattr(signals.chunk({"record": 2}).raceway, method)(**METHODS[method])
    assert dask.is_dask_collection(lazy)
    xr.testing.assert_allclose(
        lazy.compute(), direct, rtol=1e-4, atol=1e-5
    )  # transforms differ by rounding with the batch
    assert lazy.attrs == direct.attrs
    assert direct.dims[:2] == ("record", "channel")
    assert list(direct.fault.values) == [0, 1, 2, 3]
    assert direct.attrs.keys() == {"units", "long_name"}
    assert direct.name != "acceleration"
    assert direct.attrs["long_name"] == direct.name.replace("_", " ")
    assert np.isfinite(direct).all()


def test_values_and_units_are_those_of_the_pure_functions(signals):
    frequencies, density = psd(rows(signals), FS)
    found = signals.raceway.psd()
    np.testing.assert_array_equal(found.values.reshape(8, -1), density)
    np.testing.assert_array_equal(found.frequency, frequencies)
    assert (found.attrs["units"], found.frequency.attrs["units"]) == ("(m s-2)2 Hz-1", "Hz")
    np.testing.assert_array_equal(signals.raceway.velocity().values.reshape(8, -1), velocity(rows(signals), FS))
    tree = kurtogram(rows(signals), FS)
    np.testing.assert_array_equal(signals.raceway.kurtogram().high, tree.edges[:, 1])
    assert signals.raceway.kurtogram().name == "kurtosis"


def test_orders_follow_the_angle_of_each_record(signals):
    rate = xr.DataArray(np.linspace(20, 30, 4), dims="record")
    angle = 2 * np.pi * rate * signals.elapsed_time
    found = signals.raceway.order_spectrum(angle, per_turn=32)
    of_rows = np.repeat(angle.transpose("record", "elapsed_time").values, 2, axis=0)
    orders, spectrum = order_spectrum(resample_to_angle(rows(signals), of_rows, 32), 32)
    np.testing.assert_allclose(found.transpose("record", "channel", "order").values.reshape(8, -1), spectrum, rtol=1e-5)
    np.testing.assert_array_equal(found.order, orders)


def test_an_array_without_time_is_refused_in_one_sentence():
    with pytest.raises(ValueError, match="needs signals with a coordinate elapsed_time"):
        xr.DataArray(np.zeros(3), dims="record").raceway.psd()
