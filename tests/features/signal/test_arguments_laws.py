"""All public functions of `features.signal` take the same arrays, and refuse the same ones in one sentence."""

import inspect
import re
from typing import Any, cast

import numpy as np
import pytest
import xarray as xr

from features import signal
from features.signal.arguments import as_numbers, as_records

FS, PER_TURN = 12_000.0, 32
SAMPLES = 12_000
TIME = np.arange(SAMPLES) / FS


def _records() -> np.ndarray:
    """Two records of shaft harmonics and noise, whole numbers within the range of all types that are tried."""
    rng = np.random.default_rng(3)
    shaft = sum(np.cos(2 * np.pi * 20 * k * TIME + k) for k in range(1, 6))
    return np.round(20 * shaft + 15 * rng.standard_normal((2, SAMPLES)))


X = _records()
RATES = np.array([87.0, 93.5])

CALLS: dict[str, tuple[np.ndarray, Any]] = {
    "angles_from_speed": (20 + X[:, :2000] % 5, lambda x: signal.angles_from_speed(x, FS)),
    "angles_from_tacho": (np.where(TIME % 0.05 < 0.01, 5.0, 0.0) * np.ones((2, 1)), signal.angles_from_tacho),
    "band_envelope_spectrum": (X, lambda x: signal.band_envelope_spectrum(x, FS, (300, 5000))),
    "cepstrum": (X, signal.cepstrum),
    "comb_bands": (X, lambda x: signal.comb_bands(x, FS, RATES[:1])),
    "kurtogram": (X, lambda x: signal.kurtogram(x, FS)),
    "order_map": (X, lambda y: signal.order_map(y, PER_TURN)),
    "order_spectrum": (X, lambda y: signal.order_spectrum(y, PER_TURN)),
    "psd": (X, lambda x: signal.psd(x, FS)),
    "resample_to_angle": (X, lambda x: signal.resample_to_angle(x, 2 * np.pi * 20 * TIME, PER_TURN)),
    "spectral_coherence": (X, lambda x: signal.spectral_coherence(x, FS, 200.0)),
    "track_speed": (X, lambda x: signal.track_speed(x, FS, 16.0, 25.0)),
    "velocity_rms": (X, lambda x: signal.velocity_rms(x, FS, RATES[:1])),
}
"""An array of each function, and a call of it."""

NO_SIGNALS = {"enhanced_envelope_spectrum", "whiten_cepstrally"}  # take a coherence and coefficients, tested below

FORMS = {
    "int16": lambda x: x.astype(np.int16),
    "int32": lambda x: x.astype(np.int32),
    "float16": lambda x: x.astype(np.float16),
    "float32": lambda x: x.astype(np.float32),
    "big-endian": lambda x: x.astype(">f8"),
    "Fortran order": np.asfortranarray,
    "read-only": lambda x: _read_only(x),
    "every other sample": lambda x: np.repeat(x, 2, axis=-1)[..., ::2],
    "list": lambda x: x.tolist(),
    "DataArray": lambda x: xr.DataArray(x),
    "masked array without masked values": np.ma.masked_array,
}


SINGLE = {"int16", "float16", "float32"}
COMPUTED = {"int16", "list"}  # of each function, in single and in double precision


def _read_only(x: np.ndarray) -> np.ndarray:
    x = x.copy()
    x.flags.writeable = False
    return x


def _arrays(result: Any) -> list[np.ndarray]:
    return [part for one in result for part in _arrays(one)] if isinstance(result, tuple) else [np.asarray(result)]


def _assert_equal(result: Any, expected: Any, *, single: bool = False) -> None:
    """Equal results, in single precision within its rounding."""
    for found, wanted in zip(_arrays(result), _arrays(expected), strict=True):
        if single and wanted.dtype.kind == "f":
            largest = np.abs(wanted).max(initial=0.0, where=np.isfinite(wanted))
            np.testing.assert_allclose(found, wanted, rtol=1e-4, atol=1e-5 * largest)
        else:
            np.testing.assert_array_equal(found, wanted)


