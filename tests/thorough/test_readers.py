"""What other people's programs read of a corpus; docs/sharing.md has the table."""

import pytest

from tests.paths import ROOT
from tests.readers import EVERYTHING, NO_TEXT, READERS, found_version, verdict, write_forms

PAGE = ROOT / "docs" / "sharing.md"
TABLE = {
    cells[0]: cells[1:]
    for line in PAGE.read_text(encoding="utf-8").splitlines()
    if len(cells := [cell.strip().replace("`", "") for cell in line.strip("|").split("|")]) == 4
}


@pytest.fixture(scope="module")
def forms(tmp_path_factory):
    return write_forms(tmp_path_factory.mktemp("readers"))


@pytest.mark.parametrize("name", READERS)
def test_a_reader_reads_what_the_docs_say(forms, name):
    version = found_version(name)
    if version is None:
        pytest.skip(f"{name} is not installed")
    found = [verdict(READERS[name][0], path) for path in forms]
    whole = NO_TEXT if name == "CDO" else EVERYTHING
    assert found == [whole, whole]  # with any version
    listed = TABLE[name]
    if listed[0] == version:
        assert listed[1:] == found
