"""Labels on the data card: faults that can be seen, meanings of all variables."""

import xarray as xr

from gen.corpus.card.markdown import plain_text, table
from gen.corpus.choice import per_record
from gen.corpus.schema import ROLES
from gen.corpus.visible import fault_counts


def findings(corpus: xr.Dataset) -> list[str]:
    """Section on the faults that can be seen in their records, and on those that were drawn again; empty if not simulated."""
    counts = fault_counts(corpus)
    if counts is None:
        return []
    heading = ("", "## Labels", "")
    if counts.unjudged == counts.records:
        return [*heading, "What the faults add to the records is not known: `truth.twins` of the recipe is `false`."]
    seen = (
        f"Of {counts.records} records labelled with a fault, the fault can be seen in {counts.detectable} (`detectable`): its line in the "
        f"squared envelope of some band stands out of the lines that the same record shows there without the fault."
    )
    again = f"the fault of {counts.redrawn_specimens} specimens, the level of {counts.redrawn_levels} records"
    return [*heading, f"{seen} Drawn again because the fault could not be seen: {again}."]


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
