"""Laws of the verdict: when it is unsure, and how windows, channels and references are used."""

import numpy as np
import pytest

from features.baselines import Model
from features.baselines.predictions import DAMAGED, UNSURE
from features.table.durations import windows_of
from features.table.indicators import Orders
from gen.corpus import FAULTS, fault_classes
from gen.corpus.fault_classes import FaultClass, harmonics
from raceway.diagnosis import Given, Pair
from raceway.diagnosis.answer import Judged, _conclude, _usable
from raceway.diagnosis.evidence import Line
from raceway.diagnosis.verdict import ANSWER, CERTAIN, OBVIOUS, PLAIN, SURE, WITHOUT_LINES, certainly_faulty, judge
from raceway.diagnosis.wording import MISSED, answer_in_words, missed_faults
from raceway.importing.recorded import LONGEST, Recorded

FS, RATE = 12_000.0, 25.0
ORDERS = Orders(*map(np.asarray, (0.3983, 3.5848, 5.4152, 2.3567)))
GIVEN = Given({"6205": ORDERS}, (RATE, RATE))
USED = Recorded({"": np.zeros(200_000)}, 10_000.0)


def probabilities(name, likely=0.88):
    rest = (1 - likely) / 3
    return {fault: likely if fault == name else rest for fault in FAULTS[:4]}


def line(fault, harmonic=1, level=PLAIN + 1, side=""):
    return Line(fault, f"{harmonic}", harmonic, 3.0 * harmonic, 75.0 * harmonic, level, (1000.0, 3000.0), side)


OF_INNER = [line("inner"), line("inner", level=8.0, side="shaft")]
PLAIN_OUTER = [line("outer", level=OBVIOUS - 1), line("outer", 2)]


@pytest.mark.parametrize(
    ("name", "lines", "expected"),
    [
        ("inner", OF_INNER, "inner"),
        ("inner", [line("inner"), line("inner", 2)], UNSURE),
        ("inner", [], UNSURE),
        ("inner", PLAIN_OUTER, UNSURE),
        ("inner", [*PLAIN_OUTER, *OF_INNER], "inner"),
        ("outer", [*PLAIN_OUTER, line("outer", level=OBVIOUS - 2, side="shaft")], "outer"),
        ("outer", [*PLAIN_OUTER, line("outer", level=OBVIOUS, side="shaft")], UNSURE),
        ("ball", [], UNSURE),
        ("ball", [line("cage"), line("outer", level=10.0)], UNSURE),
        ("ball", [line("outer", level=10.0)], UNSURE),
        ("ball", [line("ball"), line("ball", side="ftf")], "ball"),
        ("ball", [line("ball"), line("ball", side="ftf"), line("ball", level=PLAIN + 5, side="shaft")], UNSURE),
        ("ball", [line("ball"), line("ball", level=PLAIN - 1, side="shaft")], "ball"),
    ],
)
def test_a_fault_needs_lines_of_its_own_with_sidebands_that_fit(name, lines, expected):
    assert judge(probabilities(name, WITHOUT_LINES - 0.01), 0.5, lines)[0] == expected


@pytest.mark.parametrize(
    ("lines", "sure"),
    [([], "ball"), ([line("ball")], "ball"), ([line("outer", level=10.0)], UNSURE), (OF_INNER, UNSURE)],
)
def test_balls_are_answered_without_lines_if_they_are_probable_and_no_line_tells_another_part(lines, sure):
    assert judge(probabilities("ball", WITHOUT_LINES), 0.5, lines)[0] == sure
    assert judge(probabilities("ball", WITHOUT_LINES), WITHOUT_LINES + 0.01, lines)[0] == UNSURE
    for fault in ("inner", "outer"):
        assert judge(probabilities(fault, 0.99), 0.5, [])[0] == UNSURE


@pytest.mark.parametrize("likely", [0.7, 0.9999])
def test_lines_of_the_cage_alone_are_no_ball(likely):
    for lines in ([line("cage")], [line("cage"), line("cage", 2, level=OBVIOUS)]):
        verdict, why = judge(probabilities("ball", likely), 0.5, lines)
        assert (verdict, why) == (UNSURE, "the classifier says ball, but no 2 BSF line stands out")


