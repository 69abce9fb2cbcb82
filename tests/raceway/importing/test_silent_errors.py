"""Files that were read wrongly in silence, or refused without a way out: read, or refused with what settles it."""

import struct
import zipfile

import h5py
import numpy as np
import pytest
import scipy.io

from features.baselines.model_file import read_model_file
from gen.support.errors import CorpusError
from gen.support.limits import VARIABLE
from raceway.importing import read_signal
from raceway.importing.label_tables import read_table_of_labels
from raceway.importing.reading_options import Reading
from raceway.importing.user_folder import OPTIONS, read_recording, recordings_in
from tests.labels import write_labels
from tests.raceway.importing.file_writers import FS, N, T, X, Y, array, changed, excel, mat, text, workbook
from tests.raceway.importing.people_files import AT, LVM, ONE_LVM, PLAIN
from tests.raceway.importing.test_people_files import assert_refused, write

WITHOUT_TIMES = {"columns": "No"}
CHINESE = "时间（s）,加速度（g）\n"
PADERBORN = np.array([("speed", Y), ("vibration_1", X)], dtype=[("Name", "O"), ("Data", "O")])
VOLTS = 2 + np.abs(np.round(X, 3)) + 0.001


def lvm(**said):
    times = [""] * N if said.get("columns") == "No" else T
    return text(times, X, mark="\t", header=LVM.format(**ONE_LVM | said))


READ = {  # content or writer, what is given, values, sample rate
    "exact_step.lvm": (lvm(**WITHOUT_TIMES), {}, X * 9.80665, FS),
    "rounded_step.lvm": (lvm(**WITHOUT_TIMES, step="0.000977"), {}, X * 9.80665, 1024.0),
    "coarse_step.lvm": (lvm(**WITHOUT_TIMES, step="0.000156"), {}, X * 9.80665, None),
    "times_beside_a_coarse_step.lvm": (lvm(step="0.000078"), {}, X * 9.80665, FS),
    **{f"{encoding}.csv": (text(T, X, mark=",", header=CHINESE, encoding=encoding), {}, X * 9.80665, FS)
       for encoding in ("utf-8", "gbk", "utf-16")},
    "big5.csv": (text(T, X, mark=",", header=CHINESE.replace("时间", "時間"), encoding="big5"), {}, X * 9.80665, FS),
    "cp932.csv": (text(T, X, mark=",", header=CHINESE.replace("时间", "時間"), encoding="cp932"), {}, X * 9.80665, FS),
    "volts.csv": (text(VOLTS, form=".3f"), {"decimal": ".", **AT}, VOLTS, FS),
    "grouped.csv": (text(VOLTS, form=".3f"), {"decimal": ",", **AT}, 1000 * VOLTS, FS),
    "2004.02.12.10.32.39": (text(X, Y, mark="\t"), {"column": 0, **AT}, X, FS),
    "text.xls": (text(T, X, mark="\t", header="t [s]\tx [m/s2]\n"), {}, X, FS),
    "sheet.csv": (excel(["x [m/s2]"], X), AT, X, FS),
    "mfpt.mat": (mat(bearing={"sr": 48828, "gs": X, "rate": 25}, BPFO=81.1), {}, X, 48828.0),
    "uestc.mat": (mat(Data=X, SampleFrequency=20000, Datacount=N), {}, X, 20000.0),
    "paderborn.mat": (mat(N09={"Y": PADERBORN}), {"variable": "N09.Y[1].Data", **AT}, X, FS),
}  # fmt: skip


@pytest.mark.parametrize("name", READ)
def test_a_file_is_read_as_it_was_written(tmp_path, name):
    content, keys, values, fs = READ[name]
    write(tmp_path / name, content)
    signal = read_signal(tmp_path / name, **keys, options=OPTIONS)
    np.testing.assert_allclose(signal.values, values, rtol=1e-9)
    assert signal.fs == fs
    assert recordings_in(tmp_path, []) == [tmp_path / name]


def table_7_3(path):
    with h5py.File(path, "w") as file:
        file["T"] = np.zeros((1, 6), "u4")
        file["T"].attrs["MATLAB_class"] = np.bytes_("table")
        file["#refs#/a"] = X


