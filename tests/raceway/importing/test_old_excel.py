"""Old Excel files (.xls) are read as they were written; damaged and hostile ones are refused before they take memory."""

import struct

import numpy as np
import pytest

from gen.support.errors import CorpusError
from raceway.importing import read_signal
from raceway.importing.refused_files import guarded
from tests.raceway.importing.file_writers import FS, T, X

pytest.importorskip("python_calamine", reason="python-calamine is in the extra files")
G = 9.80665
FREE, END, OF_TABLE = 0xFFFFFFFF, 0xFFFFFFFE, 0xFFFFFFFD  # what a sector leads to
SHORT = 150  # numbers
INTEGERS = np.random.default_rng(5).integers(-(2**15), 2**15, (16, 1500))
BOOKS = {
    "measured": (T, X),
    "fifteen": (T, *[X] * 15),
    "counter_and_integers": (np.arange(1500), INTEGERS[0]),
    "rounded": (np.arange(1500) / 100, np.round(INTEGERS[0] / 300, 2)),
    "integers": (np.arange(1500), *INTEGERS),
}


def xls(path, *columns):
    xlwt = pytest.importorskip("xlwt", reason="xlwt writes old Excel files for this test alone")
    book = xlwt.Workbook()
    sheet = book.add_sheet("Data")
    rows = [("t [s]", *["x [g]"] * (len(columns) - 1)), *zip(*(column.tolist() for column in columns), strict=True)]
    for row, cells in enumerate(rows):
        for column, cell in enumerate(cells):
            sheet.write(row, column, cell)
    book.save(str(path))


@pytest.mark.parametrize("name", BOOKS)
def test_values_are_those_that_were_written_whatever_the_bytes_of_their_cells_look_like(tmp_path, name):
    columns = BOOKS[name]
    xls(tmp_path / "a.xls", *columns)
    signal = read_signal(tmp_path / "a.xls", column=len(columns) - 1, rate=FS if columns[0] is not T else None)
    np.testing.assert_allclose(signal.values, G * columns[-1], rtol=1e-9)
    assert signal.fs == FS


def shaped(path, shape):
    """Old Excel file that states first row, row after the last, first column and column after the last of its sheet."""
    xls(path, T, X)
    head, dimensions, rest = path.read_bytes().rpartition(b"\0\2\x0e\0")
    path.write_bytes(head + dimensions + struct.pack("<IIHH", *shape) + rest[12:])


def record(kind, form, *values):
    content = struct.pack(f"<{form}", *values)
    return struct.pack("<HH", kind, len(content)) + content


def short(path, shape):
    """Workbook below 4096 bytes, which lies in sectors of 64 bytes that are parts of the stream of the first entry."""
    begin, end = [record(0x809, "HHQ4x", 0x600, kind, 0) for kind in (5, 0x10)], record(0x0A, "")
    cells = [record(0x203, "HHHd", row, 0, 0, value) for row, value in enumerate(X[:SHORT].tolist())]
    named = "IBBBBc", 0, 0, 0, 1, 0, b"D"
    place = len(begin[0] + record(0x85, *named) + end)
    parts = [
        begin[0],
        record(0x85, named[0], place, *named[2:]),
        end,
        begin[1],
        record(0x200, "IIHH2x", *shape),
        *cells,
        end,
    ]
    workbook = b"".join(parts)
    sectors = -(-len(workbook) // 512)

    def following(*places):
        return struct.pack("<128I", *places, *[FREE] * (128 - len(places)))

    def entry(name, kind, start, size):
        return struct.pack(
            "<64sHBB3I36xIQ", name.encode("utf-16le"), 2 * len(name) + 2, kind, 1, FREE, FREE, FREE, start, size
        )

    head = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(16) + struct.pack("<5H6x", 62, 3, 0xFFFE, 9, 6)
    head += struct.pack("<9I", 0, 1, 1, 0, 4096, 2, 1, END, 0) + following(0)[: 4 * 109]
    table = following(OF_TABLE, END, END, *range(4, 3 + sectors), END)
    directory = entry("Root Entry", 5, 3, 512 * sectors) + entry("Workbook", 2, 0, len(workbook)) + bytes(256)
    chain = following(*range(1, -(-len(workbook) // 64)), END)
    path.write_bytes(head + table + directory + chain + workbook.ljust(512 * sectors, b"\0"))


def test_a_short_workbook_is_read(tmp_path):
    short(tmp_path / "a.xls", (0, SHORT, 0, 1))
    np.testing.assert_allclose(read_signal(tmp_path / "a.xls", rate=FS, unit="m/s2").values, X[:SHORT])


@pytest.mark.parametrize("write", [shaped, short])
@pytest.mark.parametrize(
    ("shape", "told"),
    [
        ((0, 2**32 - 1, 0, 2), "4294967295 rows and 2"),
        ((0, 65_537, 0, 2), "65537 rows and 2"),
        ((5, 3, 0, 2), "4294967294 rows and 2"),  # the library would take as much for it
        ((0, 640, 0, 257), "640 rows and 257"),
    ],
)
def test_a_larger_shape_than_old_excel_has_is_refused_before_the_library_takes_memory(tmp_path, write, shape, told):
    write(tmp_path / "a.xls", shape)
    with pytest.raises(
        CorpusError, match=f"has a sheet of {told} columns, more than an old Excel file can have; save it as .xlsx"
    ):
        read_signal(tmp_path / "a.xls")


def test_a_sector_that_leads_to_itself_is_refused(tmp_path):
    xls(tmp_path / "a.xls", T, X)
    content = bytearray((tmp_path / "a.xls").read_bytes())
    table = 512 * (1 + int.from_bytes(content[76:80], "little"))
    content[table : table + 4] = bytes(4)
    (tmp_path / "a.xls").write_bytes(content)
    with pytest.raises(CorpusError, match=r"is damaged, or an old Excel file above 6.8 MB; save it as .xlsx\."):
        read_signal(tmp_path / "a.xls")


def test_a_file_that_is_cut_is_refused_with_one_sentence_or_has_its_values(tmp_path, capfd):
    xls(tmp_path / "a.xls", T, X)
    content = (tmp_path / "a.xls").read_bytes()
    reasons = set()
    for size in range(len(content) - 3000, len(content), 40):
        (tmp_path / "a.xls").write_bytes(content[:size])
        try:
            values = read_signal(tmp_path / "a.xls").values
        except CorpusError as refused:
            reasons.add(str(refused).removeprefix(f"{tmp_path / 'a.xls'}: "))
        else:
            np.testing.assert_allclose(values, G * X)
    assert reasons == {
        "is truncated, damaged or not a spreadsheet file.",
        "is damaged, or an old Excel file above 6.8 MB; save it as .xlsx.",
    }
    # the library panics on a third of them
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("kind", [KeyboardInterrupt, SystemExit])
def test_a_user_who_stops_is_not_told_that_the_file_is_damaged(tmp_path, kind):
    (tmp_path / "a.xls").write_bytes(b"x")
    with pytest.raises(kind), guarded(tmp_path / "a.xls", "spreadsheet"):
        raise kind
