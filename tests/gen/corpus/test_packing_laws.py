"""Laws of the packing of signals: they decode to single precision alike in every reader, and the counts come back exactly."""

import netCDF4
import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from gen.corpus import MISSING_COUNT, SIGNAL, open_corpus, open_records, part_name, write_part
from gen.corpus.schema import signal_attributes
from gen.support.errors import CorpusError
from tests.corpora import SIZES, dataset

EVERY_COUNT = np.arange(-(2**15), 2**15).astype(np.int16)
LARGEST = 32767
LIMITS = (1e-6, 1e6)  # of recording.converter.full_scale_m_s2


def decoded_by_xarray(counts, attributes):
    return xr.decode_cf(xr.Dataset({"x": ("time", counts, attributes)}))["x"]


@given(st.floats(*LIMITS))
def test_every_count_comes_back_from_single_precision_for_any_full_scale(full_scale):
    attributes = signal_attributes(LARGEST / full_scale)
    decoded = decoded_by_xarray(EVERY_COUNT, attributes)
    assert decoded.dtype == np.float32
    assert np.flatnonzero(np.isnan(decoded)).tolist() == [0]
    assert EVERY_COUNT[0] == MISSING_COUNT
    scale = attributes["scale_factor"]
    np.testing.assert_array_equal(np.rint(decoded[1:] / scale), EVERY_COUNT[1:])
    np.testing.assert_array_equal(np.rint(decoded[1:] * np.float32(1 / scale)), EVERY_COUNT[1:])
    stored_again = xr.conventions.encode_cf_variable(decoded.variable)
    assert stored_again.dtype == np.int16
    np.testing.assert_array_equal(stored_again.values, EVERY_COUNT)
    np.testing.assert_allclose(decoded[1:], EVERY_COUNT[1:] * (full_scale / LARGEST), rtol=1.2e-7)


def test_every_reader_decodes_to_the_same_single_precision_numbers(nine):
    path, starts = nine / "c.nc", np.cumsum([0, *SIZES[:-1]])
    counts = np.concatenate([dataset(int(first), n)[SIGNAL] for first, n in zip(starts, SIZES, strict=True)])
    with open_corpus(path) as opened:
        signal, scale = opened[SIGNAL].load(), opened[SIGNAL].encoding["scale_factor"]
        bearings = opened["bearing"].values.tolist()
    assert (signal.dtype, signal.values.dtype, scale.dtype) == (np.float32, np.float32, np.float32)
    np.testing.assert_array_equal(signal, counts * scale)
    np.testing.assert_array_equal(np.rint(signal / scale), counts)
    for engine in ("netcdf4", "h5netcdf"):
        with xr.open_dataset(path, engine=engine, decode_times=False) as file:
            assert file[SIGNAL].dtype == file[SIGNAL].values.dtype == np.float32
            np.testing.assert_array_equal(file[SIGNAL], signal)
            assert file["bearing"].values.tolist() == bearings
    with netCDF4.Dataset(path) as file:
        found = file[SIGNAL][:]
        assert file[SIGNAL].units == "m s-2"
        assert found.dtype == np.float32
        np.testing.assert_array_equal(found, signal)


@pytest.mark.parametrize(
    "scale",
    [np.float32(0), np.float32(-1), np.float32(np.nan), np.float32(np.inf), np.float32(1e-40), np.float32(1e35), 1e-310, 1e304],
)  # fmt: skip
def test_a_scale_with_which_counts_are_no_normal_numbers_is_refused(tmp_path, scale):
    part = dataset(0, 1)
    part[SIGNAL].attrs["scale_factor"] = scale
    write_part(part, tmp_path / part_name(0))
    with pytest.raises(CorpusError, match="has scale_factor"):
        open_records([tmp_path / part_name(0)])
