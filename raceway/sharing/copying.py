"""Chosen records and channels of one or several corpora, read in blocks as if they were one corpus.

``sources -> choose -> Chosen -> blocks of stored records -> a corpus, or a form of another program (raceway.sharing)``

Nothing of a record changes but the numbers of machines in corpora that are joined, and what was asked for: names of channels, and
floating point in place of counts.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from xarray.conventions import encode_cf_variable

from gen.corpus.choice import channel_names, chosen_channels, chosen_records
from gen.corpus.index import open_corpus
from gen.corpus.manifest import COUNTED, Manifest, read_manifest
from gen.corpus.numbering import new_numbers
from gen.corpus.schema import RECIPE_TEXT, SIGNAL
from gen.corpus.where import nearest
from gen.support.errors import CorpusError
from gen.support.limits import check_limit
from gen.support.progress import Progress, counter
from raceway.sharing.acdd import publication_attributes
from raceway.sharing.joining import check_fit, check_repeats, sample_digests, with_same_variables
from raceway.sharing.publication import publication_of

_MOST_IN_BLOCK = 1024  # records; scenarios are text of some kilobytes a record
_SPAN = 8  # times the records of a block; variables are read with those of the records between the chosen ones
_SAME = ("Conventions", "raceway_format")  # global attributes of every corpus
_OF_THE_WHOLE = ("summary", "id", "naming_authority")  # facts of publication that a choice of records does not have
_FACTS_OF_THE_WHOLE = {"overrides", "recordings"}


class Block(NamedTuple):
    """Some chosen records in memory."""

    numbers: NDArray[np.intp]
    """Numbers of the records: those of the corpus; of several corpora, counted through in their order."""
    dataset: xr.Dataset
    """The records, decoded."""

    def accelerations(self) -> NDArray[np.float32]:
        """Signal in single precision, shape (record, channel, elapsed_time) [m s-2]; a missing sample is NaN."""
        return self.dataset[SIGNAL].values.astype(np.float32, copy=False)

    def as_stored(self) -> xr.Dataset:
        """Records as they are stored (:func:`gen.corpus.make_dataset`): counts with their scale, or single precision."""
        return self.dataset.assign({SIGNAL: encode_cf_variable(self.dataset[SIGNAL].variable)})


@dataclass(frozen=True)
class Chosen:
    """Chosen records and channels of one or several corpora."""

    paths: tuple[Path, ...]
    manifests: tuple[Manifest, ...]
    corpora: tuple[xr.Dataset, ...]
    """Opened, with the chosen channels and the same variables."""
    records: tuple[NDArray[np.intp], ...]
    """Numbers of the chosen records of each corpus."""
    filled: tuple[str, ...]
    """Variables that one of the corpora lacks."""
    asked: str
    """The choice and the changes, for the history; empty if the corpora are copied whole."""
    float32: bool
    progress: Progress | None = None
    """Called with the number of records that are done and of all."""

    @property
    def count(self) -> int:
        """Number of chosen records."""
        return sum(map(len, self.records))

    @property
    def of(self) -> int:
        """Number of all records of the corpora."""
        return sum(corpus.sizes["record"] for corpus in self.corpora)

    @property
    def samples(self) -> int:
        """Samples of a record and channel."""
        return self.corpora[0].sizes["elapsed_time"]

    @cached_property
    def sample_rate(self) -> float:
        """Sample rate [Hz]."""
        return float(self.corpora[0]["sample_rate"].variable[:1].values[0])

    @cached_property
    def channels(self) -> list[str]:
        """Names of the channels."""
        return channel_names(self.corpora[0])

    @property
    def publication(self) -> dict[str, Any]:
        """Licence, creators and references if they are the same for all corpora; else none, since they cannot be joined."""
        first, *others = (publication_of(manifest).stored for manifest in self.manifests)
        return first if all(other == first for other in others) else {}

    @cached_property
    def title(self) -> str:
        """Titles of the corpora."""
        return " + ".join(dict.fromkeys(str(corpus.attrs.get("title", "")) for corpus in self.corpora))

    @cached_property
    def own_attributes(self) -> dict[str, Any]:
        """Global attributes of the records: history and source are those of all corpora."""
        each = [corpus.attrs for corpus in self.corpora]
        lines = [*dict.fromkeys(line for of in each for line in str(of.get("history", "")).splitlines()), self.asked]
        source = "; ".join(dict.fromkeys(str(of["source"]) for of in each if "source" in of))
        joined = {"title": self.title, "history": "\n".join(filter(None, lines)), "source": source}
        return {name: each[0][name] for name in _SAME if name in each[0]} | {
            name: text for name, text in joined.items() if text
        }

    @cached_property
    def attributes(self) -> dict[str, Any]:
        """Global attributes of the records, and licence, creators and other facts of publication that all corpora share."""
        first, *others = map(publication_attributes, self.manifests)
        shared = {name: text for name, text in first.items() if all(of.get(name) == text for of in others)}
        return {
            name: text for name, text in shared.items() if not self.asked or name not in _OF_THE_WHOLE
        } | self.own_attributes

    @property
    def recipe(self) -> str | None:
        """Recipe, if it is the same for all corpora."""
        first, *others = (corpus.attrs.get(RECIPE_TEXT) for corpus in self.corpora)
        return first if all(other == first for other in others) else None

    def facts(self) -> dict[str, Any]:
        """Fields of the manifest of a copy: those that all corpora share, and all sentences of any; of a choice, no hash of the whole."""
        each = [manifest.content for manifest in self.manifests]
        left_out = {*COUNTED, "title", "publication", "recipe_sha256"} | (_FACTS_OF_THE_WHOLE if self.asked else set())
        fields: dict[str, Any] = {"title": self.title, "publication": self.publication}
        for name in dict.fromkeys(name for facts in each for name in facts if name not in left_out):
            values = [facts.get(name) for facts in each]
            if any(isinstance(value, list) for value in values):
                fields[name] = list(dict.fromkeys(item for value in values for item in value or ()))
            elif all(value == values[0] for value in values):
                fields[name] = values[0]
            elif name == "versions":  # those that no two corpora disagree about
                every = [value or {} for value in values]
                fields[name] = {
                    library: number
                    for versions in every
                    for library, number in versions.items()
                    if all(other.get(library, number) == number for other in every)
                }
        return fields

    def values(self, name: str) -> NDArray[Any]:
        """Values of a per-record variable for all chosen records."""
        pairs = zip(self.corpora, self.records, strict=True)
        return np.concatenate([corpus[name].values[records] for corpus, records in pairs])

    @cached_property
    def _numbers(self) -> dict[str, NDArray[np.int32]]:
        return new_numbers([str(text) for text in self.values("identity")])

    @cached_property
    def _report(self) -> Callable[[int], None]:
        return counter(self.progress, self.count)

    @cached_property
    def _digests(self) -> NDArray[np.bytes_]:
        return np.zeros(self.count, "S32")

    def blocks(self, most_bytes: int, places: NDArray[np.intp] | None = None) -> Iterator[Block]:
        """Blocks of chosen records of one corpus, each with at most so many bytes in single precision, but one record at least.

        ``places`` are some of the chosen records, ascending, instead of all.
        """
        places = np.arange(self.count) if places is None else places
        size = self.records_in(most_bytes)
        first, before = 0, 0
        for corpus, records in zip(self.corpora, self.records, strict=True):
            own = places[(places >= first) & (places < first + len(records))]
            for start in range(0, len(own), size):
                here = own[start : start + size]
                dataset = _load(corpus, records[here - first], size * _SPAN)
                yield Block(before + records[here - first], self._finish(dataset, here))
                self._report(len(here))
            first, before = first + len(records), before + corpus.sizes["record"]

    def records_in(self, most_bytes: int) -> int:
        """Records whose signals fill so many bytes in single precision; at least 1, and not more than a block may have."""
        each = 4 * len(self.channels) * self.samples
        return int(np.clip(most_bytes // max(1, each), 1, _MOST_IN_BLOCK))

    def check_repeats(self) -> None:
        """CorpusError if records of two corpora, all of which have been read, have the same samples."""
        if len(self.paths) > 1:
            check_repeats(self._digests, list(zip(map(str, self.paths), self.records, strict=True)))

    def _finish(self, dataset: xr.Dataset, places: NDArray[np.intp]) -> xr.Dataset:
        """Records as they are copied: with new numbers, in floating point if asked, with the attributes of all."""
        new = {name: values[places] for name, values in self._numbers.items() if name in dataset.variables}
        changed = {name: xr.Variable("record", values, dataset[name].attrs) for name, values in new.items()}
        signal = dataset[SIGNAL].variable
        if self.float32:
            changed[SIGNAL] = xr.Variable(signal.dims, signal.values.astype(np.float32), signal.attrs)
        if len(self.paths) > 1:
            self._digests[places] = sample_digests(signal.values)
        return dataset.drop_attrs(deep=False).assign(changed).assign_attrs(self.own_attributes)


@contextmanager
def choose(
    sources: Sequence[Path],
    *,
    where: str | None = None,
    split: str | None = None,
    channels: Sequence[str] | None = None,
    rename: Mapping[str, str] | None = None,
    float32: bool = False,
    progress: Progress | None = None,
) -> Iterator[Chosen]:
    """Open corpora, choose some of their records and channels, and close them at the end.

    Channels are renamed before they are chosen, and a condition applies to the numbers that each corpus has of its own.

    Raises
    ------
    CorpusError
        If a corpus is unfinished or altered, nothing is chosen, or the corpora do not fit together.
    """
    if not sources:
        raise CorpusError("copy: no corpus is given; give one or more.")
    places = [path.resolve() for path in sources]
    twice = next((path for path, place in zip(sources, places, strict=True) if places.count(place) > 1), None)
    if twice is not None:
        raise CorpusError(f"copy: {twice} is given twice; give each corpus once.")
    with ExitStack() as stack:
        opened = [stack.enter_context(open_corpus(path)) for path in sources]
        manifests = [read_manifest(path) for path in sources]
        opened = [
            _with_channels(corpus, channels, path)
            for corpus, path in zip(_rename_channels(opened, rename or {}), sources, strict=True)
        ]
        named = list(zip(map(str, sources), opened, strict=True))
        # all corpora must fit the first one
        for other in named[1:]:
            check_fit(named[0], other, float32=float32)
        corpora, filled = with_same_variables(named)
        # the same channels may come in another order
        order = channel_names(corpora[0])
        corpora = [corpus if channel_names(corpus) == order else corpus.sel(channel=order) for corpus in corpora]
        records = chosen_records(corpora, where, split)
        # before any signal is read
        check_limit("records", sum(map(len, records)), "copy: the corpora hold", CorpusError)
        # how the copy differs from its sources, for its history
        told = {
            "joined": f"{len(sources)} corpora" if len(sources) > 1 else None,
            "where": where,
            "split": split,
            "channels": channels and ", ".join(channels),
            "renamed": rename and ", ".join(f"{old} to {new}" for old, new in rename.items()),
            "stored": "in floating point" if float32 else None,
        }
        of_each = tuple(sources), tuple(manifests), tuple(corpora), tuple(records)
        yield Chosen(*of_each, filled, _history(told), float32, progress)


def _history(told: Mapping[str, str | None]) -> str:
    """Line about a copy; empty if nothing was chosen or changed.

    >>> _history({"where": "rig < 3", "split": None}), _history({"where": None})
    ('copied by raceway copy: where rig < 3', '')
    """
    asked = "; ".join(f"{name} {text}" for name, text in told.items() if text)
    return asked and f"copied by raceway copy: {' '.join(asked.split())}"


def _rename_channels(corpora: Sequence[xr.Dataset], rename: Mapping[str, str]) -> list[xr.Dataset]:
    """Corpora in which channels have new names; CorpusError if none has a channel of an old name, or two get the same name."""
    channels = list(dict.fromkeys(name for corpus in corpora for name in channel_names(corpus)))
    unknown = next((name for name in rename if name not in channels), None)
    if unknown is not None:
        raise CorpusError(f"rename: there is no channel {unknown!r}{nearest(unknown, channels)}")
    renamed_corpora = []
    for corpus in corpora:
        names = [rename.get(name, name) for name in channel_names(corpus)]
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise CorpusError(f"rename: two channels would be named {twice}; give each its own name.")
        renamed_corpora.append(
            corpus.assign_coords(channel=("channel", np.array(names, object), corpus["channel"].attrs))
        )
    return renamed_corpora


def _with_channels(corpus: xr.Dataset, channels: Sequence[str] | None, path: Path) -> xr.Dataset:
    try:
        places = chosen_channels(channel_names(corpus), channels)
    except CorpusError as error:
        raise CorpusError(f"{path}: {error}") from None
    return corpus if len(places) == corpus.sizes["channel"] else corpus.isel(channel=list(places))


def _load(corpus: xr.Dataset, records: NDArray[np.intp], span: int) -> xr.Dataset:
    """Some records of an opened corpus in memory; a variable is read with at most ``span`` records at a time."""
    pieces = []
    for some in np.split(records, np.flatnonzero(np.diff(records // span)) + 1):
        run = some[-1] - some[0] + 1 == len(some)
        wanted: Any = slice(int(some[0]), int(some[-1]) + 1) if run else some
        pieces.append(corpus.isel(record=wanted).load())
    if len(pieces) == 1:
        return pieces[0]
    whole: Any = xr.concat(pieces, "record", data_vars="minimal", coords="minimal", compat="override", join="override")
    return whole
