"""Laws of damage: every change of a stored corpus is detected, and a failed write leaves no file."""

import hashlib
import json
import os
import resource
import shutil
import signal as signals

import h5py
import numpy as np
import pytest

from gen.corpus import (
    SIGNAL,
    open_corpus,
    open_part,
    part_name,
    read_manifest,
    validate_corpus,
    write_durably,
    write_index,
    write_manifest,
    write_part,
)
from gen.corpus.part import deflated
from gen.errors import CorpusError
from tests.corpora import SIZES, dataset, write_corpus


@pytest.fixture(scope="module")
def corpus(tmp_path_factory):
    folder = tmp_path_factory.mktemp("corpus") / "c"
    write_corpus(folder)
    return folder


@pytest.fixture
def copied(corpus, tmp_path):
    return shutil.copytree(corpus, tmp_path / "copy")


def flip(path, place=-100):
    content = bytearray(path.read_bytes())
    content[place] ^= 0xFF
    path.write_bytes(content)


def rename_in_manifest(folder, name):
    manifest = json.loads((folder / "manifest.json").read_text())
    manifest["parts"][1]["name"] = name
    (folder / "manifest.json").write_text(json.dumps(manifest))


def edit_index(folder, edit):
    with h5py.File(folder / "corpus.nc", "r+") as index:
        edit(index)


def swap_sources(index, parts):
    """Let the virtual signal refer to other parts, or to parts in another order."""
    shape, dtype, fill = index[SIGNAL].shape, index[SIGNAL].dtype, index[SIGNAL].fillvalue
    attributes = {key: index[SIGNAL].attrs[key] for key in ("scale_factor", "add_offset", "units", "long_name", "role")}
    del index[SIGNAL]
    layout = h5py.VirtualLayout(shape, dtype)
    first = 0
    for name, records in parts:
        layout[first : first + records] = h5py.VirtualSource(name, SIGNAL, (records, *shape[1:]), dtype)
        first += records
    fresh = index.create_virtual_dataset(SIGNAL, layout, fillvalue=fill)
    fresh.attrs.update(attributes)
    fresh.attrs["_FillValue"] = np.int16(fill)
    for axis, name in enumerate(("record", "channel", "elapsed_time")):
        fresh.dims[axis].attach_scale(index[name])


def seal(folder):
    """Write the hash of the changed index into the manifest: damage by someone who knows the format."""
    index = folder / "corpus.nc"
    edit_manifest(
        folder, index={"bytes": index.stat().st_size, "sha256": hashlib.sha256(index.read_bytes()).hexdigest()}
    )


def edit_manifest(folder, parts=(), **changes):
    manifest = json.loads((folder / "manifest.json").read_text()) | changes
    for number, change in dict(parts).items():
        manifest["parts"][number] |= change
    (folder / "manifest.json").write_text(json.dumps(manifest))


def other_index(folder):
    other = folder.with_name("other")
    write_corpus(other, SIZES[::-1])
    shutil.copyfile(other / "corpus.nc", folder / "corpus.nc")


def link_out(path):
    path.rename(path.parents[1 + (path.suffix == ".nc" and path.parent.name == "parts")] / f"moved-{path.name}")
    path.symlink_to(path.parents[1 + (path.suffix == ".nc" and path.parent.name == "parts")] / f"moved-{path.name}")


def make_pipe(path):
    path.unlink()
    os.mkfifo(path)


