"""Verdict from the probabilities of the classifier and the lines of a recording, which must agree. Pure.

A class is answered if the classifier is sure of it and the lines do not tell another:

- A fault needs lines of its own family, because all else is the same at a wrong speed and with a wrong bearing. Balls often
  show none: from a probability of .90 on they are answered if no line stands out. Lines of the cage alone are no ball, since slow
  fluctuations have such lines. A class without lines of its own, such as several faults, needs lines of any part.
- Lines of the inner race have a sideband at the shaft rate, because it turns through the load zone. The highest such sideband
  of the outer race is lower than its highest line, because it stands still. That of balls is below 15 dB or below those at
  the rate of the cage. Other lines come from another part or another bearing.
- "Damaged" is answered in place of "unsure" if all faults together have a probability of .97 at each pair of bearing and speed.
- "Healthy" falls to plain lines of a part: a fundamental and a harmonic, or three harmonics, one of them 15 dB above the
  floor. From a probability of .85 on they must be 25 dB above it, since healthy bearings have faint lines of all parts. It
  also falls to a strange colour, if there is a healthy recording to compare with.
- Where the classifier says healthy, the strongest family is answered in its place if its fundamental and three further
  harmonics stand out, one of them 20 dB above the floor: lines as plain as these are an answer of their own.
"""

from collections.abc import Iterable, Mapping, Sequence

from features.baselines.predictions import UNSURE
from gen.corpus.fault_classes import HEALTHY, SHAFT, SIDES, FaultClass, families, fault_class
from raceway.diagnosis.evidence import Line
from raceway.diagnosis.wording import by_family, family_in_words, line_of

BALL = "ball"  # class
PLAIN = 15.0  # dB, level of lines that contradict a class
OBVIOUS = 25.0  # dB, the same for a class of which the classifier is sure
ANSWER = 20.0  # dB, level of a family of lines that is answered although the classifier says healthy
SURE = 0.85  # probability
WITHOUT_LINES = 0.90  # probability of balls that are answered without a line
CERTAIN = 0.97  # probability of all faults together, from which an unsure answer is "damaged"


def certainly_faulty(probabilities: Iterable[Mapping[str, float]]) -> bool:
    """Whether a fault, whichever it is, is certain at each pair of bearing and speed; not by a model without the class healthy."""
    return all(each.get(HEALTHY, 1.0) <= 1 - CERTAIN for each in probabilities)


def strange_colour(probabilities: Mapping[str, float], distance: float) -> bool:
    """Whether healthy is the likeliest, and the colour is none of the healthy recordings."""
    return distance > 1 and max(probabilities, key=lambda name: probabilities[name]) == HEALTHY


def judge(
    probabilities: Mapping[str, float], threshold: float, lines: Sequence[Line], distance: float = 0.0
) -> tuple[str, str]:
    """Class or "unsure", and for the latter a clause with the reason.

    ``distance`` is that of the colour from the healthy recordings, as in `features.baselines.colour_distance`.
    """
    likely = max(probabilities, key=lambda name: probabilities[name])
    families, row = by_family(lines), fault_class(likely)
    # plain lines go before a classifier that sees nothing
    if likely == HEALTHY and families and _answers(next(iter(families.values()))):
        return next(iter(families)), ""
    # many faults change the colour of a machine and show no line
    if strange_colour(probabilities, distance):
        return UNSURE, (
            f"healthy is the likeliest, but the spectral colour differs {distance:.1f} times as much from that of the healthy recording "
            "as healthy recordings of one machine usually differ"
        )
    if probabilities[likely] < threshold:
        return UNSURE, _doubt(families, threshold)
    # lines and classifier agree, unless the sidebands tell of another part
    own = _family_of(row)
    if own in families:
        foreign = _foreign_sidebands(families[own], row)
        return (UNSURE, f"the classifier says {likely}, but {foreign}") if foreign else (likely, "")
    # balls often show no line; if the cage shows one, the classifier may rest on that alone
    if likely == BALL and not families and probabilities[likely] >= WITHOUT_LINES:
        return likely, ""
    # healthy bearings have faint lines of all parts
    if likely == HEALTHY:
        level = OBVIOUS if probabilities[likely] >= SURE else PLAIN
        families = {fault: held for fault, held in families.items() if _plain(held, level)}
    if not row.is_family and bool(families) != (likely == HEALTHY):
        return likely, ""
    other = next((fault for fault in families if fault != row.companion), None)
    if other is None:
        return UNSURE, f"the classifier says {likely}, but no {line_of(likely)} line stands out"
    return UNSURE, f"the classifier says {likely}, but {family_in_words(families[other])}, which tells of {other}"


def _family_of(row: FaultClass) -> str:
    """Class under which the lines of a class are found: the first one with its fundamental line."""
    return next((first.name for first in families() if row.is_family and first.lines[0] == row.lines[0]), row.name)


def _foreign_sidebands(lines: Sequence[Line], row: FaultClass) -> str:
    """Clause on sidebands at the shaft rate, or their absence, that tell of another part; empty if they fit the class."""
    highest = {side: max((line.level for line in lines if line.side == side), default=0.0) for side in ("", *SIDES)}
    shaft = highest[SHAFT.base]
    if row.beside == "needed" and not shaft:
        return f"{family_in_words(lines)} without sidebands at the rate of the shaft, which an inner race has"
    if row.beside == "lower" and shaft >= highest[""]:
        return f"{family_in_words(lines)} that are higher than the lines, as no outer race has"
    if row.side != SHAFT.base and shaft >= max(PLAIN, highest[row.side]):
        return f"{family_in_words(lines)}, as the inner race of another bearing would show"
    return ""


def _plain(lines: Sequence[Line], level: float) -> bool:
    harmonics = {line.harmonic for line in lines if not line.side}
    return len(harmonics) >= (2 if 1 in harmonics else 3) and max(line.level for line in lines) >= level


def _answers(lines: Sequence[Line]) -> bool:
    """Whether the lines of a family are plain enough to be an answer without the classifier."""
    harmonics = {line.harmonic for line in lines if not line.side}
    plain = 1 in harmonics and len(harmonics) >= 4 and max(line.level for line in lines if not line.side) >= ANSWER
    return plain and not _foreign_sidebands(lines, fault_class(lines[0].fault))


def _doubt(families: Mapping[str, Sequence[Line]], threshold: float) -> str:
    """Why the classifier does not answer, and what the strongest lines tell."""
    least = f"no class reaches the probability of {threshold:.2f} from which the classifier answers"
    if not families:
        return f"{least}, and no line stands out"
    fault, lines = next(iter(families.items()))
    return f"{least}; {family_in_words(lines)}, which tells of {fault}"
