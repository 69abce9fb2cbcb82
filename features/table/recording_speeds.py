"""Shaft speed of every recording of a corpus, and the sentences that warn of wrong labels.

``parts -> sums of the levels of lines by recording -> one estimate per recording -> variables of its records``

A recording may be cut into records of several parts. Its sums are kept until its last record has come, so that memory
holds the unfinished recordings alone and no signals.
"""

from collections.abc import Iterable, Sequence
from itertools import chain
from typing import Any, Literal, NamedTuple, cast

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from features.signal.rows import FloatArray
from features.signal.speed import DISAGREEMENT, EVIDENCE, ShaftSpeed, find_speed
from features.table.channels import accelerations, orders_of
from features.table.speed_search import line_levels
from gen.corpus import numbered
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
        raise ValueError(f"speed: {speed!r} is no treatment of shaft speeds; choose from {', '.join(SPEEDS)}.")
    return "off" if speed == "check" and LATENT in table.variables else cast("Speed", speed)


def recording_numbers(table: xr.Dataset) -> IntArray:
    """Number of the recording that each record was cut from, from 0 and without a gap, shape (record,)."""
    return numbered(*(table[name].values for name in RECORDING))


def block_sums(task: tuple[xr.Dataset, IntArray]) -> list[Sums]:
    """Sums of the levels of lines of the recordings in one block of records.

    ``task`` is the block and the number of the recording of each of its records, shape (record,).
    """
    block, recording = task
    x, nominal = accelerations(block), orders_of(block)
    fs, shaft_rate = float(block["sample_rate"].values[0]), block["shaft_rate"].values
    # a recording of which no window is usable still counts its records
    counts = zip(*(values.tolist() for values in np.unique(recording, return_counts=True)), strict=True)
    sums = {number: Sums(number, records, 0, np.zeros((1, 1))) for number, records in counts}
    for numbers, batch in line_levels(x, fs, shaft_rate, nominal):
        for number, level in zip(recording[numbers].tolist(), batch, strict=True):
            # sums of windows can be added over blocks, medians could not
            sums[number] = _added(sums[number], Sums(number, 0, 1, level))
    return list(sums.values())


def _added(sums: Sums, more: Sums) -> Sums:
    return Sums(sums.recording, sums.records + more.records, sums.windows + more.windows, sums.levels + more.levels)


def recording_speeds(recording: IntArray, shaft_rate: FloatArray, blocks: Iterable[Sequence[Sums]]) -> list[ShaftSpeed]:
    """Estimate of each recording, by its number, from the sums of all blocks in their order.

    Parameters
    ----------
    recording
        Number of the recording of each record, shape (record,).
    shaft_rate
        As labelled [Hz], shape (record,); a recording with several rates is estimated relative to its first.
    blocks
        Sums of each block.
    """
    _, first, records = np.unique(recording, return_index=True, return_counts=True)
    begun, estimates = dict[int, Sums](), dict[int, ShaftSpeed]()
    for new in chain.from_iterable(blocks):
        number = new.recording
        sums = _added(begun.pop(number), new) if number in begun else new
        # a recording is estimated when its last record has come, and its sums are then forgotten
        if sums.records < records[number]:
            begun[number] = sums
        else:
            label = float(shaft_rate[first[number]])
            estimates[number] = find_speed(sums.levels / max(sums.windows, 1), sums.windows, label)
    return [estimates[number] for number in sorted(estimates)]


def with_speeds(table: xr.Dataset, recording: IntArray, estimates: list[ShaftSpeed], speed: Speed) -> xr.Dataset:
    """Table with the estimated rate, its uncertainty and its evidence as variables of the records."""
    label = table["shaft_rate"].values
    # without a label there is no estimate
    told = [(estimate.rate, estimate.uncertainty, estimate.labelled_rate or np.nan) for estimate in estimates]
    rate, uncertainty, labelled = np.array(told).reshape(-1, 3)[recording].T
    relative, spread = rate / labelled, uncertainty / labelled
    codes = np.array([EVIDENCE.index(estimate.evidence) for estimate in estimates], np.int8)[recording]
    described = {"units": "Hz", "role": "operating"}
    flags = {"flag_values": np.arange(len(EVIDENCE), dtype=np.int8), "flag_meanings": " ".join(EVIDENCE)}
    # stored, because the labels that disagree may be replaced by estimates
    disagreeing = sum(not estimate.agrees for estimate in estimates)
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
