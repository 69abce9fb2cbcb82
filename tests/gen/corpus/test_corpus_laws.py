"""Laws of the format: every reader returns the written values, wherever the corpus is stored."""

import shutil
from pathlib import Path

import netCDF4
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gen.corpus import (
    CODECS,
    SCHEMA,
    SIGNAL,
    corpus_files,
    make_dataset,
    open_corpus,
    part_name,
    read_manifest,
    validate_corpus,
)
from gen.support.errors import CorpusError
from tests.corpora import EXTRA, FS, SIZES, columns, dataset, physical, write_parts

FORMS = ("c", "c.nc")
"""Names of a folder and of a single file."""


@pytest.mark.parametrize("codec", CODECS)
@settings(max_examples=2)
@given(st.lists(st.integers(1, 5), min_size=1, max_size=3), st.integers(1, 60), st.integers(1, 3), st.booleans())
def test_any_shape_survives_the_journey_with_any_codec_and_both_forms_hold_the_same(
    tmp_path_factory, codec, sizes, samples, n_channels, floating
):
    place = tmp_path_factory.mktemp("any")
    shape = {"samples": samples, "kind": "float32" if floating else "counts", "channels": tuple("abc"[:n_channels])}
    starts = np.cumsum([0, *sizes])
    parts = [dataset(int(first), n, **shape) for first, n in zip(starts, sizes, strict=False)]
    for form in FORMS:
        write_parts(place / form, parts, codec)
        assert validate_corpus(place / form) == []
        with netCDF4.Dataset(corpus_files(place / form)[0]) as opened:
            assert {name for name in CODECS if opened[SIGNAL].filters().get(name)} == {codec} - {"none"}
            assert opened[SIGNAL].chunking() == [1, 1, samples]
    assert {path.name for path in place.iterdir()} == set(FORMS)
    with open_corpus(place / "c") as folder, open_corpus(place / "c.nc") as file:
        assert dict(file.sizes) == {"record": sum(sizes), "channel": n_channels, "elapsed_time": samples}
        np.testing.assert_allclose(file[SIGNAL], np.concatenate([physical(part) for part in parts]), rtol=1e-7)
        np.testing.assert_allclose(file["elapsed_time"], np.arange(samples) / FS)
        assert file["channel"].values.tolist() == list(shape["channels"])
        for variable in (*SCHEMA, *EXTRA):
            expected = np.concatenate([part[variable.name].values for part in parts])
            np.testing.assert_array_equal(file[variable.name].values, expected)
            assert file[variable.name].attrs["role"] == variable.role
        assert folder.variables.keys() == file.variables.keys()
        assert all(folder[name].variable.identical(file[name].variable) for name in folder.variables)


def test_every_part_is_a_corpus_of_its_own(nine):
    with open_corpus(nine / "c") as whole:
        for number, first in enumerate(np.cumsum([0, *SIZES[:-1]])):
            path = nine / "c" / "parts" / part_name(number)
            assert validate_corpus(path) == []
            assert read_manifest(path).records == SIZES[number]
            with open_corpus(path) as alone:
                np.testing.assert_allclose(alone[SIGNAL], physical(dataset(int(first), SIZES[number])))
                here = whole.isel(record=slice(first, first + SIZES[number]))
                assert all(alone[name].variable.identical(here[name].variable) for name in whole.variables)


@pytest.mark.parametrize("form", FORMS)
def test_a_corpus_reads_alike_from_anywhere_and_after_it_was_moved(nine, tmp_path, monkeypatch, form):
    path, last = nine / form, physical(dataset(sum(SIZES[:-1]), SIZES[-1]))[-1]
    moved = tmp_path / "elsewhere" / f"other name{path.suffix}"
    (shutil.copytree if path.is_dir() else shutil.copyfile)(path, (moved.parent.mkdir(), moved)[1])
    places = [(tmp_path, moved), (moved.parent, Path(moved.name))]
    for here, name in places + ([(moved, Path()), (moved / "parts", Path(".."))] if path.is_dir() else []):
        monkeypatch.chdir(here)
        with open_corpus(name) as found:
            np.testing.assert_allclose(found[SIGNAL][-1], last)


@pytest.mark.parametrize("columns_change", [lambda c: c.pop("bpfi"), lambda c: c.update(colour=np.zeros(2))])
def test_a_missing_or_unknown_column_is_named(columns_change):
    some = columns(0, 2)
    columns_change(some)
    with pytest.raises(CorpusError, match=r"columns \['(bpfi|colour)'\] are either missing or not described"):
        make_dataset(np.zeros((2, 1, 5), np.int16), FS, ("a",), some, extra=EXTRA, counts_per_unit=1.0, attributes={})
