"""Hash of source files: what was made by other sources can be told from what these made."""

import functools
import hashlib
from collections.abc import Iterator
from importlib.resources import files
from importlib.resources.abc import Traversable


@functools.cache
def hash_sources(*places: str) -> str:
    """SHA-256 over the Python files in folders, and over single files, in hexadecimal; each place begins with its package.

    >>> len(hash_sources("gen/support", "gen/physics/hertz.py"))
    64
    """
    digest = hashlib.sha256()
    for place in places:
        package, _, inside = place.partition("/")
        for name, content in _python_files(files(package).joinpath(inside), place):
            digest.update(f"{name}\n".encode() + content)
    return digest.hexdigest()


def _python_files(place: Traversable, name: str) -> Iterator[tuple[str, bytes]]:
    if place.is_dir():
        for inner in sorted(place.iterdir(), key=lambda inner: inner.name):
            if inner.is_dir() or inner.name.endswith(".py"):
                yield from _python_files(inner, f"{name}/{inner.name}")
    else:
        yield name, place.read_bytes()
