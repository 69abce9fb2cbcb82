"""Laws of the band that features are computed from, and of the channel."""

import numpy as np
import pytest
import xarray as xr

from features import feature_table
from features.baselines import Model, predict
from features.table.band import DEFAULT_BAND, ENERGY_EDGES, Band, checked_band
from features.table.indicators import Orders, indicators
from gen.support.errors import CorpusError
from tests.tone_corpora import write_corpus

FS, RATE, HIGH_BAND = 25_600.0, 25.0, Band(300.0, 9000.0)
ORDERS = Orders(*(np.full(1, order) for order in (0.4, 3.6, 5.4, 2.4)))


def bursts(frequency, height=3.0):
    """Bursts at the BPFO of one frequency [Hz], in noise."""
    time = np.arange(int(FS)) / FS
    phase = (time * 3.6 * RATE) % 1 / (3.6 * RATE)
    noise = np.random.default_rng(1).standard_normal(len(time))
    burst = np.exp(-(((phase - 2e-3) / 5e-4) ** 2)) * np.sin(2 * np.pi * frequency * phase)
    return (noise + height * burst)[None]


def comb(x, band):
    values, names = indicators(x, FS, np.array([RATE]), ORDERS, ("lines",), band)
    return values[0, names.index("bands_max_bpfo_comb")]


def test_bursts_above_the_default_band_are_found_in_a_higher_one():
    of_noise = comb(bursts(3000.0, height=0.0), DEFAULT_BAND)
    assert comb(bursts(3000.0), DEFAULT_BAND) > 3 * of_noise
    assert comb(bursts(8000.0), DEFAULT_BAND) == pytest.approx(of_noise, rel=0.01)
    assert comb(bursts(8000.0), HIGH_BAND) > 3 * of_noise


@pytest.mark.parametrize(
    "band", [DEFAULT_BAND, HIGH_BAND, Band(2000.0, 3000.0), Band(0.0, 1000.0), Band(60_000.0, 61_000.0)]
)
def test_narrow_bands_lie_side_by_side_within_the_band(band):
    edges = [edge for edges in band.narrow for edge in edges]
    assert edges[1:-1:2] == edges[2::2]
    assert band.low <= edges[0] < edges[-1] == band.high
    assert np.diff(band.energy_edges).min() > 0
    assert set(band.energy_edges) <= {*ENERGY_EDGES, band.high}


@pytest.mark.parametrize("edges", [(5000, 300), (300, 900), (-1, 5000), (300, 2e5), (float("nan"), 5000)])
def test_a_band_that_cannot_be_used_is_refused(edges):
    with pytest.raises(ValueError, match="give two edges"):
        checked_band(*edges)
    with pytest.raises(ValueError, match="give two edges"):
        feature_table("corpus", band=edges)


def test_a_model_keeps_its_band_and_refuses_features_of_another(tmp_path):
    write_corpus(tmp_path / "corpus")
    band = Band(100.0, 1800.0)
    Model("logistic_regression").fit(feature_table(tmp_path / "corpus", band=band)).save(tmp_path / "model.skops")
    model = Model.load(tmp_path / "model.skops")
    assert model.band == band
    xr.testing.assert_identical(
        feature_table(tmp_path / "corpus", band=tuple(band)), feature_table(tmp_path / "corpus", band=band)
    )
    assert model.score(tmp_path / "corpus").records == 48
    with pytest.raises(
        CorpusError,
        match=r"computed from 300-5000 Hz, .* trained on 100-1800 Hz; compute them with the band \(100, 1800\)\.$",
    ):
        predict(feature_table(tmp_path / "corpus"), model)
