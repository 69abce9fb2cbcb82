"""Files of recordings as people have them, each made by a small writer."""

import zipfile
from collections.abc import Sequence
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


def text(
    *columns: np.ndarray,
    header: str = "",
    mark: str = ";",
    comma: bool = False,
    end: str = "",
    tail: str = "",
    encoding: str = "utf-8",
):
    """Writer of a text of columns: numbers after a header, each line with an end, and lines after them."""

    def write(path: Path) -> None:
        lines = [mark.join(f"{value:.10g}" for value in row) + end for row in zip(*columns, strict=True)]
        body = "\n".join(lines)
        path.write_text(header + (body.replace(".", ",") if comma else body) + "\n" + tail, encoding)

    return write


def sheet(rows: Sequence[Sequence[object]], path: Path, name: str = "Data") -> None:
    """Write the least Excel file that spreadsheets open: a sheet of texts and numbers before an empty one."""

    def cell(value: object) -> str:
        return (
            f"<c><v>{value!r}</v></c>"
            if isinstance(value, float)
            else f'<c t="inlineStr"><is><t>{escape(str(value))}</t></is></c>'
        )

    main, office = (
        "http://schemas.openxmlformats.org/spreadsheetml/2006/main",
        "http://schemas.openxmlformats.org/officeDocument/2006",
    )
    package = "http://schemas.openxmlformats.org/package/2006"
    kind = "application/vnd.openxmlformats-officedocument.spreadsheetml"
    sheets = "".join(f"<row>{''.join(map(cell, row))}</row>" for row in rows)
    parts = {
        "[Content_Types].xml": f'<Types xmlns="{package}/content-types"><Default Extension="xml" ContentType="application/xml"/>'
        '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        f'<Override PartName="/xl/workbook.xml" ContentType="{kind}.sheet.main+xml"/>'
        f'<Override PartName="/xl/worksheets/sheet1.xml" ContentType="{kind}.worksheet+xml"/>'
        f'<Override PartName="/xl/worksheets/sheet2.xml" ContentType="{kind}.worksheet+xml"/></Types>',
        "_rels/.rels": f'<Relationships xmlns="{package}/relationships"><Relationship Id="r1" Type="{office}/relationships/officeDocument" '
        'Target="xl/workbook.xml"/></Relationships>',
        "xl/workbook.xml": f'<workbook xmlns="{main}" xmlns:r="{office}/relationships"><sheets><sheet name="{name}" sheetId="1" r:id="r1"/>'
        '<sheet name="Notes" sheetId="2" r:id="r2"/></sheets></workbook>',
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{package}/relationships">'
        f'<Relationship Id="r1" Type="{office}/relationships/worksheet" Target="worksheets/sheet1.xml"/>'
        f'<Relationship Id="r2" Type="{office}/relationships/worksheet" Target="worksheets/sheet2.xml"/></Relationships>',
        "xl/worksheets/sheet1.xml": f'<worksheet xmlns="{main}"><sheetData>{sheets}</sheetData></worksheet>',
        "xl/worksheets/sheet2.xml": f'<worksheet xmlns="{main}"><sheetData></sheetData></worksheet>',
    }  # fmt: skip
    with zipfile.ZipFile(path, "w") as archive:
        for part, content in parts.items():
            archive.writestr(part, f'<?xml version="1.0" encoding="UTF-8"?>{content}')


def excel(header: Sequence[str], *columns: np.ndarray, before: Sequence[Sequence[object]] = ()):
    return lambda path: sheet([*before, header, *([float(v) for v in row] for row in zip(*columns, strict=True))], path)


def matlab_7_3(path: Path) -> None:
    with h5py.File(path, "w") as file:
        file["vibration"], file["tacho"], file["rpm"] = X[np.newaxis], Y[np.newaxis], np.array([[1500.0]])


def wav(*channels: np.ndarray, dtype: str = "f4"):
    return lambda path: wavfile.write(path, int(FS), np.stack(channels, axis=-1).astype(dtype).squeeze())


def wav_24(path: Path) -> None:
    """24 bits, which SciPy does not write."""
    import wave

    with wave.open(str(path), "wb") as file:
        file.setparams((1, 3, int(FS), N, "NONE", ""))
        file.writeframes(np.round(X * 2**23).astype("<i4").view(np.uint8).reshape(-1, 4)[:, :3].tobytes())


def mat(**variables: object):
    return lambda path: scipy.io.savemat(path, variables)


def array(values: np.ndarray):
    return lambda path: np.save(path, values)


