"""Laws of the format: what is written comes back, whoever reads it, and damage does not go unnoticed."""

import json
import os
import resource
import shutil
import signal as signals
import subprocess
from pathlib import Path

import h5py
import netCDF4
import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

from gen.corpus import (
    FAULTS,
    SCHEMA,
    SIGNAL,
    Variable,
    describe_part,
    make_dataset,
    open_corpus,
    open_part,
    part_name,
    read_manifest,
    validate_corpus,
    write_index,
    write_manifest,
    write_part,
)
from gen.errors import CorpusError

law = settings(deadline=None, max_examples=10)
FS = 1000.0
COUNTS_PER_UNIT = 65.534
EXTRA = (Variable("draws", "str", "1", "provenance", "drawn values"),)
SIZES = (3, 4, 2)  # records of the parts


def columns(first, n):
    """Values of all per-record variables for records ``first`` to ``first + n``, no two alike where that can be."""
    numbers = np.arange(first, first + n)
    found = {variable.name: numbers * 1.5 + 0.25 for variable in SCHEMA if variable.dtype == "f8"}
    found |= dict.fromkeys(("rig", "specimen", "recording", "n_spalls"), numbers)
    texts = {"bearing": "6205", "source": "small/", "draws": "x" * 7}
    found |= {name: [text + "y" * number for number in numbers] for name, text in texts.items()}
    return found | {"fault": numbers % len(FAULTS), "split": numbers % 3, "sample_rate": np.full(n, FS)}


def dataset(first, n, *, samples=50, kind="counts", channels=("a", "b")):
    rng = np.random.default_rng(first)
    counts = rng.integers(-32767, 32768, (n, len(channels), samples)).astype(np.int16)
    floating = kind == "float32"
    return make_dataset(
        (counts / COUNTS_PER_UNIT).astype(np.float32) if floating else counts,
        FS,
        channels,
        columns(first, n),
        extra=EXTRA,
        counts_per_unit=None if floating else COUNTS_PER_UNIT,
        attributes={"title": "A corpus", "history": "made by a test"},
    )


def write_corpus(folder, sizes=SIZES, *, kind="counts", codec="zlib"):
    """Parts of random records, index and manifest; the parts as they went in."""
    (folder / "parts").mkdir(parents=True)
    starts = np.concatenate([[0], np.cumsum(sizes)])
    parts = [dataset(int(first), n, kind=kind) for first, n in zip(starts, sizes, strict=False)]
    rows = [write_part(part, folder / "parts" / part_name(number), codec) for number, part in enumerate(parts)]
    write_index(folder, rows)
    write_manifest(folder, rows, complete=True)
    return parts


@pytest.fixture(scope="module")
def corpus(tmp_path_factory):
    folder = tmp_path_factory.mktemp("corpus") / "c"
    return folder, write_corpus(folder)


@pytest.fixture
def copied(corpus, tmp_path):
    return shutil.copytree(corpus[0], tmp_path / "copy")


def physical(part):
    scale = part[SIGNAL].attrs.get("scale_factor", 1.0)
    return part[SIGNAL].values * scale


@pytest.mark.parametrize("kind", ["counts", "float32"])
def test_what_goes_into_the_parts_comes_out_of_the_corpus(tmp_path, kind):
    parts = write_corpus(tmp_path / "c", kind=kind)
    with open_corpus(tmp_path / "c") as found:
        np.testing.assert_allclose(found[SIGNAL], np.concatenate([physical(part) for part in parts]), rtol=1e-7)
        for variable in (*SCHEMA, *EXTRA):
            expected = np.concatenate([part[variable.name].values for part in parts])
            np.testing.assert_array_equal(found[variable.name].values, expected)
            assert found[variable.name].attrs["role"] == variable.role
        assert found["channel"].values.tolist() == ["a", "b"]
        np.testing.assert_allclose(found["elapsed_time"], np.arange(50) / FS)
    assert validate_corpus(tmp_path / "c") == []


