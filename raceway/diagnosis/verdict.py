"""Verdict from the probabilities of the classifier and the lines of a recording, which must agree. Pure.

A class is answered if the classifier is sure of it and the lines do not tell another:

- A fault needs lines of its own family, because all else is the same at a wrong speed and with a wrong bearing; for balls,
  those of the cage, which goes round with them, suffice. A class without lines of its own, such as several faults, needs lines
  of any part.
- Lines of the inner race have a sideband at the shaft rate, because it turns through the load zone. The highest such sideband
  of the outer race is lower than its highest line, because it stands still. That of balls is below 15 dB or below those at
  the rate of the cage. Other lines come from another part or another bearing.
- "Damaged" is answered if no line stands out, all faults together are as probable as an answer must be, and the signal is more
  impulsive than 99 of 100 healthy records of the training. A strange colour is no reason for it.
- "Healthy" falls to plain lines of a part: a fundamental and a harmonic, or three harmonics, one of them 15 dB above the
  floor. From a probability of .85 on they must be 25 dB above it, since healthy bearings have faint lines of all parts. It
  also falls to a strange colour, if there is a healthy recording to compare with.
- Where the classifier says healthy, the strongest family is answered in its place if its fundamental and three further
  harmonics stand out, one of them 20 dB above the floor: lines as plain as these are an answer of their own.
"""

from collections.abc import Mapping, Sequence

from features.baselines.predictions import DAMAGED, UNSURE
from gen.corpus.fault_classes import HEALTHY, SHAFT, SIDES, fault_class
from raceway.diagnosis.evidence import Line
from raceway.diagnosis.wording import by_family, family_in_words, faulty, line_of

PLAIN = 15.0  # dB, level of lines that contradict a class
OBVIOUS = 25.0  # dB, the same for a class of which the classifier is sure
ANSWER = 20.0  # dB, level of a family of lines that is answered although the classifier says healthy
SURE = 0.85  # probability


def judge(
    probabilities: Mapping[str, float],
    threshold: float,
    lines: Sequence[Line],
    distance: float = 0.0,
    *,
    impulsive: bool = False,
) -> tuple[str, str]:
    """Class, "damaged" or "unsure", and for the latter a clause with the reason.

    ``distance`` is that of the colour from the healthy recordings, as in `features.baselines.colour_distance`, and ``impulsive`` is of
    `features.baselines.predictions.Predictions`.
    """
    likely = max(probabilities, key=lambda name: probabilities[name])
    families = by_family(lines)
    # plain lines go before a classifier that sees nothing
    if likely == HEALTHY and families and _answers(next(iter(families.values()))):
        return next(iter(families)), ""
    # a fault is sure, and no line tells its part
    if impulsive and not families and faulty(probabilities) >= threshold:
        return DAMAGED, ""
    # many faults change the colour of a machine and show no line
    if likely == HEALTHY and distance > 1:
        return UNSURE, (
            f"healthy is the likeliest, but the spectral colour differs {distance:.1f} times as much from that of the healthy recording "
            "as healthy recordings of one machine usually differ"
        )
    if probabilities[likely] < threshold:
        return UNSURE, _doubt(families, threshold)
    # lines and classifier agree, unless the sidebands tell of another part
    if likely in families:
        foreign = _foreign_sidebands(families[likely])
        return (UNSURE, f"the classifier says {likely}, but {foreign}") if foreign else (likely, "")
    # lines of the cage alone speak for balls, which go round with it
    if families.keys() == {fault_class(likely).companion}:
        return likely, ""
    # healthy bearings have faint lines of all parts
    if likely == HEALTHY:
        level = OBVIOUS if probabilities[likely] >= SURE else PLAIN
        families = {fault: held for fault, held in families.items() if _plain(held, level)}
    if not fault_class(likely).is_family and bool(families) != (likely == HEALTHY):
        return likely, ""
    if not families:
        return UNSURE, f"the classifier says {likely}, but no {line_of(likely)} line stands out"
    fault, held = next(each for each in families.items() if each[0] != fault_class(likely).companion)
    return UNSURE, f"the classifier says {likely}, but {family_in_words(held)}, which tells of {fault}"


def _foreign_sidebands(lines: Sequence[Line]) -> str:
    """Clause on sidebands at the shaft rate, or their absence, that tell of another part; empty if they fit the family."""
    row = fault_class(lines[0].fault)
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
    return plain and not _foreign_sidebands(lines)


def _doubt(families: Mapping[str, Sequence[Line]], threshold: float) -> str:
    """Why the classifier does not answer, and what the strongest lines tell."""
    least = f"no class reaches the probability of {threshold:.2f} from which the classifier answers"
    if not families:
        return f"{least}, and no line stands out"
    fault, lines = next(iter(families.items()))
    return f"{least}; {family_in_words(lines)}, which tells of {fault}"