def test_every_public_function_is_tried_here():
    functions = {name for name in dir(signal) if inspect.isfunction(getattr(signal, name))}
    assert functions == {*CALLS, *NO_SIGNALS}


@pytest.mark.parametrize("form", FORMS)
def test_records_of_all_types_and_layouts_are_taken_as_the_same_array(form):
    given = FORMS[form](X)
    taken = as_records(given)
    assert taken.dtype == (np.float32 if form in SINGLE else np.float64)
    assert taken.flags.c_contiguous
    assert taken.flags.writeable
    np.testing.assert_array_equal(taken, X)
    np.testing.assert_array_equal(as_numbers(given, "x"), X)


@pytest.mark.parametrize("name", CALLS)
def test_all_types_of_an_array_give_the_same_result(name):
    x, call = CALLS[name]
    expected = call(x)
    for form in COMPUTED:
        _assert_equal(call(FORMS[form](x)), expected, single=form in SINGLE)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("name", CALLS)
def test_one_record_gives_its_row_of_the_results_in_its_precision(name, dtype):
    x, call = CALLS[name]
    x = x.astype(dtype)
    both = call(x)
    _assert_equal(call(x[0]), _first_row(call(x[:1]), both))


def _first_row(single: Any, both: Any) -> Any:
    """Result of one row without the axis of records, which is the axis along which two rows are more."""
    if isinstance(single, tuple):
        return tuple(map(_first_row, single, both))
    return single[0] if np.shape(single) != np.shape(both) else single


REFUSED = {
    "masked": (lambda x: np.ma.masked_array(x, x == x[0, 0]), "values are masked"),
    "complex": (lambda x: x + 1j, "in place of real numbers"),
    "NaN": (lambda x: np.where(np.arange(x.shape[-1]) == 5, np.nan, x), "not finite, the first at [0, 5]"),
    "infinite": (lambda x: np.where(np.arange(x.shape[-1]) == 5, np.inf, x), "not finite, the first at [0, 5]"),
    "text": (lambda x: x.astype(str), "in place of real numbers"),
    "objects": (lambda x: x.astype(object), "in place of real numbers"),
    "ragged": (lambda _: [[1.0, 2.0], [1.0]], "no array of real numbers"),
    "nothing": (lambda _: None, "in place of real numbers"),
}
SHAPES_REFUSED = {
    "three axes": lambda x: x[:, None],
    "a number": lambda _: 1.0,
    "no record": lambda x: x[:0],
    "no sample": lambda x: x[:, :0],
    "time before channels": lambda x: x.T,
}


@pytest.mark.parametrize("name", CALLS)
def test_arrays_without_meaning_are_refused_in_one_sentence(name):
    x, call = CALLS[name]
    cases = REFUSED | {what: (make, "in place of (record, time)") for what, make in SHAPES_REFUSED.items()}
    for make, told in cases.values():
        with pytest.raises(ValueError, match=re.escape(told)) as refusal:
            call(make(x))
        assert "\n" not in str(refusal.value)


POSITIVE = (0, -1.0, np.nan, np.inf, "12000", None, [1.0, 2.0], 1 + 0j)
WHOLE = (0, -3, 1.5, np.nan, "3", None, [3, 4])
RATES_REFUSED = (0.0, [87.0, -1.0], [87.0, 88.0, 89.0], np.nan, None, "87", [[87.0, 88.0]])
PROBABILITIES_REFUSED = (0, 1, -0.1, np.nan, "0.1")
BANDS_REFUSED = (300, (300,), (5000, 300), (-1, 300), (np.nan, 300), ("a", "b"), (300, 300))
PARAMETERS = {
    **dict.fromkeys(("fs", "segment", "highest", "resolution", "slowest", "fastest"), POSITIVE),
    **dict.fromkeys(("per_turn", "turns", "pulses_per_turn"), WHOLE),
    **dict.fromkeys(("rate", "shaft_rate"), RATES_REFUSED),
    "narrowest": (np.nan, np.inf, "0", None),
    "threshold": (np.nan, "1", [1.0, 2.0]),
    "band": (None, *BANDS_REFUSED),
}
"""Values without meaning of each parameter that is no array and no switch."""
ARRAYS = {"x": X, "y": X, "tacho": X, "angle": 2 * np.pi * 20 * TIME}
GIVEN = ARRAYS | {
    "segment": 0.1, "fs": FS, "rate": 90.0,
    "highest": 200.0, "resolution": 200.0, "per_turn": PER_TURN, "turns": 2, "pulses_per_turn": 1, "threshold": 2.0,
    "slowest": 16.0, "fastest": 25.0, "narrowest": 0.0, "band": (300.0, 5000.0), "shaft_rate": 20 + 0 * X,
}  # fmt: skip