@law
@given(st.lists(st.integers(1, 5), min_size=1, max_size=4), st.integers(1, 60), st.integers(1, 3), st.booleans())
def test_any_shape_survives_the_journey(tmp_path_factory, sizes, samples, n_channels, floating):
    folder = tmp_path_factory.mktemp("any")
    (folder / "parts").mkdir()
    names = tuple("abc"[:n_channels])
    kind = "float32" if floating else "counts"
    starts = np.concatenate([[0], np.cumsum(sizes)])
    parts = [
        dataset(int(first), n, samples=samples, kind=kind, channels=names)
        for first, n in zip(starts, sizes, strict=False)
    ]
    rows = [write_part(part, folder / "parts" / part_name(number)) for number, part in enumerate(parts)]
    write_index(folder, rows)
    write_manifest(folder, rows, complete=True)
    with open_corpus(folder) as found:
        assert dict(found.sizes) == {"record": sum(sizes), "channel": n_channels, "elapsed_time": samples}
        np.testing.assert_allclose(found[SIGNAL], np.concatenate([physical(part) for part in parts]), rtol=1e-7)
    assert validate_corpus(folder) == []


@pytest.mark.parametrize("engine", ["netcdf4", "h5netcdf"])
def test_both_engines_of_xarray_read_the_records_of_the_parts(corpus, engine):
    folder, _ = corpus
    with xr.open_dataset(folder / "corpus.nc", engine=engine, decode_times=False) as index:
        first = 0
        for path in sorted((folder / "parts").iterdir()):
            with xr.open_dataset(path, engine=engine, decode_times=False) as part:
                for record in range(part.sizes["record"]):
                    np.testing.assert_array_equal(index[SIGNAL][first + record], part[SIGNAL][record])
                first += part.sizes["record"]
        assert first == index.sizes["record"]


def test_plain_netcdf4_reads_counts_in_metres_per_second_squared(corpus):
    folder, parts = corpus
    with netCDF4.Dataset(folder / "corpus.nc") as index:
        assert index[SIGNAL].units == "m s-2"
        assert index[SIGNAL].dimensions == ("record", "channel", "elapsed_time")
        np.testing.assert_allclose(index[SIGNAL][4], physical(parts[1])[1])
        assert index["fault"].flag_meanings == " ".join(FAULTS)


@pytest.mark.skipif(shutil.which("ncdump") is None, reason="ncdump is not installed")
def test_ncdump_lists_the_corpus(corpus):
    header = subprocess.run(
        ["ncdump", "-h", corpus[0] / "corpus.nc"], capture_output=True, text=True, check=True
    ).stdout
    assert "record = 9 ;" in header
    assert f"short {SIGNAL}(record, channel, elapsed_time) ;" in header
    assert 'fault:flag_meanings = "healthy inner outer ball" ;' in header


def test_a_corpus_reads_alike_from_anywhere_and_after_it_was_moved(corpus, tmp_path, monkeypatch):
    folder, parts = corpus
    moved = shutil.copytree(folder, tmp_path / "elsewhere" / "other name")
    for here, path in ((tmp_path, moved), (moved, Path()), (moved / "parts", Path(".."))):
        monkeypatch.chdir(here)
        with open_corpus(path) as found:
            np.testing.assert_allclose(found[SIGNAL][-1], physical(parts[-1])[-1])


@pytest.mark.parametrize("codec", ["zlib", "zstd", "none"])
def test_every_codec_gives_back_what_it_was_given(tmp_path, codec):
    parts = write_corpus(tmp_path / "c", codec=codec)
    with open_corpus(tmp_path / "c") as found:
        np.testing.assert_allclose(found[SIGNAL], np.concatenate([physical(part) for part in parts]))
    with netCDF4.Dataset(tmp_path / "c" / "parts" / part_name(0)) as part:
        filters = part[SIGNAL].filters()
        assert {name for name in ("zlib", "zstd") if filters[name]} == ({codec} - {"none"})
        assert part[SIGNAL].chunking() == [1, 1, 50]


