"""Models within a model: each is read from its file when it is first used, since it takes a fifth of a second."""

from pathlib import Path
from typing import Any, Generic, NamedTuple, TypeVar

Held = TypeVar("Held")


class Packed(NamedTuple):
    """A model as it stands in a file."""

    content: bytes
    path: Path | str


class Part(Generic[Held]):
    """Field of a model that holds another one, or None."""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, model: object | None, owner: Any) -> Held | None:
        if model is None:  # a dataclass asks for the default of its field
            return None
        part = model.__dict__[self.name]
        if isinstance(part, Packed):
            from features.baselines.model_file import unpack  # skops takes a second to load

            part = owner.of_content(part.path, unpack(part.content, part.path))
            model.__dict__[self.name] = part
        return part

    def __set__(self, model: object, part: Held | Packed | None) -> None:
        model.__dict__[self.name] = part
