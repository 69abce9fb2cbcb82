"""Who made a corpus, under which licence it may be used, and how to cite it.

The same facts stand in the manifest, in the attributes of ``index.nc`` or of the single file, in ``croissant.json`` and in the data card.
No part depends on them, so that a corpus can be published under another licence without a new simulation.
"""

import re
from collections.abc import Mapping
from datetime import UTC, date, datetime
from os import environ
from typing import Annotated, Any, Literal, Self

from packaging.licenses import InvalidLicenseExpression, canonicalize_license_expression
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, StringConstraints, ValidationError

from gen.corpus.manifest import Manifest
from gen.support.errors import CorpusError
from gen.support.sentences import sentences

EPOCH = "SOURCE_DATE_EPOCH"
"""Environment variable with a time [s since 1970, UTC] that replaces that of the clock in reproducible files."""

_ORCID = re.compile(r"(?:https?://orcid\.org/)?(\d{4}-\d{4}-\d{4}-\d{3}[\dX])")
_DOI = re.compile(r"(?:https?://(?:dx\.)?doi\.org/|doi:)?(10\.\d{4,9}/[!-~]{1,200})", re.IGNORECASE)
_EMAIL = re.compile(r"[^@\s<>,;]{1,64}@[^@\s<>,;]{1,200}\.[^@\s<>,;.]{2,63}")


def check_orcid(text: str) -> str:
    """ORCID without the address before it; ValueError if it is none, or if its last character is not the check digit of ISO 7064 (11-2).

    >>> check_orcid("https://orcid.org/0000-0002-1825-0097")
    '0000-0002-1825-0097'
    """
    match = _ORCID.fullmatch(text)
    if match is None:
        raise ValueError(f"{text!r} is not an ORCID; it has four groups of four digits, such as 0000-0002-1825-0097.")
    *digits, last = match[1].replace("-", "")
    total = 0
    # check digit of ISO 7064, 11-2
    for digit in digits:
        total = (total + int(digit)) * 2
    check = (12 - total % 11) % 11
    if last != "0123456789X"[check]:
        raise ValueError(
            f"{text!r} is not an ORCID: its last digit does not fit the others; compare it digit by digit."
        )
    return match[1]


def check_doi(text: str) -> str:
    """DOI without the address before it; ValueError if it is none.

    >>> check_doi("https://doi.org/10.1000/182")
    '10.1000/182'
    """
    match = _DOI.fullmatch(text)
    if match is None:
        raise ValueError(f"{text!r} is not a DOI; it begins with 10. and has a slash, such as 10.1000/182.")
    return match[1]


def _check_license(text: str) -> str:
    try:
        return canonicalize_license_expression(text)
    except InvalidLicenseExpression:
        raise ValueError(
            f"{text!r} is not an SPDX identifier; give one of spdx.org/licenses with its version, such as CC-BY-4.0 or CC0-1.0, "
            f"several joined by AND or OR, or LicenseRef-NAME for a licence of your own."
        ) from None


def _check_email(text: str) -> str:
    if _EMAIL.fullmatch(text) is None:
        raise ValueError(f"{text!r} is not an e-mail address; give one such as name@example.org.")
    return text


def _check_date(text: str) -> str:
    try:
        if date.fromisoformat(text).isoformat() == text:
            return text
    except ValueError:
        pass
    raise ValueError(f"{text!r} is not a date; write year, month and day as 2026-03-31.")


def _one_line(text: str) -> str:
    if not text.isprintable() or text != text.strip():
        raise ValueError(f"{text!r} has line breaks, other unprintable characters or spaces around it; give one line.")
    return text


def _name_alone(text: str) -> str:
    if match := _ORCID.search(text):
        raise ValueError(
            f"{text!r} has an ORCID in the name; give it as orcid, or write 'Jane Doe <{match[1]}>' in a command."
        )
    return text


Line = Annotated[str, StringConstraints(min_length=1, max_length=200), AfterValidator(_one_line)]
Reference = Annotated[str, StringConstraints(min_length=1, max_length=500), AfterValidator(_one_line)]
License = Annotated[str, AfterValidator(_check_license)]
Orcid = Annotated[str, AfterValidator(check_orcid)]
Doi = Annotated[str, AfterValidator(check_doi)]
Email = Annotated[str, AfterValidator(_check_email)]
Date = Annotated[str, AfterValidator(_check_date)]


class Creator(BaseModel):
    """A person or an organisation that made the corpus."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)

    name: Annotated[Line, AfterValidator(_name_alone)]
    """Name as in a citation, such as `Jane Doe`."""
    orcid: Orcid | None = None
    """ORCID of a person, such as `0000-0002-1825-0097`."""


class Publication(BaseModel):
    """Facts about a corpus that its publication needs; every one can be left out."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)

    license: License | None = None
    """Licence of the corpus as an SPDX identifier (spdx.org/licenses), such as `CC-BY-4.0`."""
    creators: Annotated[tuple[Creator, ...], Field(max_length=100)] = ()
    """Persons or organisations that made the corpus, in the order of a citation."""
    institution: Line | None = None
    """Institution at which the corpus was made, and which publishes it."""
    contact: Email | None = None
    """E-mail address for questions about the corpus."""
    doi: Doi | None = None
    """DOI under which the corpus is or will be published, such as `10.1000/182`."""
    references: Annotated[tuple[Reference, ...], Field(max_length=50)] = ()
    """Papers, reports and web pages that describe the corpus, one text each."""
    date: Date | None = None
    """Day on which the corpus was made, such as `2026-03-31`; if left out, that of the environment variable SOURCE_DATE_EPOCH, if set."""

    def kind_of(self, creator: Creator) -> Literal["person", "institution"] | None:
        """Whether a creator is a person, who has an ORCID, or the institution; None if neither is known."""
        return "person" if creator.orcid else "institution" if creator.name == self.institution else None

    @property
    def stored(self) -> dict[str, Any]:
        """Facts that are given, as they are stored in JSON."""
        return self.model_dump(mode="json", exclude_defaults=True)

    def dated(self) -> Self:
        """The same facts, with the date of ``SOURCE_DATE_EPOCH`` if none is given; CorpusError if that is not a number of seconds."""
        seconds = environ.get(EPOCH)
        if self.date is not None or not seconds:
            return self
        try:
            day = datetime.fromtimestamp(int(seconds), UTC).date()
        except (ValueError, OverflowError, OSError):
            raise CorpusError(
                f"{EPOCH}: {seconds!r} is not a time; give whole seconds since 1970, or unset it."
            ) from None
        return self.model_copy(update={"date": day.isoformat()})


def publication_of(manifest: Manifest) -> Publication:
    """Facts of publication of a corpus; CorpusError if somebody wrote wrong ones into its manifest."""
    try:
        return read_publication(manifest.publication)
    except CorpusError as error:
        raise CorpusError(f"publication of {manifest.title or 'the corpus'}: {error}") from None


def read_publication(facts: Mapping[str, Any]) -> Publication:
    """Facts from a mapping with the keys of :class:`Publication`; lists stand for tuples, and mappings for creators.

    Raises
    ------
    CorpusError
        If a key is unknown or a value is wrong, with the first of them in one sentence.

    >>> read_publication({"license": "CC-BY-4.0", "creators": [{"name": "Jane Doe"}]}).creators[0].name
    'Jane Doe'
    """
    if not isinstance(facts, Mapping):
        raise CorpusError(f"publication: {facts!r} is not a mapping; give keys such as license and creators.")
    try:
        return Publication.model_validate(facts)
    except ValidationError as error:
        raise CorpusError(sentences(error, Publication)[0]) from None
