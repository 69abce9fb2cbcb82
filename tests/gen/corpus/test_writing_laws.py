"""Laws of errors in writing: the sentence names the final path, the reason of the system and what helps."""

import errno
import os

import pytest

from gen.corpus import whole_folder_or_none, whole_or_not_at_all, writing
from gen.support.errors import CorpusError
from tests.disks import full_disk


def sentence(path, error: Exception) -> str:
    with pytest.raises(CorpusError) as caught, writing(path):
        raise error
    return str(caught.value)


@pytest.mark.parametrize(
    ("number", "advice"),
    [
        (errno.ENOSPC, "free some space or choose another folder"),
        (errno.EDQUOT, "free some space or choose another folder"),
        (errno.EACCES, "get permission to write there or choose another folder"),
        (errno.EPERM, "get permission to write there or choose another folder"),
        (errno.EROFS, "choose another folder"),
    ],
)
def test_the_advice_follows_from_the_reason(tmp_path, number, advice):
    path = tmp_path / "file.nc"
    expected = f"{path}: could not be written ({os.strerror(number)}); {advice}."
    assert sentence(path, OSError(number, "any words", "/a/path")) == expected
    hdf5 = f"write failed (file write failed: time = Mon,\n errno = {number}, error message = 'words', buf = 0x7f)"
    assert sentence(path, RuntimeError(hdf5)) == expected


@pytest.mark.parametrize("error", [RuntimeError("NetCDF: HDF error"), OSError(-101, "NetCDF: HDF error", "/a/path")])
def test_the_reason_that_netcdf_does_not_give_is_found(tmp_path, error):
    with full_disk():
        found = sentence(tmp_path / "file.nc", error)
    assert found.endswith(
        f"could not be written ({os.strerror(errno.EFBIG)}); free some space or choose another folder."
    )
    assert "HDF error); choose another folder." in sentence(tmp_path / "file.nc", error)
    assert list(tmp_path.iterdir()) == []


def test_no_error_names_a_temporary_path(tmp_path):
    for whole, name in ((whole_or_not_at_all, "file.nc"), (whole_folder_or_none, "folder")):
        for kind in (OSError, RuntimeError, CorpusError):
            with pytest.raises(CorpusError, match=name) as caught, whole(tmp_path / name) as temporary:
                raise kind(f"{temporary / 'part.nc'}: damaged")
            assert ".tmp" not in str(caught.value)
    assert list(tmp_path.iterdir()) == []
