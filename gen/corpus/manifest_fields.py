"""Fields of ``manifest.json``: the files of a corpus, and where its records come from."""

from typing import Annotated, Literal

from pydantic import Field, StringConstraints

from gen.corpus.journal import Count, FileRow, ListedPart, Strict
from gen.corpus.part import PartRow
from gen.corpus.publication import Publication
from gen.corpus.signals import SignalCounts, summed

MOST_EXTENSIONS = 100

_Texts = tuple[str, ...]
_Added = Annotated[int, Field(ge=1, lt=2**31)]
Extension = Annotated[dict[Literal["rigs", "specimens"], _Added], Field(min_length=1, max_length=1)]
"""Number of rigs, or of specimens in every rig, that were added to a corpus: ``{"rigs": 2}`` or ``{"specimens": 2}``."""


class Overrides(Strict):
    """Seed and number of records that replaced those of the recipe, and what was added later."""

    seed: int | None = None
    records: int | None = None
    extensions: Annotated[tuple[Extension, ...], Field(max_length=MOST_EXTENSIONS)] = ()
    """Extensions in the order in which they were made: number of added rigs, or of specimens added to every rig."""


class Choice(Strict):
    """Choice of records and channels of another corpus, as ``raceway select`` was called."""

    records: Count
    """Number of records that were chosen from."""
    parts_sha256: str | None = None
    """SHA-256 over those of the parts of the corpus that was chosen from."""
    where: str | None = None
    split: str | None = None
    channels: _Texts | None = None

    def __str__(self) -> str:
        """Options of the call."""
        given = {"where": self.where, "split": self.split, "channels": self.channels and ", ".join(self.channels)}
        return "; ".join(f"{name}: {value}" for name, value in given.items() if value is not None)


class Numbers(Strict):
    """A number for each variable that is numbered anew when corpora are merged."""

    rig: Count = 0
    specimen: Count = 0
    recording: Count = 0
    pair: Count = 0


class Origin(Strict):
    """One of the corpora that a merged corpus was made from; fields that it shares with :class:`Manifest` were copied from there."""

    parts: Count
    """Number of consecutive parts of the merged corpus with the records of this one."""
    added: Numbers
    """What was added to the numbers of this corpus."""
    same_machines: str
    """Text that is the same for two corpora if the same numbers are the same machines: of one recipe and seed, or of one import."""
    recipe_file: Annotated[str, StringConstraints(pattern=r"^recipes/[0-9]{5}\.yaml$")] | None = None
    title: str | None = None
    recipe: str | None = None
    recipe_sha256: str | None = None
    overrides: Overrides | None = None
    versions: Annotated[dict[str, str], Field(default_factory=dict)]
    importer: str | None = None
    selections: tuple[Choice, ...] = ()
    scenarios: Literal["given", "chosen"] | None = None


class Manifest(Strict):
    """Contents of ``manifest.json`` after its check; fields of simulated corpora are None in imported ones, and the other way round."""

    raceway_format: int
    complete: bool
    records: Count
    index: FileRow | None = None
    """``corpus.nc``; None until the corpus is complete."""
    next_index: FileRow | None = None
    """Another ``corpus.nc`` that may stand in place of ``index``, while :func:`gen.corpus.publish` replaces it."""
    parts_: Annotated[tuple[ListedPart, ...], Field(alias="parts")]
    title: str | None = None
    recipe: str | None = None
    recipe_sha256: str | None = None
    overrides: Overrides | None = None
    publication: Publication = Publication()
    versions: Annotated[dict[str, str], Field(default_factory=dict)]
    failures: _Texts = ()
    importer: str | None = None
    basis: _Texts = ()
    """Sentences on what labels and units of recordings rest on."""
    recordings: Count | None = None
    skipped: _Texts = ()
    warnings: _Texts = ()
    selections: tuple[Choice, ...] = ()
    """Choices by which the records were taken from a larger corpus, the first one first."""
    origins: tuple[Origin, ...] = ()
    """Corpora that were merged into this one, in the order of their records."""
    scenarios: Literal["given", "chosen"] | None = None
    """``chosen`` if the records are some of those of the recipe; ``given`` if their scenarios were not drawn from it, so that each record
    is made again from the scenario that is stored with it."""

    @property
    def parts(self) -> list[PartRow]:
        """Rows of the parts, in the order of their records."""
        return [part.row for part in self.parts_]

    @property
    def importers(self) -> set[str | None]:
        """Importers of all records; None stands for those that were simulated."""
        return {origin.importer for origin in self.origins} or {self.importer}

    @property
    def signals(self) -> SignalCounts:
        """Counts of the records that cannot be used."""
        return summed(row.signals for row in self.parts)


def extensions_of(made: Manifest | Origin) -> tuple[Extension, ...]:
    """Extensions of a corpus in the order in which they were made; none if it was not generated."""
    return () if made.overrides is None else made.overrides.extensions
