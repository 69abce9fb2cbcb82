"""The feature tables that ship with Raceway, from which the reference model is trained: ``python -m benchmarks.reference_table``.

One has records of 2 s and of half a second, the other records of 2 s at a higher sample rate, whose features are computed from a wider
band.
"""

from collections.abc import Iterable

import xarray as xr

from benchmarks.ablation import changed
from features import feature_table
from features.baselines.records import DEFAULT_GROUPS
from features.baselines.references import with_energies
from features.table.band import DEFAULT_BAND, Band
from features.table.durations import DURATION
from features.table.table_files import write_table
from gen import generate
from gen.corpus import temporary_folder
from gen.recipe import Recipe, corpus_identity, find_recipe, read_recipe
from gen.support.errors import RecipeError
from gen.support.executor import cores
from gen.support.yaml_files import read_yaml
from raceway import show_progress
from raceway.kept_models import LONG, REFERENCE, SHIPPED_TABLE, WIDE_TABLE

LABELS = ("fault", "width", "rig", "specimen", "recording", "split", "shaft_rate", DURATION)  # what a training needs
FACTS = ("title", "channel", "band_low_hz", "band_high_hz")
WIDE_BAND = Band(300.0, 9000.0)
WIDE = {
    "corpus.rigs": 48,
    "recording.sample_rate_hz": 25_600,
    "machine.resonator.frequency_hz": "uniform(1200, 9000)",
    "path.modes.count": "choice(3, 4, 5, 6, 8, 10)",
    "path.modes.frequency_hz": "normal(4500, 3000, low=500, high=11_000)",
    "background.modes.frequency_hz": "normal(5000, 2800, low=300, high=11_000)",
    "background.tones.frequency_hz": "normal(3500, 2500, low=40, high=10_000)",
}
"""Changes of the recipe: what stands above 5 kHz in machines, and how many rigs are enough there."""


def reference_tables() -> tuple[xr.Dataset, xr.Dataset]:
    """Features that the reference model takes, and labels that its training needs: of `both_lengths`, and of the `wide_recipe`."""
    both, wide = both_lengths(read_recipe(REFERENCE)), wide_recipe()
    tables = [make_table(recipe) for recipe in both]
    joined = xr.concat(tables, "record", data_vars="minimal", join="exact", combine_attrs="identical")
    return joined.assign_attrs(recipes=identities(both)), make_table(wide, WIDE_BAND).assign_attrs(
        recipes=identities([wide])
    )


def both_lengths(recipe: Recipe) -> tuple[Recipe, Recipe]:
    """A recipe with records of 2 s, and as it is."""
    return lasting(recipe, LONG), recipe


def wide_recipe() -> Recipe:
    """The recipe of the reference model with records of 2 s of which a wider band can be used."""
    return lasting(Recipe.model_validate(changed(read_yaml(find_recipe(REFERENCE), RecipeError), WIDE)), LONG)


def lasting(recipe: Recipe, seconds: float) -> Recipe:
    """A recipe with records of another duration."""
    return recipe.model_copy(update={"recording": recipe.recording.model_copy(update={"duration_s": seconds})})


def identities(recipes: Iterable[Recipe]) -> str:
    """What the records of a table depend on, whatever the number and the files of the corpora that it was made from."""
    return " ".join(map(corpus_identity, recipes))


def make_table(recipe: Recipe, band: Band = DEFAULT_BAND) -> xr.Dataset:
    """Feature table of a corpus that is generated in a temporary folder and removed again: it takes gigabytes, its features megabytes."""
    with temporary_folder() as folder:
        corpus = generate(recipe, folder / "corpus", workers=cores(), progress=show_progress("generating", "records"))
        progress = show_progress("computing features", "parts")
        table = feature_table(corpus.path, workers=cores(), band=band, progress=progress)
    # nothing else is needed for a training, and what ships should be small
    kept = table.reset_coords()[["features", "group", *LABELS]].set_coords("group")
    kept = kept.isel(feature=kept["group"].isin(with_energies(DEFAULT_GROUPS)))
    kept.attrs = {name: table.attrs[name] for name in FACTS}
    return kept


if __name__ == "__main__":
    for table, file in zip(reference_tables(), (SHIPPED_TABLE, WIDE_TABLE), strict=True):
        file.unlink(missing_ok=True)
        write_table(table, file)
