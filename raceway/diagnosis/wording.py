"""Sentences of a diagnosis. Pure."""

import math
from collections.abc import Mapping, Sequence

from features.signal.speed import DISAGREEMENT, RIVALS_BEYOND
from gen.corpus.fault_classes import HEALTHY, SIDES, families, fault_class
from gen.support.units import from_si
from raceway.diagnosis.evidence import LEAST_LEVEL, Line
from raceway.diagnosis.search import STRONG_COMB, Given, Pair

AT_END = 0.002  # distance of a speed from the end of the search, relative
NAMED = 3  # bearings alike
MISSED = ((0.5, (15, 86), (1, 288)), (2.0, (4, 86), (0, 288)), (10.0, (7, 86), (0, 288)))
"""Most seconds of recordings, and how many faulty ones of how many were called healthy, by ``python -m benchmarks.verdicts REAL
--missed``: of CWRU, MFPT (3 s at most) and UESTC alone, and in comparisons with a healthy recording, which MFPT has none of."""


def family_in_words(lines: Sequence[Line]) -> str:
    """Lines of one family, such as "BPFI at 5.41 orders and 2 harmonics stand up to 18 dB above the floor"."""
    plain = [line for line in lines if not line.side]
    first = min(plain, key=lambda line: line.harmonic)
    level = max(line.level for line in plain)
    further = len(plain) - 1
    more = "" if not further else " and 1 further harmonic" if further == 1 else f" and {further} further harmonics"
    verb = "stand up to" if further else "stands"
    sides = [part for side, part in SIDES.items() if any(line.side == side for line in lines)]
    beside = f" with sidebands at the rate of the {listed(sides, 'and')}" if sides else ""
    return f"{first.name} at {first.order:.2f} orders{more} {verb} {level:.0f} dB above the floor{beside}"


def by_family(lines: Sequence[Line]) -> dict[str, list[Line]]:
    """Lines by the class that they tell, strongest family first."""
    families: dict[str, list[Line]] = {}
    for line in lines:
        families.setdefault(line.fault, []).append(line)
    return families


def reasons(verdict: str, lines: Sequence[Line]) -> str:
    """Why a class is the verdict: its own lines or that there are none, and the lines of other families."""
    families = by_family(lines)
    own = families.pop(verdict, None)
    others = "; ".join(family_in_words(held) for held in families.values())
    if verdict == HEALTHY:
        return f"{others}, too few lines or too faint ones for a fault" if others else NO_LINE
    if own:
        return family_in_words(own) + (f"; also {others}" if others else "")
    return others or f"{NO_LINE}, as often with balls"


def line_of(fault: str) -> str:
    """Name of the line that tells a class; "fault" for a class without a line of its own."""
    row = fault_class(fault)
    return row.lines[0].label if row.is_family else "fault"


def faulty(probabilities: Mapping[str, float]) -> float:
    """Sum of the probabilities of all faults."""
    return sum(probability for fault, probability in probabilities.items() if fault != HEALTHY)


def probability_in_words(probability: float) -> str:
    """Probability with two digits, never 1.

    >>> probability_in_words(0.912), probability_in_words(0.9999), probability_in_words(0.0001)
    ('0.91', 'above 0.99', 'below 0.01')
    """
    if probability < 0.01:
        return "below 0.01"
    return "above 0.99" if probability > 0.99 else f"{probability:.2f}"


def candidates(probabilities: Mapping[str, float]) -> str:
    """The two most probable classes.

    >>> candidates({"healthy": 0.001, "inner": 0.45, "ball": 0.38}), candidates({"healthy": 0.001, "inner": 0.999})
    ('inner 0.45, ball 0.38', 'inner above 0.99, healthy below 0.01')
    """
    ranked = sorted(probabilities, key=lambda name: -probabilities[name])[:2]
    return ", ".join(f"{name} {probability_in_words(probabilities[name])}" for name in ranked)


def answer_in_words(verdict: str, probabilities: Mapping[str, float], lines: Sequence[Line]) -> str:
    """Such as "Inner race fault (probability 0.94): BPFI at 5.40 orders stands 18 dB above the floor"."""
    likely = max(probabilities, key=lambda name: probabilities[name])
    told = f"probability {probability_in_words(probabilities[likely])}"
    if likely == verdict:
        return f"{fault_class(verdict).words} ({told}): {reasons(verdict, lines)}"
    return (
        f"{fault_class(verdict).words}: {reasons(verdict, lines)}, although the classifier alone says {likely} ({told})"
    )


