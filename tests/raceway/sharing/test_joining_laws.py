"""Laws of joined corpora: records stay as they are, machines stay apart, nothing is there twice, and every record can be replayed."""

import shutil

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import gen
from gen import generate, open_corpus, validate_corpus
from gen.corpus import SCHEMA, SIGNAL, identity, make_dataset, new_corpus, read_manifest
from gen.corpus.numbering import NUMBERS, new_numbers
from gen.support.errors import CorpusError
from raceway import copy, publish
from raceway.sharing.publication import Publication
from tests import corpora


@pytest.fixture(scope="module")
def simulated(tiny_corpus, tiny_recipe, tmp_path_factory):
    """Folders of two simulated corpora, of 48 and of 12 records."""
    other = tmp_path_factory.mktemp("other") / "corpus"
    generate(tiny_recipe, other, seed=4, records=12)
    return tiny_corpus, other


def columns(path, *names):
    with open_corpus(path) as corpus:
        return [corpus[name].values for name in names]


def contents(path):
    """Values of all variables but the numbers that joined corpora get anew."""
    with open_corpus(path) as corpus:
        return {str(name): found.values for name, found in corpus.variables.items() if name not in NUMBERS}


@pytest.mark.parametrize("name", ["joined", "joined.nc"])
def test_joined_records_are_those_of_the_corpora_and_their_machines_stay_apart(tones, tmp_path, name):
    made = copy(tones, tmp_path / name)
    assert (made.records, made.of, made.filled) == (36, 36, ())
    assert validate_corpus(tmp_path / name) == []
    found, each = contents(tmp_path / name), [contents(folder) for folder in tones]
    for variable, values in found.items():
        whole = variable in ("channel", "elapsed_time")
        expected = each[0][variable] if whole else np.concatenate([one[variable] for one in each])
        np.testing.assert_array_equal(values, expected, err_msg=variable)
    for number, values in zip(NUMBERS, columns(tmp_path / name, *NUMBERS[:3]), strict=False):
        (own,) = columns(tones[0], number)
        np.testing.assert_array_equal(values, np.tile(own, 3) + np.repeat([0, 1, 2], 12) * (own.max() + 1))


def test_choosing_and_joining_can_change_places(tones, tmp_path):
    """Numbers follow from the identities alone, whatever copies a record went through."""
    where = "specimen in (1, 2)"
    for number, folder in enumerate(tones):
        copy(folder, tmp_path / f"some-{number}", where=where)
    copy([tmp_path / f"some-{number}" for number in range(3)], tmp_path / "chosen_first")
    copy(tones, tmp_path / "at_once", where=where)
    copy(tones[:2], tmp_path / "two")
    copy([tmp_path / "two", tones[2]], tmp_path / "in_steps.nc")
    copy(tmp_path / "in_steps.nc", tmp_path / "joined_first", where="specimen in (1, 2, 5, 6, 9, 10)")
    expected = columns(tmp_path / "at_once", *NUMBERS[:3], SIGNAL)
    for name in ("chosen_first", "joined_first"):
        for found, values in zip(columns(tmp_path / name, *NUMBERS[:3], SIGNAL), expected, strict=True):
            np.testing.assert_array_equal(found, values)


@given(
    st.lists(
        st.tuples(st.sampled_from(["a", "b/x", ""]), *[st.integers(-1, 2**31 - 1) | st.integers(0, 3)] * 4), min_size=1
    )
)
def test_equal_identities_have_equal_numbers_and_others_have_others(rows):
    found = new_numbers([identity(*row) for row in rows])
    for place, name in enumerate(NUMBERS, start=1):
        own = [(row[0], row[place]) for row in rows]
        pairs = {(new, old if old[1] >= 0 else -1) for new, old in zip(found[name].tolist(), own, strict=True)}
        assert len({new for new, _ in pairs}) == len({old for _, old in pairs}) == len(pairs)
        if len({row[0] for row in rows}) == 1:
            assert found[name].tolist() == [number for _, number in own]


