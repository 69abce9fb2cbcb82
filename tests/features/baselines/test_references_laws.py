"""Laws of healthy references: what a record is compared with, and that no tested record belongs to its reference."""

import numpy as np
import pytest
import xarray as xr
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st

from features.baselines import Model, predict
from features.baselines.reference_choice import check_durations, choose_reference
from features.baselines.references import ENERGIES, NEAREST, SAME_SPEED, relative_names, relative_to, virtual_references
from features.table.class_features import EVIDENCE
from features.table.indicators import Orders
from features.table.recording_features import recording_table
from features.table.recording_speeds import recording_numbers
from gen.corpus import UNKNOWN_CODE, open_corpus
from gen.support.errors import CorpusError
from raceway.cli import cli
from raceway.commands import model_commands
from tests.tone_corpora import write_corpus

pytestmark = pytest.mark.usefixtures("few_trees")

LINES = (*EVIDENCE, "raw_kurtosis")
ORDERS = Orders(ftf=0.4, bpfo=3.58, bpfi=5.42, bsf=2.36)


def make_table(rigs: int = 8, *, healthy: int = 2, own: float = 3.0, seed: int = 0) -> xr.Dataset:
    """Feature table of rigs whose features differ by ``own``, each with healthy, inner and outer specimens of two recordings.

    A fault moves the features of a record by less than the rig does.
    """
    rng = np.random.default_rng(seed)
    kinds = np.tile([0] * healthy + [1, 2], rigs)
    fault, rig = np.repeat(kinds, 2), np.repeat(np.arange(rigs), 2 * (healthy + 2))
    count, names = len(fault), (*LINES, *ENERGIES)
    of_rig = own * rng.standard_normal((rigs, len(names)))
    features = of_rig[rig] + 0.1 * rng.standard_normal((count, len(names)))
    features[:, : len(LINES)] += 1.0 * fault[:, None] * np.linspace(-1, 1, len(LINES))
    known = {
        "fault": fault.astype(np.int8),
        "rig": rig,
        "specimen": np.arange(count) // 2,
        "recording": np.arange(count),
        "shaft_rate": rng.uniform(10, 50, count),
        "sample_rate": np.full(count, 12_000.0),
    }
    groups = ["lines"] * (len(LINES) - 1) + ["shape"] + ["bands"] * len(ENERGIES)
    return xr.Dataset(
        {"features": (("record", "feature"), features), **{name: ("record", held) for name, held in known.items()}},
        {"feature": np.array(names, dtype=object), "group": ("feature", np.array(groups, dtype=object))},
        {"title": "a made-up corpus"},
    )


@pytest.fixture(scope="module")
def table():
    return make_table()


@pytest.fixture(scope="module")
def model(table, few_trees):  # noqa: ARG001
    return Model().fit(table)


def lines_of(table: xr.Dataset) -> np.ndarray:
    """Values of the lines, shape (record, line)."""
    return table["features"].values[:, : len(LINES)]


def changes(table: xr.Dataset, reference: xr.Dataset) -> np.ndarray:
    """Changes of the lines from a reference, shape (record, line)."""
    return relative_to(table, reference, LINES)["features"].values[:, len(LINES) : 2 * len(LINES)]


def healthy_of_rig(table: xr.Dataset, row: int) -> np.ndarray:
    """Numbers of the healthy records of the rig of a record."""
    return np.flatnonzero((table["fault"].values == 0) & (table["rig"].values == table["rig"].values[row]))


def test_a_record_that_is_its_own_reference_has_no_change(table):
    for record in (0, 1):
        alone = table.isel(record=[record])
        assert not relative_to(alone, alone, LINES)["features"].values[:, len(LINES) :].any()


@given(gain=st.floats(1e-3, 1e3), seed=st.integers(0, 99))
@settings(max_examples=10)
def test_gains_of_record_and_reference_have_no_effect(gain, seed):
    x = np.random.default_rng(seed).standard_normal((4, 6000))
    one = np.array([[gain], [1.0]])  # of the first of two records alone
    found = [
        relative_to(*(recording_table(signal, 12_000.0, 25.0, ORDERS, UNKNOWN_CODE) for signal in pair), LINES)
        for pair in ((x[:2], x[2:]), (one * x[:2], x[2:]), (x[:2], gain * x[2:]))
    ]
    assert np.ptp(found[0]["features"].values[:, -len(ENERGIES) :], axis=1).min() > 0
    for other in found[1:]:  # lines are computed in single precision
        np.testing.assert_allclose(other["features"].values, found[0]["features"].values, atol=1e-4)


