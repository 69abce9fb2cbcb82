"""How much a file from elsewhere may ask for before it is refused; a user raises a limit by its name.

A few bytes can ask for terabytes: a count in a recipe, an alias in YAML, a compressed array. So sizes are compared with these limits before
anything is allocated. ``raceway --limit NAME=NUMBER`` or the environment variable ``RACEWAY_LIMITS`` raises one, for the command and its
workers.
"""

import os
from collections.abc import Mapping
from typing import NamedTuple

from gen.errors import RacewayError

VARIABLE = "RACEWAY_LIMITS"


class Limit(NamedTuple):
    """A limit: its value unless a user raises it, the unit it counts in, and what it bounds."""

    value: int
    unit: str
    meaning: str


LIMITS: Mapping[str, Limit] = {
    "yaml_bytes": Limit(1_000_000, "bytes", "size of a recipe or mapping file"),
    "yaml_values": Limit(20_000, "values", "values of a recipe or mapping file, aliases written out"),
    # the classes and splits of all rigs are drawn before the first record: 10 million records take some 0.5 GB
    "records": Limit(10_000_000, "records", "records of a corpus"),
    # drawn anew for every part: 10 million specimens took 4 s each time
    "rig_specimens": Limit(100_000, "specimens", "specimens of a rig"),
    # a batch of the kernel has 16 lanes of single precision even for one record: 94 bytes a sample were measured, so 2.4 GB
    "record_samples": Limit(25_000_000, "samples", "samples of a record over all its channels, those that settle included"),
    # responses, counts and the paths of every rig: 8 to 12 bytes a sample were measured, so 1.8 GB beside the batch
    "part_samples": Limit(150_000_000, "samples", "samples of all records of a part, other memory a record needs counted in samples"),
    "recording_files": Limit(100_000, "files", "files of recordings that one import looks at"),
    "file_bytes": Limit(2_000_000_000, "bytes", "bytes of values in one file of recordings, of a corpus or of a model, unpacked"),
    "manifest_bytes": Limit(50_000_000, "bytes", "size of the manifest of a corpus"),
    "schema_bytes": Limit(50_000_000, "bytes", "size of the description of the objects in a model file"),
    "model_objects": Limit(1_000_000, "objects", "objects in a model file, one that is referred to twice counted twice"),
    "model_features": Limit(1_000, "features", "features of a model"),
    "model_nodes": Limit(50_000_000, "nodes", "nodes of all trees of a forest in a model, one that is referred to twice counted twice"),
}  # fmt: skip


def limits_page() -> str:
    """Markdown page with all limits."""
    rows = [f"| `{name}` | {found.value:,} {found.unit} | {found.meaning} |" for name, found in LIMITS.items()]
    title = "# Limits on what a file may ask for\n"
    how = (
        "Raise one with `raceway --limit NAME=NUMBER COMMAND ...`. Why there are limits: [security.md](security.md).\n"
    )
    return "\n".join([title, how, "| name | unless raised | what it bounds |", "|---|---:|---|", *rows]) + "\n"


def limit(name: str) -> int:
    """Value of a limit, as a user has set it or as it stands in ``LIMITS``.

    Raises
    ------
    RacewayError
        If the user's setting is no ``NAME=NUMBER`` or names no limit.
    """
    return parse_limits(os.environ.get(VARIABLE, "")).get(name, LIMITS[name].value)


def parse_limits(text: str) -> dict[str, int]:
    """Limits written as ``NAME=NUMBER``, separated by commas.

    >>> parse_limits("records=2e7,file_bytes=8000000000")
    {'records': 20000000, 'file_bytes': 8000000000}

    Raises
    ------
    RacewayError
        If one is no ``NAME=NUMBER``, or names no limit.
    """
    found = {}
    for item in filter(None, text.split(",")):
        name, _, number = item.partition("=")
        try:
            value = int(float(number))
        except (ValueError, OverflowError):
            value = 0
        if name not in LIMITS or value < 1:
            raise RacewayError(f"limit {item!r}: give NAME=NUMBER, NAME one of {', '.join(LIMITS)}, NUMBER 1 or more.")
        found[name] = value
    return found


def check_limit(name: str, amount: int, what: str, error: type[Exception]) -> None:
    """Raise ``error`` if ``what`` asks for more than a limit allows; ``what`` begins the sentence."""
    allowed = limit(name)
    if amount > allowed:
        asked = str(amount) if amount < 10**18 else "1e18 or more"
        raise error(
            f"{what} {asked} {LIMITS[name].unit}, and the limit is {allowed}; if that is meant, raise it with "
            f"raceway --limit {name}=NUMBER ({LIMITS[name].meaning})."
        )
