"""Records in memory written as a corpus: simulated ones, changed or not, others with the variables of the format, or plain arrays.

A record keeps its scenario, from which it can be replayed, if its signal is the one that the scenario gave. All records of one recipe give
a corpus with this recipe.
"""

import json
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from gen.corpus import (
    DRAWS,
    IDENTITY,
    LIFE,
    RECIPE_TEXT,
    SCHEMA,
    SIGNAL,
    Variable,
    blocks_of,
    check_new,
    make_dataset,
    new_corpus,
)
from gen.corpus.numbering import new_numbers
from gen.corpus.plain_arrays import records_of_arrays
from gen.corpus.schema import NAMED, ROLES, records_in_memory, schema_problems
from gen.corpus.simulated import UNJUDGED
from gen.generation.identity import origins_of_backgrounds
from gen.generation.labels import LABELS
from gen.measurement.measure import LARGEST_COUNT
from gen.mechanisms.background.background import BackgroundSection
from gen.recipe import Recipe, corpus_identity, read_recipe, recipe_text
from gen.recipe.sensing import RecordingSection
from gen.support.errors import CorpusError

if TYPE_CHECKING:
    import pandas as pd

_OF_THE_SIGNAL = {
    **dict.fromkeys(("snr", "fault_snr", "fault_share", "background_rms", "gain"), np.nan),
    "detectable": UNJUDGED,
}
"""Truth that holds for the signal of the scenario alone, and its value where that is another one."""
_NOT_A_COUNT = 0.01  # largest distance of a decoded sample from a count; single precision comes within 0.004


def write_corpus(
    records: xr.Dataset | NDArray[Any],
    target: Path | str,
    *,
    fs: float | None = None,
    labels: "pd.DataFrame | Mapping[str, ArrayLike] | None" = None,
) -> Path:
    """Write records in memory as a corpus.

    Parameters
    ----------
    records : Dataset or array
        One or several records with the variables of the format, in any order: from :func:`gen.record`, :func:`gen.records`,
        :func:`gen.simulate` or :func:`gen.open_corpus`, whole or chosen, changed, or joined with :func:`xarray.concat`. Variables of shape
        (record,) can be added, with the attributes ``long_name`` and ``role``. A record whose samples are no longer counts of
        its converter, such as a filtered one, or are fewer, is written without its scenario, so that it cannot be replayed, and with NaN
        for its levels and gains, which a warning tells. Other changes are not noticed: a factor of 2, or of a recipe whose converter is
        float32 all but a change of the length. Signals are stored as float32 unless all are counts of one converter.
        Or accelerations [m s-2] of shape (record, time) or (record, channel, time).
    target : path
        New corpus: a file if the name ends in ``.nc``, else a folder that is empty or does not exist.
    fs : float
        Sample rate of an array [Hz].
    labels : DataFrame or mapping of columns
        Of an array, one row for each record: ``fault`` (name of the class) and ``specimen`` (the physical bearing, by number or name), and
        further variables of the :data:`format <gen.corpus.SCHEMA>`, such as ``shaft_rate`` or ``shaft_rpm``, ``load_n``, ``bpfo``,
        ``rig``, ``split``. Those that are left out are not known; all records are of one rig, for training.

    Returns
    -------
    Path
        The corpus. It is there as a whole or not at all.

    Raises
    ------
    CorpusError
        If the target exists or cannot be written, there is no record, or a variable is missing or not in the format.
    """
    target = Path(target).absolute()
    check_new(target)
    plain = isinstance(records, np.ndarray) or fs is not None or labels is not None
    rows = records_in_memory(records_of_arrays(records, fs, labels) if plain else records)
    draws = rows[DRAWS].values.astype(str) if DRAWS in rows else np.full(rows.sizes["record"], "")
    recipes = [_recipe_of(text) if text else None for text in draws]
    signal, full_scale, unchanged = _signal(rows[SIGNAL].values, recipes)
    rows, told = _without_old_truth(rows, (draws != "") & ~unchanged)
    stored = _stored(rows, np.where(unchanged, draws, ""), signal, full_scale)
    # only all records of one recipe make a corpus of that recipe
    recipe = _whole_recipe(rows) if unchanged.all() else None
    names = dict.fromkeys(of.name for of in recipes if of is not None)
    facts = {
        "title": stored.attrs["title"],
        "recipe": ", ".join(names) or None,
        "versions": json.loads(rows.attrs.get("versions", "{}")),
        "basis": origins_of_backgrounds(of for of in recipes if of is not None),
        "warnings": told,
    }
    with new_corpus(target, recipe_text=recipe and recipe_text(recipe), **facts) as corpus:
        for block in blocks_of(stored):
            corpus.write(stored.isel(record=block))
    return target