@pytest.mark.parametrize("to", [None, "huggingface"])
def test_a_corpus_that_holds_the_same_samples_is_refused(tones, tmp_path, to):
    copy(tones[1], tmp_path / "some.nc", where="specimen == 2")
    with pytest.raises(CorpusError, match=r"some\.nc: record 0 has the same samples as record 6 of .*tones-1,"):
        copy([tones[0], tones[1], tmp_path / "some.nc"], tmp_path / "out", to=to)
    assert not list(tmp_path.glob("*out*"))
    assert copy([tones[1], tmp_path / "some.nc"], tmp_path / "apart", where="specimen != 2").records == 9


def test_records_of_silence_may_be_alike(tmp_path):
    for number, name in enumerate("ab"):
        silence = corpora.dataset(3 * number, 3)
        silence[SIGNAL][:] = 0
        corpora.write_parts(tmp_path / name, [silence])
    copy([tmp_path / "a", tmp_path / "b"], tmp_path / "joined")
    assert read_manifest(tmp_path / "joined").signals == {"dead": 6}


@pytest.mark.parametrize(
    ("changed", "sentence"),
    [
        (
            {"channels": ("a", "c")},
            r"has the channels a, c, and .*c has a, b; .*\(--rename-channel c=b;.*\(--channels\)",
        ),
        ({"samples": 40}, "has the record length 40 samples, and .* has 50 samples; make both with records of one"),
        ({"kind": "float32"}, r"has the storage of the signals float32, and .* m s-2; .*\(float32\)"),
    ],
)
def test_corpora_that_do_not_fit_together_are_refused_with_the_difference(nine, tmp_path, changed, sentence):
    corpora.write_parts(tmp_path / "other", [corpora.dataset(100, 3, **changed)])
    with pytest.raises(CorpusError, match=sentence):
        copy([nine / "c", tmp_path / "other"], tmp_path / "joined")


def test_corpora_of_another_sample_rate_or_unit_are_refused(tmp_path, monkeypatch):
    for rate, unit in ((1000.0, "g"), (2000.0, "g"), (1000.0, "oz")):
        monkeypatch.setattr(corpora, "FS", rate)
        weight = ("record", np.arange(3.0), {"units": unit, "long_name": "weight", "role": "latent"})
        part = corpora.dataset(round(rate) + len(unit), 3)
        corpora.write_parts(tmp_path / f"{rate:g}{unit}", [part.assign(weight=weight)])
    with pytest.raises(CorpusError, match=r"has the sample rate 2000 Hz, and .* has 1000 Hz;"):
        copy([tmp_path / "1000g", tmp_path / "2000g"], tmp_path / "joined")
    with pytest.raises(CorpusError, match=r"1000oz: the unit of weight is oz, in .*1000g g; make both"):
        copy([tmp_path / "1000g", tmp_path / "1000oz"], tmp_path / "joined")


def test_counts_and_floating_point_join_in_floating_point_if_asked(nine, tmp_path):
    corpora.write_parts(tmp_path / "floats", [corpora.dataset(100, 3, kind="float32")])
    copy([nine / "c", tmp_path / "floats"], tmp_path / "joined", float32=True)
    assert validate_corpus(tmp_path / "joined") == []
    with open_corpus(tmp_path / "joined") as corpus:
        told = "copied by raceway copy: joined 2 corpora; stored in floating point"
        assert corpus.attrs["history"].splitlines() == ["made by a test", told]
    (found,) = columns(tmp_path / "joined", SIGNAL)
    expected = [columns(path, SIGNAL)[0].astype(np.float32) for path in (nine / "c", tmp_path / "floats")]
    assert found.dtype == np.float32
    np.testing.assert_array_equal(found, np.concatenate(expected))


def test_channels_of_two_sources_join_by_name_in_any_order(nine, tmp_path):
    corpora.write_parts(tmp_path / "other", [corpora.dataset(100, 3, channels=("sensor", "a", "extra"))])
    copy(
        [nine / "c", tmp_path / "other"], tmp_path / "joined", rename={"sensor": "b"}, channels=["a", "b"]
    )  # fmt: skip
    found, channels = columns(tmp_path / "joined", SIGNAL, "channel")
    (other,) = columns(tmp_path / "other", SIGNAL)
    assert channels.tolist() == ["a", "b"]
    np.testing.assert_array_equal(found[9:], other[:, [1, 0]])


