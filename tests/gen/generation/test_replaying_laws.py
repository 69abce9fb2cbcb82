"""Laws of replay: every record is made again bit for bit from its stored scenario, and a corpus without one gets a sentence."""

import re

import numpy as np
import pytest

from gen import generate, open_corpus, read_scenarios, replay, simulate, validate_corpus, write_corpus
from gen.corpus import FAULTS, SIGNAL, finish_corpus, part_name, write_part
from gen.corpus.numbering import NUMBERS
from gen.support.errors import CorpusError, RecipeError
from gen.support.yaml_files import parse_yaml
from tests.tampering import edited, seal


def written(records, folder):
    """A corpus of one part whose signals are in floating point."""
    (folder / "parts").mkdir(parents=True)
    rows = [write_part(records, folder / "parts" / part_name(0))]
    finish_corpus(folder, rows)


def test_any_record_can_be_made_again_bit_for_bit(whole, single):
    for generated, record in ((whole, 0), (whole, 7), (whole, 8), (single, 23)):
        replayed = replay(generated.path, record)
        assert replayed.identical
        assert replayed.dataset["recording"].values.tolist() == [record]
        with open_corpus(generated.path) as corpus:
            for name in ("draws", "fault", "shaft_rate", "snr", "true_bpfo"):
                assert replayed.dataset[name].values[0] == corpus[name].values[record]


def test_a_record_that_was_tampered_with_is_not_what_replay_makes(write_recipe, tmp_path):
    floating = {"recording.converter": {"kind": "float32"}, "storage.codec": "none", "records": 8}
    generated = generate(write_recipe(tmp_path / "r.yaml", floating), tmp_path / "c")
    with edited(generated.path / "parts" / part_name(0)) as part:
        part[SIGNAL][3, 0, 100] += 1e-4
    seal(generated.path)
    assert [replay(generated.path, record).identical for record in range(2, 5)] == [True, False, True]


def test_records_of_faults_and_levels_that_were_drawn_again_are_replayed_bit_for_bit(write_recipe, tmp_path):
    """Also where records before them were left out, so that their places in the corpus are not their numbers."""
    level = {"kind": "snr", "faulty_db": "uniform(-25, 10)", "healthy_db": "uniform(-15, 10)"}
    outer = {"kind": "outer", "width_mm": 0.5, "angle_deg": "uniform(-180, 180)"}
    hidden = {"kind": "ball", "width_mm": 0.1, "level": {"faulty_db": -60}}
    changes = {"level": level, "faults": [outer, hidden], "recording.duration_s": 0.25, "truth.undetected": "redraw"}
    generated = generate(write_recipe(tmp_path / "r.yaml", changes), tmp_path / "corpus")
    assert generated.failures
    with open_corpus(tmp_path / "corpus") as corpus:
        numbers, faults, levels = (corpus[name].values for name in ("recording", "fault_tries", "level_tries"))
    moved = numbers != np.arange(len(numbers))
    for wanted in (moved & (faults > 0), moved & (levels > 0)):
        assert replay(tmp_path / "corpus", int(np.flatnonzero(wanted)[0])).identical


def test_a_rung_alone_is_replayed_bit_for_bit(write_recipe, tmp_path):
    """The largest rung of its group, which set the level, is not in the corpus."""
    level = {"kind": "snr", "faulty_db": 0, "healthy_db": 0}
    faults = [{"kind": "healthy", "weight": 2}, {"kind": "inner", "width_mm": 0.5}]
    size = {"corpus.rungs": [0, 0.5, 1], "corpus.records_per_specimen": 1, "corpus.rigs": 1}
    changes = {"level": level, "faults": faults, **size}
    generate(write_recipe(tmp_path / "r.yaml", changes), tmp_path / "corpus")
    with open_corpus(tmp_path / "corpus") as corpus:
        small = corpus.isel(record=np.isin(corpus["rung"].values, (0, 1))).load()
    assert set(small["rung"].values) == {0, 1}
    write_corpus(small, tmp_path / "small")
    assert all(replay(tmp_path / "small", record).identical for record in range(small.sizes["record"]))


def test_a_record_is_replayed_with_channels_cut_renamed_or_exchanged_and_in_floating_point(write_recipe, tmp_path):
    channels = [{"name": "x", "body": "housing"}, {"name": "y", "body": "housing", "angle_deg": 90}]
    recipe = write_recipe(tmp_path / "r.yaml", {"recording.channels": channels, "records": 3})
    generate(recipe, tmp_path / "made")
    with open_corpus(tmp_path / "made") as corpus:
        whole = corpus.load().drop_encoding().drop_vars(["fault_name", "split_name"])
    whole = whole.assign_coords(
        elapsed_time=whole["elapsed_time"].astype(np.float64)
    )  # in the byte order of this machine
    copies = {
        "whole": whole,
        "cut": whole.isel(channel=[1]),
        "renamed": whole.assign_coords(channel=["a", "b"]),
        "exchanged": whole.assign_coords(channel=["y", "x"]),
        "in other order": whole.isel(channel=[1, 0]),
    }
    for name, copy in copies.items():
        written(copy, tmp_path / name)
        again = replay(tmp_path / name, 2)
        assert again.identical
        assert again.dataset["channel"].values.tolist() == ["x", "y"]


