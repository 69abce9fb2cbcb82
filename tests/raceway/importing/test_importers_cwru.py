"""The CWRU importer on small made-up files, each with one irregularity."""

import json
import math
import shutil

import numpy as np
import pytest
import scipy.io
import scipy.signal

from gen.corpus import FAULTS, open_corpus, validate_corpus
from gen.support.errors import CorpusError
from raceway.importing import import_set
from raceway.importing.published import published_sets
from raceway.sharing.card.card_page import data_card

G = 9.80665


def noise(samples=13_000, seed=0):
    return np.random.default_rng(seed).normal(size=(samples, 1))


def write(folder, name, variables):
    folder.mkdir(parents=True, exist_ok=True)
    scipy.io.savemat(folder / name, variables)


def published(folder, number, *, name=None, rpm=1797, samples=13_000, held=None):
    variables = {f"X{held or number:03d}_DE_time": noise(samples, number)}
    if rpm is not None:
        variables[f"X{held or number:03d}RPM"] = rpm
    write(folder, name or f"{number}_0.mat", variables)


@pytest.fixture
def source(tmp_path):
    return tmp_path / "set"


@pytest.fixture
def output(tmp_path):
    return tmp_path / "corpus"


def imported(source, output, **options):
    done = import_set("cwru", source, output, **options)
    assert validate_corpus(output) == []
    with open_corpus(output) as corpus:
        return done, corpus.load()


def test_a_recording_becomes_half_second_records_in_metres_per_second_squared(source, output):
    published(source / "IR" / "007", 105)
    done, corpus = imported(source, output)
    assert (done.recordings, done.records, done.skipped) == (1, 2, ())
    assert corpus.acceleration.shape == (2, 1, 6000)
    np.testing.assert_array_equal(
        corpus.acceleration.values[1, 0], (noise(13_000, 105)[6000:12_000, 0] * G).astype(np.float32)
    )
    assert corpus.source.values.tolist() == ["IR/007/105_0.mat:X105_DE_time#0", "IR/007/105_0.mat:X105_DE_time#6000"]
    assert corpus.sample_rate.values.tolist() == [12_000, 12_000]
    assert corpus.recording.values.tolist() == [105, 105]


def test_the_published_tables_tell_fault_size_place_and_load(source, output):
    for number in (105, 120, 3008, 132, 145, 160, 100):
        published(source, number, rpm=None, held={3008: 51}.get(number))
    _, corpus = imported(source, output)
    done = {
        int(corpus.recording[row]): (
            FAULTS[corpus.fault.values[row]],
            round(float(corpus.width[row]) / 25.4e-6),
            None if np.isnan(corpus.angle[row]) else round(math.degrees(corpus.angle[row])),
            round(float(corpus.shaft_rate[row]) * 60),
            round(float(corpus.motor_load[row]) / 745.7),
        )
        for row in range(corpus.sizes["record"])
    }
    assert done == {
        105: ("inner", 7, None, 1797, 0),
        120: ("ball", 7, None, 1750, 2),
        3008: ("ball", 28, None, 1730, 3),
        132: ("outer", 7, -90, 1750, 2),
        145: ("outer", 7, 0, 1772, 1),
        160: ("outer", 7, 90, 1730, 3),
        100: ("healthy", 0, None, 1730, 3),
    }
    assert np.isnan(corpus["load"]).all()


# Case Western Reserve University Bearing Data Center, tables "Normal Baseline Data" and "12k Drive End Bearing Fault Data"; the
# published copies carry number and load in their names, such as 12k_drive_end/B/014/187_2.mat. Per row: fault, diameter [mil],
# position on the outer race, and the recording at 0, 1, 2 and 3 hp.
PUBLISHED = """
normal   0  -  97   98   99   100
inner    7  -  105  106  107  108
inner   14  -  169  170  171  172
inner   21  -  209  210  211  212
inner   28  -  3001 3002 3003 3004
ball     7  -  118  119  120  121
ball    14  -  185  186  187  188
ball    21  -  222  223  224  225
ball    28  -  3005 3006 3007 3008
outer    7  6  130  131  132  133
outer   14  6  197  198  199  200
outer   21  6  234  235  236  237
outer    7  3  144  145  146  147
outer   21  3  246  247  248  249
outer    7  12 156  158  159  160
outer   21  12 258  259  260  261
"""


