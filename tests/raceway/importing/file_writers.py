"""Writers of recordings as people have them: each gives a function that writes a file."""

import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from xml.sax.saxutils import escape

import h5py
import numpy as np
import scipy.io
from scipy.io import wavfile

FS = 12_800.0
N = 640
X = np.round(np.random.default_rng(3).uniform(-0.9, 0.9, N), 6)
Y = np.round(np.random.default_rng(4).uniform(-0.9, 0.9, N), 6)
T = np.arange(N) / FS
_PACKAGE = "http://schemas.openxmlformats.org/package/2006"
_OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006"
_MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
_KIND = "application/vnd.openxmlformats-officedocument.spreadsheetml"


def lines(*columns: Sequence[object], mark: str = ";", comma: bool = False, end: str = "", form: str = ".10g") -> str:
    """Rows of columns of numbers or texts, each with an end."""
    texts = [[value if isinstance(value, str) else format(value, form) for value in column] for column in columns]
    rows = (mark.join(row) + end for row in zip(*texts, strict=True))
    return "".join(f"{row.replace('.', ',') if comma else row}\n" for row in rows)


def text(*columns: Sequence[object], header: str = "", tail: str = "", encoding: str = "utf-8", **form: object):
    """Writer of a text: a header, rows, and lines after them."""
    return (
        header + lines(*columns, **form) + tail
        if encoding == "utf-8"
        else ((header + lines(*columns, **form) + tail).encode(encoding))
    )


def changed(content: str, number: int, line: str) -> str:
    """Text with another line in the place of one, counted from 1."""
    every = content.splitlines(keepends=True)
    every[number - 1] = line + "\n"
    return "".join(every)


def _cell(value: object) -> str:
    match value:
        case bool():
            return f'<c t="b"><v>{value:d}</v></c>'
        case float() | int():
            return f"<c><v>{value!r}</v></c>"
        case None:
            return "<c><f>B2*2</f></c>"  # a formula without a stored value
        case _ if str(value).startswith("#"):
            return f'<c t="e"><v>{value}</v></c>'
    return f'<c t="inlineStr"><is><t>{escape(str(value))}</t></is></c>'


def workbook(
    sheets: Mapping[str, Sequence[Sequence[object]] | str], *, hidden: Sequence[str] = (), active: int | None = None
):
    """Writer of the least Excel file that spreadsheets open: rows of cells, or XML in their place."""

    def write(path: Path) -> None:
        numbered = [*enumerate(sheets.items(), 1)]
        view = "" if active is None else f'<bookViews><workbookView activeTab="{active}"/></bookViews>'
        listed = "".join(
            f'<sheet name="{name}" sheetId="{n}" r:id="r{n}"{" state=" + chr(34) + "hidden" + chr(34) if name in hidden else ""}/>'
            for n, (name, _) in numbered
        )
        parts = {
            "[Content_Types].xml": f'<Types xmlns="{_PACKAGE}/content-types"><Default Extension="xml" ContentType="application/xml"/>'
            f'<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
            f'<Override PartName="/xl/workbook.xml" ContentType="{_KIND}.sheet.main+xml"/>'
            + "".join(f'<Override PartName="/xl/worksheets/sheet{n}.xml" ContentType="{_KIND}.worksheet+xml"/>' for n, _ in numbered)
            + "</Types>",
            "_rels/.rels": f'<Relationships xmlns="{_PACKAGE}/relationships"><Relationship Id="r1" Type="{_OFFICE}/relationships/'
            f'officeDocument" Target="xl/workbook.xml"/></Relationships>',
            "xl/workbook.xml": f'<workbook xmlns="{_MAIN}" xmlns:r="{_OFFICE}/relationships">{view}<sheets>{listed}</sheets></workbook>',
            "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{_PACKAGE}/relationships">'
            + "".join(
                f'<Relationship Id="r{n}" Type="{_OFFICE}/relationships/worksheet" Target="worksheets/sheet{n}.xml"/>'
                for n, _ in numbered
            )
            + "</Relationships>",
        }  # fmt: skip
        for n, (_, rows) in numbered:
            content = (
                rows if isinstance(rows, str) else "".join(f"<row>{''.join(map(_cell, row))}</row>" for row in rows)
            )
            parts[f"xl/worksheets/sheet{n}.xml"] = (
                f'<worksheet xmlns="{_MAIN}"><sheetData>{content}</sheetData></worksheet>'
            )
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            for part, content in parts.items():
                archive.writestr(part, f'<?xml version="1.0" encoding="UTF-8"?>{content}')

    return write


def rows_of(header: Sequence[str], *columns: np.ndarray, before: Sequence[Sequence[object]] = ()) -> list[list[object]]:
    """Cells of a header and of columns of numbers."""
    return [*map(list, before), list(header), *([float(value) for value in row] for row in zip(*columns, strict=True))]


def excel(header: Sequence[str], *columns: np.ndarray, before: Sequence[Sequence[object]] = ()):
    return workbook({"Data": rows_of(header, *columns, before=before), "Notes": []})


def excel_with(cell: object, row: int = 300):
    """Writer of an Excel file in which one cell of the signal, in the row counted from 1, is another."""
    rows = rows_of(["Time [s]", "x [g]"], T, X)
    rows[row - 1][1] = cell
    return workbook({"Data": rows})


def matlab_7_3(path: Path) -> None:
    with h5py.File(path, "w") as file:
        file["vibration"], file["tacho"], file["rpm"] = X[np.newaxis], Y[np.newaxis], np.array([[1500.0]])


def wav(*channels: np.ndarray, dtype: str = "f4", fs: float = FS):
    return lambda path: wavfile.write(path, int(fs), np.stack(channels, axis=-1).astype(dtype).squeeze())


def wav_24(path: Path) -> None:
    """24 bits, which SciPy does not write."""
    import wave

    with wave.open(str(path), "wb") as file:
        file.setparams((1, 3, int(FS), N, "NONE", ""))
        file.writeframes(np.round(X * 2**23).astype("<i4").view(np.uint8).reshape(-1, 4)[:, :3].tobytes())


def mat(level: str = "5", **variables: object):
    return lambda path: scipy.io.savemat(path, variables, format=level)


def array(values: np.ndarray):
    return lambda path: np.save(path, values)
