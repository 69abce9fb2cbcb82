"""Random streams, one for each rig, specimen, record and purpose: they depend on numbers, not on the order of work."""

from enum import IntEnum

import numpy as np


class Purpose(IntEnum):
    """Purpose of a random stream; the number is part of the seed of the stream and must not change."""

    RIG = 0
    CLASSES = 1
    SPLIT = 2
    SPECIMEN = 3
    FAULT = 4
    WAVINESS = 5
    RECORD = 6
    MOTION = 7
    NOISE = 8
    SAMPLING = 9
    ROUGHNESS = 10
    WEAR = 11
    LOAD_WANDER = 12
    KNOCKS = 13
    PHASES = 14
    LEVEL = 15
    RIG_SENSOR_FAULTS = 20
    RECORD_SENSOR_FAULTS = 21
    SENSOR_NOISE = 22
    GEAR = 23
    GEAR_PHASE = 24
    MACHINE_CONDITION = 25
    BURSTS = 26
    LOOSENESS = 27
    RIG_OPERATION = 30
    SPECIMEN_OPERATION = 31
    SPEED_PROFILE = 32
    LOAD_PROFILE = 33
    EDGES = 40
    AXIS = 41
    SLIP = 42
    LIFE = 60


def stream(seed: int, rig: int, specimen: int, record: int, purpose: Purpose) -> np.random.Generator:
    """Random stream of one purpose; a stream of a rig or a specimen has 0 for the numbers of the lower levels."""
    # The words that SeedSequence(seed, spawn_key=(rig, specimen, record, purpose)) makes of its numbers; given as an array they take half
    # the time.
    words = [seed >> 32 * place & 0xFFFFFFFF for place in range(max(4, -(-seed.bit_length() // 32)))]
    sequence = np.random.SeedSequence(np.array([*words, rig, specimen, record, purpose], np.uint32))
    return np.random.Generator(np.random.PCG64DXSM(sequence))