@pytest.mark.parametrize(
    ("likely", "lines", "expected"),
    [
        (SURE - 0.01, PLAIN_OUTER, UNSURE),
        (SURE - 0.01, [line("inner")], "healthy"),
        (SURE - 0.01, [line("inner"), line("inner", side="shaft")], "healthy"),
        (SURE - 0.01, [line("inner", level=PLAIN - 1), line("inner", 2, PLAIN - 1)], "healthy"),
        (SURE - 0.01, [line("inner", 2), line("inner", 3)], "healthy"),
        (SURE - 0.01, [line("inner", 2), line("inner", 3), line("inner", 4)], UNSURE),
        (SURE, PLAIN_OUTER, "healthy"),
        (SURE, [line("outer", level=OBVIOUS), line("outer", 2)], UNSURE),
    ],
)
def test_healthy_falls_to_plain_lines_and_if_it_is_sure_to_obvious_ones(likely, lines, expected):
    assert judge(probabilities("healthy", likely), 0.5, lines)[0] == expected


@pytest.mark.parametrize("chances", [(0.031,), (0.01, 0.031)])
@pytest.mark.parametrize("why", [{}, {"elsewhere": True}, {"strange": 4.21}])
def test_an_unsure_answer_is_damaged_if_a_fault_is_certain_at_every_pair(chances, why):
    why = {name: (pair(30.0),) if value is True else value for name, value in why.items()}
    names = (UNSURE, "outer")[: len(chances)]

    def answer(healthy):
        each = [
            judged(name, pair(RATE + number))._replace(probabilities=chance(none))
            for number, (name, none) in enumerate(zip(names, healthy, strict=True))
        ]
        return _conclude(USED, GIVEN, Model(), each, why.get("elsewhere", ()), why.get("strange"), compared=True)

    doubted, certain = answer(chances), answer([1 - CERTAIN] * len(chances))
    assert (doubted.verdict, certain.verdict) == (UNSURE, DAMAGED)
    # the reason of the doubt stays
    assert certain.sentence.partition(": ")[2] == doubted.sentence.partition(": ")[2]


def chance(healthy):
    """Probabilities of which no fault is likelier than another."""
    return {fault: healthy if fault == "healthy" else (1 - healthy) / 3 for fault in FAULTS[:4]}


def test_a_model_that_knows_no_healthy_bearing_tells_of_no_certain_fault():
    assert not certainly_faulty([{"inner": 0.5, "outer": 0.5}])


def test_several_faults_need_lines_of_some_part():
    chances = {"healthy": 0.05, "compound": 0.95}
    assert judge(chances, 0.5, OF_INNER) == ("compound", "")
    assert judge(chances, 0.5, []) == (UNSURE, "the classifier says compound, but no fault line stands out")


@pytest.fixture
def dented(monkeypatch):
    """Class of a plug-in by its row."""

    def install(**row):
        monkeypatch.setattr(fault_classes, "plugin", lambda *_: FaultClass("dented", **row))
        return {"healthy": 0.12, "dented": 0.88}

    fault_classes.fault_class.cache_clear()
    yield install
    fault_classes.fault_class.cache_clear()


@pytest.mark.parametrize("companion", ["", "outer"])
def test_a_class_with_the_fundamental_of_a_built_in_one_is_answered_by_its_lines(dented, companion):
    chances = dented(lines=harmonics("bpfo", 1, 2), companion=companion)
    assert judge(chances, 0.5, PLAIN_OUTER) == ("dented", "")
    assert judge(chances, 0.5, [*OF_INNER, *PLAIN_OUTER]) == ("dented", "")
    assert judge(chances, 0.5, []) == (UNSURE, "the classifier says dented, but no BPFO line stands out")
    assert judge(chances, 0.5, OF_INNER)[0] == UNSURE


def test_the_sidebands_of_a_class_are_those_that_its_row_asks_for(dented):
    sides = [*PLAIN_OUTER, line("outer", level=OBVIOUS, side="shaft")]
    for beside, lines, expected in (("", sides, "dented"), ("lower", sides, UNSURE), ("needed", PLAIN_OUTER, UNSURE)):
        fault_classes.fault_class.cache_clear()
        assert judge(dented(lines=harmonics("bpfo", 1), beside=beside), 0.5, lines)[0] == expected


