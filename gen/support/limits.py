"""Limits on the memory and time that a file from a stranger can ask for.

A few bytes can ask for terabytes: a count in a recipe, an alias in YAML, a compressed array. So sizes are compared with these limits before
anything is allocated. A user raises a limit with ``raceway --limit NAME=NUMBER`` or the environment variable ``RACEWAY_LIMITS``, for the
command and its workers.
"""

import os
from collections.abc import Mapping
from typing import NamedTuple

from gen.support.errors import RacewayError

VARIABLE = "RACEWAY_LIMITS"


class Limit(NamedTuple):
    """A limit: its default value, its unit, and the quantity that it bounds."""

    value: int
    unit: str
    meaning: str


LIMITS: Mapping[str, Limit] = {
    "yaml_bytes": Limit(1_000_000, "bytes", "size of a recipe, or of the common keys of labels"),
    "yaml_values": Limit(20_000, "values", "values of a recipe, or of the common keys of labels, with aliases expanded"),
    # the classes and splits of all rigs are drawn before the first record: 10 million records take some 0.5 GB
    "records": Limit(10_000_000, "records", "records of a corpus"),
    # drawn again for every part: 10 million specimens took 4 s each time
    "rig_specimens": Limit(100_000, "specimens", "specimens of a rig"),
    # a batch of the kernel has 16 lanes of single precision even for one record: 94 bytes a sample were measured, so 2.4 GB
    "record_samples": Limit(25_000_000, "samples", "samples of a record over all its channels, settle_s included"),
    # responses, counts and the paths of every rig: 8 to 12 bytes a sample were measured, so 1.8 GB beside the batch
    "part_samples": Limit(150_000_000, "samples", "samples of all records of a part; other memory of a record is counted in samples"),
    "recording_files": Limit(100_000, "files", "files of recordings that one import examines"),
    "file_bytes": Limit(2_000_000_000, "bytes", "size of a file of recordings or a model, and of the values of a corpus"),
    "manifest_bytes": Limit(50_000_000, "bytes", "size of the manifest of a corpus"),
}  # fmt: skip


def limits_page() -> str:
    """Markdown page with all limits."""
    rows = [f"| `{name}` | {bound.value:,} {bound.unit} | {bound.meaning} |" for name, bound in LIMITS.items()]
    title = "# Limits on what a file may ask for\n"
    how = (
        "Raise one with `raceway --limit NAME=NUMBER COMMAND ...`. The reason for limits: [security.md](security.md).\n"
    )
    return "\n".join([title, how, "| name | default | bounded quantity |", "|---|---:|---|", *rows]) + "\n"


def limit(name: str) -> int:
    """Value of a limit: the setting of the user, or else the default.

    Raises
    ------
    RacewayError
        If the setting is not ``NAME=NUMBER`` or has an unknown name.
    """
    return parse_limits(os.environ.get(VARIABLE, "")).get(name, LIMITS[name].value)


def parse_limits(text: str) -> dict[str, int]:
    """Limits written as ``NAME=NUMBER``, separated by commas.

    >>> parse_limits("records=2e7,file_bytes=8000000000")
    {'records': 20000000, 'file_bytes': 8000000000}

    Raises
    ------
    RacewayError
        If an item is not ``NAME=NUMBER`` or has an unknown name.
    """
    numbers = {}
    for item in filter(None, text.split(",")):
        name, _, number = item.partition("=")
        try:
            value = int(float(number))
        except (ValueError, OverflowError):
            value = 0
        if name not in LIMITS or value < 1:
            raise RacewayError(f"limit {item!r}: give NAME=NUMBER, NAME one of {', '.join(LIMITS)}, NUMBER 1 or more.")
        numbers[name] = value
    return numbers


def check_limit(name: str, amount: int, what: str, error: type[Exception]) -> None:
    """Raise ``error`` if ``amount`` is above a limit; ``what`` begins the sentence."""
    allowed = limit(name)
    if amount > allowed:
        asked = str(amount) if amount < 10**18 else "1e18 or more"
        raise error(
            f"{what} {asked} {LIMITS[name].unit}, and the limit is {allowed}; if that is meant, raise it with "
            f"raceway --limit {name}=NUMBER or the environment variable RACEWAY_LIMITS={name}=NUMBER ({LIMITS[name].meaning})."
        )