def test_the_order_of_records_and_references_has_no_effect(table):
    order = np.random.default_rng(1).permutation(table.sizes["record"])
    mixed = table.isel(record=order)
    first = relative_to(table, table, LINES)["features"].values
    np.testing.assert_array_equal(relative_to(table, mixed, LINES)["features"].values, first)
    np.testing.assert_array_equal(relative_to(mixed, table, LINES)["features"].values, first[order])
    pairs = {tuple(table["recording"].values[pair]) for pair in np.transpose(virtual_references(table, LINES, 3))}
    others = {tuple(mixed["recording"].values[pair]) for pair in np.transpose(virtual_references(mixed, LINES, 3))}
    assert others == pairs
    assert {tuple(pair) for pair in np.transpose(virtual_references(table, LINES, 4))} != pairs


@pytest.mark.parametrize("records_each", [1, 2])
def test_a_virtual_reference_is_one_of_the_nearest_healthy_recordings_of_the_same_rig(table, records_each):
    cut = np.arange(table.sizes["record"]) // records_each
    table = table.assign(recording=("record", cut), shaft_rate=("record", table["shaft_rate"].values[cut]))
    records, references = virtual_references(table, LINES, 0)
    assert records.tolist() == list(range(table.sizes["record"]))
    rig, speed, recording = table["rig"].values, np.log(table["shaft_rate"].values), recording_numbers(table)
    for record, reference in zip(records, references, strict=True):
        known = (rig == rig[record]) & (table["fault"].values == 0) & (recording != recording[record])
        assert known[reference]
        nearer = np.abs(speed - speed[record])[known] < abs(speed[reference] - speed[record])
        assert nearer.sum() < NEAREST


def test_records_are_compared_with_their_own_rig_if_the_reference_has_all_rigs(table):
    table = table.assign(shaft_rate=("record", np.full(table.sizes["record"], 25.0)))
    lines, of_rig = lines_of(table), changes(table, table)
    for row in range(len(lines)):
        np.testing.assert_allclose(of_rig[row], lines[row] - lines[healthy_of_rig(table, row)].mean(axis=0))
    others = table["rig"].values > 0
    of_all = changes(table, table.isel(record=others))
    np.testing.assert_allclose(of_all, lines - lines[others & (table["fault"].values == 0)].mean(axis=0))


def test_records_are_compared_with_the_healthy_ones_nearest_in_speed(table):
    lines, change, speed = lines_of(table), changes(table, table), np.log(table["shaft_rate"].values)
    for row in range(len(lines)):
        healthy = healthy_of_rig(table, row)
        apart = np.abs(speed[healthy] - speed[row])
        near = healthy[apart <= apart.min() + SAME_SPEED]
        np.testing.assert_allclose(change[row], lines[row] - lines[near].mean(axis=0))


def test_a_missing_feature_of_a_reference_record_is_taken_from_the_others(table):
    gap = table.copy(deep=True)
    gap["features"][0, 0] = np.nan
    tested, whole = table.isel(record=[9]), table.isel(record=table["recording"].values != 0)
    assert changes(tested, gap)[0, 0] == changes(tested, whole)[0, 0]


@pytest.mark.parametrize("unknown", [0.0, np.nan])
def test_a_record_of_unknown_speed_is_compared_with_all_healthy_records_of_its_rig(table, unknown):
    speeds, lines = table["shaft_rate"].values.copy(), lines_of(table)
    speeds[9] = unknown
    change = changes(table.assign(shaft_rate=("record", speeds)), table)
    np.testing.assert_allclose(change[9], lines[9] - lines[healthy_of_rig(table, 9)].mean(axis=0))
    none = table.assign(shaft_rate=("record", np.full(len(speeds), unknown)))
    assert "nearest in speed" not in choose_reference(none, table.isel(record=slice(0, 40)), LINES)[2]


def test_faulty_records_of_a_reference_are_not_used(table, model):
    healthy = table.isel(record=table["fault"].values == 0)
    unknown = healthy.assign(fault=("record", np.full(healthy.sizes["record"], UNKNOWN_CODE, np.int8)))
    first = predict(table, model, healthy).probabilities
    for other in (table, unknown):
        np.testing.assert_array_equal(predict(table, model, other).probabilities, first)


def test_a_reference_tells_classes_that_differ_less_than_rigs(model):
    other = make_table(seed=5)
    assert model.score(other).balanced_accuracy < 0.6
    assert model.score(other, reference=other).balanced_accuracy > 0.95


def test_the_first_healthy_recording_of_each_rig_is_the_reference_in_the_tested_corpus_itself(table, model):
    tested, healthy, sentence = choose_reference(table, table, LINES)
    assert sorted(healthy["recording"].values.tolist()) == list(range(0, 64, 8))
    assert set(tested["recording"].values) == set(range(64)) - set(range(0, 64, 8))
    scores = model.score(table, reference=table)
    assert scores.records == 56
    assert scores.reference == sentence
    assert "8 tested records that belong to it are left out" in scores.reference


