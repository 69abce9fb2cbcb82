"""Shaft speed of every recording of a corpus, and the sentences that warn of wrong labels.

``parts -> sums of the levels of lines by recording -> one estimate per recording -> variables of its records``

A recording may be cut into records of several parts. Its sums are kept until its last record has come, so that memory
holds the unfinished recordings alone and no signals.
"""

from collections.abc import Iterable
from typing import Any, Literal, NamedTuple, cast

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from features.signal.lines import Orders
from features.signal.rows import FloatArray
from features.signal.speed import DISAGREEMENT, EVIDENCE, ShaftSpeed, find_speed
from features.table.speed_search import line_levels
from gen.corpus import RecordBlock, read_channel
from gen.support.units import from_si

Speed = Literal["off", "check", "correct"]
SPEEDS: tuple[Speed, ...] = ("off", "check", "correct")

RECORDING = ("rig", "specimen", "fault", "recording")  # numbers that identify a recording together
LATENT = "true_shaft_rate"  # variable of simulated corpora alone
ESTIMATE, UNCERTAINTY, BY = "shaft_rate_estimate", "shaft_rate_uncertainty", "shaft_rate_evidence"
MOST_SENTENCES = 5
LINES = {"bpfo": "BPFO lines", "bpfi": "BPFI lines", "2bsf": "2 BSF lines", "shaft": "shaft harmonics"}

IntArray = NDArray[np.integer[Any]]


class Sums(NamedTuple):
    """Sums over the records of one recording in one part."""

    recording: int
    records: int
    windows: int
    """Windows that could be used."""
    levels: FloatArray
    """Sum over the windows, shape (line, candidate)."""


def checked_speed(speed: str, table: xr.Dataset) -> Speed:
    """Treatment of speeds that fits the corpus: simulated ones are not checked, since their label error is drawn.

    Raises
    ------
    ValueError
        If it is none of `SPEEDS`.
    """
    if speed not in SPEEDS:
        message = f"speed: {speed!r} is no treatment of shaft speeds; choose from {', '.join(SPEEDS)}."
        raise ValueError(message)
    return "off" if speed == "check" and LATENT in table.variables else cast("Speed", speed)


def recording_numbers(table: xr.Dataset) -> IntArray:
    """Number of the recording that each record was cut from, from 0 and without a gap, shape (record,)."""
    keys = np.stack([table[name].values for name in RECORDING])
    return np.unique(keys, axis=1, return_inverse=True)[1].reshape(-1)


def block_sums(task: tuple[RecordBlock, IntArray], channel: int = 0) -> list[Sums]:
    """Sums of the levels of lines of the recordings in one block of records.

    ``task`` is the block and the number of the recording of each of its records, shape (record,).
    """
    block, recording = task
    x, (fs, shaft_rate, *nominal) = read_channel(block, channel, ("sample_rate", "shaft_rate", *Orders._fields))
    levels: dict[int, FloatArray] = {}
    windows: dict[int, int] = {}
    # records of one batch share a sample rate
    for rate in np.unique(fs[fs > 0]):
        rows = np.flatnonzero(fs == rate)
        orders = Orders(*(order[rows] for order in nominal))
        for numbers, batch in line_levels(x[rows], float(rate), shaft_rate[rows], orders):
            for key, level in zip(recording[rows[numbers]].tolist(), batch, strict=True):
                # sums of windows can be added over blocks, medians could not
                levels[key] = levels[key] + level if key in levels else level.astype(float)
                windows[key] = windows.get(key, 0) + 1
    # a recording of which no window is usable still counts its records
    nothing = np.zeros((1, 1))
    return [
        Sums(key, count, windows.get(key, 0), levels.get(key, nothing))
        for key, count in zip(*(batch.tolist() for batch in np.unique(recording, return_counts=True)), strict=True)
    ]


