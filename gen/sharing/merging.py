"""Several corpora as one.

Rigs, specimens, recordings and pairs are numbered anew, so that machines of different corpora never share a number; everything else of a
record stays. The manifest tells the origin of each part, with which any simulated record can be replayed. Corpora that share samples are
refused: a record that is in the training set and in the test set makes every score too good.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from gen.corpus import (
    SIGNAL,
    Manifest,
    PartRow,
    Publication,
    SignalCounts,
    extensions_of,
    finish_corpus,
    new_corpus_folder,
    open_corpus,
    part_name,
    read_manifest,
    write_durably,
    write_part,
)
from gen.corpus.manifest_fields import Numbers, Origin
from gen.corpus.record_hashes import RENUMBERED
from gen.errors import CorpusError
from gen.limits import check_limit
from gen.progress import Progress, counter
from gen.sharing.columns import Columns, columns_of_all, with_all
from gen.sharing.copying import (
    in_floating_point,
    part_attributes,
    parts_sha256,
    records_of_origins,
    renumbered,
    small_file,
    stored_records,
)
from gen.sharing.repeats import Seen, sample_digests

_ORIGIN_FACTS = ("recipe", "recipe_sha256", "overrides", "versions", "importer", "selections", "scenarios")
_LARGEST = 2**31 - 1


@dataclass(frozen=True)
class Merged:
    """Result of :func:`merge`."""

    directory: Path
    records: int
    parts: int
    origins: int
    """Number of corpora; a merged corpus counts as those that it was made from."""
    filled: tuple[str, ...]
    """Variables that one of the corpora lacks."""
    signals: SignalCounts
    """Number of records that cannot be used."""


class _Source(NamedTuple):
    """A corpus to merge, opened."""

    directory: Path
    manifest: Manifest
    corpus: xr.Dataset
    origins: list[Origin]


def merge(
    directories: Sequence[Path | str],
    output: Path | str,
    *,
    title: str | None = None,
    float32: bool = False,
    progress: Progress | None = None,
) -> Merged:
    """Write all records of several corpora as one corpus, in the order of the corpora.

    Parameters
    ----------
    directories : sequence of paths
        Folders of two or more finished corpora of the same sample rate, duration and channels.
    output : path
        Folder of the new corpus; it must be empty or not exist.
    title : str, optional
        Title of the new corpus; by default the titles of the corpora.
    float32 : bool
        Store all signals in floating point: for corpora whose signals are stored in different ways.
    progress : callable, optional
        Called with the number of records written and the number of all.

    Raises
    ------
    CorpusError
        If corpora do not fit together or share records, one is unfinished or altered, or the folder cannot be written.
    """
    folders, output = [Path(directory) for directory in directories], Path(output)
    if len(folders) < 2:
        raise CorpusError(f"merge: {len(folders)} corpus given; give two or more.")
    with ExitStack() as stack:
        sources = [_opened(folder, stack) for folder in folders]
        total = sum(source.manifest.records for source in sources)
        check_limit("records", total, "merge: the corpora hold", CorpusError)
        for source in sources[1:]:
            _check_same_form(sources[0], source, float32)
        _check_extensions(sources)
        columns = columns_of_all([(str(source.directory), source.corpus) for source in sources])
        title = title or " + ".join(dict.fromkeys(str(source.corpus.attrs.get("title", "")) for source in sources))
        finish = partial(_finished, columns=columns, attributes=_attributes(sources, title), float32=float32)
        added = _new_numbers(sources)
        with new_corpus_folder(output) as folder:
            rows = _write_parts(sources, added, finish, folder, progress)
            origins = _with_recipes(sources, added, folder)
            signals = finish_corpus(folder, rows, publication=_publication(sources), **_facts(sources, title, origins))
    return Merged(output, total, len(rows), len(origins), columns.filled, signals)


def _opened(directory: Path, stack: ExitStack) -> _Source:
    manifest = read_manifest(directory)
    corpus = stack.enter_context(open_corpus(directory))
    origins = list(manifest.origins) or [_own_origin(manifest, corpus.attrs.get("title"))]
    return _Source(directory, manifest, corpus, origins)


def _own_origin(manifest: Manifest, title: str | None) -> Origin:
    """Origin of the records of a corpus that was not merged."""
    chosen_from = manifest.selections[0].parts_sha256 if manifest.selections else None
    recipe = None if manifest.scenarios == "given" else manifest.recipe_sha256
    return Origin(
        parts=len(manifest.parts),
        added=Numbers(),
        title=title,
        same_machines=recipe or chosen_from or parts_sha256(manifest),
        **{name: getattr(manifest, name) for name in _ORIGIN_FACTS},
    )


def _check_same_form(first: _Source, other: _Source, float32: bool) -> None:
    """CorpusError unless two corpora have the same channels, sample rate and length, and the same storage if it is to be kept."""
    for what, one, two, advice in (
        (
            "channels",
            *(_channels(source) for source in (first, other)),
            "choose the same channels with raceway select, or make both with these",
        ),
        ("sample rate", *(_sample_rate(source) for source in (first, other)), "make both at one sample rate"),
        ("record length", *(_length(source) for source in (first, other)), "make both with records of one length"),
        (
            "storage of the signals",
            *(_storage(source) for source in (first, other)),
            "store all in floating point (--float32)",
        ),
    ):
        if one != two and not (float32 and what == "storage of the signals"):
            raise CorpusError(f"{other.directory}: has the {what} {two}, and {first.directory} has {one}; {advice}.")


def _check_extensions(sources: Iterable[_Source]) -> None:
    """Refuse corpora of one recipe that were extended in different ways: one number of a specimen stands for two bearings in them."""
    longest: dict[str, tuple[Any, ...]] = {}
    for source in sources:
        for origin in source.origins:
            found = extensions_of(origin)
            short, long = sorted((longest.get(origin.same_machines, ()), found), key=len)
            if long[: len(short)] != short:
                raise CorpusError(
                    f"{source.directory}: was extended in another way than a corpus of the same recipe before it, so that their "
                    f"numbers stand for different bearings; merge corpora of different seeds, or one of the two."
                )
            longest[origin.same_machines] = long


def _channels(source: _Source) -> str:
    return ", ".join(str(name) for name in source.corpus["channel"].values)


def _sample_rate(source: _Source) -> str:
    rates = np.unique(source.corpus["sample_rate"].values)
    return ", ".join(f"{rate:.17g} Hz" for rate in rates)


def _length(source: _Source) -> str:
    time = source.corpus["elapsed_time"].values
    return f"{len(time)} samples, the last at {time[-1]:.12g} s" if len(time) else "0 samples"


def _storage(source: _Source) -> str:
    encoding = source.corpus[SIGNAL].encoding
    return (
        f"{encoding['dtype']} in {encoding['scale_factor'].dtype} steps of {encoding['scale_factor']:.9g} m s-2"
        if "scale_factor" in encoding
        else "float32"
    )


def _new_numbers(sources: Iterable[_Source]) -> dict[str, Numbers]:
    """What is added to the numbers of each group of corpora with the same machines."""
    largest: dict[str, dict[str, int]] = {}
    for source in sources:
        columns = {name: source.corpus[name].values for name in RENUMBERED if name in source.corpus}
        for origin, records in zip(source.origins, records_of_origins(source.manifest), strict=True):
            found = largest.setdefault(origin.same_machines, dict.fromkeys(RENUMBERED, -1))
            for name, values in columns.items():
                own = int(values[records].max(initial=-1)) - getattr(origin.added, name)
                found[name] = max(found[name], own)
    added, sums = {}, dict.fromkeys(RENUMBERED, 0)
    for machines, found in largest.items():
        added[machines] = Numbers(**sums)
        sums = {name: sums[name] + found[name] + 1 for name in RENUMBERED}
    for name, count in sums.items():
        if count > _LARGEST:
            raise CorpusError(f"merge: {name} would have numbers above {_LARGEST}; merge fewer corpora.")
    return added


def _write_parts(
    sources: Sequence[_Source],
    added: Mapping[str, Numbers],
    finish: Callable[[xr.Dataset], xr.Dataset],
    folder: Path,
    progress: Progress | None,
) -> list[PartRow]:
    """Write every part of every corpus with new numbers; ``finish`` gives it the variables and attributes of the merged corpus."""
    done = counter(progress, sum(source.manifest.records for source in sources))
    rows, seen = list[PartRow](), Seen()
    for source in sources:
        channels, digests, first = range(source.corpus.sizes["channel"]), [], 0
        for origin, row in _parts_of(source):
            part = stored_records(source.corpus, np.arange(first, first + row.records), channels)
            part = finish(renumbered(part, added[origin.same_machines], origin.added))
            digests.append(sample_digests(part))
            seen.check(str(source.directory), first, digests[-1])
            rows.append(write_part(part, folder / "parts" / part_name(len(rows))))
            first += row.records
            done(row.records)
        seen.add(str(source.directory), digests)
    return rows


def _parts_of(source: _Source) -> Iterator[tuple[Origin, PartRow]]:
    """Rows of all parts of a corpus, each with its origin."""
    rows = iter(source.manifest.parts)
    for origin in source.origins:
        for _ in range(origin.parts):
            yield origin, next(rows)


def _finished(part: xr.Dataset, columns: Columns, attributes: Mapping[str, Any], float32: bool) -> xr.Dataset:
    """Part with all variables of the merged corpus and its attributes."""
    return with_all(in_floating_point(part) if float32 else part, columns).assign_attrs(attributes)


def _attributes(sources: Sequence[_Source], title: str) -> dict[str, Any]:
    """Global attributes of the parts: those that all corpora share, and title, history and source."""
    each = [part_attributes(source.directory) for source in sources]
    common = {name: value for name, value in each[0].items() if all(str(of.get(name)) == str(value) for of in each)}
    source = "; ".join(dict.fromkeys(str(of.get("source", "not known")) for of in each))
    told = f"{len(sources)} corpora joined by raceway merge"
    history = "\n".join([*dict.fromkeys(str(of.get("history", "")) for of in each), told])
    return common | {"title": title, "history": history, "source": source}


def _with_recipes(sources: Sequence[_Source], added: Mapping[str, Numbers], folder: Path) -> list[Origin]:
    """Origins of the merged corpus; their recipes are copied into its folder, each text once."""
    names: dict[bytes, str] = {}
    found = []
    for source in sources:
        for origin in source.origins:
            text, recipe_file = _recipe(source, origin), None
            if text is not None:
                recipe_file = names.setdefault(text, f"recipes/{len(names):05d}.yaml")
                (folder / "recipes").mkdir(exist_ok=True)
                write_durably(text, folder / recipe_file)
            changed = {"recipe_file": recipe_file, "added": added[origin.same_machines]}
            if source.manifest.origins:
                changed["selections"] = origin.selections + source.manifest.selections
            found.append(origin.model_copy(update=changed))
    return found


def _recipe(source: _Source, origin: Origin) -> bytes | None:
    """Recipe of the records of one origin; None if there is none."""
    if not source.manifest.origins:
        return small_file(source.directory, "recipe.yaml")
    return None if origin.recipe_file is None else small_file(source.directory, origin.recipe_file)


def _facts(sources: Sequence[_Source], title: str, origins: Sequence[Origin]) -> dict[str, Any]:
    """Facts about the merged corpus for its manifest."""
    facts: dict[str, Any] = {"title": title}
    for name in ("basis", "failures", "skipped", "warnings"):
        sentences = [sentence for source in sources for sentence in getattr(source.manifest, name)]
        facts |= {name: sentences} if sentences else {}
    return facts | {"origins": [origin.model_dump(mode="json") for origin in origins]}


def _publication(sources: Sequence[_Source]) -> Publication:
    """Licence, creators and references if they are the same for all corpora; else none, since they cannot be joined."""
    first, *others = (source.manifest.publication for source in sources)
    return first if all(other == first for other in others) else Publication()
