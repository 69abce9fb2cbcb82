"""Shaft speeds in the feature table: one estimate per recording, wherever its records lie, and features at that speed."""

import numpy as np
import pytest
import xarray as xr

from features import feature_table, shaft_speed
from features.table.recording_speeds import (
    BY,
    ESTIMATE,
    UNCERTAINTY,
    other_speed,
    rates_to_use,
    speed_warnings,
)
from gen.corpus import FAULTS, Variable, open_corpus
from tests.corpora import write_records
from tests.pulses import LINES, ORDERS, pulse_train

FS, SECONDS, WINDOWS = 12_000.0, 0.4, 5
SPEEDS = {
    "healthy": (25.0, 25.0),
    "inner": (25.0, 26.2),
    "outer": (25.0, 25.1),
    "ball": (26.0, 24.5),
}  # labelled and true
TRUTH = Variable("true_shaft_rate", "f8", "Hz", "latent", "mean shaft rate")
GROUPS = ("lines",)


def write_machines(folder, *, per_part=7, extra=(), spoiled=(), speeds=None):
    """Write one recording of each class, cut into windows that follow each other through parts of ``per_part`` records."""
    rng = np.random.default_rng(0)
    speeds = SPEEDS if speeds is None else speeds
    signal, rows = [], []
    for number, (fault, (label, true)) in enumerate(speeds.items()):
        line = LINES[fault.split()[0]]
        whole = pulse_train(FS, WINDOWS * SECONDS, None if line is None else line * true, 3000.0, rng)
        time = np.arange(len(whole)) / FS
        whole += sum(0.3 * np.cos(2 * np.pi * k * true * time) / k for k in range(1, 7))
        for window in whole.reshape(WINDOWS, -1):
            known = {"shaft_rate": label, "sample_rate": FS, "specimen": number, "recording": number, **ORDERS}
            known |= {"fault": FAULTS.index(fault.split()[0])} | ({"true_shaft_rate": true} if extra else {})
            rows.append(known | dict.fromkeys(("bearing", "source", "identity"), f"{fault}.csv"))
            signal.append(window)
    for number in spoiled:
        signal[number] = np.zeros_like(signal[number])
    columns = {name: [row[name] for row in rows] for name in rows[0]}
    return write_records(folder, signal, FS, columns, title="machines", per_part=per_part, extra=extra)


