"""Laws of merged corpora: records stay as they are, machines stay apart, nothing is there twice, and every record can be replayed."""

import numpy as np
import pytest
import xarray as xr

from gen import generate, merge, open_corpus, pack, replay, select, shaft_angles, stored_scenario, validate_corpus
from gen.corpus import (
    SCHEMA,
    Publication,
    make_dataset,
    part_name,
    publish,
    read_manifest,
    write_index,
    write_manifest,
    write_part,
)
from gen.corpus.record_hashes import RENUMBERED, record_hashes
from gen.errors import CorpusError
from gen.sharing.columns import columns_of_all
from tests import corpora, tone_corpora
from tests.kills import killed


@pytest.fixture
def tones(tmp_path):
    """Folders of three corpora of tones, each of 12 records, 4 specimens and one machine."""
    folders = [tmp_path / f"tones-{seed}" for seed in range(3)]
    for seed, folder in enumerate(folders):
        tone_corpora.write_corpus(folder, specimens=4, parts=1, seed=seed)
    return folders


@pytest.fixture(scope="module")
def simulated(tiny_corpus, tiny_recipe, tmp_path_factory):
    """Folders of two simulated corpora, of 48 and of 12 records."""
    other = tmp_path_factory.mktemp("other") / "corpus"
    generate(tiny_recipe, other, seed=4, records=12)
    return tiny_corpus, other


def columns(folder, *names):
    with open_corpus(folder) as corpus:
        return [corpus[name].values for name in names]


def hashes(folder):
    with open_corpus(folder) as corpus:
        return record_hashes(corpus)


def test_merged_records_are_those_of_the_corpora_and_their_machines_stay_apart(tones, tmp_path):
    made = merge(tones, tmp_path / "merged")
    assert (made.records, made.parts, made.origins, made.filled) == (36, 3, 3, ())
    assert validate_corpus(tmp_path / "merged") == []
    assert hashes(tmp_path / "merged") == [each for folder in tones for each in hashes(folder)]
    for name, values in zip(RENUMBERED[:3], columns(tmp_path / "merged", *RENUMBERED[:3]), strict=True):
        (own,) = columns(tones[0], name)
        assert np.array_equal(values, np.tile(own, 3) + np.repeat([0, 1, 2], 12) * (own.max() + 1)), name


def test_merging_in_two_steps_gives_the_numbers_of_one(tones, tmp_path):
    merge(tones, tmp_path / "at_once")
    merge(tones[:2], tmp_path / "two")
    made = merge([tmp_path / "two", tones[2]], tmp_path / "in_steps")
    assert made.origins == 3
    one, other = (read_manifest(tmp_path / name) for name in ("at_once", "in_steps"))
    assert one.origins == other.origins
    names = "rig", "specimen", "recording"
    assert np.array_equal(columns(tmp_path / "at_once", *names), columns(tmp_path / "in_steps", *names))


def test_two_selections_of_one_corpus_keep_their_common_machines(tones, tmp_path):
    """In any order, and with records of another corpus between them."""
    select(tones[0], tmp_path / "low", where="specimen < 2")
    select(tones[0], tmp_path / "high", where="specimen >= 2")
    merge([tmp_path / "high", tones[1], tmp_path / "low"], tmp_path / "merged")
    rig, specimen = columns(tmp_path / "merged", "rig", "specimen")
    assert rig.tolist() == [0] * 6 + [1] * 12 + [0] * 6
    assert specimen.tolist() == [*np.repeat([2, 3], 3), *np.repeat([4, 5, 6, 7], 3), *np.repeat([0, 1], 3)]


def test_a_selection_of_a_merge_keeps_its_numbers_and_origins(tones, tmp_path):
    merge(tones, tmp_path / "merged")
    select(tmp_path / "merged", tmp_path / "some", where="recording in (3, 25, 35)")
    manifest = read_manifest(tmp_path / "some")
    assert [origin.parts for origin in manifest.origins] == [1, 1]
    assert [origin.added.rig for origin in manifest.origins] == [0, 2]
    assert columns(tmp_path / "some", "rig", "recording")[1].tolist() == [3, 25, 35]
    assert validate_corpus(tmp_path / "some") == []
    merge([tmp_path / "some", tones[1]], tmp_path / "again")
    assert [str(*origin.selections) for origin in read_manifest(tmp_path / "again").origins] == [
        "where: recording in (3, 25, 35)",
        "where: recording in (3, 25, 35)",
        "",
    ]


def test_a_corpus_that_holds_the_same_samples_is_refused(tones, tmp_path):
    select(tones[1], tmp_path / "some", where="specimen == 2")
    with pytest.raises(CorpusError, match=r"some: record 0 has the same samples as record 6 of .*tones-1,"):
        merge([tones[0], tones[1], tmp_path / "some"], tmp_path / "merged")
    assert not (tmp_path / "merged").exists()
    assert not list(tmp_path.glob(".merged*"))


