"""Laws of the hashes of single records."""

import numpy as np
import pytest
import xarray as xr

from gen.corpus import open_corpus, open_part, write_part
from gen.corpus.record_hashes import RENUMBERED, record_hashes
from tests.corpora import SIZES, dataset, write_corpus


@pytest.mark.parametrize("kind", ["counts", "float32"])
def test_a_record_has_one_hash_before_writing_in_its_part_and_in_its_corpus(tmp_path, kind):
    parts = write_corpus(tmp_path, kind=kind)
    made = [found for part in parts for found in record_hashes(part)]
    stored = [found for path in sorted((tmp_path / "parts").iterdir()) for found in record_hashes(open_part(path))]
    with open_corpus(tmp_path) as corpus:
        assert made == stored == record_hashes(corpus)
    assert len(set(made)) == len(made) == sum(SIZES)


@pytest.mark.parametrize("codec", ["zlib", "none"])
def test_a_hash_depends_neither_on_the_other_records_nor_on_the_codec(tmp_path, codec):
    whole = dataset(0, 5)
    write_part(whole.isel(record=[3, 1]), tmp_path / "part.nc", codec)
    hashes = record_hashes(whole)
    with open_part(tmp_path / "part.nc") as part:
        assert record_hashes(part) == [hashes[3], hashes[1]]


def test_every_variable_but_the_renumbered_ones_enters_the_hash():
    whole = dataset(0, 2)
    hashes = record_hashes(whole)
    for name, variable in whole.variables.items():
        if variable.dims != ("record",):
            continue
        other = variable.copy(deep=True)
        other.values[1] = f"{other.values[1]}z" if other.dtype == object else other.values[1] + 1
        changed = record_hashes(whole.assign({name: other}))
        assert changed[0] == hashes[0]
        assert (changed[1] == hashes[1]) == (name in RENUMBERED), name


def test_scale_type_and_every_count_enter_the_hash():
    whole = dataset(0, 1)
    signal = whole["acceleration"]
    scaled = signal.assign_attrs(scale_factor=signal.attrs["scale_factor"] * 2)
    higher = xr.where(np.arange(signal.size).reshape(signal.shape) == 17, signal + 1, signal).astype(np.int16)
    typed = whole.assign(width=whole["width"].astype(np.float32))
    changed = [whole.assign(acceleration=scaled), whole.assign(acceleration=higher.assign_attrs(signal.attrs)), typed]
    assert len({record_hashes(one)[0] for one in [whole, *changed]}) == 4