@pytest.fixture(scope="module", autouse=True)
def small_blocks():
    """Several blocks of a small corpus."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("gen.corpus.lazy._BLOCK_RECORDS", 7)
        yield


@pytest.fixture(scope="module")
def corpus(tmp_path_factory):
    return write_machines(tmp_path_factory.mktemp("machines") / "corpus")


@pytest.fixture(scope="module")
def checked(corpus):
    return feature_table(corpus, GROUPS, speed="check")


@pytest.fixture(scope="module")
def corrected(corpus):
    return feature_table(corpus, GROUPS, speed="correct")


def test_wrong_labels_are_found_and_right_ones_stand(checked):
    true = np.repeat([true for _, true in SPEEDS.values()], WINDOWS)
    clear = checked[BY].values > 0
    assert clear[np.isin(checked["fault"].values, [1, 2])].all()
    np.testing.assert_array_less(np.abs(checked[ESTIMATE].values - true)[clear], 2 * checked[UNCERTAINTY].values[clear])
    assert checked.attrs["recordings_with_other_speed"] == 2


def test_check_leaves_the_features_as_they_are(corpus, checked):
    plain = feature_table(corpus, GROUPS)
    xr.testing.assert_identical(checked["features"], plain["features"])
    assert not {ESTIMATE, UNCERTAINTY, BY} & set(plain.variables)
    assert "speed" not in plain.attrs


def test_correct_computes_the_features_at_the_found_speed_where_it_is_clear(checked, corrected, tmp_path):
    found = {fault: float(rate) for fault, rate in zip(SPEEDS, corrected[ESTIMATE].values[::WINDOWS], strict=True)}
    clear = dict(zip(SPEEDS, corrected[BY].values[::WINDOWS] > 0, strict=True))
    speeds = {fault: (found[fault] if clear[fault] else label, true) for fault, (label, true) in SPEEDS.items()}
    relabelled = write_machines(tmp_path / "relabelled", speeds=speeds)
    np.testing.assert_allclose(corrected["features"], feature_table(relabelled, GROUPS)["features"], atol=1e-6)
    inner = corrected["fault"].values == FAULTS.index("inner")
    comb = {"feature": "whitened_bpfi_comb"}
    assert (corrected["features"].sel(comb) > checked["features"].sel(comb) + 0.5).values[inner].all()


@pytest.mark.parametrize("per_part", [3, 20])
def test_windows_of_one_recording_share_one_estimate_however_the_parts_are_cut(checked, tmp_path, per_part):
    other = feature_table(write_machines(tmp_path / "other", per_part=per_part), GROUPS, speed="check")
    for name in (ESTIMATE, UNCERTAINTY, BY):
        assert (np.unique(checked[name].values.reshape(-1, WINDOWS), axis=1).shape[1]) == 1
        np.testing.assert_allclose(other[name], checked[name], rtol=1e-9)


def test_the_estimate_of_a_recording_is_that_of_shaft_speed(corpus, checked):
    with open_corpus(corpus) as opened:
        x = opened["acceleration"].values[WINDOWS : 2 * WINDOWS, 0]
    found = shaft_speed(x, FS, 25.0, tuple(ORDERS.values()))
    assert found.rate == pytest.approx(checked[ESTIMATE].values[WINDOWS])
    assert found.uncertainty == pytest.approx(checked[UNCERTAINTY].values[WINDOWS])


@pytest.mark.usefixtures("started_processes")
def test_two_workers_give_the_same_table(corpus, corrected):
    done = []
    parallel = feature_table(corpus, GROUPS, speed="correct", workers=2, progress=lambda *counts: done.append(counts))
    xr.testing.assert_identical(parallel, corrected)
    assert done == [(number, 6) for number in range(1, 7)]  # three parts, twice


def test_windows_without_a_signal_are_left_out_and_a_recording_without_any_has_no_rate(tmp_path):
    one, all_of_healthy = WINDOWS + 1, range(WINDOWS)
    table = feature_table(write_machines(tmp_path / "spoiled", spoiled=(one, *all_of_healthy)), GROUPS, speed="correct")
    assert np.isnan(table[ESTIMATE].values[:WINDOWS]).all()
    assert (table[BY].values[:WINDOWS] == 0).all()
    assert table[ESTIMATE].values[one] == pytest.approx(26.2, rel=0.01)


def test_simulated_corpora_are_corrected_on_request_and_never_checked(tmp_path):
    simulated = write_machines(tmp_path / "simulated", extra=(TRUTH,))
    assert ESTIMATE not in feature_table(simulated, GROUPS, speed="check")
    assert ESTIMATE in feature_table(simulated, GROUPS, speed="correct")


def test_a_warning_names_the_recording_both_speeds_and_the_lines(checked, corrected):
    inner, ball = speed_warnings(checked)
    assert inner.startswith("inner.csv: labelled 1500 rpm, but its BPFI lines fit 15")
    assert ball.startswith("ball.csv: labelled 1560 rpm, but its shaft harmonics fit 14")
    assert inner.endswith("%); check the label and the bearing, or use the speed 'correct'.")
    assert speed_warnings(corrected)[0].endswith("%); its features use the estimated speed.")


def test_only_a_clear_speed_contradicts_the_label():
    found = {"shaft_rate": [25.0, 25.0, 25.0], ESTIMATE: [26.0, 26.0, 25.1], UNCERTAINTY: [0.2] * 3, BY: [0, 2, 2]}
    table = xr.Dataset({name: ("record", np.array(values)) for name, values in found.items()})
    assert other_speed(table).tolist() == [False, True, False]
    assert rates_to_use(table.assign_attrs(speed="check")).tolist() == [25.0, 25.0, 25.0]
    assert rates_to_use(table.assign_attrs(speed="correct")).tolist() == [25.0, 26.0, 25.1]
