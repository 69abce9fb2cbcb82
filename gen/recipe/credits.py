"""Licence, creators and references of the corpus; no record depends on them."""

from typing import Annotated

from pydantic import Field

from gen.corpus.publication import Creator, Publication
from gen.drawing import Section


class CreatorSection(Section, Creator):
    """A person or an organisation that made the corpus."""


class PublicationSection(Section, Publication):
    """Facts that the publication of the corpus needs."""

    creators: Annotated[tuple[CreatorSection, ...], Field(max_length=100)] = ()  # pyright: ignore[reportIncompatibleVariableOverride]  # frozen
    """Persons or organisations that made the corpus, in the order of a citation."""