def test_the_same_records_give_the_same_bytes(tmp_path):
    one, other = (write_part(dataset(0, 3), tmp_path / name) for name in ("part-00000.nc", "part-00001.nc"))
    assert (one.bytes, one.sha256) == (other.bytes, other.sha256)
    assert describe_part(tmp_path / "part-00000.nc") == one


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
    """Let the virtual signal look at other parts, or at parts in another order."""
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


PARTS = [(f"parts/{part_name(number)}", size) for number, size in enumerate(SIZES)]
REFUSED = {
    "a part is missing": (lambda c: (c / "parts" / part_name(1)).unlink(), r"part-00001\.nc: missing; copy it again"),
    "a part is altered": (lambda c: flip(c / "parts" / part_name(1)), r"part-00001\.nc: altered, it is not the file"),
    "a part is cut short": (lambda c: os.truncate(c / "parts" / part_name(2), 500), r"part-00002\.nc: altered"),
    "a part is empty": (lambda c: os.truncate(c / "parts" / part_name(2), 0), r"part-00002\.nc: altered"),
    "a part stands for another": (
        lambda c: shutil.copyfile(c / "parts" / part_name(0), c / "parts" / part_name(2)), r"part-00002\.nc: altered",
    ),
    "the manifest is gone": (lambda c: (c / "manifest.json").unlink(), r"holds no manifest\.json, so it is no corpus"),
    "the manifest is no JSON": (lambda c: (c / "manifest.json").write_text("{"), r"manifest\.json: not a corpus manifest"),
    "the manifest lists no parts": (lambda c: (c / "manifest.json").write_text("{}"), r"manifest\.json: not a corpus manifest"),
    "a part name leads out": (lambda c: rename_in_manifest(c, "../x"), r"'\.\./x' is not the name of a part"),
    "a part name is a path": (lambda c: rename_in_manifest(c, "/etc/passwd"), r"is not the name of a part"),
    "a part name is no text": (lambda c: rename_in_manifest(c, 7), r"7 is not the name of a part"),
    "the index is gone": (lambda c: (c / "corpus.nc").unlink(), r"corpus\.nc: not a corpus index"),
    "the index is cut short": (lambda c: os.truncate(c / "corpus.nc", 900), r"corpus\.nc: not a corpus index"),
    "the index has no signal": (lambda c: edit_index(c, lambda i: i.pop(SIGNAL)), r"corpus\.nc: not a corpus index"),
    "the index reads files elsewhere": (
        lambda c: edit_index(c, lambda i: swap_sources(i, [("../secret.nc", 3), *PARTS[1:]])), r"index and manifest disagree about",
    ),
    "the index leaves a part out": (
        lambda c: edit_index(c, lambda i: swap_sources(i, [PARTS[0], (PARTS[1][0], 6)])), r"index and manifest disagree about",
    ),
}  # fmt: skip


@pytest.mark.parametrize("damage", REFUSED)
def test_a_damaged_corpus_is_refused_with_the_file_named_and_found_by_validation(copied, damage):
    break_it, sentence = REFUSED[damage]
    break_it(copied)
    with pytest.raises(CorpusError, match=sentence):
        open_corpus(copied)
    problems = validate_corpus(copied)
    assert len(problems) == 1
    assert str(copied) in problems[0]
    with pytest.raises(CorpusError, match=sentence):
        raise CorpusError(problems[0])


def set_value(index, name, value):
    index[name][2] = value


FOUND = {
    "a label differs from its part": (lambda i: set_value(i, "fault", 0), "fault differs from corpus.nc"),
    "a shaft rate differs": (lambda i: set_value(i, "shaft_rate", 99.0), "shaft_rate differs from corpus.nc"),
    "the signal is scaled otherwise": (
        lambda i: i[SIGNAL].attrs.modify("scale_factor", 1.0), "acceleration differs from corpus.nc",
    ),
    "parts of the signal are swapped": (
        lambda i: swap_sources(i, [PARTS[1], PARTS[0], PARTS[2]]), "acceleration differs from corpus.nc",
    ),
}  # fmt: skip