def test_records_of_silence_may_be_alike(tmp_path, monkeypatch):
    silence = corpora.dataset(0, 3)
    silence["acceleration"][:] = 0
    monkeypatch.setattr(corpora, "dataset", lambda *_, **__: silence)
    for name in "ab":
        corpora.write_corpus(tmp_path / name, (3,))
    assert merge([tmp_path / "a", tmp_path / "b"], tmp_path / "merged").signals.dead == 6


def test_corpora_that_do_not_fit_together_are_refused_with_the_difference(tones, tmp_path):
    corpora.write_corpus(tmp_path / "counts")
    corpora.write_corpus(tmp_path / "floats", kind="float32")
    select(tmp_path / "counts", tmp_path / "one", channels=["a"])
    for pair, sentence in (
        (("counts", "one"), "one: has the channels a, and .*counts has a, b; choose the same channels"),
        (("counts", "floats"), r"has the storage of the signals float32, and .* m s-2; .*--float32"),
    ):
        with pytest.raises(CorpusError, match=sentence):
            merge([tmp_path / name for name in pair], tmp_path / "merged")
    with pytest.raises(CorpusError, match="1 corpus given; give two or more"):
        merge(tones[:1], tmp_path / "merged")


@pytest.mark.parametrize(("fs", "samples"), [(2000.0, 50), (1000.0, 40)])
def test_corpora_of_another_sample_rate_or_length_are_refused(tmp_path, monkeypatch, fs, samples):
    corpora.write_corpus(tmp_path / "a")
    usual = corpora.dataset
    monkeypatch.setattr(corpora, "FS", fs)
    monkeypatch.setattr(corpora, "dataset", lambda *part, **how: usual(*part, **how, samples=samples))
    corpora.write_corpus(tmp_path / "b")
    with pytest.raises(
        CorpusError, match="the sample rate 2000 Hz, and .* has 1000 Hz;" if fs == 2000 else "record length 40 samples"
    ):
        merge([tmp_path / "a", tmp_path / "b"], tmp_path / "merged")


def test_counts_and_floating_point_are_merged_in_floating_point_if_asked(tmp_path, monkeypatch):
    corpora.write_corpus(tmp_path / "counts")
    usual = corpora.dataset
    monkeypatch.setattr(corpora, "dataset", lambda first, n, **how: usual(first + 100, n, **how))
    corpora.write_corpus(tmp_path / "floats", kind="float32")
    merge([tmp_path / "counts", tmp_path / "floats"], tmp_path / "merged", float32=True)
    assert validate_corpus(tmp_path / "merged") == []
    (found,) = columns(tmp_path / "merged", "acceleration")
    expected = [columns(tmp_path / name, "acceleration")[0].astype(np.float32) for name in ("counts", "floats")]
    assert found.dtype == np.float32
    assert np.array_equal(found, np.concatenate(expected))


def test_a_corpus_of_an_older_version_is_merged_in_floating_point(tmp_path, monkeypatch):
    corpora.write_corpus(tmp_path / "new")
    usual = corpora.dataset

    def older(first, n, **how):
        part = usual(first + 100, n, **how)
        part["acceleration"].attrs |= {"scale_factor": np.float64(1) / 65.534, "add_offset": np.float64(0)}
        part["elapsed_time"].attrs = {"units": "s"}
        return part

    monkeypatch.setattr(corpora, "dataset", older)
    corpora.write_corpus(tmp_path / "old")
    for order in (("new", "old"), ("old", "new")):
        with pytest.raises(CorpusError, match=r"int16 in float(32|64) steps of 0\.0152592547 m s-2, and"):
            merge([tmp_path / name for name in order], tmp_path / "merged")
        merge([tmp_path / name for name in order], tmp_path / "-".join(order), float32=True)
        assert validate_corpus(tmp_path / "-".join(order)) == []


@pytest.mark.parametrize("units", [("dB", "1"), ("1", "dB")])
def test_levels_of_older_corpora_have_the_unit_of_new_ones(units):
    of = [xr.Dataset({"snr": ("record", [3.0], {"units": unit})}) for unit in units]
    for one in of:
        one["acceleration"] = ("record", "channel", "elapsed_time"), np.zeros((1, 1, 2))
        one["channel"], one["elapsed_time"] = ["a"], [0.0, 1.0]
    found = columns_of_all([("one", of[0]), ("other", of[1])])
    assert found.variables["snr"].attributes["units"] == "1"


