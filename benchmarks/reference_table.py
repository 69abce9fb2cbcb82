"""The feature table that ships with Raceway, from which the reference model is trained: ``python -m benchmarks.reference_table``."""

import xarray as xr

from features.baselines.records import DEFAULT_GROUPS
from features.baselines.references import with_energies
from features.table.durations import DURATION
from features.table.table_files import write_table
from gen.recipe import read_recipe, shipped_recipes
from raceway.kept_models import REFERENCE, SHIPPED_TABLE, both_lengths, identities, make_table

LABELS = ("fault", "width", "rig", "specimen", "recording", "split", "shaft_rate", DURATION)  # what a training needs
FACTS = ("title", "channel", "band_low_hz", "band_high_hz")


def reference_table() -> xr.Dataset:
    """Features that the reference model takes, and labels that its training needs, of the corpora of `both_lengths`."""
    parts, recipes = list[xr.Dataset](), both_lengths(read_recipe(shipped_recipes()[REFERENCE]))
    for recipe in recipes:
        table = make_table(recipe)
        # nothing else is needed for a training, and what ships should be small
        kept = table.reset_coords()[["features", "group", *LABELS]].set_coords("group")
        kept = kept.isel(feature=kept["group"].isin(with_energies(DEFAULT_GROUPS)))
        kept.attrs = {name: table.attrs[name] for name in FACTS}
        parts.append(kept)
    both = xr.concat(parts, "record", data_vars="minimal", join="exact", combine_attrs="identical")
    return both.assign_attrs(recipes=identities(recipes))


if __name__ == "__main__":
    write_table(reference_table(), SHIPPED_TABLE)
