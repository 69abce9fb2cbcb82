"""Every page of the documentation has its Python examples run; those of the tutorials by ``tests/thorough/test_site.py``."""

import re

import numpy as np
import pandas as pd
import scipy.io
import xarray as xr
from scipy.io import wavfile

import gen
import raceway
from tests.page_examples import blocks, run_blocks
from tests.paths import ROOT
from tests.tone_corpora import FS, write_corpus

RUN = {"classifiers.md", "diagnose.md", "features.md", "importing.md", "python.md", "sharing.md"}
NEED_A_CLUSTER = {"running.md"}
SHOW_A_PLUGIN = {"plugins.md"}  # run by tests/test_plugins.py


def test_every_page_with_examples_has_a_test():
    assert {path.name for path in ROOT.glob("docs/*.md") if blocks(path.name)} == RUN | NEED_A_CLUSTER | SHOW_A_PLUGIN
    tests = "".join(path.read_text(encoding="utf-8") for path in ROOT.glob("tests/**/test_*.py"))
    assert {page for page in RUN if f'run_blocks("{page}"' not in tests} == set()


def test_the_examples_of_sharing_read_a_file_and_a_table_and_write_csv_and_zarr(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    signals = write_corpus(tmp_path / "corpus")
    for form in ("corpus.nc", "corpus.parquet"):
        raceway.copy(["corpus"], form)
    names = run_blocks("sharing.md", tmp_path)
    np.testing.assert_array_equal(names["record"], signals[17])
    np.testing.assert_array_equal(names["signals"], signals)
    labels = pd.read_csv("labels.csv")
    assert labels["fault_name"].tolist() == names["corpus"]["fault_name"].values.tolist()
    np.testing.assert_allclose(pd.read_csv("record-17.csv")["housing"], signals[17], rtol=1e-6)
    with xr.open_zarr("corpus.zarr") as store:
        xr.testing.assert_identical(store.load(), names["corpus"].load())


def test_the_examples_of_importing_read_a_set_and_a_recording(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    noise = np.random.default_rng(0).standard_normal((12000, 1))
    (tmp_path / "cwru").mkdir()
    scipy.io.savemat(tmp_path / "cwru" / "105.mat", {"X105_DE_time": noise, "X105RPM": 1797.0})
    wavfile.write(tmp_path / "pump.wav", 12000, noise[:, 0].astype(np.float32))
    names = run_blocks("importing.md", tmp_path)
    assert (names["done"].recordings, names["done"].records) == (1, 2)
    assert re.search(r"\(12000,\) 12000", capsys.readouterr().out)


def test_the_examples_of_diagnose_estimate_a_speed_and_correct_those_of_a_corpus(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    signals = write_corpus(tmp_path / "recordings", specimens=4)
    orders = gen.bearing_orders("6205")._asdict()
    names = run_blocks("diagnose.md", tmp_path, x=signals, fs=FS, shaft_rate=30.0, **orders)
    assert abs(names["found"].rate / 30 - 1) <= 0.08
    assert len(names["table"]["shaft_rate_estimate"]) == len(signals)