CLOCK = {None: None, 0: 3, -90: 6, 90: 12}  # by the angle in degrees


def test_every_recording_has_the_fault_and_the_load_of_the_published_tables():
    published = {}
    for row in PUBLISHED.split("\n")[1:-1]:
        fault, diameter, clock, *numbers = row.split()
        for load, number in enumerate(numbers):
            place = None if clock == "-" else int(clock)
            published[int(number)] = (fault.replace("normal", "healthy"), int(diameter), place, load)
    done = {
        number: (row["fault"], round(row.get("width_mm", 0) / 0.0254), CLOCK[row.get("angle_deg")], load)
        for row in published_sets()["cwru"].rows
        for load, number in enumerate(row["number"])
    }
    assert done == published
    assert len(published) == 64


def test_the_loads_of_one_fault_are_one_specimen_and_another_fault_is_another(source, output):
    for number in (105, 106, 169, 130, 144):
        published(source, number)
    _, corpus = imported(source, output)
    specimen = dict(zip(corpus.recording.values.tolist(), corpus.specimen.values.tolist(), strict=True))
    assert specimen[105] == specimen[106]
    assert len({specimen[number] for number in (105, 169, 130, 144)}) == 4


def test_specimens_have_the_same_number_in_both_subsets(tmp_path, source):
    published(source, 234)
    numbers = [imported(source, tmp_path / subset, subset=subset)[1].specimen.values[0] for subset in ("all", "wang")]
    assert numbers[0] == numbers[1]


def test_the_wang_subset_is_forty_recordings_of_four_classes(source, output):
    for row in published_sets()["cwru"].rows:
        for number in row["number"]:
            published(source, number, samples=6000, held={3001: 56, 3005: 48}.get(number))
    done, corpus = imported(source, output, subset="wang")
    assert done.recordings == done.records == 40
    assert np.bincount(corpus.fault).tolist() == [4, 12, 12, 12]


def test_missing_recordings_are_counted_and_named(source, output):
    for number in range(97, 101):
        published(source, number)
    done, _ = imported(source, output, subset="wang")
    assert any(text.startswith("36 of 40 recordings were not found: 105, 106,") for text in done.warnings)


@pytest.mark.parametrize("name", ["105.mat", "105_0.MAT", "12k_Drive_End_IR007_0_105.mat"])
def test_a_recording_is_known_by_its_number_whatever_else_is_in_the_name(source, output, name):
    published(source, 105, name=name)
    assert imported(source, output)[0].recordings == 1


def test_28_mil_files_hold_other_numbers_and_no_speed_and_both_are_told(source, output):
    published(source, 3002, rpm=None, held=57)
    done, corpus = imported(source, output)
    assert corpus.shaft_rate.values[0] == pytest.approx(1772 / 60)
    told = " ".join(done.warnings)
    assert "3002_0.mat:X057_DE_time: is of a bearing of another maker, with lines at 3.68 and 5.32 orders" in told
    assert "3002_0.mat:X057_DE_time: states no speed: the nominal 1772 rpm are used." in told


def test_variables_of_another_number_beside_the_wanted_ones_do_not_matter(source, output):
    write(
        source,
        "99.mat",
        {"X098_DE_time": noise(seed=98), "X099_DE_time": noise(seed=99), "X098RPM": 1772, "X099RPM": 1750},
    )
    _, corpus = imported(source, output)
    assert corpus.acceleration.values[0, 0, 0] == np.float32(noise(seed=99)[0, 0] * G)
    assert corpus.shaft_rate.values[0] == pytest.approx(1750 / 60)


@pytest.mark.parametrize(("share", "kept"), [(0, False), (0.949, False), (0.951, True), (1.049, True), (1.051, False)])
def test_a_speed_within_5_percent_of_the_nominal_one_is_kept(source, output, share, kept):
    published(source, 106, rpm=1772 * share)
    done, corpus = imported(source, output)
    assert corpus.shaft_rate.values[0] == pytest.approx(1772 / 60 * (share if kept else 1))
    assert any("the nominal 1772 rpm" in text for text in done.warnings) is not kept