REFUSED = {  # content or writer, what is given, part of the sentence
    "several_blocks.lvm": (lvm().replace("Samples\t640", "Samples\t320"), {},
        "has 640 rows and states 320 samples: it holds several blocks; save each in a file of its own."),
    "lost_samples.csv": (text(np.delete(np.arange(N + 1), 600), X, header="n;x [g]\n"), {"column": "x", **AT},
        "has times in column 0 n that are not evenly spaced"),
    "count_of_rows.csv": (f"{N}\n" + text(X), AT, "has 640 in line 1, which is the number of the rows below; delete that line."),
    "count_below_a_name.csv": (f"x [g]\n{N}\n" + text(X), AT, "has 640 in line 2, which is the number of the rows below"),
    "sign_apart.txt": (text(T, [f"{'- ' if x < 0 else '+ '}{abs(x)}" for x in X], mark=" "), {"column": 2, "delimiter": " ", **AT},
        "has no row like the others in line 1 ('0 - 0.745831')"),
    "windows.npy": (array(np.stack([X[:520]] * 16, axis=1)), {"column": 0}, "windows cannot be told from channels"),
    "volts.csv": (text(VOLTS, form=".3f"), AT, "give the decimal mark with --decimal."),
    "table.mat": (table_7_3, {}, "holds T, which is a table; save its columns as arrays of numbers."),
    "rates.mat": (mat(x=X, fs=12800, sample_rate=25600), {}, "give the sample rate with --rate."),
    "old.xls": (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600), {}, "is damaged, or an old Excel file above 6.8 MB; save it as .xlsx."),
    "many_rows.xlsx": (workbook({"a": "<row><c><v>1</v></c></row>" * 1_100_000}), {},
        "rows, and one of Excel has at most 1048576; export it again."),
    "overload_in_times.csv": (changed(PLAIN, 600, "OVL,0.5"), {}, "has no row like the others in line 600"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_a_file_that_leaves_something_open_is_refused(tmp_path, name):
    assert_refused(tmp_path / name, *REFUSED[name])


@pytest.mark.parametrize("name", ["Zeit", "time", "X_Value"])
def test_times_without_a_unit_are_told_by_their_name_unless_the_rate_is_given(tmp_path, name):
    rows = "".join(f"{n / 1000:.3f};{n * n % 7}\n" for n in range(200))
    path = tmp_path / "r.csv"
    path.write_text(f"{name};x\n{rows}", encoding="utf-8")
    reading = Reading((), *[None] * (len(Reading._fields) - 1))
    with pytest.raises(CorpusError, match=rf"rate; write {name} \[s\] over its times, or give it with --rate HZ"):
        read_recording(path, reading)
    assert read_recording(path, reading._replace(rate=800))[0].fs == 800
    path.write_text(f"{name} [s];x\n{rows}", encoding="utf-8")
    assert read_recording(path, reading)[0].fs == 1000


LABELS = {"bearing": "6205", "unit": "g", "sample_rate_hz": 12800}
ROW = {"path": "a.npy", "fault": "inner", "specimen": "A"}


@pytest.mark.parametrize("source", ["table", "option", "file"])
def test_a_speed_that_may_be_in_thousands_is_refused_wherever_it_is_given(tmp_path, source):
    table = write_labels(
        tmp_path, [ROW | ({"shaft_rpm": "1.480"} if source == "table" else {})], bearing="6205", unit="g"
    )
    shared = "shaft_rpm: 1.480\nbearing: '6205'\nunit: g\n" if source == "file" else "bearing: '6205'\nunit: g\n"
    table.with_suffix(".yaml").write_text(shared)
    with pytest.raises(CorpusError, match=r"shaft_rpm: 1\.480 may be in thousands; write it without marks"):
        read_table_of_labels(table, {"shaft_rpm": "1.480"} if source == "option" else {})


@pytest.mark.parametrize("encoding", ["utf-8-sig", "gbk"])
def test_a_table_of_labels_has_backslashes_a_stated_mark_and_an_encoding_of_east_asia(tmp_path, encoding):
    (tmp_path / "labels.csv").write_text("sep=;\npath;specimen;shaft_rpm\ndata\\a.npy;轴承一号;1480\n", encoding)
    ((place, labels),) = read_table_of_labels(tmp_path / "labels.csv", {**LABELS, "fault": "inner"})
    assert (place.rpartition(", ")[2], labels.path, labels.specimen) == ("row 3", "data/a.npy", "轴承一号")


def test_a_model_that_unpacks_to_more_than_the_limit_is_refused(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, "file_bytes=100000")
    with zipfile.ZipFile(tmp_path / "m.skops", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("schema.json", struct.pack("200000x"))
    with pytest.raises(CorpusError, match="unpacked has 200000 bytes, and the limit is 100000"):
        read_model_file(tmp_path / "m.skops")


def test_a_recording_too_short_for_a_spectrum_is_named(tmp_path):
    (tmp_path / "a.csv").write_text("x [g]\n" + "0.5\n0.25\n" * 3)
    with pytest.raises(CorpusError, match=r"a\.csv: holds 6 samples, and a diagnosis needs 8 at least"):
        read_recording(tmp_path / "a.csv", Reading((), None, None, None, FS, None))


def test_a_rate_or_a_speed_of_several_values_is_not_taken_as_its_first(tmp_path):
    scipy.io.savemat(tmp_path / "a.mat", {"x": X, "fs": [FS, 2 * FS], "rpm": [1500, 1800]})
    scipy.io.savemat(tmp_path / "b.mat", {"x": X, "fs": [FS, FS], "rpm": 1500})
    several, alike = (read_signal(tmp_path / name, variable="x", unit="g") for name in ("a.mat", "b.mat"))
    assert (several.fs, several.rpm, alike.fs, alike.rpm) == (None, None, FS, 1500)