PARTS = [(f"parts/{part_name(number)}", size) for number, size in enumerate(SIZES)]
REFUSED = {
    "a part is missing": (lambda c: (c / "parts" / part_name(1)).unlink(), r"part-00001\.nc: is missing; copy it again"),
    "a part is altered": (lambda c: flip(c / "parts" / part_name(1)), r"part-00001\.nc: is altered: its size or hash differs"),
    "a part is cut short": (lambda c: os.truncate(c / "parts" / part_name(2), 500), r"part-00002\.nc: is altered"),
    "a part is empty": (lambda c: os.truncate(c / "parts" / part_name(2), 0), r"part-00002\.nc: is altered"),
    "a part stands for another": (
        lambda c: shutil.copyfile(c / "parts" / part_name(0), c / "parts" / part_name(2)), r"part-00002\.nc: is altered",
    ),
    "the manifest is gone": (lambda c: (c / "manifest.json").unlink(), r"has no manifest\.json, so it is not a corpus"),
    "the manifest is no JSON": (lambda c: (c / "manifest.json").write_text("{"), r"manifest\.json: not a corpus manifest"),
    "the manifest lists no parts": (lambda c: (c / "manifest.json").write_text("{}"), r"manifest\.json: not a corpus manifest"),
    "a part name leads out": (lambda c: rename_in_manifest(c, "../x"), r"'\.\./x' is not the name of a part"),
    "a part name is a path": (lambda c: rename_in_manifest(c, "/etc/passwd"), r"is not the name of a part"),
    "a part name is no text": (lambda c: rename_in_manifest(c, 7), r"manifest\.json: not a corpus manifest \(parts\.1\.name"),
    "the index is gone": (lambda c: (c / "corpus.nc").unlink(), r"corpus\.nc: is missing; copy it again"),
    "the index is cut short": (lambda c: os.truncate(c / "corpus.nc", 900), r"corpus\.nc: is altered: its size or hash differs"),
    "the index is that of another corpus": (other_index, r"corpus\.nc: is altered: its size or hash differs"),
    "a byte of the index is flipped": (lambda c: flip(c / "corpus.nc"), r"corpus\.nc: is altered: its size or hash differs"),
    "a part is a link out of the corpus": (
        lambda c: link_out(c / "parts" / part_name(1)), r"part-00001\.nc: is a link that leads out of the corpus; replace it",
    ),
    "the index is a link out of the corpus": (lambda c: link_out(c / "corpus.nc"), r"corpus\.nc: is a link that leads out of the corpus"),
    "the folder of the parts is a link": (
        lambda c: link_out(c / "parts"), r"part-00000\.nc: is a link that leads out of the corpus; replace it",
    ),
    "a part is a pipe": (lambda c: make_pipe(c / "parts" / part_name(0)), r"part-00000\.nc: is not a plain file; copy it again"),
    "the manifest is a pipe": (lambda c: make_pipe(c / "manifest.json"), r"manifest\.json: is not a plain file"),
    "the manifest counts other records": (lambda c: edit_manifest(c, records=8), r"it counts 8 records, its parts 9"),
    "the manifest counts a part wrongly": (
        lambda c: edit_manifest(c, records=10, parts={0: {"records": 4}}), r"9 records, the parts hold 10|disagree about parts",
    ),
    "the manifest lists a part twice": (
        lambda c: edit_manifest(c, parts={1: {"name": part_name(0)}}), r"it lists part-00000\.nc more than once",
    ),
    "the manifest has no hash of the index": (lambda c: edit_manifest(c, index=None), r"has no hash of corpus\.nc"),
    "the manifest holds lists for objects": (lambda c: (c / "manifest.json").write_text("[[]]"), r"not a corpus manifest"),
    "the manifest is nested without end": (
        lambda c: (c / "manifest.json").write_text("[" * 100_000), r"not a corpus manifest",
    ),
    "a number of the manifest has 5000 digits": (
        lambda c: (c / "manifest.json").write_text('{"records": ' + "9" * 5000 + "}"), r"not a corpus manifest",
    ),
    "the manifest is no UTF-8": (lambda c: (c / "manifest.json").write_bytes(b'{"title": "\xff"}'), r"not a corpus manifest"),
    "the manifest is huge": (lambda c: os.truncate(c / "manifest.json", 60_000_000), r"raceway --limit manifest_bytes=NUMBER"),
}  # fmt: skip


@pytest.mark.parametrize("damage", REFUSED)
def test_a_damaged_corpus_is_refused_with_the_file_named_and_found_by_validation(copied, damage):
    break_it, sentence = REFUSED[damage]
    break_it(copied)
    with pytest.raises(CorpusError, match=sentence):
        open_corpus(copied)
    problems = validate_corpus(copied)
    assert len(problems) == (3 if "parts is a link" in damage else 1)
    assert str(copied) in problems[0]
    with pytest.raises(CorpusError, match=sentence):
        raise CorpusError(problems[0])


def set_value(index, place, name, value):
    index[name][place] = value


def plain_signal(index):
    attributes, values = dict(index[SIGNAL].attrs), index[SIGNAL][:]
    del index[SIGNAL]
    index.create_dataset(SIGNAL, data=values).attrs.update(
        {k: v for k, v in attributes.items() if k != "DIMENSION_LIST"}
    )


def external_link(index):
    del index["load"]
    index["load"] = h5py.ExternalLink("/etc/passwd", "load")


def external_storage(index):
    del index["load"]
    index.create_dataset("load", (9,), "f8", external=[("/etc/passwd", 0, 72)])


def virtual_label(index):
    del index["load"]
    layout = h5py.VirtualLayout((9,), "f8")
    layout[:] = h5py.VirtualSource("/etc/secret.nc", "load", (9,), "f8")
    index.create_virtual_dataset("load", layout)


