"""Views of a record: lines stand where they belong at any speed, and a chosen band is the planted one."""

from itertools import combinations

import numpy as np
import pytest

from features.table.band import DEFAULT_BAND, Band
from gen.corpus import open_corpus
from gen.support.errors import CorpusError
from raceway.reports.pictures import WIDTH, Drawing, draw_envelope_spectrum, draw_record, picture, squared_envelope
from raceway.reports.subject import shown_record, shown_recording
from raceway.reports.views import MAPS, VIEWS, draw_view, plot_record
from tests.pulses import pulse_train

FS = 12_000.0
ORDERS = (0.3983, 3.5848, 5.4152, 2.3567)
BPFO = ORDERS[1]


@pytest.fixture(scope="module")
def steady():
    x = pulse_train(FS, 4.0, 30.0 * BPFO, 3000.0, np.random.default_rng(0), noise=0.3)
    return shown_recording("steady", x, FS, (30.0, 30.0), ORDERS, DEFAULT_BAND)


@pytest.fixture(scope="module")
def run_up():
    """Impacts at the BPFO and harmonics of a shaft that runs up from 15 to 30 turns a second."""
    rate = np.linspace(15.0, 30.0, round(6 * FS))
    turns, rng = np.cumsum(rate) / FS, np.random.default_rng(1)
    hits = np.diff(np.floor(turns * BPFO), prepend=0.0)
    times = np.arange(200) / FS
    ringing = np.convolve(hits, np.exp(-600 * times) * np.sin(2 * np.pi * 3000 * times))[: len(rate)]
    shaft = sum(0.2 * np.sin(2 * np.pi * k * turns) for k in (1, 2, 3))
    return shown_recording(
        "run-up", ringing + shaft + 0.02 * rng.standard_normal(len(rate)), FS, (15.0, 30.0), ORDERS, DEFAULT_BAND
    )


@pytest.mark.parametrize("view", VIEWS)
def test_a_constant_record_is_drawn_without_a_warning(view):
    shown = shown_recording("constant", np.ones(24_000), FS, (30.0, 30.0), ORDERS, DEFAULT_BAND)
    assert np.all(squared_envelope(shown)[1] == 0)
    assert picture(draw_view(view, shown), "png").startswith(b"\x89PNG")


@pytest.mark.parametrize("view", VIEWS)
def test_every_view_is_drawn_at_constant_and_at_varying_speed_and_over_another_record(view, steady, run_up):
    assert picture(draw_view(view, run_up), "png").startswith(b"\x89PNG")
    if view in MAPS:
        with pytest.raises(ValueError, match="it shows one record alone"):
            draw_view(view, steady, steady)
    else:
        assert draw_view(view, steady, steady).legends


@pytest.mark.parametrize("columns", [1, 2])
@pytest.mark.parametrize("orders", [ORDERS, (0.44, 5.7, 8.3, 3.1), (0.45, 9.1, 10.9, 5.0)])
def test_names_of_lines_are_not_printed_over_each_other(steady, orders, columns):
    for fault in ("healthy", "inner", "outer", "ball", "cage"):
        figure = Drawing(figsize=(WIDTH if columns == 1 else 1.6 * WIDTH, 2), layout="constrained")
        axes = figure.subplots(1, columns, squeeze=False)[0, -1]
        draw_envelope_spectrum(axes, steady._replace(orders=type(steady.orders)(*map(np.asarray, orders)), fault=fault))
        figure.canvas.draw()
        boxes = [text.get_window_extent() for text in axes.texts]
        assert len(boxes) >= 5
        assert not [pair for pair in combinations(boxes, 2) if pair[0].overlaps(pair[1])]


def test_the_envelope_of_a_run_up_has_its_line_within_half_a_bin_of_its_order(run_up):
    orders, spectrum = squared_envelope(run_up)
    near = np.abs(orders - BPFO) < 0.3
    found = orders[near][spectrum[near].argmax()]
    assert found == pytest.approx(BPFO, abs=0.5 / run_up.turns[-1])
    _, smeared = squared_envelope(run_up._replace(angle=None))
    assert spectrum[near].max() > 5 * smeared[(np.abs(_ - BPFO) < 0.3)].max()


@pytest.mark.parametrize("seconds", [0.5, 6.0])
def test_a_recording_whose_varying_speed_cannot_be_tracked_is_refused_with_the_option_that_settles_it(seconds):
    noise = np.random.default_rng(2).standard_normal(round(seconds * FS))
    with pytest.raises(
        CorpusError, match=r"noise: the speed between 600 and 1800 rpm cannot be tracked .* give one speed"
    ):
        shown_recording("noise", noise, FS, (10.0, 30.0), ORDERS, DEFAULT_BAND)


@pytest.mark.parametrize("view", [None, "envelope"])
def test_a_record_from_python_is_drawn_as_the_command_draws_it_and_shown_in_a_notebook(tiny_corpus, view):
    with open_corpus(tiny_corpus) as corpus:
        of_command = [shown_record(corpus, number, 0, DEFAULT_BAND) for number in (5, 6)]
        figure = plot_record(corpus.isel(record=5), view, healthy=corpus.isel(record=6))
    expected = draw_record(*of_command) if view is None else draw_view(view, *of_command)
    lines, others = ([line for axes in of.axes for line in axes.lines] for of in (figure, expected))
    assert len(lines) == len(others) > 10
    for line, other in zip(lines, others, strict=True):
        np.testing.assert_array_equal(line.get_xydata(), other.get_xydata())
    assert figure._repr_png_().startswith(b"\x89PNG")


def test_the_title_of_a_record_is_what_a_person_calls_it(tiny_corpus):
    with open_corpus(tiny_corpus) as corpus:
        for fault, words in (("healthy", "Healthy"), ("outer", "Outer race fault")):
            record = corpus.isel(record=int(np.argmax(corpus["fault_name"].values == fault)))
            rpm = f"{60 * float(record.shaft_rate):,.0f} rpm"
            assert plot_record(record).get_suptitle() == f"{words}, 6205, {rpm}"
            # a text of a corpus is not drawn
            foreign = record.assign_coords(bearing="$x^{$")
            assert plot_record(foreign).get_suptitle() == f"{words}, {rpm}"
        with pytest.raises(CorpusError, match=r"has 48 records; give one, such as isel\(record=0\)"):
            plot_record(corpus)
        with pytest.raises(ValueError, match="view: 'polar' is none of waveform, psd"):
            plot_record(record, "polar")


def test_a_band_that_ends_above_half_the_sample_rate_is_named_as_it_is_recorded_in_every_panel(steady):
    titles = [axes.get_title("left") for axes in draw_record(steady._replace(band=Band(3000.0, 9000.0))).axes]
    assert [title.count("3-6 kHz") for title in titles] == [0, 1, 1]


def test_a_name_is_drawn_as_it_is_whatever_signs_it_has(steady):
    figure = draw_view("psd", steady._replace(title="$x^{$.wav"))
    assert picture(figure, "png")
    assert figure.get_suptitle() == "$x^{$.wav"