def test_lines_of_a_companion_alone_answer_no_class_with_other_lines(dented):
    chances = dented(lines=harmonics("bpfi", 2, 4), companion="outer")
    assert judge(chances, 0.5, PLAIN_OUTER) == (UNSURE, "the classifier says dented, but no 2 BPFI line stands out")
    assert judge(chances, 0.5, [*PLAIN_OUTER, line("dented")]) == ("dented", "")


COMB = [line("outer", harmonic, level=ANSWER + 1 if harmonic == 2 else 12.0) for harmonic in (1, 2, 3, 5)]


@pytest.mark.parametrize("likely", [0.4, 0.97])
@pytest.mark.parametrize("distance", [0.0, 3.0])
def test_lines_that_plain_are_answered_although_the_classifier_says_healthy(likely, distance):
    assert judge(probabilities("healthy", likely), 0.5, COMB, distance) == ("outer", "")
    assert judge(probabilities("inner", 0.97), 0.5, COMB)[0] == UNSURE
    for missing in range(4):
        fewer = [one for number, one in enumerate(COMB) if number != missing]
        assert judge(probabilities("healthy", likely), 0.5, fewer, distance)[0] in ("healthy", UNSURE)
    of_ball = [one._replace(fault="ball") for one in COMB]
    assert judge(probabilities("healthy", likely), 0.5, of_ball)[0] == "ball"
    foreign = [*of_ball, line("ball", level=PLAIN + 5, side="shaft")]
    assert judge(probabilities("healthy", likely), 0.5, foreign)[0] in ("healthy", UNSURE)


def test_missed_faults_are_told_for_the_nearest_length():
    for seconds, alone, compared in MISSED:
        for near in (0.9 * seconds, 1.1 * seconds):
            assert missed_faults(near, compared=False) == (seconds, *alone)
            assert missed_faults(near, compared=True) == (seconds, *compared)
    assert missed_faults(1e-3, compared=False) == (MISSED[0][0], *MISSED[0][1])
    assert missed_faults(1e3, compared=False) == (MISSED[-1][0], *MISSED[-1][1])


def judged(name, pair):
    spectrum = [object()]
    return Judged(
        pair,
        name,
        "" if name != UNSURE else "no reason",
        probabilities(name),
        0.5,
        4,
        [],
        spectrum,
    )


def pair(rate, bearing="6205"):
    return Pair(bearing, ORDERS, rate, 0.2, "bpfo", 9.0)


def concluded(*names, elsewhere=(), strange=None, given=GIVEN):
    each = [judged(name, pair(RATE + number)) for number, name in enumerate(names)]
    return _conclude(USED, given, Model(), each, elsewhere, strange, compared=True)


def test_pairs_that_cannot_be_told_apart_must_give_the_same_class():
    given = GIVEN._replace(rates=(RATE, 2 * RATE))
    same = concluded("outer", "outer", "outer", given=given)
    assert same.verdict == "outer"
    assert same.sentence.endswith(
        "; shaft 1,500 rpm as found between 1,500 and 3,000 rpm, or up to 2.5 % beyond, and the lines fit 6205 at 1,560 rpm and 6205 at "
        "1,620 rpm as well."
    )
    found = concluded("outer", "inner", given=given)
    assert found.verdict == UNSURE
    assert "as well" not in found.sentence
    assert "cannot tell apart 6205 at 1,500 rpm (outer) and 6205 at 1,560 rpm (inner)" in found.sentence
    assert found.advice[0].startswith("Measure the speed during the recording, and give it as a narrow range (--rpm; ")
    assert "6205 at 1,560 rpm (unsure)" in concluded("outer", UNSURE, given=given).sentence


@pytest.mark.parametrize(
    ("alike", "named"),
    [
        ((), "6004"),
        (("6205",), "6004 or 6205"),
        (("6205", "ER-16K", "6208"), "6004, 6205, ER-16K or 6208"),
        (("6205", "ER-16K", "6208", "6310"), "6004, 6205, ER-16K or 2 more"),
    ],
)
def test_four_bearings_that_no_line_tells_apart_are_named_or_three_of_more_at_one_speed(alike, named):
    several = Given(dict.fromkeys(("6004", *alike, "other"), ORDERS), (RATE, RATE))
    each = [judged("outer", pair(RATE + 0.001, "6004")._replace(alike=alike))]
    answer = _conclude(USED, several, Model(), each, (), None, compared=True)
    assert answer.sentence.endswith(f"; bearing {named} as found, shaft 1,500 rpm.")