FOUND = {
    "a label differs from its part": (lambda i: set_value(i, 2, "fault", 0), "fault differs from corpus.nc"),
    "a shaft rate differs": (lambda i: set_value(i, 2, "shaft_rate", 99.0), "shaft_rate differs from corpus.nc"),
    "the signal is scaled otherwise": (
        lambda i: i[SIGNAL].attrs.modify("scale_factor", 1.0), "acceleration differs from corpus.nc",
    ),
    "parts of the signal are swapped": (
        lambda i: swap_sources(i, [PARTS[1], PARTS[0], PARTS[2]]), "index and manifest disagree about parts/part-00000.nc",
    ),
    "labels are permuted": (
        lambda i: set_value(i, slice(None), "fault", i["fault"][:][::-1]), "fault differs from corpus.nc",
    ),
    "the signal is read from files elsewhere": (
        lambda i: swap_sources(i, [("../secret.nc", 3), *PARTS[1:]]), "index and manifest disagree about ../secret.nc",
    ),
    "a part is left out of the signal": (
        lambda i: swap_sources(i, [PARTS[0], (PARTS[1][0], 6)]), "index and manifest disagree about parts/part-00001.nc",
    ),
    "there is no signal": (lambda i: i.pop(SIGNAL), "not a corpus index"),
    "the signal is a plain dataset": (plain_signal, "acceleration is not a virtual dataset"),
    "a label is an external link": (external_link, "load is a soft or external link"),
    "a label is stored in another file": (external_storage, "the values of load are in another file"),
    "a label is a virtual dataset": (virtual_label, "load is a virtual dataset"),
    "a variable of no known dimension": (lambda i: i.create_dataset("x", data=np.zeros(4)), "x is of type"),
    "numbers with the encoding of text": (
        lambda i: i["fault"].attrs.create("_Encoding", "utf-8"), "fault has the attribute _Encoding, which it must not have",
    ),
    "a label that is packed": (
        lambda i: i["load"].attrs.create("scale_factor", 2.0), "load has the attribute scale_factor, which it must not have",
    ),
    "a group": (lambda i: i.create_group("x"), "x"),
}  # fmt: skip


@pytest.mark.parametrize("damage", FOUND)
def test_validation_finds_an_index_that_does_not_say_what_its_parts_say(copied, damage):
    break_it, sentence = FOUND[damage]
    edit_index(copied, break_it)
    seal(copied)
    assert any(sentence in problem for problem in validate_corpus(copied))


@pytest.mark.parametrize(
    ("name", "key", "value"), [(SIGNAL, "units", "g"), ("fault", "flag_meanings", "inner healthy outer ball")]
)
def test_validation_finds_an_index_whose_attributes_are_not_those_of_its_parts(copied, name, key, value):
    edit_index(copied, lambda index: index[name].attrs.modify(key, value))
    seal(copied)
    assert any(name in problem for problem in validate_corpus(copied))


def test_a_signal_is_not_read_by_a_scale_that_is_not_that_of_its_part(copied):
    edit_index(copied, lambda index: index[SIGNAL].attrs.modify("scale_factor", 1.0))
    seal(copied)
    with (
        open_corpus(copied) as corpus,
        pytest.raises(CorpusError, match=r"part-00000\.nc: its signal has another shape or type than the corpus"),
    ):
        corpus[SIGNAL][0].load()


CHUNKS = {
    "no stream": (b"no zlib stream", 0),
    "too short": (deflated(np.zeros(49, np.int16)), 0),
    "too long": (deflated(np.zeros(5000, np.int16)), 0),
    "cut short": (deflated(np.arange(50, dtype=np.int16))[:-4], 0),
    "without its filters": (np.zeros(50, np.int16).tobytes(), 3),
}


@pytest.mark.parametrize("chunk", CHUNKS)
def test_a_damaged_chunk_is_refused_when_it_is_read(copied, chunk):
    path = copied / "parts" / part_name(0)
    content, left_out = CHUNKS[chunk]
    with h5py.File(path, "r+") as part:
        part[SIGNAL].id.write_direct_chunk((1, 0, 0), content, left_out)
    with open_part(path) as part:
        part[SIGNAL][0].load()
        with pytest.raises(CorpusError, match=r"part-00000\.nc: damaged \(.*\); generate or copy it again"):
            part[SIGNAL][1].load()


def damaged_part(change):
    """A corpus whose last part was damaged before its index and manifest were written."""

    def make(folder):
        (folder / "parts").mkdir(parents=True)
        parts = [dataset(0, 3), change(dataset(3, 4))]
        rows = [write_part(part, folder / "parts" / part_name(number)) for number, part in enumerate(parts)]
        write_index(folder, rows)
        write_manifest(folder, rows, complete=True)

    return make


def with_values(name, value):
    def change(part):
        part[name].values[1] = value
        return part

    return change


def with_attribute(name, key, value):
    def change(part):
        part[name].attrs[key] = value
        return part

    return change


