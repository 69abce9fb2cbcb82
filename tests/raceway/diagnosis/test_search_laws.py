"""Laws of the search for bearing and speed: a comb beside its shaft is found over a wide range, and noise explains nothing."""

import numpy as np
import pytest

from features.table.indicators import Orders
from raceway.diagnosis import ANY_RATE, Given, Pair
from raceway.diagnosis.evidence import Line
from raceway.diagnosis.search import LevelSpectra, find_pairs, mean_spectra, strange_comb
from raceway.diagnosis.wording import speed_warning
from tests.pulses import impulses_beside_a_shaft

FS, RATE = 12_000.0, 29.5
NINE, EIGHT = Orders(0.3983, 3.5848, 5.4152, 2.3567), Orders(0.3821, 3.0530, 4.9470, 1.9940)
SEVEN = Orders(0.364, 2.545, 4.455, 1.696)
ORDER = {"bpfo": 3.5848, "bpfi": 5.4152, "2bsf": 4.7134}


def recording(order, seed, shaft=0.3, seconds=5.0, rate=RATE):
    return impulses_beside_a_shaft(order, seed, fs=FS, rate=rate, seconds=seconds, shaft=shaft)


def found(x, given):
    spectra = mean_spectra([x], FS, given)
    return find_pairs(spectra, given)


@pytest.mark.parametrize("family", ORDER)
@pytest.mark.parametrize("rates", [(18.0, 42.0), ANY_RATE])
def test_a_comb_beside_its_shaft_is_found_in_a_range(family, rates):
    pair = found(recording(ORDER[family], 1), Given({"nine": NINE}, rates))[0][0]
    assert pair.rate == pytest.approx(RATE, rel=0.01)
    assert abs(pair.rate - RATE) < 3 * pair.uncertainty
    assert pair.lines == family


def test_the_bearing_is_found_among_several_at_a_known_speed():
    given = Given({"eight": EIGHT, "nine": NINE, "also nine": NINE, "seven": SEVEN}, (RATE, RATE))
    (pair,), _ = found(recording(ORDER["bpfo"], 2), given)
    assert (pair.bearing, pair.alike, pair.lines) == ("nine", ("also nine",), "bpfo")


@pytest.mark.parametrize("error", [-0.4, -0.25, 0.3, 0.4])
def test_a_wrong_speed_is_kept_and_the_pair_that_explains_the_lines_is_elsewhere(error):
    label = RATE * (1 + error)
    pairs, elsewhere = found(recording(ORDER["bpfo"], 3), Given({"nine": NINE}, (label, label)))
    assert [pair.rate for pair in pairs] == [label]
    assert elsewhere[0].rate == pytest.approx(RATE, rel=0.01)


def test_a_speed_a_few_per_cent_off_is_corrected_and_explains_the_lines():
    label = 1.05 * RATE
    pairs, elsewhere = found(recording(ORDER["bpfo"], 4), Given({"nine": NINE}, (label, label)))
    assert pairs[0].rate == pytest.approx(RATE, rel=0.01)
    assert elsewhere == ()


@pytest.mark.parametrize("error", [-0.05, -0.03, 0.03, 0.05])
def test_a_speed_far_from_the_label_is_assumed_only_if_the_shaft_clearly_tells_it(error):
    """Without lines of the shaft a wrong bearing would explain the comb as well, so that the label stays beside it."""
    label = RATE * (1 + error)
    (told, _), (untold, elsewhere) = (
        found(recording(ORDER["bpfo"], 4, shaft=shaft), Given({"nine": NINE}, (label, label))) for shaft in (0.6, 0.0)
    )
    assert [pair.rate for pair in told] == pytest.approx([RATE], rel=0.01)
    assert untold[0].rate == label
    beside = [pair.rate for pair in untold[1:]]
    assert beside == pytest.approx([RATE] * len(beside), rel=0.01)
    assert pytest.approx(RATE, rel=0.01) in [*beside, *(pair.rate for pair in elsewhere)]


@pytest.mark.parametrize("error", [-0.055, -0.04])
def test_a_comb_of_a_wrong_bearing_does_not_move_a_speed_that_the_shaft_confirms(error):
    """Its order is that of another bearing, so that it fits BPFO at another speed."""
    pairs, _ = found(recording(ORDER["bpfo"] * (1 + error), 5, shaft=1.0), Given({"nine": NINE}, (RATE, RATE)))
    assert pairs[0].rate == RATE
    assert pairs[1].rate == pytest.approx(RATE * (1 + error), rel=0.01)


@pytest.mark.parametrize("shaft", [0.0, 0.5])
def test_noise_and_shafts_alone_leave_the_label_and_nothing_to_explain(shaft):
    for seed in range(20):
        given = Given({"nine": NINE}, (RATE, RATE))
        x = recording(0, seed, shaft, seconds=3.0)
        spectra = mean_spectra([x], FS, given)
        pairs, elsewhere = find_pairs(spectra, given)
        assert pairs[0].rate == RATE
        assert elsewhere == ()
        assert strange_comb(spectra, pairs[0], []) is None


def spectra_with(*orders, height=3.0):
    """Levels of noise with lines at orders of the shaft."""
    level = np.full(6000, -0.11)
    level[np.rint(np.array(orders) * RATE / 0.25).astype(int)] = height
    return LevelSpectra(level, np.full(6000, -0.11), 0.25, 20)


BPFI = Line("inner", "BPFI", 1, 5.4152, 5.4152 * RATE, 24.0, (1000.0, 3000.0))


@pytest.mark.parametrize(
    ("orders", "lines", "strange"),
    [
        ((4.21, 8.42, 12.63), [], True),
        ((4.21,), [], False),
        ((2.5, 5.0, 7.5), [], False),  # the second lies at the shaft
        ((4.4152, 8.8304, 13.2456), [], True),
        ((4.4152, 8.8304, 13.2456), [BPFI], False),  # one shaft order below BPFI
        ((3.5848, 7.1696, 10.7544), [], False),
        (tuple(100 * n / RATE for n in (1, 2, 3)), [], False),
        (tuple(60 * n / RATE for n in (1, 2, 3)), [], False),
    ],
)
def test_a_comb_is_strange_unless_bearing_shaft_mains_or_evidence_explain_it(orders, lines, strange):
    found_order = strange_comb(spectra_with(*orders), Pair("nine", NINE, RATE, 0.2, "shaft", 5.0), lines)
    assert (found_order is not None) == strange
    if strange:
        assert found_order == pytest.approx(orders[0], rel=0.01)


def test_a_speed_at_the_end_of_the_search_is_told():
    given = Given({"nine": NINE}, (20.0, RATE / 1.025))
    (sentence,) = speed_warning(found(recording(ORDER["bpfo"], 1), given)[0][0], given)
    assert "end of the search of 1,170 to 1,770 rpm" in sentence
    for rates in ((20.0, 35.0), (RATE, RATE)):
        given = Given({"nine": NINE}, rates)
        assert speed_warning(found(recording(ORDER["bpfo"], 1), given)[0][0], given) == ()
