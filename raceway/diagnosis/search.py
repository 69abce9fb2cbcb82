"""Search for the bearing and the shaft speed that explain the lines of a recording. Pure.

``channels -> mean level spectra -> evidence of every pair of bearing and speed -> the few pairs that explain the lines``

The evidence is that of `features.signal.speed`: the highest comb of a bearing, and the harmonics of the shaft. It is
computed over speeds from half to 1.7 times those that are given, so that lines that no given pair explains are found too.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from features.signal.demodulation import ZERO_PADDING
from features.signal.lines import families
from features.signal.rows import FloatArray, centre
from features.signal.speed import (
    CLEAR_MARGIN,
    DISAGREEMENT,
    FLOOR,
    PENALTY,
    RIVALS_BEYOND,
    SHAFT_SHIFT,
    STEP,
    comb_height,
    evidence_of,
    levels_at,
    line_orders,
    name_of,
    spread_of,
)
from features.signal.speed import TOLERANCE as LABEL_TOLERANCE
from features.table.band import DEFAULT_BAND
from features.table.indicators import Orders
from features.table.record_batch import SHORTEST
from features.table.speed_search import LONGEST, level_spectra
from gen.corpus.fault_classes import fault_class
from gen.support.units import rpm_to_hertz
from raceway.diagnosis.evidence import SHAFT_DRIFT, TOLERANCE, Line, side_of

ANY_RATE = (5.0, 100.0)  # Hz, of a shaft whose speed is not known
TURNS = 4.0  # of the shaft in a window at least
WIDER = (0.5, 1.7)  # range of the speeds that are searched over those that are given
STRONG_COMB = 3.0  # standard deviations of a comb that has to be explained
SHAFT_BEHIND = CLEAR_MARGIN  # standard deviations by which the shaft may fit another speed better
SHAFT_TIE = 0.5  # standard deviations by which two speeds fit the shaft alike
MOST_PAIRS = 4  # that are told apart
FAR = 0.015  # relative error of a label that is no small error of a measured speed
SAME_ORDERS = 0.01  # relative; bearings with orders as near as this are one
STRANGE_ORDERS = (1.5, 10.0)  # in which a comb that belongs to no part is searched
MAINS = (50.0, 60.0)  # Hz
HARMONICS = (1.0, 2.0, 3.0)  # of a comb


class Given(NamedTuple):
    """Bearings by name with their nominal orders, as numbers, and the lowest and highest shaft rate [Hz], equal if it is known."""

    bearings: Mapping[str, Orders]
    rates: tuple[float, float]

    @property
    def known(self) -> bool:
        """Whether there is one bearing and one speed."""
        return len(self.bearings) == 1 and self.rates[0] == self.rates[1]

    @property
    def searched(self) -> tuple[float, float]:
        """Lowest and highest shaft rate [Hz] of the search: 8 % around one rate, 2.5 % beyond a range."""
        low, high = self.rates
        reach = LABEL_TOLERANCE if low == high else RIVALS_BEYOND
        return (1 - reach) * low, (1 + reach) * high


def given_of(orders: Mapping[str, Iterable[float]], rpm: Sequence[float] | None) -> Given:
    """Bearings by name with their fault orders, and the lowest and highest speed; all usual speeds if it is not known."""
    low, high = ANY_RATE if rpm is None else (rpm_to_hertz(float(speed)) for speed in rpm)
    return Given({name: Orders(*map(np.asarray, each)) for name, each in orders.items()}, (low, high))


class Pair(NamedTuple):
    """A bearing and a shaft speed.

    Attributes
    ----------
    bearing, orders
        Name and nominal orders.
    rate, uncertainty
        Shaft rate at which the orders fit the lines, and one standard deviation [Hz].
    lines
        Those that tell the rate, one of `features.signal.speed.EVIDENCE`.
    strength
        Evidence, in standard deviations of noise.
    alike
        Other bearings with orders as near as 1 %, which no line tells from this one.
    """

    bearing: str
    orders: Orders
    rate: float
    uncertainty: float
    lines: str
    strength: float
    alike: tuple[str, ...] = ()


class LevelSpectra(NamedTuple):
    """Mean log level over the floor of envelope and signal, shape (frequency,), resolution [Hz] and number of windows."""

    envelope: FloatArray
    signal: FloatArray
    resolution: float
    windows: int


def mean_spectra(channels: Sequence[FloatArray], fs: float, machine: Given) -> LevelSpectra:
    """Spectra of the lines of a recording, means over the windows of all its channels, each of shape (time,)."""
    longest = max(LONGEST, TURNS / machine.rates[0])
    count = max(1, int(np.ceil(len(channels[0]) / fs / longest - 1e-9)))
    length = len(channels[0]) // count
    highest = max(float(line_orders(_row(orders))[0].max()) for orders in machine.bearings.values())
    top = min(WIDER[1] * machine.rates[1] * highest, DEFAULT_BAND.high, fs / 2)
    windows = np.concatenate([channel[: count * length].reshape(count, length) for channel in channels])
    rates = np.full(len(windows), np.sqrt(np.prod(machine.rates)))
    resolution, envelope, signal = level_spectra(centre(windows.astype(np.float32)), fs, rates, top)
    return LevelSpectra(envelope.mean(axis=0), signal.mean(axis=0), resolution, len(windows))


class _Grid(NamedTuple):
    """Evidence of every pair: bearings with those alike, rates [Hz], combs (bearing, comb, speed), and shaft (speed,)."""

    given: Given
    alike: Mapping[str, list[str]]
    rates: FloatArray
    combs: FloatArray
    shaft: FloatArray

    @property
    def evidence(self) -> FloatArray:
        """Shape (bearing, speed)."""
        return self.combs.max(axis=1) + self.shaft

    def near(self, rate: float) -> NDArray[np.bool_]:
        return np.abs(self.rates / rate - 1) < RIVALS_BEYOND

    def best(self, evidence: FloatArray) -> list[Pair]:
        """Pair of the highest evidence, shape (bearing, speed), and its rivals within the margin, best first."""
        left, pairs = evidence.copy(), []
        while len(pairs) < MOST_PAIRS and left.max() > evidence.max() - CLEAR_MARGIN:
            bearing, number = (int(place) for place in np.unravel_index(int(left.argmax()), left.shape))
            pairs.append(self._pair(bearing, number))
            left[bearing, self.near(self.rates[number])] = -np.inf
        return pairs

    def _pair(self, bearing: int, number: int) -> Pair:
        name, alike = list(self.alike.items())[bearing]
        rate, evidence = self.rates[number], self.evidence[bearing]
        error = np.log(self.rates / rate)
        around = np.abs(error) <= LABEL_TOLERANCE
        # how narrow the peak of the evidence is tells how well the speed is known
        spread = spread_of(error[around], evidence[around], int(around[:number].sum()))
        return Pair(
            bearing=name,
            orders=self.given.bearings[name],
            rate=float(rate),
            uncertainty=float(rate * spread),
            lines=name_of(self.combs[bearing, :, number]),
            strength=float(evidence[number]),
            alike=tuple(alike),
        )


def find_pairs(spectra: LevelSpectra, machine: Given) -> tuple[tuple[Pair, ...], tuple[Pair, ...]]:
    """Pairs within those given that explain the lines of a recording, best first, and pairs elsewhere that explain what these do not.

    Those elsewhere explain a strong comb.

    With one bearing and one speed, that pair is the answer unless the lines clearly tell another speed within 8 %: in its
    place if the shaft tells so too, and clearly so if it is more than 1.5 % away, and else beside it. Otherwise all pairs are
    named that come within 1.5 standard deviations of the best, up to four.
    """
    grid = _grid(spectra, machine)
    (low, high), rates, evidence = machine.rates, grid.rates, grid.evidence
    within = (rates >= machine.searched[0]) & (rates <= machine.searched[1])
    error = np.log(rates / low) if low == high else np.zeros(len(rates))
    # far from a label a speed needs better evidence
    pairs = grid.best(np.where(within, evidence - PENALTY * (error / LABEL_TOLERANCE) ** 2, -np.inf))
    if machine.known:
        pairs = _corrected(grid, pairs[0], clear=len(pairs) == 1)
    names = list(grid.alike)
    own = max(evidence[names.index(pair.bearing), grid.near(pair.rate)].max() for pair in pairs)
    # only strong combs accuse the given speed and bearing
    strong = np.where(grid.combs.max(axis=1) > STRONG_COMB, evidence, -np.inf)
    elsewhere = grid.best(strong) if strong.max() > own + CLEAR_MARGIN else []
    return tuple(pairs), tuple(elsewhere)


def _corrected(grid: _Grid, best: Pair, *, clear: bool) -> list[Pair]:
    """The pair of the label, unless the best one is clear, or the best of all speeds and not only near the label.

    Combs of a wrong bearing are found at wrong speeds too. So the best pair stands alone only if its speed fits the
    harmonics of the shaft as well as the label does, and far from the label clearly better.
    """
    label, shaft, (evidence,) = grid.given.rates[0], grid.shaft, grid.evidence
    place = int(np.abs(grid.rates - best.rate).argmin())
    clear &= bool(shaft.max() - shaft[place] < SHAFT_BEHIND)
    highest = (
        grid.near(best.rate)[evidence.argmax()] and evidence.max() > evidence[grid.near(label)].max() + CLEAR_MARGIN
    )
    agrees = abs(best.rate - label) <= DISAGREEMENT * best.uncertainty
    at_label = best._replace(rate=label)
    if agrees or not (clear or highest):
        return [at_label]
    # a speed of a wrong bearing can be moved until its orders fit, and the shaft does not follow
    needed = SHAFT_BEHIND if abs(best.rate / label - 1) > FAR else -SHAFT_TIE
    fits = shaft[place] > shaft[grid.near(label) & ~grid.near(best.rate)].max(initial=-np.inf) + needed
    return [best] if fits else [at_label, best]


def _grid(spectra: LevelSpectra, machine: Given) -> _Grid:
    low, high = machine.rates
    least = min(low, max(WIDER[0] * low, SHORTEST[0] * ZERO_PADDING * spectra.resolution))
    rates = np.exp(np.arange(np.log(least), np.log(WIDER[1] * high), STEP))
    alike = _alike(machine.bearings)
    searched = [_evidence(spectra, machine.bearings[name], rates) for name in alike]
    return _Grid(machine, alike, rates, np.stack([combs for combs, _ in searched]), searched[0][1])


def _evidence(spectra: LevelSpectra, orders: Orders, rates: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Heights of combs, shape (comb, speed), and of the shaft, shape (speed,)."""
    steps = np.arange(-SHAFT_SHIFT, len(rates) + SHAFT_SHIFT)
    factors = np.exp(STEP * steps)
    in_envelope, in_signal = line_orders(_row(orders))
    first = rates[0] / spectra.resolution
    parts = (
        levels_at(spectra.envelope[None], in_envelope * first, factors),
        levels_at(spectra.signal[None], in_signal[None] * first, factors),
    )
    return evidence_of(np.concatenate(parts, axis=1)[0], spectra.windows)


