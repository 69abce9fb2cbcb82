"""Random numbers and streams by name, such as ``path.modes.gain_db`` of rig 3.

Each depends on the seed, its level, the number of the rig, specimen or record, and its name alone: not on the order of work, and not on
what else is drawn. So a further key, section or mechanism moves no value of any other.
"""

import functools
from hashlib import blake2b
from typing import Literal

import numpy as np

Level = Literal["corpus", "rig", "specimen", "record"]


def number(seed: int, level: Level, of: int, name: str) -> float:
    """Random number in [0, 1).

    >>> number(1, "rig", 3, "path.direct") == number(1, "rig", 3, "path.direct") != number(1, "rig", 4, "path.direct")
    True
    """
    return (int.from_bytes(_digest(seed, level, of, name, 8)) >> 11) * 2.0**-53


def stream(seed: int, level: Level, of: int, name: str) -> np.random.Generator:
    """Random stream; its name begins with what it is for."""
    words = np.frombuffer(_digest(seed, level, of, name, 32), "<u4")
    return np.random.Generator(np.random.PCG64DXSM(np.random.SeedSequence(words)))


def _digest(seed: int, level: Level, of: int, name: str, size: int) -> bytes:
    state = _state(seed, level, of, size).copy()
    state.update(name.encode())
    return state.digest()


@functools.lru_cache(maxsize=16)
def _state(seed: int, level: Level, of: int, size: int) -> blake2b:
    """Hash of what the names of an item have in common: a copy takes half the time of a new one."""
    return blake2b(f"{seed} {level} {of} ".encode(), digest_size=size)