def test_facts_are_kept_if_all_corpora_have_them(tones, tmp_path):
    published = [shutil.copytree(folder, tmp_path / folder.name) for folder in tones[:2]]
    for folder in published:
        publish(folder, Publication(license="CC-BY-4.0", date="2026-01-02"))
    copy(published, tmp_path / "same")
    copy([published[1], tones[2]], tmp_path / "other")
    assert read_manifest(tmp_path / "same").publication["license"] == "CC-BY-4.0"
    assert read_manifest(tmp_path / "other").publication == {}
    with open_corpus(tmp_path / "same") as corpus:
        assert corpus.attrs["title"] == "tones"
        assert corpus.attrs["history"].endswith("copied by raceway copy: joined 2 corpora")


def test_records_of_joined_simulated_corpora_are_replayed(simulated, tmp_path):
    """And of a choice of them, in which they are numbered anew."""
    whole, other = simulated
    copy(whole, tmp_path / "some", where="specimen in (1, 6, 9, 15)")
    copy(other, tmp_path / "other.nc")
    copy([tmp_path / "some", tmp_path / "other.nc"], tmp_path / "joined", float32=True)
    assert all(gen.replay(tmp_path / "joined", record).identical for record in (0, 9, 23))
    copy(tmp_path / "joined", tmp_path / "few.nc", where="recording in (3, 14, 23)")
    assert gen.replay(tmp_path / "few.nc", 2).identical
    with gen.open_corpus(tmp_path / "few.nc") as few, gen.open_corpus(other) as whole:
        assert gen.read_scenarios(few.isel(record=2)) == gen.read_scenarios(whole.isel(record=11))


def imported(folder, fs, samples, channel):
    """Write four records as an importer does."""
    rng = np.random.default_rng(0)
    found = {v.name: np.array(["machine 3"] * 4, object) if v.dtype == "str" else np.zeros(4) for v in SCHEMA}
    found |= {"fault": [0, 0, 1, 1], "specimen": [0, 0, 1, 1], "recording": range(4), "sample_rate": [fs] * 4}
    found["identity"] = [identity("0123456789ab", 0, number // 2, number) for number in range(4)]
    signal = rng.normal(size=(4, 1, samples)).astype(np.float32)
    with new_corpus(folder, title="Measured", importer="generic", basis=["labels rest on teardown"]) as corpus:
        corpus.write(make_dataset(signal, fs, (channel,), found, attributes={"title": "Measured", "source": "a pump"}))


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_simulated_and_imported_records_join_with_unknown_values_marked(simulated, tmp_path, order):
    time, channels, rates = columns(simulated[1], "elapsed_time", "channel", "sample_rate")
    imported(tmp_path / "measured", float(rates[0]), len(time), "accelerometer")
    sources = [(simulated[1], tmp_path / "measured")[place] for place in order]
    with pytest.raises(CorpusError, match=r"rename-channel (accelerometer=sensor|sensor=accelerometer)"):
        copy(sources, tmp_path / "both", float32=True)
    made = copy(sources, tmp_path / "both.nc", float32=True, rename={"accelerometer": str(channels[0])})
    assert {"draws", "true_shaft_rate", "detectable", "pair", "loaded_hits"} <= set(made.filled)
    assert validate_corpus(tmp_path / "both.nc") == []
    names = ("draws", "true_shaft_rate", "detectable", "pair", "loaded_hits")
    measured = slice(12, 16) if order[0] == 0 else slice(0, 4)
    draws, rate, detectable, pair, hits = (values[measured] for values in columns(tmp_path / "both.nc", *names))
    assert set(draws) == {""}
    assert np.isnan(rate).all()
    assert (set(detectable), set(pair), set(hits)) == ({2}, {-1}, {-1})
    assert read_manifest(tmp_path / "both.nc").basis == ("labels rest on teardown",)
    assert copy(tmp_path / "both.nc", tmp_path / "fast", where="true_shaft_rate > 0").records == 12
    assert gen.replay(tmp_path / "fast", 3).identical
    with pytest.raises(CorpusError, match="was not"):
        gen.replay(tmp_path / "both.nc", 13 if order[0] == 0 else 1)
