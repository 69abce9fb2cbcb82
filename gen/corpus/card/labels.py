"""Labels on the data card: faults that can be seen, labels that can be recovered from the signals, meanings of all variables."""

import xarray as xr

from gen.corpus.card.markdown import plain_text, table
from gen.corpus.choice import per_record
from gen.corpus.recoverable import NUMBERS, recoveries
from gen.corpus.schema import ROLES
from gen.corpus.visible import fault_counts


def findings(corpus: xr.Dataset) -> list[str]:
    """Section on the labels, empty for a corpus without any that vary."""
    lines = [*_visible_faults(corpus), *_recoverable_labels(corpus)]
    return ["", "## Labels", *lines] if lines else []


def _visible_faults(corpus: xr.Dataset) -> list[str]:
    """Lines on the faults that can be seen in their records, and on those that were drawn again; none if not simulated."""
    counts = fault_counts(corpus)
    if counts is None:
        return []
    if counts.unjudged == counts.records:
        return ["", "What the faults add to the records is not known: `truth.twins` of the recipe is `false`."]
    seen = (
        f"Of {counts.records} records labelled with a fault, the fault can be seen in {counts.detectable} (`detectable`): its line in the "
        f"squared envelope of some band stands out of the lines that the same record shows there without the fault."
    )
    again = f"the fault of {counts.redrawn_specimens} specimens, the level of {counts.redrawn_levels} records"
    return ["", f"{seen} Drawn again because the fault could not be seen: {again}."]


def _recoverable_labels(corpus: xr.Dataset) -> list[str]:
    """Table of the rank correlations of labels with simple numbers of the records."""
    correlations = recoveries(corpus)
    if not correlations:
        return []
    meaning = (
        f"Which labels can be recovered from the signals? The table has the closest of {', '.join(NUMBERS)} to each label, by Spearman's "
        f"rank correlation over specimens, or over records where the label changes from record to record. Chance alone reaches "
        f"2 / sqrt(count); a label with less than that cannot be recovered from these numbers."
    )
    rows = ((f"`{row.label}`", row.fault, row.number, f"{row.correlation:+.2f}", row.items) for row in correlations)
    header = ("label", "fault", "closest number", "rank correlation", "count")
    return ["", meaning, *table(header, rows, right=2)]


def meanings(corpus: xr.Dataset) -> list[str]:
    """Section with unit, role and meaning of every per-record variable, by role and name."""
    facts = {
        name: [plain_text(corpus[name].attrs.get(key, "")) for key in ("units", "role", "long_name")]
        for name in per_record(corpus)
    }
    places = {role: place for place, role in enumerate(ROLES)}
    names = sorted(facts, key=lambda name: (places.get(facts[name][1], len(ROLES)), name))
    rows = ((f"`{plain_text(name)}`", *facts[name]) for name in names)
    return ["", "## Variables", *table(("variable", "unit", "role", "meaning"), rows)]