def test_158_keeps_its_doubtful_speed_with_a_warning(source, output):
    published(source, 158, rpm=1773)
    done, corpus = imported(source, output)
    assert corpus.shaft_rate.values[0] == pytest.approx(1773 / 60)
    assert any("158_0.mat:X158_DE_time: the speed in it differs by about 2 %" in text for text in done.warnings)


def test_a_healthy_recording_at_48_khz_is_resampled_as_the_12_khz_copies_were(source, output):
    published(source, 97, samples=240_000)
    published(source, 98, samples=121_000)
    done, corpus = imported(source, output)
    expected = scipy.signal.resample_poly(noise(240_000, 97)[:, 0] * G, 1, 4)
    np.testing.assert_array_equal(corpus.acceleration.values[0, 0], expected[:6000].astype(np.float32))
    assert np.bincount(corpus.recording)[[97, 98]].tolist() == [10, 20]
    told = " ".join(done.warnings)
    assert "97_0.mat:X097_DE_time: its 240000 samples are taken as recorded at 48000 Hz." in told
    assert "97_0.mat:X097_DE_time: resampled from 48000 to 12000 Hz" in told
    assert "98_0.mat:X098_DE_time: its 121000 samples are taken as recorded at 12000 Hz." in told


def test_the_corpus_tells_what_was_skipped_and_done(source, output):
    published(source, 158)
    (source / "106.mat").write_bytes(b"")
    done, _ = imported(source, output)
    manifest = json.loads((output / "manifest.json").read_text())
    card = data_card(output)
    assert manifest["skipped"] == list(done.skipped)
    assert all(sentence in card for sentence in (*done.skipped, *done.warnings))
    assert "no licence text is stated" in card
    assert "| outer | 2 | 1 |" in card


def test_files_that_hold_no_such_recording_are_named_and_the_others_are_imported(source, output):
    """Damaged files: test_importers_refused.py."""
    published(source, 105)
    write(source, "106.mat", {"X222_DE_time": noise(), "X222RPM": 1796})
    write(source, "107.mat", {"bearing": {"gs": noise(), "sr": 48828}})
    done, corpus = imported(source, output)
    assert (done.recordings, set(corpus.recording.values.tolist())) == (1, {105})
    assert [sentence.partition(", nor")[0] for sentence in done.skipped] == [
        "106.mat:X106_DE_time: holds X222_DE_time, X222RPM, not X106_DE_time; name one with variable; skipped.",
        "107.mat:X107_DE_time: holds bearing.gs, bearing.sr, not X107_DE_time; name one with variable; skipped.",
    ]


def test_files_that_are_no_drive_end_recordings_or_come_twice_are_named(source, output):
    published(source / "a", 105)
    published(source / "b", 105)
    published(source, 278)
    write(source, "notes.mat", {"x": 1})
    done, _ = imported(source, output)
    assert done.recordings == 1
    assert done.skipped == (
        "278_0.mat: has no number of a drive-end recording at 12 kHz in its path; skipped.",
        "b/105_0.mat: is 105 again, which a/105_0.mat holds; skipped.",
        "notes.mat: has no number of a drive-end recording at 12 kHz in its path; skipped.",
    )


def test_an_interrupted_import_leaves_nothing_behind(source, output):
    published(source, 105)

    def interrupt(done, total):
        assert (done, total) == (1, 1)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        import_set("cwru", source, output, progress=interrupt)
    assert [path.name for path in output.parent.iterdir()] == ["set"]


def test_the_same_files_give_the_same_bytes(tmp_path, source):
    published(source, 105)
    first, second = (import_set("cwru", source, tmp_path / name).path for name in ("one", "two"))
    for path in sorted(path.relative_to(first) for path in first.rglob("*") if path.is_file()):
        assert (first / path).read_bytes() == (second / path).read_bytes(), path


def test_an_unknown_subset_is_refused_with_a_sentence(source, output):
    with pytest.raises(CorpusError, match="subset: 'loparo' is not known; choose all or wang"):
        import_set("cwru", source, output, subset="loparo")
    assert not output.exists()


def test_a_source_without_matlab_files_is_refused(source, output):
    with pytest.raises(CorpusError, match="no such folder"):
        import_set("cwru", source, output)
    source.mkdir()
    with pytest.raises(CorpusError, match=r"no \.mat file in it or below"):
        import_set("cwru", source, output)
    shutil.rmtree(source)
