"""Laws of the features: invariances, the effects of faults, and NaN for records that cannot be evaluated."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from features.signal.lines import FAMILIES
from features.table.definitions import GROUPS, define_features
from features.table.indicators import Orders, feature_names, indicators

law = settings(max_examples=12)
seeds = st.integers(0, 2**32 - 1)
FTF, BPFO, BPFI, BSF = 0.3983, 3.5848, 5.4152, 2.3567
TRANSFER = ("lines", "shape")


def orders(records):
    return Orders(*(np.full(records, order) for order in (FTF, BPFO, BPFI, BSF)))


def features(x, fs, shaft_rate, groups=GROUPS):
    rates = np.broadcast_to(np.asarray(shaft_rate, float), len(x)).copy()
    return indicators(x, fs, rates, orders(len(x)), groups)[0]


def noise(seed, records=4, n=6000):
    return np.random.default_rng(seed).standard_normal((records, n))


def named(values, groups=GROUPS):
    return dict(zip(feature_names(groups), values.T, strict=True))


@cache
def impulse_train(order, shaft_rate, fs=12_000, duration=0.5, seed=0):
    """Impulse responses of a 3 kHz resonance at a fault order, in white noise, shape (1, time)."""
    t = np.arange(round(duration * fs)) / fs
    since = np.mod(t + 0.003, 1 / (order * shaft_rate))
    impulses = np.exp(-800 * since) * np.sin(2 * np.pi * 3000 * since)
    return (impulses + 0.05 * noise(seed, 1, len(t))[0])[None]


def test_groups_are_returned_in_the_requested_order_with_the_same_values():
    x = noise(0)
    whole, names = indicators(x, 12_000.0, np.full(4, 30.0), orders(4))
    for groups in (("time",), ("shape", "lines"), ("bands", "shape")):
        values, returned = indicators(x, 12_000.0, np.full(4, 30.0), orders(4), groups)
        assert returned == feature_names(groups)
        np.testing.assert_array_equal(values, whole[:, [names.index(name) for name in returned]])


@pytest.mark.parametrize("groups", [("colour",), "lines"])
def test_a_group_that_does_not_exist_is_refused_by_name(groups):
    with pytest.raises(ValueError, match="choose from lines, shape, bands, time"):
        feature_names(groups)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"orders": "6212"}, "^orders: '6212' is given in place of ftf, bpfo, bpfi and bsf"),
        ({"orders": 3.58}, "^orders: 3.58 is given in place of ftf, bpfo, bpfi and bsf"),
        ({"orders": (FTF, BPFO, BPFI)}, "^orders: .* is given in place of ftf, bpfo, bpfi and bsf"),
        ({"orders": (FTF, BPFO, BPFI, "x")}, "^orders: 'x' is given in place of a number"),
        ({"shaft_rate": np.ones(3)}, r"^shaft_rate: an array of shape \(3,\) is given .* each of 4 records"),
        ({"x": noise(0)[0]}, r"^x: an array of shape \(6000,\) is given in place of \(record, time\)"),
        ({"band": (300, 400)}, "^band: 300-400 Hz is not allowed"),
    ],
)
def test_arguments_of_another_form_are_refused_by_name(wrong, said):
    arguments = {"x": noise(0), "fs": 12_000.0, "shaft_rate": 30.0, "orders": orders(4), "band": (300, 4000)}
    assert indicators(**arguments)[0].shape[0] == 4
    with pytest.raises(ValueError, match=said):
        indicators(**arguments | wrong)


@law
@given(seeds, st.floats(1e-4, 1e4))
def test_lines_and_shape_do_not_depend_on_gain(seed, gain):
    x = noise(seed)
    once, again = features(x, 12_000.0, 30.0, TRANSFER), features(gain * x, 12_000.0, 30.0, TRANSFER)
    np.testing.assert_allclose(again, once, rtol=1e-3, atol=1e-3)


@law
@given(seeds, st.floats(-20, 20))
def test_no_feature_depends_on_a_constant_offset(seed, offset):
    x = noise(seed)
    np.testing.assert_allclose(features(x + offset, 12_000.0, 30.0), features(x, 12_000.0, 30.0), rtol=1e-3, atol=1e-3)


@law
@given(seeds, st.sampled_from([24_000, 48_000, 96_000]))
def test_lines_and_shape_do_not_depend_on_the_sample_rate(seed, fs):
    rng = np.random.default_rng(seed)
    coefficients = np.zeros((2, 3001), complex)
    coefficients[:, 1:2500] = rng.standard_normal((2, 2499)) + 1j * rng.standard_normal((2, 2499))
    slow = np.fft.irfft(coefficients, 6000, norm="forward")
    fast = np.fft.irfft(coefficients, fs // 2, norm="forward")
    np.testing.assert_allclose(
        features(slow, 12_000.0, 30.0, TRANSFER), features(fast, fs, 30.0, TRANSFER), rtol=5e-3, atol=5e-3
    )


@law
@given(seeds, st.floats(6000.0, 11_000.0))
def test_frequencies_above_5_khz_do_not_change_lines_and_shape(seed, tone):
    x = noise(seed, n=12_000)
    loud = x + np.sin(2 * np.pi * tone * np.arange(12_000) / 24_000)
    np.testing.assert_allclose(
        features(loud, 24_000.0, 30.0, TRANSFER), features(x, 24_000.0, 30.0, TRANSFER), atol=0.02
    )


@law
@given(seeds, st.integers(1, 40), st.sampled_from([(6000, 12_000.0), (6103, 12_207.0), (50_000, 12_800.0)]))
def test_a_record_does_not_depend_on_the_batch_it_is_in(seed, records, size):
    n, fs = size
    x = noise(seed, min(records, 200_000 // n), n)
    rates = np.random.default_rng(seed).uniform(9.0, 60.0, len(x))
    together = features(x, fs, rates)
    last = features(x[-1:], fs, rates[-1:])
    np.testing.assert_array_equal(together[-1:], last)


@law
@given(st.sampled_from(FAMILIES), st.floats(15.0, 50.0), st.floats(-0.015, 0.015), st.integers(0, 99))
def test_the_comb_of_a_simulated_fault_is_the_highest_for_every_error_of_the_speed_label(family, rate, error, seed):
    """The comb is also higher than any comb of noise.

    The lines of an envelope become weaker towards the width of its band, above which it has none. So in bands of 1 kHz a comb decreases as
    its third harmonic rises from 600 to 800 Hz; in the broad band the decrease is small. Only one narrow band contains the resonance, and
    the mean is over all narrow bands.
    """
    order = {"bpfo": BPFO, "bpfi": BPFI, "2bsf": 2 * BSF}[family]
    values = named(features(impulse_train(order, rate, seed=seed), 12_000.0, rate * (1 + error)))
    within = 3 * order * rate < 600
    least = {"whitened": 1.5, "bands_max": 1.3 if within else 0.8, "bands_mean": 1.3 if within else 0.8}
    for view in least:  # cepstral whitening flattens a train without jitter
        combs = {name: values[f"{view}_{name}_comb"][0] for name in FAMILIES}
        assert max(combs, key=combs.__getitem__) == family
        assert combs[family] > least[view]


def test_a_load_that_varies_once_per_cage_revolution_gives_a_slow_fluctuation():
    t = np.arange(12_000) / 12_000
    x = noise(1, n=12_000)
    constant = named(features(x, 12_000.0, 30.0))
    varying = named(features(x * (1 + 0.7 * np.cos(2 * np.pi * FTF * 30.0 * t)), 12_000.0, 30.0))
    for name in ("whitened_slow_fluctuation", "whitened_slow_share", "whitened_ftf"):
        assert (varying[name] > 1.5 * constant[name]).all(), name


@law
@given(seeds, st.floats(0.1, 10.0))
def test_log_energies_rise_by_twice_the_logarithm_of_the_gain(seed, gain):
    x = noise(seed)
    rise = features(gain * x, 12_000.0, 30.0, ("bands",)) - features(x, 12_000.0, 30.0, ("bands",))
    np.testing.assert_allclose(rise, 2 * np.log(gain), atol=1e-6)


@pytest.mark.parametrize("spoil", [np.nan, np.inf, -np.inf, "constant", "silent"])
def test_a_record_without_a_usable_signal_has_nan_and_the_others_do_not_change(spoil):
    x = noise(3)
    good = features(x, 12_000.0, 30.0)
    if isinstance(spoil, str):
        x[1] = {"constant": 0.1, "silent": 0.0}[spoil]
    else:
        x[1, 17] = spoil
    values = features(x, 12_000.0, 30.0)
    assert np.isnan(values[1]).all()
    np.testing.assert_array_equal(np.delete(values, 1, axis=0), np.delete(good, 1, axis=0))


@pytest.mark.parametrize("rate", [np.nan, 0.0, -30.0, np.inf])
def test_a_record_of_unknown_speed_has_nan(rate):
    values = features(noise(3), 12_000.0, [30.0, rate, 30.0, 30.0])
    np.testing.assert_array_equal(np.isnan(values).all(axis=1), [False, True, False, False])


def test_a_record_of_less_than_two_revolutions_has_no_lines_and_no_shape_but_statistics():
    values = named(features(noise(3), 12_000.0, [30.0, 3.0, 30.0, 30.0]))
    for feature in define_features():
        assert np.isnan(values[feature.name][1]) == (feature.group in TRANSFER)
        assert np.isfinite(values[feature.name][[0, 2, 3]]).all()


@law
@given(st.floats(9.0, 60.0), st.floats(0, 2 * np.pi))
def test_a_strong_tone_at_the_shaft_rate_does_not_change_the_impulsiveness(rate, phase):
    x = noise(1)
    tone = 50 * np.sin(2 * np.pi * rate * np.arange(6000) / 12_000 + phase)
    without, with_tone = named(features(x, 12_000.0, rate)), named(features(x + tone, 12_000.0, rate))
    for view in ("cepstral", "whitened", "bands_max", "bands_mean"):
        name = f"{view}_impulsiveness"
        np.testing.assert_allclose(with_tone[name], without[name], atol=0.05)
