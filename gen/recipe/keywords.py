"""A recipe from keys by their own names: ``shaft_rpm`` stands for ``operation.shaft_rpm``.

A name that one section alone has is put into that section; a whole section can be given too, as a mapping. The recipe that results is
checked like any other.
"""

import difflib
import functools
from collections.abc import Mapping, Sequence
from typing import Any

from gen.drawing import Section, plain
from gen.recipe.faults import OF_KIND
from gen.recipe.keys import fields_below
from gen.recipe.model import Recipe
from gen.support.errors import RecipeError
from gen.support.sentences import kinds_of

DEFAULTS: Mapping[str, Any] = {
    "name": "records",
    "bearing": "6205",
    "operation": {"shaft_rpm": 1500},
    "recording": {"sample_rate_hz": 25_600, "duration_s": 1},
}
"""Values of the keys that a recipe file must give."""

FaultLike = Section | dict[str, Any] | str
"""A fault: from a call such as :func:`gen.outer`, an entry of ``faults`` of a recipe, or a kind without required keys."""

_COUNTED = ("rigs", "specimens_per_rig", "records_per_specimen")


def make_recipe(fault: FaultLike | Sequence[FaultLike] | None = None, n: int | None = None, **keys: Any) -> Recipe:
    """Recipe with ``n`` records of each fault, from keys by their own names: the one that :func:`gen.records` uses.

    With :func:`gen.write_recipe` and :func:`gen.generate` it makes a corpus that does not fit into memory.

    Parameters
    ----------
    fault : section, dict, str or list of them
        One fault or several, which take turns; a healthy bearing if left out.
    n : int
        Number of records of each fault. Each record has a specimen of its own on one rig, unless ``keys`` give ``rigs``,
        ``specimens_per_rig``, ``records_per_specimen`` or ``rungs``.
    **keys
        Keys of a recipe by their own names or as whole sections.

    Raises
    ------
    RecipeError
        If a key is unknown, ambiguous, given twice or wrong, or if ``n`` does not agree with the keys.
    """
    if "faults" in keys and fault is not None:
        raise RecipeError("faults: is given twice, also as fault; give it once.")
    remaining: dict[str, Any] = plain(keys)  # a copy
    data: dict[str, Any] = {}
    # whole sections first, then single keys into the sections that have them
    for name in [name for name in remaining if name in Recipe.model_fields]:
        data[name] = remaining.pop(name)
    for name, value in remaining.items():
        _set(data, name, value)
    faults = plain("healthy" if fault is None else fault)
    faults = [faults] if isinstance(faults, dict | str) else faults
    if isinstance(faults, list):
        faults = [{"kind": entry} if isinstance(entry, str) else entry for entry in faults]
    data.setdefault("faults", faults)
    # records in memory have defaults of their own where a recipe has none
    for name, value in DEFAULTS.items():
        section = data.setdefault(name, value)
        if isinstance(section, dict) and isinstance(value, dict):
            data[name] = value | section
    corpus, entries = data.setdefault("corpus", {}), data["faults"]
    entries = entries.get("entries") if isinstance(entries, dict) else entries
    if isinstance(corpus, dict) and isinstance(entries, list):
        data["corpus"] = _counted({"fault_choice": "in_turn", **corpus}, max(len(entries), 1), n)
    data.setdefault("title", _title(data))
    return Recipe(**data)


def _set(data: dict[str, Any], name: str, value: Any) -> None:
    """Put a value into the only section that has a key of this name."""
    sections, kinds = _place(name)
    section = data
    for step in sections:
        section = section.setdefault(step, {})
        if not isinstance(section, dict):
            raise RecipeError(f"{name}: {'.'.join(sections)} is given and is no section; give one of the two.")
    if name in section:
        raise RecipeError(f"{name}: is given twice, also in {'.'.join(sections)}; give it once.")
    section[name] = value
    if kinds:
        # a key that one kind alone has chooses this kind
        section.setdefault("kind", _usual_kind(sections, kinds))


def _usual_kind(sections: tuple[str, ...], kinds: set[str]) -> str:
    """Kind of a section that has a key: the default of the section if it has the key too."""
    default: Any = Recipe.model_fields[sections[0]].default
    for step in sections[1:]:
        default = getattr(default, step, None)
    usual = getattr(default, "kind", None)
    return usual if usual in kinds else min(kinds)