@pytest.fixture(scope="module")
def one_record(write_recipe, tmp_path_factory):
    """A record with a fault from the middle of a corpus, and the file of its recipe."""
    folder = tmp_path_factory.mktemp("one")
    level = {"kind": "snr", "faulty_db": "uniform(-20, 10)", "healthy_db": "uniform(-15, 10)"}
    changes = {"level": level, "recording.duration_s": 0.25, "truth.undetected": "redraw", "storage.codec": "none"}
    generated = generate(write_recipe(folder / "r.yaml", changes), folder / "whole")
    with open_corpus(generated.path) as corpus:
        tried = (corpus["level_tries"].values > 0) & (corpus["fault"].values == FAULTS.index("outer"))
        record = corpus.isel(record=np.flatnonzero(tried)[[-1]]).load()
    (scenario,) = read_scenarios(record)
    (folder / "record.yaml").write_text(scenario.text, encoding="utf-8")
    return record, scenario, folder / "record.yaml"


def test_the_recipe_of_a_record_gives_the_record_again(one_record, tmp_path):
    """In a corpus of its own, in which all its numbers are 0."""
    record, _, path = one_record
    for name in ("folder", "file.nc"):
        first, second = (generate(path, tmp_path / name) for _ in range(2))
        assert (first.records, first.kept, second.kept) == (1, 0, 1)
        assert validate_corpus(tmp_path / name) == []
        with open_corpus(tmp_path / name) as corpus:
            assert [int(corpus[number][0]) for number in NUMBERS] == [0, 0, 0, -1]
            assert int(record["recording"][0]) > 8
            for variable in set(record.variables) - {*NUMBERS, "channel", "elapsed_time", "step_error"}:
                np.testing.assert_array_equal(corpus[variable].values, record[variable].values, variable)
        assert replay(tmp_path / name, 0).identical


def test_an_edited_recipe_of_a_record_gives_another_record_with_its_labels(one_record, tmp_path):
    record, scenario, path = one_record
    (width,), rpm = scenario.recipe.faults[0].width_mm, scenario.recipe.operation.shaft_rpm
    for key, value, written, factor, label in (
        ("width_mm", width, f"[{width:g}]", 2.0, "width"),
        ("shaft_rpm", rpm, f"{rpm!r}", 1.25, "true_shaft_rate"),
    ):
        text = path.read_text(encoding="utf-8")
        edited = text.replace(f"{key}: {written}", f"{key}: {factor * value!r}")
        assert edited != text
        (tmp_path / "edited.yaml").write_text(edited, encoding="utf-8")
        generate(tmp_path / "edited.yaml", tmp_path / key)
        with open_corpus(tmp_path / key) as corpus:
            assert corpus[label].values == pytest.approx(factor * record[label].values, rel=1e-3)
            assert not np.array_equal(corpus[SIGNAL].values, record[SIGNAL].values)


def test_a_recipe_of_a_record_without_its_fault_gives_the_healthy_record(one_record, tmp_path):
    _, scenario, path = one_record
    keys = parse_yaml(path.read_text(encoding="utf-8"), "record", RecipeError)
    generate(keys | {"faults": [{"kind": "healthy"}]}, tmp_path / "healthy")
    sound = simulate([scenario.without_fault()])
    with open_corpus(tmp_path / "healthy") as corpus:
        assert corpus["fault_name"].values.tolist() == ["healthy"]
        np.testing.assert_array_equal(corpus[SIGNAL].values, sound[SIGNAL].values)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"origin": {"split": "half"}}, "origin.split: 'half' is not allowed here"),
        ({"origin": {"record": -1}}, "origin.record: -1 is not allowed here"),
        ({"bearing": ["6205", "6206"]}, "bearing.designations: one record, with an origin, has one of them"),
        ({"operation": {"shaft_rpm": "uniform(1, 2)"}}, "operation.shaft_rpm: uniform(1, 2) is no number"),
        ({"contact": {"lubricant": {"viscosity_100_mm2_s": 80}}}, "rig 2: oil of 68 mm2/s at 40 C has no lower viscosity"),
        ({"path": {"modulation": {"probability": 0.5, "first": 0.1, "second": 0}}}, "path.modulation.probability: one record"),
        (
            {"sensor_faults": {"loose_mount": {"probability": 1, "loose_channels": [5], "frequency_hz": [500],
                "damping_percent": [5], "holding_m_s2": [10]}}},
            "sensor_faults.loose_mount.loose_channels: a record has",
        ),
    ],
)  # fmt: skip
def test_what_one_record_cannot_have_is_one_sentence(one_record, change, sentence):
    with pytest.raises(RecipeError, match=f"^{re.escape(sentence)}") as raised:
        one_record[1].with_(**change)
    assert "\n" not in str(raised.value)


def test_a_stored_text_that_is_no_scenario_is_refused_with_corpus_and_record(nine):
    with pytest.raises(CorpusError, match=r"c: record 4: stored scenario: is not the JSON text of a recipe"):
        replay(nine / "c", 4)