FOUND_IN_PARTS = {
    "a class that does not exist": (with_values("fault", 9), "fault has values other than 0 healthy, 1 inner"),
    "a split that does not exist": (with_values("split", -1), "split has values other than 0 train, 1 validation, 2 test."),
    "a missing variable": (lambda part: part.drop_vars("bpfo"), "bpfo"),
    "a wrong unit": (with_attribute("load", "units", "lbf"), "load is in 'lbf', not 'N'"),
    "a wrong type": (lambda part: part.assign(rig=part["rig"].astype("f8").assign_attrs(part["rig"].attrs)), "rig"),
    "no role": (with_attribute("draws", "role", "secret"), "draws needs a long_name and a role"),
    "a missing sample": (with_values(SIGNAL, -32768), "has samples that are not finite"),
}  # fmt: skip


@pytest.mark.parametrize("damage", FOUND_IN_PARTS)
def test_validation_finds_a_part_that_is_not_in_the_format(tmp_path, damage):
    change, sentence = FOUND_IN_PARTS[damage]
    damaged_part(change)(tmp_path / "c")
    assert any(sentence in problem for problem in validate_corpus(tmp_path / "c"))


def test_a_corpus_under_way_is_refused_until_it_is_complete(copied):
    write_manifest(copied, read_manifest(copied).parts[:2], complete=False)
    with pytest.raises(CorpusError, match="is unfinished; run the raceway generate command that began it again"):
        open_corpus(copied)


def test_a_corpus_of_another_format_version_is_refused(copied):
    manifest = json.loads((copied / "manifest.json").read_text()) | {"raceway_format": 99}
    (copied / "manifest.json").write_text(json.dumps(manifest))
    with pytest.raises(CorpusError, match="corpus format 99, this version of raceway reads format 2"):
        open_corpus(copied)


def test_sizes_alone_do_not_see_what_hashes_see(copied):
    flip(copied / "parts" / part_name(1))
    open_corpus(copied, check="size").close()
    with pytest.raises(CorpusError, match="altered"):
        open_corpus(copied, check="sha256")


@pytest.fixture
def small_disk():
    """Let no file grow beyond 20 kB while a test runs, as on a disk that fills up."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signals.signal(signals.SIGXFSZ, signals.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, before[1]))
    yield
    resource.setrlimit(resource.RLIMIT_FSIZE, before)
    signals.signal(signals.SIGXFSZ, handler)


@pytest.mark.usefixtures("small_disk")
def test_a_full_disk_leaves_no_half_part(tmp_path):
    large = dataset(0, 20, samples=5000)
    with pytest.raises(CorpusError, match=r"part-00000\.nc: could not be written .* free some space"):
        write_part(large, tmp_path / part_name(0), "none")
    assert list(tmp_path.iterdir()) == []


def test_a_pipe_or_a_folder_is_not_replaced_by_a_file(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for place in (tmp_path / "pipe", tmp_path):
        with pytest.raises(
            CorpusError, match="exists and is not a plain file, so it cannot be replaced; choose another name"
        ):
            write_durably(b"x", place)
    assert [path.name for path in tmp_path.iterdir()] == ["pipe"]


def test_a_full_disk_leaves_the_last_manifest_as_it_was(copied, request):
    request.getfixturevalue("small_disk")  # after the copy
    before = (copied / "manifest.json").read_bytes()
    with pytest.raises(CorpusError, match=r"manifest\.json: could not be written"):
        write_manifest(copied, read_manifest(copied).parts, complete=True, notes="x" * 30_000)
    assert (copied / "manifest.json").read_bytes() == before
    assert validate_corpus(copied) == []


def test_a_full_disk_leaves_the_last_index_as_it_was(copied, request):
    before = (copied / "corpus.nc").read_bytes()
    assert len(before) > 20_000
    request.getfixturevalue("small_disk")
    with pytest.raises(CorpusError, match=r"corpus\.nc: could not be written"):
        write_index(copied, read_manifest(copied).parts)
    assert (copied / "corpus.nc").read_bytes() == before
    assert {path.name for path in copied.iterdir()} == {"corpus.nc", "manifest.json", "parts"}


@pytest.mark.parametrize("place", range(len(b"parts/part-00001.nc.acceleration."), 96, 4))
def test_an_index_with_a_damaged_mapping_is_refused_and_does_not_end_the_process(copied, place):
    """Some of these bytes are ranks and versions, with which HDF5 writes beyond its arrays."""
    path = copied / "corpus.nc"
    whole = path.read_bytes()
    place += whole.index(b"parts/part-00001.nc")
    path.write_bytes(whole[:place] + b"\xff" + whole[place + 1 :])
    seal(copied)
    (problem,) = validate_corpus(copied)
    with pytest.raises(CorpusError):
        open_corpus(copied)
    if place == whole.index(b"parts/part-00001.nc") + 65:
        assert problem.endswith("is damaged: the HDF5 library crashes on it; make or copy the corpus again.")