def _row(orders: Orders) -> Orders:
    return Orders(*(np.array([float(order)]) for order in orders))


def _alike(bearings: Mapping[str, Orders]) -> dict[str, list[str]]:
    """Names of bearings whose fault orders differ, and of those with the orders of each."""
    alike: dict[str, list[str]] = {}
    for name, orders in bearings.items():
        own = families(_row(orders))
        same = (other for other in alike if np.abs(families(_row(bearings[other])) / own - 1).max() <= SAME_ORDERS)
        first = next(same, None)
        if first is None:
            alike[name] = []
        else:
            alike[first].append(name)
    return alike


def strange_comb(spectra: LevelSpectra, pair: Pair, lines: Sequence[Line]) -> float | None:
    """Order of a strong comb that belongs neither to the shaft nor to a part of the bearing, None without one.

    It is higher than all combs of the bearing. Multiples of 50 and 60 Hz are left out, where mains can make lines, and
    frequencies that differ from a harmonic of the evidence ``lines`` by a multiple of the shaft rate.
    """
    lowest, highest = np.log(STRANGE_ORDERS)
    # a fine grid in the logarithm, since lines widen with their frequency
    order = np.exp(np.arange(lowest, highest, STEP))
    harmonics = np.array(HARMONICS)[:, None] * order
    places = pair.rate * harmonics[:, :1].T / spectra.resolution
    levels = levels_at(spectra.envelope[None], places, order / order[0])[0]
    width = 4 * spectra.resolution / pair.rate  # half of a main lobe, in orders
    # neither the shaft nor the mains
    free = _off(harmonics, 1.0, width + SHAFT_DRIFT * harmonics)
    for mains in MAINS:
        free &= _off(harmonics, mains / pair.rate, width)
    heights = comb_height(np.where(free, levels, FLOOR), spectra.windows)
    # nor a part of this bearing
    own = np.zeros(len(order), bool)
    for family in np.outer(families(_row(pair.orders))[0], HARMONICS).ravel():
        own |= np.abs(order - family) < TOLERANCE * family
    strange = free[:2].all(axis=0) & ~own
    # nor a sideband of lines that were found
    for line in lines:
        if not line.side:
            beside = [order - harmonic * line.order / line.harmonic for harmonic in HARMONICS]
            strange &= _off(
                np.array(beside), side_of(fault_class(line.fault), pair.orders), width + SHAFT_DRIFT * order
            ).all(axis=0)
    left = np.where(strange, heights, -np.inf)
    place = int(left.argmax())
    # what is left must be stronger than every comb of the bearing
    if left[place] < max(STRONG_COMB, heights[own].max(initial=0.0)):
        return None
    return float(order[place])


def _off(value: FloatArray, unit: float, width: FloatArray | float) -> NDArray[np.bool_]:
    """Whether values are farther than a width from all multiples of a unit."""
    return np.abs(value - unit * np.rint(value / unit)) > width
