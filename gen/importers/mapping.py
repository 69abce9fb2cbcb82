"""Mapping files: YAML that describes a user's recordings file by file, read and checked as recipes are.

A key that describes a file can be given once at the top for all files, and again for a file that differs. A quantity that a recipe also
has is spelt as in a recipe, with the unit at the end of the key.
"""

from functools import cached_property
from pathlib import Path
from typing import Annotated, Self

from pydantic import Field, ValidationError, model_validator

from gen.importers.mapping_keys import FileKeys
from gen.importers.mapping_values import Hertz, Name, Text
from gen.importers.section import Section, sections_of
from gen.support.errors import CorpusError
from gen.support.sentences import sentences
from gen.support.yaml_files import read_yaml


class MappingFile(FileKeys):
    """A mapping file; the keys of a file that it has apply to all files."""

    title: Text = "Own recordings"
    origin: Text = "Origin and licence are not stated."
    channel: Name = "sensor"
    resample_hz: Hertz | None = None
    files: Annotated[tuple[FileKeys, ...], Field(min_length=1)]

    @cached_property
    def sections(self) -> tuple[Section, ...]:
        """The files with all their keys."""
        return sections_of(self, self.files)

    @property
    def channel_names(self) -> tuple[str, ...]:
        """Names of the channels of all recordings."""
        return _channels(self, self.sections[0])

    @model_validator(mode="after")
    def _belongs_together(self) -> Self:
        for section in self.sections:
            if _channels(self, section) != self.channel_names:
                raise ValueError(
                    f"files[{section.position}]: has the channels {', '.join(_channels(self, section))}, and files[0] has "
                    f"{', '.join(self.channel_names)}; give all files the same channels, or make a corpus of each."
                )
        return self


def _channels(mapping: MappingFile, section: Section) -> tuple[str, ...]:
    return tuple(sensor.name or mapping.channel for sensor in section.sensors())


def read_mapping(path: Path) -> MappingFile:
    """Read and check a mapping file.

    Raises
    ------
    CorpusError
        If it is missing, is not YAML, or has wrong keys or values; one sentence for each of them.
    """
    if path.is_dir():
        raise CorpusError(
            f"{path}: is a folder; give the YAML file that describes the recordings, such as {path / 'mapping.yaml'}."
        )
    if not path.is_file():
        raise CorpusError(f"{path}: no such file; give the YAML file that describes the recordings.")
    data = read_yaml(path, CorpusError)
    if not isinstance(data, dict) or not all(isinstance(key, str) for key in data):
        raise CorpusError(
            f"{path}: a mapping file has the key files, a list of sections with path, fault, specimen and further keys."
        )
    try:
        return MappingFile.model_validate(data)
    except ValidationError as error:
        problems = sentences(error, MappingFile)
        raise CorpusError("\n".join(f"{path}: {sentence}" for sentence in problems)) from None
