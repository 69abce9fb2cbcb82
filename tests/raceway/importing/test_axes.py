"""Columns of a file are the axes of one sensor if names and units say so, or if there are three without names."""

from pathlib import Path

import numpy as np
import pytest

from raceway.importing.acceleration import Sensor, read_signal, reader
from raceway.importing.axes import axes_of
from raceway.importing.header import Header, unit_said
from raceway.importing.reading_options import Reading
from raceway.importing.refused_files import UnusableError
from raceway.importing.user_folder import read_recording
from tests.raceway.importing.file_writers import T, X, Y, array, mat, text, wav

Z = np.roll(X, 7)


@pytest.mark.parametrize(
    ("names", "axes"),
    [
        ("x,y", "x,y"),
        ("x [g],y [g],z [g],speed [rpm],Temperature", "x [g],y [g],z [g]"),
        ("accX (m/s²),accY (m/s²),accZ (m/s²)", "accX (m/s²),accY (m/s²),accZ (m/s²)"),
        ("ax,ay,az", "ax,ay,az"),
        ("Horizontal_vibration,Vertical_vibration", "Horizontal_vibration,Vertical_vibration"),
        ("Vertical,Horizontal,Axial", "Vertical,Horizontal,Axial"),
        ("1H [g],1V [g],1A [g]", "1H [g],1V [g],1A [g]"),
        ("ch1,ch2,ch3", "ch1,ch2,ch3"),
        ("Dev1/ai0,Dev1/ai1,Dev1/ai2", "Dev1/ai0,Dev1/ai1,Dev1/ai2"),
        ("x [V],y [V]", "x [V],y [V]"),
        ("x [g],tacho [V]", "x [g]"),
        ("x,y,vz [mm/s]", "x,y"),
        ("x,y,current", ""),
        ("ch1,ch2", ""),
        ("DE [g],FE [g],BA [g]", ""),
        ("drive_end_x,fan_end_y", ""),
        ("DE_x,DE_y,FE_x,FE_y", ""),
        ("Bearing 1,Bearing 2,Bearing 3", ""),
        ("ax,ay,az,gx,gy,gz", ""),
        ("a,v", ""),
        ("a,b", ""),
        ("x,x", ""),
        ("x [counts],y [counts]", ""),
    ],
)
def test_names_differ_in_a_direction_or_in_the_number_of_three_channels(names, axes):
    every = tuple(names.split(","))
    header = Header(every, tuple(map(unit_said, every)))
    assert [every[n] for n in axes_of(header, range(len(every)))] == [*filter(None, axes.split(","))]


@pytest.mark.parametrize(
    ("name", "content", "axes"),
    [
        ("r.csv", text(T, X, Y, Z, header="Time [s];x [g];y [g];z [g]\n"), ("x", "y", "z")),
        ("r.txt", text(X, Y, Z, mark="\t", header="Dev1/ai0\tDev1/ai1\tDev1/ai2\n"), ("Dev1/ai0", "Dev1/ai1", "Dev1/ai2")),
        ("named_twice.csv", text(T, X, Y, header="t [s];x [g];x [V]\n"), ("x [g]",)),
        ("r.wav", wav(X, Y), ()),
        ("r.npy", array(np.stack([X, Y, Z])), ("0", "1", "2")),
        ("fields.mat", mat(run={"acc_x": X, "acc_y": Y}, t=T, fs=12800.0), ("run.acc_x", "run.acc_y")),
        ("cwru.mat", mat(X097_DE_time=X, X097_FE_time=Y, X097RPM=1797.0), ()),
        ("lengths.mat", mat(x=X, y=Y[:-3]), ()),
        ("columns.mat", mat(data=np.stack([X, Y, Z], axis=1)), ("0", "1", "2")),
    ],
)  # fmt: skip
def test_a_file_of_several_signals_names_its_axes_as_they_are_chosen(name, content, axes, tmp_path: Path):
    path = tmp_path / name
    if callable(content):
        content(path)
    else:
        path.write_text(content, encoding="utf-8")
    with pytest.raises(UnusableError) as refused:
        reader(path, None)(Sensor())
    assert refused.value.axes == axes
    columns = [int(axis) if axis.isdecimal() else axis for axis in axes]
    named = name == "fields.mat"
    signals = [read_signal(path, **{"variable" if named else "column": axis}).values for axis in columns]
    for values, written in zip(signals, (X, Y, Z), strict=False):
        np.testing.assert_allclose(values / values.std(), written / written.std(), rtol=1e-9)


@pytest.mark.parametrize("name", ["r.mat", "saved_as.dat", "r.npz"])
def test_a_channel_is_a_variable_of_every_file_that_has_some(name, tmp_path: Path):
    content = {"DE": X, "FE": Y, "fs": 12800.0}
    if name.endswith(".npz"):
        np.savez(tmp_path / name, **content)
    else:
        mat(**content)(tmp_path / name)
    recorded, *_ = read_recording(tmp_path / name, Reading(("FE",), None, None, None, 12800.0, None))
    values = recorded.signals["FE"]
    np.testing.assert_allclose(values / values.std(), Y / Y.std(), rtol=1e-9)