TITLED = "Messung 7;Halle 2\nDatum;05.01.2026 10:00\nKanäle;2\n"
RIGHT = {  # file, writer, what is given, what is found beside X: sample rate and unit
    "european.csv": (text(X, Y, comma=True, header="x [g];y [g]\n"), {"column": 0, "rate": FS}, FS, "g"),
    "european_time.csv": (text(T, X, comma=True, header="Zeit [s];Beschl. [m/s²]\n"), {}, FS, "m/s2"),
    "titled.csv": (text(T, X, comma=True, header=TITLED + "Zeit [s];Beschl. (g)\n"), {}, FS, "g"),
    "time_in_ms.csv": (text(T * 1e3, X, mark=",", header="Time (ms),Acceleration (m/s^2)\n"), {}, FS, "m/s2"),
    "time_without_header.txt": (text(T, X, mark=" "), {}, FS, "m/s2"),
    "coarse_times.txt": (text(np.round(T, 4), X, mark="\t", header="time\tacc\n"), {}, FS, "m/s2"),
    "counter.csv": (text(np.arange(N), X, mark=",", header="Sample,Acc (g)\n"), {"rate": FS}, FS, "g"),
    "two_columns.csv": (text(Y, X, mark=","), {"column": 1, "rate": FS}, FS, "m/s2"),
    "named.csv": (text(T, Y, X, header="t [s];FE [g];DE [g]\n"), {"column": "DE"}, FS, "g"),
    "units_below.csv": (text(T, X, header="Time;DE\ns;g\n"), {"column": "DE"}, FS, "g"),
    "rate_in_header.txt": (text(X, header="Sample rate: 12800 Hz\nUnit: g\nAcceleration\n"), {}, FS, "g"),
    "rate_in_comment.txt": (text(X, header="# fs = 12800\n"), {}, FS, "m/s2"),
    "rate_with_comma.csv": (text(X, Y, header="Sampling frequency [kHz];12,8\nA (mV);B (mV)\n"),
                            {"column": "A", "sensitivity": 1000 * 9.80665}, FS, "mV"),
    "step_in_header.csv": (text(X, Y, comma=True, header="dt;0,000078125 s\n"), {"column": 0, "unit": "g"}, FS, "g"),
    "tabs.tsv": (text(T, X, mark="\t", comma=True, header="Time [s]\tx [m/s2]\n"), {}, FS, "m/s2"),
    "blanks.dat": (text(T, X, mark="   ", header="Time [s]  x [g]\n"), {}, FS, "g"),
    "comma_blanks.txt": (text(T, X, mark=" ", comma=True), {}, FS, "m/s2"),
    "utf_16.csv": (text(T, X, mark="\t", header="Zeit [s]\tx [m/s²]\n", encoding="utf-16"), {}, FS, "m/s2"),
    "latin_1.csv": (text(T, X, Y, header="Zeit [µs];x [m/s²];T [°C]\n".replace("µ", ""), encoding="latin-1"), {"column": 1}, FS, "m/s2"),
    "microseconds.csv": (text(T * 1e6, X, header="Zeit [µs];x [m/s²]\n", encoding="latin-1"), {}, FS, "m/s2"),
    "separator_at_end.csv": (text(T, X, end=";", header="Time [s];x [g];\n"), {}, FS, "g"),
    "empty_lines_at_end.csv": (text(T, X, tail="\n\n;\n\n"), {}, FS, "m/s2"),
    "note_at_end.csv": (text(T, X, comma=True, tail="\nRMS;0,52\nEnd of data\n"), {}, FS, "m/s2"),
    "comments.txt": (text(T, X, mark=" ", header="% made by hand\n% fs: 12800\n# t x\n", tail="% end\n"), {}, FS, "m/s2"),
    "more_names.txt": (text(T, X, mark="\t", header="Delta_X\t7.8125E-5\n***End_of_Header***\nX_Value\tAcc (g)\tComment\n"), {}, FS, "g"),
    "strokes.csv": (text(T, X, header="t/s;a/g\n\n"), {}, FS, "g"),
    "thousands.csv": (text(X, Y, mark=",", header="Sampling rate: 12,800 Hz\na,b\n"), {"column": "a"}, FS, "m/s2"),
    "short_column.csv": (text(T, X, tail="0.06;\n0.07;\n"), {}, FS, "m/s2"),
    "quoted.csv": (text(T, X, mark=",", header='"Time [s]","DE [g]"\n'), {"column": "DE [g]"}, FS, "g"),
    "dates.csv": (lambda path: path.write_text("Time;x [g]\n" + "".join(f"2026-01-05 10:00:00,{i:03d};{x}\n" for i, x in enumerate(X))),
                  {"rate": FS}, FS, "g"),
    "sheet.xlsx": (excel(["Acceleration [g]"], X), {"rate": FS}, FS, "g"),
    "sheet_with_times.xlsx": (excel(["Time [ms]", "x [m/s²]"], T * 1e3, X, before=[["Pump 7"], []]), {}, FS, "m/s2"),
    "chosen_sheet.xlsx": (excel(["fs", "12800 Hz"], X, Y), {"variable": "Data", "column": 0}, FS, "m/s2"),
    "float.wav": (wav(X, dtype="f8"), {}, FS, "m/s2"),
    "stereo.wav": (wav(Y, X, dtype="f8"), {"column": 1, "unit": "g"}, FS, "g"),
    "bits_24.wav": (wav_24, {}, FS, "m/s2"),
    "many.mat": (mat(DE_time=X, FE_time=Y, rpm=1797.0), {"variable": "DE*", "rate": FS}, FS, "m/s2"),
    "level_7_3.mat": (matlab_7_3, {"variable": "vibration", "rate": FS}, FS, "m/s2"),
    "with_times.mat": (mat(data=np.stack([T, X], axis=1)), {}, FS, "m/s2"),
    "two_rows.npy": (array(np.stack([Y, X])), {"column": 1, "rate": FS}, FS, "m/s2"),
    "times_and_signal.npy": (array(np.stack([T, X])), {}, FS, "m/s2"),
}  # fmt: skip
THREE = text(T, X, Y, mark=",", header="Time [s],DE [g],FE [g]\n")
GAP = text(T, np.where(np.arange(N) == 40, np.nan, X), mark=",", header="t,x\n")
REFUSED = {  # file, writer, what is given, sentence
    "none_chosen.csv": (THREE, {}, "has 3 columns (0 Time [s], 1 DE [g], 2 FE [g]) and none is chosen; choose one with --channel."),
    "no_such_name.csv": (THREE, {"column": "x"},
                         "has the columns 0 Time [s], 1 DE [g], 2 FE [g], and no numbers in x; choose one with --channel."),
    "no_such_number.csv": (THREE, {"column": 7}, "and no numbers in 7; choose one with --channel."),
    "times_chosen.csv": (THREE, {"column": 0}, "has times in column 0 Time [s], not a signal; choose another with --channel."),
    "other_rate.csv": (THREE, {"column": 1, "rate": 25600.0},
                       "is at 12800 Hz by its times in column 0 Time [s], and 25600 Hz are given; correct what is given with --rate."),
    "other_rate.txt": (text(X, header="fs = 12800\n"), {"rate": 12000.0},
                       "is at 12800 Hz by its header, and 12000 Hz are given; correct what is given with --rate."),
    "two_rates.csv": (text(T, X, header="Sample rate: 25,6 kHz\nt [s];x\n"), {},
                      "states 25600 Hz in its header, and its times in column 0 t [s] are at 12800 Hz; correct the file."),
    "other_unit.csv": (THREE, {"column": 1, "unit": "m/s2"},
                       "states DE [g] in its header, and the unit m/s2 is given; correct what is given with --unit."),
    "volts.csv": (text(T, X, header="t [s];x [mV]\n"), {}, "the unit is mV and the sensitivity of the sensor is missing"),
    "velocity.csv": (text(T, X, header="t [s];v [mm/s]\n"), {}, "states v [mm/s] in its header, a velocity; export"),
    "displacement.csv": (text(T, X, header="t [s];s (µm)\n", encoding="latin-1"), {"unit": "g"}, "states s (µm) in its header, a"),
    "spectrum.csv": (text(np.arange(N) * 0.5, X, header="Frequency;Level [g]\n"), {},
                     "has frequencies in column 0 Frequency; export the waveform, not its spectrum."),
    "uneven.csv": (text(np.where(T > 0.02, T + 0.01, T), X, header="t [s];x\n"), {}, "that are not evenly spaced; export it at one"),
    "text_inside.csv": (text(T, X, tail="overload\n0.1;0.2\n"), {}, "gap among its numbers, in line 641 ('overload'); correct"),
    "gap.csv": (text(T, X, tail="0.06;\n0.07;0.1\n"), {}, "gap among its numbers, in line 641 ('0.06;'); correct"),
    "nan.csv": (GAP, {}, "has values that are not finite numbers, 1 of 640, the first in line 42; export it again."),
    "commas.csv": (text(T, X, mark=",", comma=True, header="t,x\n"), {}, "has numbers with decimal commas, and commas separate"),
    "stereo.wav": (wav(X, Y), {}, "has 2 columns (0, 1) and none is chosen; choose one with --channel."),
    "many.mat": (mat(DE=X, FE=Y, rpm=1797.0), {}, "more than one variable with 100 numbers or more; name one with --channel."),
    "two_rows.npy": (array(np.stack([X, Y])), {}, "has 2 columns (0, 1) and none is chosen; choose one with --channel."),
    "no_such_sheet.xlsx": (excel(["x"], X), {"variable": "Run"}, "holds the sheets Data, Notes, not Run; name one with --channel."),
    "empty_sheet.xlsx": (excel(["x"], X), {"variable": "Notes"}, "has no row of numbers among its first 0; name another sheet with"),
    "no_excel.xlsx": (lambda path: path.write_text("x"), {}, "is truncated, damaged or not a spreadsheet file"),
}  # fmt: skip
