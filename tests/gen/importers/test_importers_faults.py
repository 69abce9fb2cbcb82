"""A mapping file can name every fault class, and describes a spall only for classes with a spall."""

import pytest

from gen.corpus import FAULTS, UNKNOWN
from gen.importers.mapping import read_mapping
from gen.support.errors import CorpusError

TOP = "bearing: '6205'\nunit: g\nsample_rate_hz: 12000\nshaft_rpm: 1800\nspecimen: a\nfiles:\n"


def mapping(folder, *files):
    path = folder / "mapping.yaml"
    path.write_text(TOP + "".join(f"  - {{path: x.npy, {file}}}\n" for file in files))
    return path


def test_a_mapping_may_name_every_fault_class(tmp_path):
    found = read_mapping(mapping(tmp_path, *(f"fault: {fault}" for fault in (*FAULTS, UNKNOWN))))
    assert tuple(section.facts({}).fault for section in found.sections) == (*FAULTS, UNKNOWN)


@pytest.mark.parametrize("key", ["width_mm: 1", "depth_um: 100", "angle_deg: 0", "n_spalls: 1"])
@pytest.mark.parametrize("fault", [*FAULTS, UNKNOWN])
def test_a_spall_is_described_only_where_there_is_one(tmp_path, fault, key):
    path = mapping(tmp_path, f"fault: {fault}, {key}")
    if fault in ("healthy", "cage", UNKNOWN):
        with pytest.raises(CorpusError, match=f"{key.split(':')[0]} describes a spall, and fault is {fault}"):
            read_mapping(path)
    else:
        assert read_mapping(path).sections[0].facts({}).fault == fault