def _recipe_of(text: str) -> Recipe:
    """Name, recording and recorded background of a stored scenario: reading the rest takes ten times as long."""
    try:
        stored = json.loads(text)
        if stored.keys() <= Recipe.model_fields.keys():
            recorded = {key: value for key, value in stored.get("background", {}).items() if key == "recording"}
            background = BackgroundSection.model_validate(recorded)
            recording = RecordingSection(**stored["recording"])
            return Recipe.model_construct(name=stored["name"], recording=recording, background=background)
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        pass
    raise CorpusError("stored scenario: is not the recipe of a record; drop the variable draws.")


def _signal(
    values: NDArray[np.floating], recipes: list[Recipe | None]
) -> tuple[NDArray[np.int16] | NDArray[np.float32], float | None, NDArray[np.bool_]]:
    """Signal as it is stored, the full scale of its counts, if it has them, and whether each record is as its scenario gave it."""
    scales = [of and of.recording.full_scale for of in recipes]
    counts = [_counts(row, scale) for row, scale in zip(values, scales, strict=True)]
    unchanged = [
        of is not None and of.n_samples == values.shape[2] and (scale is None or own is not None)
        for of, scale, own in zip(recipes, scales, counts, strict=True)
    ]
    exact = [own for own in counts if own is not None]
    if len(set(scales)) == 1 and len(exact) == len(counts):
        return np.stack(exact), scales[0], np.array(unchanged)
    return values.astype(np.float32), None, np.array(unchanged)


def _counts(values: NDArray[np.floating], full_scale: float | None) -> NDArray[np.int16] | None:
    """Counts of a record; None if its samples are not those of a converter with the full scale, or it had none."""
    if full_scale is None:
        return None
    exact = values.astype(np.float64) * (LARGEST_COUNT / full_scale)
    counts = np.rint(exact)
    if not np.abs(exact - counts).max() <= _NOT_A_COUNT or np.abs(counts).max() > LARGEST_COUNT:
        return None
    return counts.astype(np.int16)


def _without_old_truth(rows: xr.Dataset, changed: NDArray[np.bool_]) -> tuple[xr.Dataset, list[str]]:
    """Records without the truth that a changed signal no longer has, and a sentence on it, which is a warning too."""
    old = [name for name in _OF_THE_SIGNAL if name in rows]
    if not changed.any() or not old:
        return rows, []
    unknown = {name: rows[name].where(~changed, _OF_THE_SIGNAL[name]).astype(rows[name].dtype) for name in old}
    sentence = (
        f"The signals of {np.count_nonzero(changed)} of {len(changed)} records were changed after their simulation, so that "
        f"{', '.join(old)} of these are unknown."
    )
    warnings.warn(sentence, stacklevel=3)
    return rows.assign(unknown), [sentence]


def _whole_recipe(rows: xr.Dataset) -> Recipe | None:
    """Recipe that a Dataset carries, if its records are all those of the recipe in their order; else None."""
    if not {RECIPE_TEXT, "records"} <= rows.attrs.keys():
        return None
    recipe = read_recipe(rows)
    corpora = {str(text).partition("/")[0] for text in rows[IDENTITY].values}
    ascending = bool((np.diff(rows["recording"].values) > 0).all())
    whole = ascending and str(rows.sizes["record"]) == rows.attrs["records"] and corpora == {corpus_identity(recipe)}
    return recipe if whole else None


def _stored(
    rows: xr.Dataset,
    draws: NDArray[np.str_],
    signal: NDArray[np.int16] | NDArray[np.float32],
    full_scale: float | None,
) -> xr.Dataset:
    """The records in the layout of the corpus (undecoded)."""
    variables = {variable.name: variable for variable in SCHEMA + LABELS + LIFE if variable.name in rows.variables}
    # names of classes follow from their codes
    derived = {SIGNAL, "channel", "elapsed_time", *(f"{name}_name" for name in NAMED)}
    # variables of the user's own
    for name in sorted(map(str, rows.variables.keys() - variables.keys() - derived)):
        values, attributes = rows[name], rows[name].attrs
        if values.dims != ("record",) or "long_name" not in attributes or attributes.get("role") not in ROLES:
            raise CorpusError(
                f"{name}: needs one value for each record and the attributes long_name and role, one of "
                f"{', '.join(ROLES)}; set them in its attrs, or drop it."
            )
        kind = "str" if values.dtype.kind in "OU" else values.dtype.str[1:]
        unit = attributes.get("units", "1")
        variables[name] = Variable(name, kind, unit, attributes["role"], attributes["long_name"])
    columns = {name: rows[name].values for name in variables} | {DRAWS: draws}
    # numbers of a corpus of its own; the identity keeps the old ones
    columns |= new_numbers([str(text) for text in rows[IDENTITY].values])
    stored = make_dataset(
        signal,
        float(rows["sample_rate"][0]),
        tuple(map(str, rows["channel"].values)),
        {name: columns[name] for name in variables},
        extra=tuple(variables.values()),
        counts_per_unit=None if full_scale is None else LARGEST_COUNT / full_scale,
        attributes={"title": "Vibration records"}
        | {key: rows.attrs[key] for key in ("title", "history", "source") if key in rows.attrs},
    )
    for problem in schema_problems(stored, LABELS + LIFE):
        raise CorpusError(problem)
    return stored
