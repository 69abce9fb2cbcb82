"""Mapping files of earlier versions: a plain list of files is read for one more release, and a script converts the others."""

import numpy as np
import pytest
import scipy.io

from gen.corpus import open_corpus
from gen.importers import import_generic
from gen.support.errors import CorpusError
from tests.labels import import_labelled
from tools.mapping_to_labels import convert

TOP = "bearing: '6205'\nunit: g\nsample_rate_hz: 2000\nshaft_rpm: 1500\n"
FILES = [
    {"path": "a.npy", "fault": "healthy", "specimen": 1},
    {"path": "b.npy", "fault": "outer", "specimen": 2, "width_mm": 0.5},
]


def noise(seed, size=1100):
    return np.random.default_rng(seed).normal(size=size)


def content(path):
    with open_corpus(path) as corpus:
        return corpus.load().drop_attrs()


def write(folder, text):
    (folder / "mapping.yaml").write_text(text)
    return folder / "mapping.yaml"


@pytest.fixture
def folder(tmp_path):
    for number, name in enumerate("ab"):
        np.save(tmp_path / f"{name}.npy", noise(number))
    return tmp_path


def test_a_plain_list_of_files_gives_the_corpus_of_a_table(folder):
    table = import_labelled(folder, FILES, bearing="6205", unit="g", sample_rate_hz=2000, shaft_rpm=1500)
    plain = import_generic(write(folder, f"{TOP}files: {FILES}"), folder / "plain")
    any_letters = (
        TOP
        + "fault: outer\nwidth_mm: 0.5\nspecimen: 2\nfiles: [{path: a.npy, fault: healthy, specimen: 1, width_mm: null}, {path: '[b]*'}]"
    )
    both = import_generic(write(folder, any_letters.replace("[b]*", "?.npy")), folder / "both")
    assert content(plain.path).identical(content(table.path))
    assert content(both.path)["source"].values.tolist()[:2] == ["a.npy#0", "b.npy#0"]


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("files: [{path: '{fault}.npy', specimen: 1}]", "files[0].path"),
        ("files: [{path: '**/*.npy', specimen: 1}]", "files[0].path"),
        ("fault: {a: healthy}\nfiles: [{path: a.npy, specimen: 1}]", "fault"),
        ("files: [{path: a.npy, shaft_rpm: {variable: rpm}}]", "files[0].shaft_rpm"),
    ],
)
def test_the_language_of_mapping_files_is_refused_with_the_command_that_converts_it(folder, text, place):
    with pytest.raises(CorpusError) as refused:
        import_generic(write(folder, TOP + text), folder / "corpus")
    mapping = folder / "mapping.yaml"
    assert str(refused.value) == (
        f"{mapping}: {place}: is in the language of mapping files, which is no longer read; in the repository of Raceway, "
        f"python tools/mapping_to_labels.py {mapping} turns it into a table of labels."
    )


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("rig: 1", "mapping.yaml: has no list of files; give a table of labels, such as"),
        ("files: [{path: ../a.npy, fault: inner, specimen: 1}]", "files[0].path: ../a.npy leads out of the folder"),
        ("files: [{path: ../*.npy, fault: inner, specimen: 1}]", "files[0].path: ../*.npy leads out of the folder"),
        ("files: [{path: a.npy, fault: gear, specimen: 1}]", "files[0].fault: 'gear' is not allowed here"),
        (
            "files: [{path: a.npy, fault: inner}]",
            "files[0].specimen: is missing; give it there, or for all files in mapping.yaml.",
        ),
    ],
)
def test_a_wrong_mapping_file_is_refused_with_its_place(folder, text, sentence):
    with pytest.raises(CorpusError) as refused:
        import_generic(write(folder, TOP + text), folder / "corpus")
    assert sentence in str(refused.value)


def test_the_script_writes_what_paths_tables_and_files_tell(tmp_path):
    for name, rpm in (("N_800_10", 1501), ("N_800_9", 1500), ("outer_race_1200_1", 1200), ("X_800_1", 800)):
        (tmp_path / "A1").mkdir(exist_ok=True)
        scipy.io.savemat(tmp_path / "A1" / f"{name}.mat", {f"v{name[0]}": noise(len(name)), "turns": rpm / 60})
    table = convert(
        write(
            tmp_path,
            "bearing: {designation: L8, n_balls: 8, pitch_diameter_mm: 33.5, ball_diameter_mm: 7.1}\nunit: g\nsample_rate_hz: 2000\n"
            "fault: {N: healthy, outer_race: outer}\nload_n: {times: 1000}\nwidth_mm: 1.016\nshaft_rpm: {variable: turns, times: 60}\n"
            "files: [{path: '{rig}/{fault}_{load_n}_*.mat', specimen: '{rig} {fault}', recording: '{fault}', variable: v*}]\n",
        ),
        tmp_path,
    )
    assert table.read_text().splitlines() == [
        "path,fault,specimen,load_n,shaft_rpm,recording,width_mm",
        "A1/N_800_9.mat,healthy,A1 N,800000.0,1500.0,N,",
        "A1/N_800_10.mat,healthy,A1 N,800000.0,1500.0,N,",
        "A1/outer_race_1200_1.mat,outer,A1 outer_race,1200000.0,1200.0,outer_race,1.0160",
    ]
    done = import_generic(table, tmp_path / "corpus")
    assert (done.recordings, done.skipped) == (2, ())
    with open_corpus(done.path) as corpus:
        np.testing.assert_allclose(np.unique(corpus.width), [0, 1.016e-3])
