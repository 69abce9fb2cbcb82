"""The feature table: computed from signal and operating variables, with all other variables copied."""

import numpy as np
import pytest
import xarray as xr
from distributed import Client

from features import feature_table
from features.table.band import Band, band_attributes, band_of
from features.table.corpus_features import band_warnings
from features.table.definitions import GROUPS
from features.table.indicators import Orders, feature_names, indicators
from features.table.table_files import read_table, write_table
from gen.corpus import (
    FAULT_NAMES,
    MISSING_COUNT,
    ROLES,
    SCHEMA,
    SIGNAL,
    Variable,
    make_dataset,
    new_corpus,
    open_corpus,
)
from gen.support.errors import CorpusError

FS, SAMPLES, RECORDS, PARTS = 12_000.0, 3000, 5, 3
SNR = Variable("snr", "f8", "1", "latent", "ratio of signal to background in decibels")
KNOWN = {"shaft_rate": 30.0, "sample_rate": FS, "ftf": 0.3983, "bpfo": 3.5848, "bpfi": 5.4152, "bsf": 2.3567}


def columns(rng):
    values = {
        "i1": lambda: rng.integers(0, 3, RECORDS),
        "i2": lambda: rng.integers(0, 3, RECORDS),
        "i4": lambda: rng.integers(0, 9, RECORDS),
        "f8": lambda: rng.uniform(0.0, 1.0, RECORDS),
        "str": lambda: [f"text {n}" for n in range(RECORDS)],
    }
    drawn = {variable.name: values[variable.dtype]() for variable in (*SCHEMA, SNR)}
    return drawn | {name: np.full(RECORDS, value) for name, value in KNOWN.items()}


def part_dataset(number, rng, spoiled=None):
    signal = rng.standard_normal((RECORDS, 2, SAMPLES)).astype(np.float32)
    if spoiled == number:
        signal[1, 0, 5] = np.nan
        signal[2, 0] = 0.25
    texts = {"title": "A corpus for a test", "history": "made", "seed": 7}
    return make_dataset(signal, FS, ("housing", "sensor"), columns(rng), extra=(SNR,), attributes=texts)


def make_corpus(directory, spoiled=None, change=lambda dataset: dataset):
    with new_corpus(directory, title="A corpus for a test") as corpus:
        for number in range(PARTS):
            corpus.write(change(part_dataset(number, np.random.default_rng(number), spoiled)))
    return directory