def recording_speeds(
    recording: IntArray, shaft_rate: FloatArray, blocks: Iterable[tuple[int, list[Sums]]]
) -> list[ShaftSpeed]:
    """Estimate of each recording, by its number, from the sums of all blocks in any order.

    Parameters
    ----------
    recording
        Number of the recording of each record, shape (record,).
    shaft_rate
        As labelled [Hz], shape (record,); a recording with several rates is estimated relative to its first.
    blocks
        Number and sums of each block.
    """
    _, first, missing = np.unique(recording, return_index=True, return_counts=True)
    label = shaft_rate[first]
    waiting: dict[int, dict[int, Sums]] = {}
    estimates: list[ShaftSpeed | None] = [None] * len(first)
    for block, sums in blocks:
        for new in sums:
            waiting.setdefault(new.recording, {})[block] = new
            # a recording is estimated when its last block has come, and then forgotten
            missing[new.recording] -= new.records
            if missing[new.recording] == 0:
                held = waiting.pop(new.recording)
                ordered = [held[number] for number in sorted(held) if held[number].windows]
                windows = sum(one.windows for one in ordered)
                # summed in the order of the blocks, so that the result does not depend on that of the tasks
                mean = sum((one.levels for one in ordered), np.zeros((1, 1))) / max(windows, 1)
                estimates[new.recording] = find_speed(mean, windows, float(label[new.recording]))
    return [speed for speed in estimates if speed is not None]


def with_speeds(table: xr.Dataset, recording: IntArray, estimates: list[ShaftSpeed], speed: Speed) -> xr.Dataset:
    """Table with the estimated rate, its uncertainty and its evidence as variables of the records."""
    label = table["shaft_rate"].values
    relative, spread = np.array([_relative(one) for one in estimates]).reshape(-1, 2)[recording].T
    codes = np.array([EVIDENCE.index(one.evidence) for one in estimates], np.int8)[recording]
    described = {"units": "Hz", "role": "operating"}
    flags = {"flag_values": np.arange(len(EVIDENCE), dtype=np.int8), "flag_meanings": " ".join(EVIDENCE)}
    # stored, because the labels that disagree may be replaced by estimates
    disagreeing = sum(not one.agrees for one in estimates)
    return table.assign(
        {
            ESTIMATE: ("record", relative * label, {"long_name": "shaft rate that fits the lines best", **described}),
            UNCERTAINTY: (
                "record",
                spread * label,
                {"long_name": "standard deviation of the estimated rate", **described},
            ),
            BY: (
                "record",
                codes,
                {"long_name": "lines that tell the rate", "units": "1", "role": "operating", **flags},
            ),
        }
    ).assign_attrs(speed=speed, recordings_with_other_speed=disagreeing)


def _relative(estimate: ShaftSpeed) -> tuple[float, float]:
    return (
        (estimate.rate / estimate.labelled_rate, estimate.uncertainty / estimate.labelled_rate)
        if estimate.rate > 0
        else (np.nan, np.nan)
    )


def rates_to_use(table: xr.Dataset) -> FloatArray:
    """Rates that features are computed at [Hz], shape (record,): estimated ones where they are clear, if speeds are corrected."""
    if table.attrs.get("speed") != "correct":
        return table["shaft_rate"].values
    return np.where(table[BY].values > 0, table[ESTIMATE].values, table["shaft_rate"].values)


def other_speed(table: xr.Dataset) -> NDArray[np.bool_]:
    """Whether the lines of each record's recording clearly tell another speed than the label, shape (record,)."""
    beyond = np.abs(table[ESTIMATE].values - table["shaft_rate"].values) > DISAGREEMENT * table[UNCERTAINTY].values
    return (table[BY].values > 0) & beyond


def speed_warnings(table: xr.Dataset) -> list[str]:
    """Sentences about the recordings whose lines tell another speed than the label, about six at most.

    A table without estimated rates gives none.
    """
    if not table.attrs.get("recordings_with_other_speed"):
        return []
    label, estimate, uncertainty = (table[name].values for name in ("shaft_rate", ESTIMATE, UNCERTAINTY))
    numbers = recording_numbers(table)
    # one sentence for a recording, not for each of its windows
    first = np.unique(numbers, return_index=True)[1]
    wrong = first[other_speed(table)[first]]
    corrected = table.attrs["speed"] == "correct"
    action = (
        "its features use the estimated speed"
        if corrected
        else "check the label and the bearing, or use the speed 'correct'"
    )
    sentences = [
        f"{table['source'].values[row]}: labelled {from_si(label[row], 'rpm'):.0f} rpm, but its {LINES[EVIDENCE[table[BY].values[row]]]} "
        f"fit {from_si(estimate[row], 'rpm'):.0f} +- {from_si(uncertainty[row], 'rpm'):.0f} rpm "
        f"({100 * (estimate[row] / label[row] - 1):+.1f} %); "
        f"{action}."
        for row in wrong[:MOST_SENTENCES]
    ]
    # a set with wrong labels throughout would fill the screen
    more = len(wrong) - MOST_SENTENCES
    if more > 0:
        sentences.append(f"{more} more recording{'s' if more > 1 else ''} with lines that fit another speed.")
    return sentences