@pytest.mark.parametrize("name", CALLS)
def test_parameters_without_meaning_are_refused_by_name(name):
    function = getattr(signal, name)
    parameters = [parameter for parameter in inspect.signature(function).parameters if parameter != "squared"]
    needed = {parameter: GIVEN[parameter] for parameter in parameters}
    if name == "velocity_rms":
        needed["shaft_rate"] = 30.0
    for parameter in parameters:
        if parameter not in ARRAYS:
            for wrong in PARAMETERS[parameter]:
                with pytest.raises(ValueError, match=rf"^{parameter}\b") as refusal:
                    function(**{**needed, parameter: wrong})
                assert "\n" not in str(refusal.value)


def test_parameters_beyond_the_record_end_with_it():
    for endless in (np.inf, 1e300):
        band = signal.band_envelope_spectrum(X, FS, (300.0, endless))
        np.testing.assert_array_equal(band[1], signal.band_envelope_spectrum(X, FS, (300.0, FS / 2))[1])
    np.testing.assert_array_equal(signal.psd(X, FS, 1e305)[1], signal.psd(X, FS, X.shape[1] / FS)[1])
    assert signal.order_map(X, 1, 1).amplitude.shape[1] == X.shape[1]


def test_results_of_one_record_serve_the_functions_that_take_them():
    coherence = signal.spectral_coherence(X[0], FS, 200.0)
    both = signal.spectral_coherence(X, FS, 200.0)
    one = signal.enhanced_envelope_spectrum(coherence, (300, 5000))
    np.testing.assert_array_equal(one, signal.enhanced_envelope_spectrum(both, (300, 5000))[0])
    assert signal.kurtogram(X[0], FS).best().shape == (2,)
    with pytest.raises(TypeError, match="give the Coherence"):
        signal.enhanced_envelope_spectrum(cast("Any", X))
    for wrong in PROBABILITIES_REFUSED:
        with pytest.raises(ValueError, match=r"^probability"):
            coherence.threshold(wrong)
    for wrong in BANDS_REFUSED:
        with pytest.raises(ValueError, match=r"^band"):
            coherence.envelope_threshold(0.1, wrong)


def test_coefficients_are_complex():
    coefficients = np.fft.rfft(X, axis=-1)
    np.testing.assert_array_equal(signal.whiten_cepstrally(coefficients[0]), signal.whiten_cepstrally(coefficients)[0])
    with pytest.raises(ValueError, match=r"^coefficients: give finite complex numbers"):
        signal.whiten_cepstrally(X)


def test_angles_suit_the_records():
    angle = 2 * np.pi * 20 * TIME
    together = signal.resample_to_angle(X, angle[None], PER_TURN)
    np.testing.assert_array_equal(signal.resample_to_angle(X, np.stack([angle, angle]), PER_TURN), together)
    with pytest.raises(ValueError, match=r"^angle: an array of shape"):
        signal.resample_to_angle(X, angle[:-1], PER_TURN)
    with pytest.raises(ValueError, match=r"^angle: an array of shape"):
        signal.resample_to_angle(X, np.stack([angle, angle, angle]), PER_TURN)
