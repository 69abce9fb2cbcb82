"""Laws of the format: every reader returns the written values, wherever the corpus is stored."""

import shutil
import subprocess
import sys
import zlib
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

from gen.corpus import (
    CODECS,
    FAULT_NAMES,
    SCHEMA,
    SIGNAL,
    make_dataset,
    open_corpus,
    open_part,
    part_name,
    validate_corpus,
    write_index,
    write_manifest,
    write_part,
)
from gen.corpus.part import deflated
from gen.errors import CorpusError
from tests.corpora import EXTRA, FS, columns, dataset, physical, write_corpus

law = settings(deadline=None, max_examples=10)


@pytest.fixture(scope="module")
def corpus(tmp_path_factory):
    folder = tmp_path_factory.mktemp("corpus") / "c"
    return folder, write_corpus(folder)


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
        assert index["fault"].flag_meanings == " ".join(FAULT_NAMES.values())


def test_the_lister_of_the_netcdf4_wheel_shows_dimensions_and_classes(corpus):
    lister = Path(sys.executable).with_name("ncinfo")
    header, fault = (
        subprocess.run([lister, *chosen, corpus[0] / "corpus.nc"], capture_output=True, text=True, check=True).stdout
        for chosen in ((), ("-v", "fault"))
    )
    assert "dimensions(sizes): record(9), channel(2), elapsed_time(50)," in header
    assert f"int16 {SIGNAL}(record, channel, elapsed_time)" in header
    assert f"flag_meanings: {' '.join(FAULT_NAMES.values())}\n" in fault


@pytest.mark.skipif(shutil.which("ncdump") is None, reason="ncdump is not installed")
def test_ncdump_lists_the_corpus(corpus):
    header = subprocess.run(
        ["ncdump", "-h", corpus[0] / "corpus.nc"], capture_output=True, text=True, check=True
    ).stdout
    assert "record = 9 ;" in header
    assert f"short {SIGNAL}(record, channel, elapsed_time) ;" in header
    assert f'fault:flag_meanings = "{" ".join(FAULT_NAMES.values())}" ;' in header


def test_a_corpus_reads_alike_from_anywhere_and_after_it_was_moved(corpus, tmp_path, monkeypatch):
    folder, parts = corpus
    moved = shutil.copytree(folder, tmp_path / "elsewhere" / "other name")
    for here, path in ((tmp_path, moved), (moved, Path()), (moved / "parts", Path(".."))):
        monkeypatch.chdir(here)
        with open_corpus(path) as found:
            np.testing.assert_allclose(found[SIGNAL][-1], physical(parts[-1])[-1])


@pytest.mark.parametrize("codec", CODECS)
def test_every_codec_gives_back_what_it_was_given(tmp_path, codec):
    parts = write_corpus(tmp_path / "c", codec=codec)
    with open_corpus(tmp_path / "c") as found:
        np.testing.assert_allclose(found[SIGNAL], np.concatenate([physical(part) for part in parts]))
    with netCDF4.Dataset(tmp_path / "c" / "parts" / part_name(0)) as part:
        filters = part[SIGNAL].filters()
        assert {name for name in CODECS if filters.get(name)} == {codec} - {"none"}
        assert part[SIGNAL].chunking() == [1, 1, 50]


def test_the_same_records_give_the_same_bytes(tmp_path):
    one, other = (write_part(dataset(0, 3), tmp_path / name) for name in ("part-00000.nc", "part-00001.nc"))
    assert (one.bytes, one.sha256) == (other.bytes, other.sha256)
    assert (tmp_path / "part-00000.nc").stat().st_size == one.bytes


@pytest.mark.parametrize("columns_change", [lambda c: c.pop("bpfi"), lambda c: c.update(colour=np.zeros(2))])
def test_a_missing_or_unknown_column_is_named(columns_change):
    some = columns(0, 2)
    columns_change(some)
    with pytest.raises(CorpusError, match=r"columns \['(bpfi|colour)'\] are either missing or not described"):
        make_dataset(np.zeros((2, 1, 5), np.int16), FS, ("a",), some, extra=EXTRA, counts_per_unit=1.0, attributes={})


def test_a_part_that_is_no_netcdf_file_is_named(tmp_path):
    (tmp_path / part_name(0)).write_text("no netCDF")
    with pytest.raises(CorpusError, match=r"part-00000\.nc: not a readable netCDF-4 part"):
        open_part(tmp_path / part_name(0))


@law
@given(st.integers(0, 2**32 - 1), st.integers(1, 9000), st.floats(0, 9000), st.sampled_from([np.int16, np.float32]))
def test_compressed_samples_are_a_zlib_stream_of_their_shuffled_bytes(seed, n, level, kind):
    samples = (level * np.random.default_rng(seed).standard_normal(n)).clip(-32767, 32767).astype(kind)
    shuffled = samples.view(np.uint8).reshape(n, -1).T.tobytes()
    assert zlib.decompress(deflated(samples)) == shuffled
    assert len(deflated(samples)) <= len(zlib.compress(shuffled, 1)) * 1.02 + 40


def test_what_needs_no_bits_takes_none():
    assert len(deflated(np.zeros(12_800, np.int16))) < 200