def _place(name: str) -> tuple[tuple[str, ...], set[str]]:
    """The only place of a key, and the values of ``kind`` with which its section has it."""
    places = _places().get(name, {})
    if not places:
        raise RecipeError(f"{name}: no such key; {_advice(name)}")
    if len(places) > 1:
        *others, last = (".".join(place) for place in places)
        first, *inside = next(iter(places))
        example = "".join(f"{{{step!r}: " for step in [*inside, name]) + "..." + "}" * (1 + len(inside))
        raise RecipeError(
            f"{name}: is a key of {', '.join(others)} and {last}; give the section, such as {first}={example}."
        )
    return next(iter(places.items()))


def _advice(name: str) -> str:
    of_faults = {key: kinds_of(model)[-1] for model in reversed(OF_KIND.values()) for key in model.model_fields}
    if name in of_faults:
        return f"it is a key of faults; give it there, as in fault=gen.{of_faults[name]}({name}=...)."
    allowed = [*_places(), *Recipe.model_fields, *of_faults]
    near = [key for key in allowed if name in key.split("_")] or difflib.get_close_matches(name, allowed, 1)
    if not near:
        return "raceway recipes --keys lists all keys."
    return f"did you mean {near[0]}{', a key of faults' if near[0] in of_faults else ''}?"


@functools.cache
def _places() -> dict[str, dict[tuple[str, ...], set[str]]]:
    """Places of every key below the sections of a recipe, each with the values of ``kind`` that have the key; not those in lists."""
    places: dict[str, dict[tuple[str, ...], set[str]]] = {}
    for path, model, name in fields_below((Recipe,)):
        if path and name != "kind" and not any(step == "NAME" or step.endswith("[]") for step in path):
            places.setdefault(name, {}).setdefault(path, set()).update(kinds_of(model))
    return places


def _counted(keys: Mapping[str, Any], n_faults: int, n: int | None) -> dict[str, Any]:
    """A corpus with all its counts, so that each fault has ``n`` records; wrong counts are left to the model."""
    corpus: dict[str, Any] = {"records_per_specimen": 1, **keys}
    rungs = corpus.get("rungs")
    counts = [corpus[name] for name in _COUNTED if name in corpus]
    if any(type(count) is not int or count < 1 for count in counts) or not isinstance(rungs, list | None):
        return dict.fromkeys(_COUNTED, 1) | corpus
    of_a_specimen = corpus["records_per_specimen"] * len(rungs or [1])
    # both counts are given, and nothing is left to complete
    if n is None and {"rigs", "specimens_per_rig"} <= corpus.keys():
        return corpus
    n = of_a_specimen if n is None else n
    if type(n) is not int or n < 1:
        raise RecipeError(f"n: {n!r} is not allowed; it must be a whole number of records, 1 or more.")
    specimens, rest = divmod(n * n_faults, of_a_specimen)
    if rest or n % of_a_specimen:
        raise RecipeError(
            f"n: {n} records of each fault are no whole number of specimens of {of_a_specimen} records; use a multiple of {of_a_specimen}."
        )
    # the count that is left out follows from the other one
    for count, other in (("rigs", "specimens_per_rig"), ("specimens_per_rig", "rigs")):
        if count in corpus and specimens % corpus[count]:
            raise RecipeError(
                f"n: {n} records of each of {n_faults} faults take {specimens} specimens, which cannot be divided by {count}: "
                f"{corpus[count]}; change one of the two."
            )
        if count in corpus:
            corpus = {other: specimens // corpus[count], **corpus}
    corpus = {"rigs": 1, "specimens_per_rig": specimens, **corpus}
    if corpus["rigs"] * corpus["specimens_per_rig"] != specimens:
        raise RecipeError(
            f"n: {n} records of each of {n_faults} faults take {specimens} specimens, and rigs * specimens_per_rig are "
            f"{corpus['rigs'] * corpus['specimens_per_rig']}; leave one of the three out."
        )
    return corpus


def _title(data: Mapping[str, Any]) -> str:
    bearing = data["bearing"]
    names = bearing.get("designations", "of given dimensions") if isinstance(bearing, dict) else bearing
    named = ", ".join(map(str, names)) if isinstance(names, list) else names
    return f"Records of bearing {named}"[:200]