@pytest.mark.parametrize("name", ["healthy", "outer"])
def test_a_comb_that_is_not_explained_makes_every_verdict_unsure_and_names_what_would_explain_it(name):
    found = concluded(name, elsewhere=(pair(30.0),))
    assert found.verdict == UNSURE
    assert (
        "6205 at 1,500 rpm does not explain the strongest lines, but 6205 at 1,800 rpm (BPFO) would" in found.sentence
    )
    found = concluded(name, strange=4.21)
    assert found.verdict == UNSURE
    assert "4.21 orders" in found.sentence


@pytest.mark.parametrize("doubt", [False, True])
def test_of_bearings_that_fit_alike_none_is_called_found(doubt):
    several = Given({"6004": ORDERS, "6205": ORDERS}, (RATE, RATE))
    each = [judged("outer", pair(RATE, "6004")), judged(UNSURE if doubt else "outer", pair(RATE))]
    answer = _conclude(USED, several, Model(), each, (), None, compared=True)
    assert "as found" not in answer.sentence
    if doubt:
        assert answer.sentence.endswith("cannot tell apart 6004 at 1,500 rpm (outer) and 6205 at 1,500 rpm (unsure).")
        assert answer.advice[0].startswith("Give the bearing")
        strange = _conclude(USED, several, Model(), each, (), 4.21, compared=True)
        assert strange.advice[0] == answer.advice[0]
        assert "as found" not in strange.sentence
    else:
        assert answer.sentence.endswith("; bearing not known: the lines fit 6004 at 1,500 rpm or 6205 at 1,500 rpm.")


def test_damaged_tells_the_probability_of_any_fault_and_why_no_part_is_named():
    answer = _conclude(
        USED, GIVEN, Model(), [judged(UNSURE, pair(RATE))._replace(probabilities=chance(0.02))], (), None, compared=True
    )
    assert answer.sentence.startswith(
        "Damaged (probability of a fault 0.98), but the part is not known: no reason; shaft 1,500 rpm"
    )
    assert "check the bearing designation" in answer.advice[0]


def test_a_ball_without_lines_says_that_there_are_none():
    assert concluded("ball").sentence.startswith(
        "Ball fault (probability 0.88): no line of inner race, outer race, balls or cage stands 10 dB above the floor, as often with balls;"
    )


def test_a_healthy_answer_says_why_lines_do_not_count():
    told = answer_in_words("healthy", probabilities("healthy"), PLAIN_OUTER)
    assert told.endswith(
        "orders and 1 further harmonic stand up to 24 dB above the floor, too few lines or too faint ones for a fault"
    )


def test_a_long_recording_is_used_from_its_beginning():
    rng = np.random.default_rng(0)
    x = rng.standard_normal(round((LONGEST + 5) * 4000))
    used, quality = _usable(Recorded({"": x}, 4000.0), GIVEN)
    np.testing.assert_array_equal(used.signals[""], x[:240_000])
    assert quality.warnings[0] == "Only the first 60 s of 65 s are used."


def test_a_channel_that_tells_nothing_is_left_out_unless_it_is_the_only_one():
    x = np.random.default_rng(0).standard_normal(round(2 * FS))
    used, quality = _usable(Recorded({"x": x, "y": 0 * x}, FS), GIVEN)
    assert list(used.signals) == ["x"]
    assert quality.warnings[0].startswith("Channel y is left out, since the signal is constant")
    assert "constant" in _usable(Recorded({"y": 0 * x}, FS), GIVEN)[1].useless


@pytest.mark.parametrize(("durations", "length"), [((), 500), ((0.3, 0.6), 600), ((0.2, 0.2), 200)])
def test_windows_are_as_long_as_the_longest_training_records_and_a_short_signal_is_one(durations, length):
    x = np.arange(1300.0)
    count = 1300 // length
    np.testing.assert_array_equal(windows_of(x, 1000.0, durations), x[: count * length].reshape(count, length))
    np.testing.assert_array_equal(windows_of(x[:150], 1000.0, durations), x[None, :150])
