"""Files of measuring programs and libraries: values, units and sample rates as they were written, other quantities refused."""

import sys
import zipfile

import numpy as np
import pandas as pd
import pytest

from gen.support.errors import CorpusError
from raceway.importing import read_signal
from raceway.importing.user_folder import OPTIONS
from tests.raceway.importing.file_writers import FS, N, T, X, Y, text
from tests.raceway.importing.people_files import LVM, ONE_LVM

G = 9.80665
PARTS = {
    "office": "urn:oasis:names:tc:opendocument:xmlns:office:1.0",
    "table": "urn:oasis:names:tc:opendocument:xmlns:table:1.0",
    "text": "urn:oasis:names:tc:opendocument:xmlns:text:1.0",
}


def tdms(path, *channels, **properties):
    nptdms = pytest.importorskip("nptdms", reason="npTDMS is in the extra files")
    with nptdms.TdmsWriter(path) as writer:
        writer.write_segment(
            [
                nptdms.ChannelObject("run", name, values, {"wf_increment": 1 / FS, "unit_string": unit} | properties)
                for name, unit, values in channels
            ]
        )


def uff(path, *sets, binary=0):
    pyuff = pytest.importorskip("pyuff", reason="pyuff is in the extra files")
    for name, unit, values, facts in sets:
        plain = {"func_type": 1, "abscissa_spec_data_type": 17, "ordinate_spec_data_type": 12}
        plain |= {"orddenom_spec_data_type": 0, "z_axis_spec_data_type": 0}
        data_set = pyuff.prepare_58(
            binary=binary, rsp_node=1, rsp_dir=1, ref_node=1, ref_dir=1, id1=name, ordinate_axis_units_lab=unit, data=values, x=T,
            abscissa_inc=1 / FS, num_pts=len(values), abscissa_spacing=1, ord_data_type=4, **plain | facts,
        )  # fmt: skip
        pyuff.UFF(str(path)).write_sets(data_set, "add")


def ods(path, content):
    pytest.importorskip("python_calamine", reason="python-calamine is in the extra files")
    names = " ".join(f'xmlns:{name}="{address}"' for name, address in PARTS.items())
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("mimetype", "application/vnd.oasis.opendocument.spreadsheet")
        archive.writestr("META-INF/manifest.xml", "<manifest/>")
        archive.writestr(
            "content.xml",
            f'<office:document-content {names}><office:body><office:spreadsheet><table:table table:name="Data">{content}'
            "</table:table></office:spreadsheet></office:body></office:document-content>",
        )


def ods_row(*cells, times=1):
    texts = [
        f'<table:table-cell office:value-type="float" office:value="{cell!r}"/>'
        if isinstance(cell, float)
        else f'<table:table-cell office:value-type="string"><text:p>{cell}</text:p></table:table-cell>'
        for cell in cells
    ]
    return f'<table:table-row table:number-rows-repeated="{times}">{"".join(texts)}</table:table-row>'


def parquet(path):
    pytest.importorskip("pyarrow", reason="pyarrow is in the extra files")
    pd.DataFrame({"t [s]": T, "x [g]": X, "who": "me"}).to_parquet(path)


def truncated(path):
    tdms(path, ("DE", "g", X))
    path.write_bytes(path.read_bytes()[:-1500])


CLOCK = np.datetime64("2026-01-01") + np.arange(N).astype("timedelta64[s]")
SHEET = ods_row("t [s]", "x [g]") + "".join(map(ods_row, T.tolist(), X.tolist()))
TWO = LVM.format(**ONE_LVM | {"channels": "2\t", "unit": "Newtons\tm/s^2", "step": "1.000000\t7.8125E-5", "columns": "No",
                              "names": "F (trigger)\tx (response)"})  # fmt: skip
READ = {
    "one.tdms": (lambda path: tdms(path, ("DE", "g", X)), G * X),
    "pressure_and_one.tdms": (lambda path: tdms(path, ("p", "Pa", Y), ("a", "m/s^2", X)), X),
    "clock_and_one.tdms": (lambda path: tdms(path, ("clock", "", CLOCK), ("a", "m/s^2", X)), X),
    "no_suffix_but_content.dat": (lambda path: tdms(path, ("DE [g]", "", X)), G * X),
    "text.uff": (lambda path: uff(path, ("DE", "g", X, {})), G * X),
    "binary.unv": (lambda path: uff(path, ("DE", "m/s^2", X, {}), binary=1), X),
    "sheet.ods": (lambda path: ods(path, SHEET + ods_row("", times=10_000)), G * X),
    "frame.parquet": (parquet, G * X),
    "archive.npz": (lambda path: np.savez(path, x=X, fs=FS), X),
    "channels.lvm": (
        lambda path: path.write_text(text([""] * N, Y, X, mark="\t", header=TWO), encoding="utf-8"),
        X,
    ),
}


