"""Sentences of a diagnosis. Pure."""

from collections.abc import Mapping, Sequence

from features.diagnosis.evidence import LEAST_LEVEL, Line
from features.faults import CLASSES, HEALTHY, SIDES

PARTS = tuple(row.part for row in CLASSES.values() if row.part)


def family_in_words(lines: Sequence[Line]) -> str:
    """Lines of one family, such as "BPFI at 5.41 orders and 2 harmonics stand up to 18 dB above the floor"."""
    plain = [line for line in lines if not line.sideband]
    first = min(plain, key=lambda line: line.harmonic)
    level = max(line.level for line in plain)
    further = len(plain) - 1
    more = "" if not further else " and 1 further harmonic" if further == 1 else f" and {further} further harmonics"
    verb = "stand up to" if further else "stands"
    sides = ""
    if any(line.sideband for line in lines):
        sides = f" with sidebands at the rate of the {SIDES[CLASSES[first.fault].side]}"
    return f"{first.name} at {first.order:.2f} orders{more} {verb} {level:.0f} dB above the floor{sides}"


def by_family(lines: Sequence[Line]) -> dict[str, list[Line]]:
    """Lines by the class that they tell, strongest family first."""
    families: dict[str, list[Line]] = {}
    for line in lines:
        families.setdefault(line.fault, []).append(line)
    return families


def reasons(verdict: str, lines: Sequence[Line]) -> str:
    """Why the verdict is what it is: its own lines, or that there are none, and the lines of other families."""
    families = by_family(lines)
    own = families.pop(verdict, None)
    others = "; ".join(family_in_words(held) for held in families.values())
    if verdict == HEALTHY:
        if others:
            return f"although {others}"
        return f"no line of {_listed(PARTS, 'or')} stands {LEAST_LEVEL:g} dB above the floor"
    if own:
        return family_in_words(own) + (f"; also {others}" if others else "")
    name = CLASSES[verdict].lines[0].label if CLASSES[verdict].evidence else "fault"
    resting = (
        f"no {name} line stands {LEAST_LEVEL:g} dB above the floor, so this rests on fainter features of the signal"
    )
    return resting + (f", and {others}" if others else "")


def probability_in_words(probability: float) -> str:
    """Probability with two digits, never 1.

    >>> probability_in_words(0.912), probability_in_words(0.9999)
    ('0.91', 'above 0.99')
    """
    return "above 0.99" if probability > 0.99 else f"{probability:.2f}"


def candidates(probabilities: Mapping[str, float], number: int = 2) -> str:
    """Most probable classes, such as "inner 0.45, ball 0.38"."""
    ranked = sorted(probabilities, key=lambda name: -probabilities[name])[:number]
    return ", ".join(f"{name} {probabilities[name]:.2f}" for name in ranked)


def speed_in_words(labelled: float, other: float | None, checked: bool) -> str:
    """Speed of the shaft; rates in Hz, ``other`` None if the label stands."""
    text = f"shaft {60 * labelled:,.0f} rpm"
    if other is not None:
        return f"shaft {60 * other:,.0f} rpm as found, {60 * labelled:,.0f} rpm as labelled"
    return f"{text} as labelled" if checked else f"{text} as labelled, not checked"


def _listed(words: Sequence[str], last: str) -> str:
    return f"{', '.join(words[:-1])} {last} {words[-1]}"