def damaged_in_words(probabilities: Mapping[str, float], why: str) -> str:
    """The same for a fault whose part is not known, with the reason."""
    return f"Damaged (probability of a fault {probability_in_words(faulty(probabilities))}), but the part is not known: {why}"


def missed_faults(seconds: float, *, compared: bool) -> tuple[float, int, int]:
    """The nearest measured length [s], the number of faulty recordings of it that were called healthy, and of all."""
    length, alone, beside = min(MISSED, key=lambda row: abs(math.log(row[0] / seconds)))
    return length, *(beside if compared else alone)


def pair_in_words(pair: Pair, machine: Given, others: Sequence[Pair]) -> str:
    """Bearing, if several are given, and speed of the shaft; then other pairs that fit the lines as well."""
    if any(other.bearing != pair.bearing for other in others):
        return f"bearing not known: the lines fit {listed([_place(each) for each in (pair, *others)], 'or')}"
    fitting = f", and the lines fit {listed([_place(other) for other in others], 'and')} as well" if others else ""
    bearing = "" if len(machine.bearings) == 1 else f"bearing {_bearing(pair)} as found, "
    speed, low, high = (f"{from_si(rate, 'rpm'):,.0f}" for rate in (pair.rate, *machine.rates))
    if low != high:
        between = f"between {low} and {high} rpm, or up to {100 * RIVALS_BEYOND:g} % beyond"
        return f"{bearing}shaft {speed} rpm as found {between}{fitting}"
    near = "" if speed == low else f" as found near {low} rpm"
    return f"{bearing}shaft {speed} rpm{near}{fitting}"


def speed_warning(pair: Pair, machine: Given) -> tuple[str, ...]:
    """Sentences on a speed at the end of the search, and on a given speed that does not fit the lines."""
    (low, high), ends = machine.rates, machine.searched
    sentences = ()
    # a maximum at the end of a search may lie beyond it
    if pair.strength > STRONG_COMB and not ends[0] * (1 + AT_END) < pair.rate < ends[1] * (1 - AT_END):
        first, last = (f"{from_si(end, 'rpm'):,.0f}" for end in ends)
        sentences = (
            f"The speed found is at the end of the search of {first} to {last} rpm, as with a wrong speed or sample rate; check both.",
        )
    if low != high or abs(pair.rate - low) <= DISAGREEMENT * pair.uncertainty:
        return sentences
    sentence = (
        f"The speed of {from_si(low, 'rpm'):,.0f} rpm does not fit the lines of this recording; they fit "
        f"{from_si(pair.rate, 'rpm'):,.0f} rpm (± {from_si(pair.uncertainty, 'rpm'):.0f}), {100 * (pair.rate / low - 1):+.1f} %."
    )
    return (sentence, *sentences)


def different_classes(judged: Sequence[tuple[Pair, str]]) -> str:
    """Clause on pairs that cannot be told apart and give different classes."""
    return f"the lines cannot tell apart {listed([f'{_place(pair)} ({verdict})' for pair, verdict in judged], 'and')}"


def unexplained(pair: Pair, elsewhere: Sequence[Pair], strange: float | None) -> str:
    """Clause on a strong comb that a pair does not explain, and on those that would explain it."""
    if not elsewhere:
        return (
            f"a line at {strange:.2f} orders and its harmonics stand out, and no part of {_place(pair)} has that order, so that the "
            "bearing or the speed may be another, or the lines come from another part of the machine"
        )
    each = [f"{_place(other)} ({other.lines.upper()})" for other in elsewhere]
    return f"{_place(pair)} does not explain the strongest lines, but {listed(each, 'or')} would"


def _place(pair: Pair) -> str:
    return f"{_bearing(pair)} at {from_si(pair.rate, 'rpm'):,.0f} rpm"


def _bearing(pair: Pair) -> str:
    """Name of a bearing and of those alike; of more than four the first three and the number of the others."""
    names = (pair.bearing, *pair.alike)
    further = len(names) - NAMED
    return listed(names, "or") if further <= 1 else f"{', '.join(names[:NAMED])} or {further} more"


def listed(words: Sequence[str], last: str) -> str:
    """Words such as "x, y and z"."""
    return f"{', '.join(words[:-1])} {last} {words[-1]}" if len(words) > 1 else words[0]


NO_LINE = (
    f"no line of {listed([row.part for row in families() if row.part], 'or')} stands {LEAST_LEVEL:g} dB above the floor"
)
