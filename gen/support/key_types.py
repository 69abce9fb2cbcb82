"""Types of keys that people write about their recordings.

Text from strangers reaches data cards, messages and the names of variables: control characters are refused, and so are marks that are
not seen, such as U+202E, behind which a name is read backwards.
"""

import unicodedata
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field


class Keys(BaseModel):
    """Keys that belong together; frozen, and other keys are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


def as_text(value: Any) -> Any:
    """Text of a whole number; other values as they are."""
    return str(value) if type(value) is int else value


def _printable(text: str) -> str:
    """Return text without control and format characters; ValueError if it has one."""
    for letter in text:
        if unicodedata.category(letter) in ("Cc", "Cf", "Cs") and letter not in "\t\n\r":
            raise ValueError(f"{letter!r} is a control character; leave it out.")
    return text


def on_one_line(text: str) -> str:
    """Return text on one line without control characters; ValueError for others."""
    if set(text) & set("\t\n\r"):
        raise ValueError(f"{text[:60]!r} has a tab or a line break; write it on one line.")
    return _printable(text)


Text = Annotated[str, Field(min_length=1, max_length=5000), BeforeValidator(as_text), AfterValidator(_printable)]
Name = Annotated[str, Field(min_length=1, max_length=200), BeforeValidator(as_text), AfterValidator(on_one_line)]
Millimetres = Annotated[float, Field(gt=0, le=10_000)]