def test_a_tested_record_that_is_also_in_the_reference_is_left_out(table, model):
    mixed = table.isel(record=np.random.default_rng(2).permutation(64)[:40])
    tested, _, _ = choose_reference(table, mixed, LINES)
    healthy = mixed["fault"].values == 0
    assert tested.sizes["record"] == 64 - healthy.sum()
    assert not set(tested["recording"].values) & set(mixed["recording"].values[healthy])
    with pytest.raises(CorpusError, match="every tested record belongs to the reference; give another"):
        model.score(table.isel(record=[0, 1]), reference=table)


def test_energies_that_are_features_themselves_are_compared_once_and_without_the_gain(table):
    louder = table.assign(features=table["features"] + 3.0 * (table["group"] == "bands"))
    once, again = (relative_to(of, table, (*ENERGIES, *LINES)).features for of in (table, louder))
    assert once.get_index("feature").is_unique
    np.testing.assert_allclose(again[:, len(ENERGIES) + len(LINES) :], once[:, len(ENERGIES) + len(LINES) :], atol=1e-9)
    model = Model("logistic_regression", groups=("lines", "shape", "bands")).fit(table)
    assert model.score(table, reference=table).balanced_accuracy > 0.95


def test_a_model_of_a_corpus_without_two_healthy_recordings_takes_no_reference(table):
    one = table.isel(record=(table["fault"].values > 0) | (table["recording"].values % 8 == 0))
    for lacking in (one, table.drop_vars("shaft_rate"), table.isel(feature=table["group"].values != "bands")):
        found = Model("random_forest").fit(lacking)
        assert found.relative is None
    with pytest.raises(CorpusError, match="the model takes no reference, because a made-up corpus has no rig with two"):
        predict(table, found, table)


def test_a_reference_without_a_healthy_record_is_refused(table, model):
    with pytest.raises(CorpusError, match="the reference holds no healthy record with features; give a healthy"):
        predict(table, model, table.isel(record=table["fault"].values > 0))


@pytest.mark.parametrize(("tested", "its", "allowed"), [(8e3, 8e3, 1), (12e3, 48e3, 1), (8e3, 12e3, 0), (12e3, 8e3, 0)])
def test_sample_rates_may_differ_if_both_reach_the_highest_band(table, model, tested, its, allowed):
    count = table.sizes["record"]
    rates = [table.assign(sample_rate=("record", np.full(count, rate))) for rate in (tested, its)]
    if allowed:
        predict(rates[0], model, rates[1])
        return
    with pytest.raises(CorpusError, match="they may differ only if both are at least 10000 Hz"):
        predict(rates[0], model, rates[1])


def test_a_model_file_holds_both_parts(table, model, tmp_path):
    model.save(tmp_path / "m.skops")
    read = Model.load(tmp_path / "m.skops")
    assert read.relative is not None
    assert read.relative.calibration == model.relative.calibration != read.calibration
    assert read.relative.features == relative_names(LINES)
    for reference in (None, table):
        found, expected = (predict(table, each, reference).probabilities for each in (read, model))
        np.testing.assert_array_equal(found, expected)


def test_a_reference_of_other_durations_is_refused(tmp_path):
    write_corpus(tmp_path / "c", specimens=4)
    with open_corpus(tmp_path / "c") as opened:
        short = opened.isel(elapsed_time=slice(500)).load()
    with pytest.raises(
        CorpusError, match=r"last 0.125 s and those of .* 0.25 s; import the reference with records of the"
    ):
        check_durations(tmp_path / "c", short)


def test_evaluate_takes_a_corpus_as_reference_and_refuses_one_before_it_computes_features(tmp_path, monkeypatch):
    corpus, path = tmp_path / "c", tmp_path / "m.skops"
    write_corpus(corpus, **{name: np.full(48, order) for name, order in ORDERS._asdict().items()})
    Model("random_forest").fit(corpus).save(path)

    def run(reference):
        done = CliRunner().invoke(cli, ["evaluate", *map(str, (corpus, "--model", path, "--reference", reference))])
        return done.exit_code, " ".join(done.output.split())

    code, told = run(corpus)
    assert code == 0, told
    assert "which has 4, those nearest in speed" in told
    assert "4 tested records that belong to it are left out." in told
    code, told = run(tmp_path / "nowhere")
    assert code
    assert f"{tmp_path / 'nowhere'}: " in told
    Model("majority").fit(corpus).save(tmp_path / "rule.skops")
    path = tmp_path / "rule.skops"
    monkeypatch.setattr(model_commands, "tables_for", lambda *_: pytest.fail("features were computed"))
    code, told = run(corpus)
    assert (code, "the model takes no reference, because tones has no rig with two healthy" in told) == (2, True), told


def test_a_reference_in_another_band_is_refused(model, table):
    other = table.assign_attrs(band_low_hz=300.0, band_high_hz=9000.0)
    with pytest.raises(
        CorpusError, match="computed from another band than those of the records; compute both with one"
    ):
        predict(table, model, other)