@pytest.mark.filterwarnings("ignore:Exception ignored")  # the writer of binary universal files leaves them open
@pytest.mark.parametrize("name", READ)
def test_values_unit_and_rate_are_those_that_were_written(tmp_path, name):
    write, expected = READ[name]
    write(tmp_path / name)
    column = {"pressure_and_one.tdms": "a", "channels.lvm": 2}.get(name)
    signal = read_signal(tmp_path / name, column=column)
    np.testing.assert_allclose(signal.values, expected, rtol=1e-9, atol=1e-10)
    assert signal.fs == FS


def test_scales_of_tdms_channels_are_applied(tmp_path):
    scale = {"NI_Number_Of_Scales": 1, "NI_Scale[0]_Scale_Type": "Linear", "NI_Scale[0]_Linear_Slope": 0.25,
             "NI_Scale[0]_Linear_Y_Intercept": 1.0, "NI_Scale[0]_Linear_Input_Source": 0xFFFFFFFF}  # fmt: skip
    tdms(tmp_path / "a.tdms", ("DE", "m/s^2", np.arange(N) % 7), **scale, NI_Scaling_Status="unscaled")
    np.testing.assert_allclose(read_signal(tmp_path / "a.tdms").values, 1 + 0.25 * (np.arange(N) % 7))


REFUSED = {
    "pressure.tdms": (lambda path: tdms(path, ("p", "Pa", X)), "states column 0 p in Pa in its header, which is no acceleration"),
    "several.tdms": (lambda path: tdms(path, ("p", "g", X), ("q", "g", Y)), "has 2 columns (0 p, 1 q) and none is chosen; choose one with"),
    "empty.tdms": (lambda path: tdms(path), "holds no column of numbers"),
    "damaged.tdms": (lambda path: path.write_bytes(b"TDSm" + bytes(40)), "is truncated, damaged or not a TDMS file"),
    "truncated.tdms": (truncated, "is truncated; copy it again, or close it in the program that records."),
    "pressure.uff": (lambda path: uff(path, ("p", "", X, {"ordinate_spec_data_type": 15})),
                     "in kind 15 in its header, which is no unit that is read"),
    "spectrum.uff": (lambda path: uff(path, ("PSD", "g", X, {"func_type": 9})), "holds a function of kind 9 (PSD), and no signal"),
    "no_sets.uff": (lambda path: path.write_text("    -1\n   164\n    -1\n"), "holds no data set 58"),
    "damaged.parquet": (lambda path: path.write_bytes(b"PAR1" + bytes(40)), "is truncated, damaged or not a Parquet file"),
    "damaged.npz": (lambda path: path.write_bytes(b"PK\3\4" + bytes(40)), "is truncated, damaged or not a NumPy file"),
    "pickle.npz": (lambda path: np.savez(path, x=np.array([{}], dtype=object)), "is truncated, damaged or not a NumPy file"),
    "two.npz": (lambda path: np.savez(path, de=X, fe=Y), "holds de, fe, more than one variable with 100 numbers or more; name one with"),
    "line_break.tdms": (lambda path: tdms(path, ("p\nq", "Pa", X)), "states column 0 p?q in Pa in its header"),
    "repeated.ods": (lambda path: ods(path, ods_row(*[0.5] * 100, times=1_000_000)), "has a sheet of 100000000 cells, which takes"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_other_quantities_and_damaged_files_are_refused_with_a_sentence(tmp_path, name):
    write, sentence = REFUSED[name]
    write(tmp_path / name)
    with pytest.raises(CorpusError) as refused:
        read_signal(tmp_path / name, options=OPTIONS)
    assert sentence in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("name", "module"),
    [("a.tdms", "nptdms"), ("a.uff", "pyuff"), ("a.parquet", "pyarrow.parquet"), ("a.ods", "python_calamine")],
)
def test_without_its_extra_a_file_tells_what_to_install(tmp_path, monkeypatch, name, module):
    (tmp_path / name).write_text("x")
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(CorpusError, match=r"needs [\w-]+; pip install raceway\[files\]\."):
        read_signal(tmp_path / name)