@pytest.fixture(scope="module", autouse=True)
def small_blocks():
    """Several blocks of a small corpus."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("gen.corpus.lazy._BLOCK_RECORDS", RECORDS)
        yield


@pytest.fixture(scope="module")
def corpus(tmp_path_factory):
    return make_corpus(tmp_path_factory.mktemp("corpus") / "corpus")


@pytest.fixture(scope="module")
def table(corpus):
    return feature_table(corpus)


def test_every_record_has_a_row_of_named_finite_features(table):
    assert table["features"].dims == ("record", "feature")
    assert table["features"].dtype == np.float64
    assert tuple(table["feature"].values) == feature_names()
    assert set(table["group"].values) == set(GROUPS)
    assert table.sizes["record"] == RECORDS * PARTS
    assert np.isfinite(table["features"]).all()
    assert table.attrs["records_with_missing_features"] == 0


def test_all_variables_of_a_record_are_copied_with_their_attributes(corpus, table):
    with open_corpus(corpus) as source:
        for variable in (*SCHEMA, SNR):
            xr.testing.assert_identical(
                table[variable.name].variable, source[variable.name].load().variable.drop_encoding()
            )
            assert table[variable.name].attrs["role"] in ROLES
        assert source.attrs.items() <= table.attrs.items()


def in_counts(dataset, missing):
    """The same records as counts of a converter, with the counts at ``missing`` places missing."""
    signal = np.rint(dataset[SIGNAL].values * 1000).astype(np.int16)
    for place in missing:
        signal[place] = MISSING_COUNT
    known = {variable.name: dataset[variable.name].values for variable in (*SCHEMA, SNR)}
    channels = tuple(dataset["channel"].values)
    return make_dataset(
        signal,
        FS,
        channels,
        known,
        extra=(SNR,),
        counts_per_unit=1000.0,
        attributes={"title": "counts", "history": "made"},
    )


def test_a_missing_count_is_not_used_as_a_sample(tmp_path):
    """Read as a sample, the fill value would be an impact of full scale. Missing counts of other channels are ignored."""
    missing = [(1, 0, 5), (2, 0), (3, 1)]  # a sample, a channel, and the channel without features
    found = feature_table(make_corpus(tmp_path / "c", change=lambda dataset: in_counts(dataset, missing)))
    rows = found["features"].values[:RECORDS]
    assert np.isnan(rows).all(axis=1).tolist() == [False, True, True, False, False]
    assert np.isfinite(rows[[0, 3, 4]]).all()
    assert found.attrs["records_with_missing_features"] == 2 * PARTS


def test_a_single_file_is_worked_on_block_by_block(tmp_path, table, monkeypatch):
    monkeypatch.setattr("gen.corpus.lazy._BLOCK_RECORDS", 4)
    done = []
    found = feature_table(make_corpus(tmp_path / "c.nc"), progress=lambda *counts: done.append(counts))
    xr.testing.assert_equal(found, table)
    assert done == [(1, 4), (2, 4), (3, 4), (4, 4)]


def test_two_workers_and_this_process_give_the_same_numbers(corpus, table):
    done = []
    with Client(n_workers=2, threads_per_worker=1, processes=False, dashboard_address=":0") as client:
        parallel = feature_table(corpus, scheduler=client, progress=lambda *counts: done.append(counts))
        xr.testing.assert_identical(feature_table(corpus, scheduler=client.scheduler.address), table)
    xr.testing.assert_identical(parallel, table)
    assert done == [(1, 3), (2, 3), (3, 3)]


def test_features_do_not_change_when_labels_latents_and_provenance_are_shuffled(tmp_path, table):
    def shuffle(dataset):
        rng = np.random.default_rng(99)
        for name, variable in dataset.variables.items():
            if variable.attrs.get("role") in ROLES[1:]:
                dataset[name] = variable.copy(data=rng.permutation(variable.values))
        return dataset

    shuffled = feature_table(make_corpus(tmp_path / "shuffled", change=shuffle))
    assert not shuffled["snr"].equals(table["snr"])
    assert not shuffled["fault"].equals(table["fault"])
    np.testing.assert_array_equal(shuffled["features"], table["features"])


def test_records_without_a_usable_signal_are_nan_and_counted(tmp_path):
    table = feature_table(make_corpus(tmp_path / "spoiled", spoiled=1))
    missing = np.isnan(table["features"]).all("feature")
    assert np.flatnonzero(missing).tolist() == [RECORDS + 1, RECORDS + 2]
    assert table.attrs["records_with_missing_features"] == 2


def test_a_table_is_unchanged_after_netcdf(tmp_path, table):
    path = tmp_path / "table.nc"
    write_table(table, path)
    again = read_table(path)
    xr.testing.assert_equal(again, table)
    assert again["fault"].dtype == np.int8
    assert again["fault"].attrs["flag_meanings"] == " ".join(FAULT_NAMES.values())
    assert again.attrs == table.attrs
    assert [file.name for file in tmp_path.iterdir()] == ["table.nc"]


def test_a_damaged_table_is_refused_or_has_the_same_features(tmp_path, table):
    path, rng, table = tmp_path / "table.nc", np.random.default_rng(5), table.isel(feature=[0, 1, 2], record=slice(4))
    write_table(table, path)
    content, refused = path.read_bytes(), 0
    for _ in range(60):
        altered = bytearray(content)
        for place in rng.integers(0, len(content), rng.integers(1, 4)):
            altered[place] ^= int(rng.integers(1, 256))
        path.write_bytes(altered)
        try:
            np.testing.assert_array_equal(read_table(path)["features"], table["features"])
        except CorpusError:
            refused += 1
    assert refused > 6


def test_a_table_is_unchanged_in_the_columns_of_parquet(tmp_path, table):
    parquet = pytest.importorskip("pyarrow.parquet")
    path = tmp_path / "table.parquet"
    write_table(table, path)
    again = parquet.read_table(path)
    assert set(again.column_names) == {
        *feature_names(),
        *(variable.name for variable in (*SCHEMA, SNR)),
        "duration",
        "fault_name",
        "split_name",
    }
    for name in ("cepstral_bpfo_comb", "time_rms"):
        np.testing.assert_array_equal(again[name].to_numpy(), table["features"].sel(feature=name))
    assert again["bearing"].to_pylist() == table["bearing"].values.tolist()
    assert again.schema.field("width").metadata[b"units"] == b"m"
    known = {b"group": b"time", b"units": b"m s-2", b"long_name": b"root mean square"}
    assert again.schema.field("time_rms").metadata == known
    assert [file.name for file in tmp_path.iterdir()] == ["table.parquet"]


def test_several_channels_have_the_features_of_each_in_columns_named_by_channel(tmp_path, corpus):
    parquet = pytest.importorskip("pyarrow.parquet")
    both = feature_table(corpus, ("time",), channel=["sensor", "housing"])
    assert (both["features"].dims[0], list(both["channel"].values)) == ("channel", ["sensor", "housing"])
    write_table(both, tmp_path / "both.parquet")
    again = parquet.read_table(tmp_path / "both.parquet")
    for name in ("sensor", "housing"):
        alone, own = feature_table(corpus, ("time",), channel=name)["features"], both["features"].sel(channel=name)
        np.testing.assert_array_equal(own, alone)
        np.testing.assert_array_equal(again[f"{name}_time_rms"].to_numpy(), own.sel(feature="time_rms"))


@pytest.mark.parametrize("window", [0, -1, np.nan, np.inf, "x", [0.1]])
def test_a_window_that_is_no_positive_number_is_refused(corpus, window):
    with pytest.raises(ValueError, match="window"):
        feature_table(corpus, window=window)


@pytest.mark.parametrize("channel", ["housing", ("housing", "sensor")])
def test_features_of_long_records_are_the_means_over_their_windows(corpus, channel):
    window = 0.11
    table = feature_table(corpus, channel=channel, window=window)
    length = round(window * FS)
    with open_corpus(corpus) as opened:
        cuts = [opened.isel(elapsed_time=slice(start, start + length)).load() for start in (0, length)]
    halves = [feature_table(cut, channel=channel)["features"] for cut in cuts]
    np.testing.assert_allclose(table["features"], (halves[0] + halves[1]) / 2, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(table["duration"], window)
    # records that are not longer are not changed
    whole = feature_table(corpus, channel=channel)
    for longer in (SAMPLES / FS, 9.0):
        assert feature_table(corpus, channel=channel, window=longer).identical(whole)


def test_a_channel_can_be_given_by_its_name(corpus):
    by_name, by_number = feature_table(corpus, ("time",), channel="sensor"), feature_table(corpus, ("time",), channel=1)
    assert by_name.identical(by_number)
    assert by_name.attrs["channel"] == "sensor"
    for wrong in (-1, 2, "senor"):
        with pytest.raises(CorpusError, match=f"no channel {wrong!r}; give one of housing, sensor"):
            feature_table(corpus, ("time",), channel=wrong)
    with pytest.raises(CorpusError, match=r"give one of housing, sensor; did you mean sensor\?"):
        feature_table(corpus, ("time",), channel="senor")


def test_a_table_names_the_band_of_its_features(corpus, tmp_path):
    write_table(feature_table(corpus, ("bands",), band=Band(300.0, 6000.0)), tmp_path / "table.nc")
    table = read_table(tmp_path / "table.nc")
    assert band_of(table.attrs) == (300.0, 6000.0)
    assert tuple(table["feature"].values) == feature_names(("bands",), Band(300.0, 6000.0))


@pytest.mark.parametrize(
    ("rate", "band"), [(2999.0, (300.0, 5000.0)), (2560.0, (100.0, 1300.0)), (2560.0, (100.0, 1200.0))]
)
def test_a_sample_rate_too_low_for_lines_is_told_exactly_where_all_are_missing(rate, band):
    time = np.arange(int(4 * rate)) / rate
    x = np.random.default_rng(0).standard_normal((1, time.size)) * (1 + np.cos(2 * np.pi * 36 * time))
    orders = Orders(*(np.array([order]) for order in (0.4, 3.6, 5.4, 2.3)))
    values, _ = indicators(x, rate, np.array([10.0]), orders, ("lines", "shape"), Band(*band))
    table = xr.Dataset({"sample_rate": ("record", [rate])}, attrs=band_attributes(Band(*band)))
    assert bool(band_warnings(table)) == np.isnan(values).all()


@pytest.mark.parametrize(
    ("rate", "band", "told"),
    [(12_000.0, (300.0, 9000.0), 1), (18_000.0, (300.0, 9000.0), 0), (8000.0, (300.0, 5000.0), 0)],
)
def test_a_band_that_was_chosen_and_ends_above_half_the_sample_rate_is_told(rate, band, told):
    table = xr.Dataset({"sample_rate": ("record", [rate])}, attrs=band_attributes(Band(*band)))
    assert sum("ends above half the sample rate of 12,000 Hz" in sentence for sentence in band_warnings(table)) == told