@pytest.mark.parametrize("damage", FOUND)
def test_validation_finds_an_index_that_does_not_say_what_its_parts_say(copied, damage):
    break_it, sentence = FOUND[damage]
    edit_index(copied, break_it)
    assert any(sentence in problem for problem in validate_corpus(copied))


@pytest.mark.xfail(strict=True, reason="validate_corpus compares values of the index with the parts, not attributes")
@pytest.mark.parametrize(
    ("name", "key", "value"), [(SIGNAL, "units", "g"), ("fault", "flag_meanings", "inner healthy outer ball")]
)
def test_validation_finds_an_index_whose_attributes_are_not_those_of_its_parts(copied, name, key, value):
    edit_index(copied, lambda index: index[name].attrs.modify(key, value))
    assert any(name in problem for problem in validate_corpus(copied))


def damaged_part(change):
    """A corpus whose last part was written with a damage of its own, everything else following from it."""

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
    "a class that does not exist": (with_values("fault", 9), "fault has values outside 0..3"),
    "a split that does not exist": (with_values("split", -1), "split has values outside 0..2"),
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
    write_manifest(copied, read_manifest(copied)["parts"][:2], complete=False)
    with pytest.raises(CorpusError, match="unfinished; the raceway generate command that began it completes it"):
        open_corpus(copied)


def test_a_corpus_of_another_format_version_is_refused(copied):
    manifest = json.loads((copied / "manifest.json").read_text()) | {"raceway_format": 99}
    (copied / "manifest.json").write_text(json.dumps(manifest))
    with pytest.raises(CorpusError, match="corpus format 99, this version of raceway reads format 1"):
        open_corpus(copied)


def test_sizes_alone_do_not_see_what_hashes_see(copied):
    flip(copied / "parts" / part_name(1))
    open_corpus(copied, check="size").close()
    with pytest.raises(CorpusError, match="altered"):
        open_corpus(copied, check="sha256")


@pytest.mark.parametrize("columns_change", [lambda c: c.pop("bpfi"), lambda c: c.update(colour=np.zeros(2))])
def test_a_missing_or_unknown_column_is_named(columns_change):
    some = columns(0, 2)
    columns_change(some)
    with pytest.raises(CorpusError, match=r"columns \['(bpfi|colour)'\] are either missing or not described"):
        make_dataset(np.zeros((2, 1, 5), np.int16), FS, ("a",), some, extra=EXTRA, counts_per_unit=1.0, attributes={})


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


def test_a_full_disk_leaves_the_last_manifest_as_it_was(copied, request):
    request.getfixturevalue("small_disk")  # after the copy
    before = (copied / "manifest.json").read_bytes()
    with pytest.raises(CorpusError, match=r"manifest\.json: could not be written"):
        write_manifest(copied, read_manifest(copied)["parts"], complete=True, notes="x" * 30_000)
    assert (copied / "manifest.json").read_bytes() == before
    assert validate_corpus(copied) == []


def test_a_full_disk_leaves_the_last_index_as_it_was(copied, request):
    before = (copied / "corpus.nc").read_bytes()
    assert len(before) > 20_000
    request.getfixturevalue("small_disk")
    with pytest.raises(CorpusError, match=r"corpus\.nc: could not be written"):
        write_index(copied, read_manifest(copied)["parts"])
    assert (copied / "corpus.nc").read_bytes() == before
    assert {path.name for path in copied.iterdir()} == {"corpus.nc", "manifest.json", "parts"}


def test_a_part_that_is_no_netcdf_file_is_named(tmp_path):
    (tmp_path / part_name(0)).write_text("no netCDF")
    with pytest.raises(CorpusError, match=r"part-00000\.nc: not a readable netCDF-4 part"):
        open_part(tmp_path / part_name(0))
