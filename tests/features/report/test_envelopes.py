"""Pictures of several envelope spectra: a waterfall has its lines at the drawn orders, a grid has a panel per record."""

import numpy as np
import pytest

from features.indicators import Orders
from features.report.envelopes import draw_envelopes, draw_waterfall, envelope_pieces
from features.report.pictures import Shown, picture

FS = 12_000.0
RATE = np.linspace(20.0, 40.0, round(4 * FS))  # a run-up [Hz]
ORDER = 3.5


@pytest.fixture(scope="module")
def run_up():
    """Noise with an envelope that is modulated at one order of a shaft that runs up."""
    turns = np.cumsum(RATE) / FS
    carrier = np.random.default_rng(1).standard_normal(len(RATE))
    return carrier * (1 + 0.9 * np.cos(2 * np.pi * ORDER * turns))


def test_the_strongest_line_of_each_piece_is_where_the_order_is_drawn(run_up):
    times, frequencies, spectra = envelope_pieces(run_up, FS, (1000.0, 5000.0))
    above = frequencies > 10
    strongest = frequencies[above][np.argmax(spectra[:, above], axis=1)]
    drawn = ORDER * np.interp(times, np.arange(len(RATE)) / FS, RATE)
    np.testing.assert_allclose(strongest, drawn, atol=4.0)


def test_the_lines_of_a_piece_have_the_amplitude_of_its_envelope():
    t = np.arange(round(4 * FS)) / FS
    signal = 3 * (1 + 0.4 * np.cos(2 * np.pi * 90 * t)) * np.sin(2 * np.pi * 3000 * t)
    _, frequencies, spectra = envelope_pieces(signal, FS, (2000.0, 4000.0))
    np.testing.assert_allclose(spectra[:, frequencies == 90], 1.2, rtol=1e-3)


def test_a_waterfall_draws_every_order_it_is_given(run_up):
    figure = draw_waterfall("Run-up", run_up, FS, (1000.0, 5000.0), RATE, {"fr": 1.0, "line": ORDER})
    drawn = figure.axes[0].lines
    assert [line.get_xdata()[-1] / line.get_xdata()[0] for line in drawn] == pytest.approx([1.775, 1.775], rel=0.05)
    assert picture(figure, "png").startswith(b"\x89PNG")


def test_a_grid_has_one_panel_for_each_record_titled_in_the_colour_of_its_class(run_up):
    orders = Orders(*map(np.float64, (0.4, 3.5, 5.4, 2.3)))
    faults = ("healthy", "inner", "cage")
    figure = draw_envelopes([Shown(f"a {fault}", run_up, FS, 30.0, orders, fault) for fault in faults])
    assert [axes.get_title(loc="left") for axes in figure.axes] == [f"a {fault}" for fault in faults]
    assert len({axes._left_title.get_color() for axes in figure.axes}) == len(faults)