def test_a_licence_is_kept_only_if_all_corpora_have_it(tones, tmp_path):
    for folder in tones[:2]:
        publish(folder, Publication(license="CC-BY-4.0", date="2026-01-02"))
    merge(tones[:2], tmp_path / "same", title="Two")
    merge(tones[1:], tmp_path / "other")
    assert read_manifest(tmp_path / "same").publication.license == "CC-BY-4.0"
    assert read_manifest(tmp_path / "other").publication.license is None
    with open_corpus(tmp_path / "same") as corpus:
        assert corpus.attrs["title"] == read_manifest(tmp_path / "same").title == "Two"


def test_every_record_of_merged_simulated_corpora_is_replayed(simulated, tmp_path):
    """And from a selection of them, in which they keep the new numbers."""
    whole, other = simulated
    select(whole, tmp_path / "some", where="specimen in (1, 6, 9, 15)")
    pack(other, tmp_path / "other.nc")
    merge([tmp_path / "some", tmp_path / "other.nc"], tmp_path / "merged")
    assert hashes(tmp_path / "merged") == hashes(tmp_path / "some") + hashes(other)
    assert all(replay(tmp_path / "merged", record).identical for record in range(24))
    select(tmp_path / "merged", tmp_path / "few", where="recording in (18, 47, 59)")
    again = [replay(tmp_path / "few", record) for record in range(3)]
    assert all(one.identical for one in again)
    assert [int(one.dataset["recording"][0]) for one in again] == [18, 47, 59]
    with pytest.raises(CorpusError, match="record 3 is not in it; it has records 0 to 2"):
        replay(tmp_path / "few", 3)
    assert stored_scenario(tmp_path / "few", 2) == stored_scenario(other, 11)
    assert np.array_equal(shaft_angles(tmp_path / "few", 2), shaft_angles(other, 11))


def test_records_in_floating_point_are_replayed_too(simulated, tmp_path):
    merge(simulated, tmp_path / "merged", float32=True)
    assert all(replay(tmp_path / "merged", record).identical for record in (5, 47, 48, 59))


def test_a_merged_corpus_is_not_completed_by_generate(simulated, tiny_recipe, tmp_path):
    merge(simulated, tmp_path / "merged")
    with pytest.raises(CorpusError, match="was merged from several corpora, so it cannot be generated"):
        generate(tiny_recipe, tmp_path / "merged")


def imported(folder, fs, samples, channels):
    """Write four records as an importer does."""
    rng = np.random.default_rng(0)
    found = {v.name: np.array(["machine 3"] * 4, object) if v.dtype == "str" else np.zeros(4) for v in SCHEMA}
    found |= {"fault": [0, 0, 1, 1], "specimen": [0, 0, 1, 1], "recording": range(4), "sample_rate": [fs] * 4}
    signal = rng.normal(size=(4, len(channels), samples)).astype(np.float32)
    part = make_dataset(signal, fs, channels, found, attributes={"title": "Measured", "source": "a pump"})
    (folder / "parts").mkdir(parents=True)
    rows = [write_part(part, folder / "parts" / part_name(0))]
    write_index(folder, rows)
    write_manifest(folder, rows, complete=True, importer="generic", recordings=4)


def test_simulated_and_imported_records_stay_together_with_unknown_values_marked(simulated, tmp_path):
    time, channels, rates = columns(simulated[1], "elapsed_time", "channel", "sample_rate")
    imported(tmp_path / "measured", float(rates[0]), len(time), tuple(channels))
    made = merge([simulated[1], tmp_path / "measured"], tmp_path / "both", float32=True)
    assert {"draws", "true_shaft_rate", "detectable", "pair"} <= set(made.filled)
    assert validate_corpus(tmp_path / "both") == []
    draws, rate, detectable, pair = columns(tmp_path / "both", "draws", "true_shaft_rate", "detectable", "pair")
    assert set(draws[12:]) == {""}
    assert np.isnan(rate[12:]).all()
    assert set(detectable[12:]) == {2}
    assert set(pair[12:]) == {-1}
    assert replay(tmp_path / "both", 3).identical
    with pytest.raises(CorpusError, match=r"record 13 comes from a corpus \(Measured\) that was not generated"):
        replay(tmp_path / "both", 13)
    card = (tmp_path / "both" / "README.md").read_text()
    assert all(words in card for words in ("Tiny corpus", "recipes/00000.yaml", "Measured", "raceway import generic"))


def test_a_killed_merge_leaves_the_whole_corpus_or_none(tones, tmp_path):
    output, wholes = tmp_path / "out", 0
    for _ in killed(lambda: merge(tones, output), moments=5, seed=1):
        if output.exists():
            assert validate_corpus(output) == []
            assert read_manifest(output).records == 36
            output.rename(tmp_path / f"whole-{wholes}")
            wholes += 1
    assert wholes >= 1
    merge(tones, output)
    assert not list(tmp_path.glob(".out*"))
