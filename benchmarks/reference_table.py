"""The feature table that ships with Raceway, from which the reference model is trained: ``python -m benchmarks.reference_table``."""

from collections.abc import Iterable

import xarray as xr

from features import feature_table
from features.baselines.records import DEFAULT_GROUPS
from features.baselines.references import with_energies
from features.table.durations import DURATION
from features.table.table_files import write_table
from gen import generate
from gen.corpus import temporary_folder
from gen.recipe import Recipe, corpus_identity, read_recipe, shipped_recipes
from gen.support.executor import cores
from raceway import show_progress
from raceway.kept_models import LONG, REFERENCE, SHIPPED_TABLE

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


def both_lengths(recipe: Recipe) -> tuple[Recipe, Recipe]:
    """A recipe with records of 2 s, and as it is."""
    return lasting(recipe, LONG), recipe


def lasting(recipe: Recipe, seconds: float) -> Recipe:
    """A recipe with records of another duration."""
    return recipe.model_copy(update={"recording": recipe.recording.model_copy(update={"duration_s": seconds})})


def identities(recipes: Iterable[Recipe]) -> str:
    """What the records of a table depend on, whatever the number and the files of the corpora that it was made from."""
    return " ".join(map(corpus_identity, recipes))


def make_table(recipe: Recipe) -> xr.Dataset:
    """Feature table of a corpus that is generated in a temporary folder and removed again: it takes gigabytes, its features megabytes."""
    with temporary_folder() as folder:
        corpus = generate(recipe, folder / "corpus", workers=cores(), progress=show_progress("generating", "records"))
        return feature_table(corpus.path, workers=cores(), progress=show_progress("computing features", "parts"))


if __name__ == "__main__":
    renewed = reference_table()
    SHIPPED_TABLE.unlink(missing_ok=True)
    write_table(renewed, SHIPPED_TABLE)
