"""Records of several parts made together, so that the batches of the kernel are full.

Parts are drawn block after block, and every integration waits until its batch is full: those of records, of their twins, of faults drawn
again and of step checks. Only as many records as fit ``WINDOW_BYTES`` are under way; if all of them wait, the oldest get a batch with idle
lanes. A record does not depend on its batch, so the parts are those that would be made one by one.
"""

from bisect import bisect_right
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.recipe import Recipe
from gen.records import Families, Family, Records, picked
from gen.simulation.batches import Integration, Waiting
from gen.simulation.simulate import step_changes, step_checks
from gen.simulation.steps import has_checks
from gen.simulation.timeline import timeline

WINDOW_BYTES = 64e6  # of a process: signals, scenarios and kernel inputs of the records under way
_RECORD_BYTES = 16_000  # of a record besides its signal
_DRAWN, _JUDGED = 256, 128  # records in a block; functions that take many records at once need some

Report = Callable[[int, int], None]


class MadePart(NamedTuple):
    """Records of one part."""

    place: int
    """Of the part among those that are made."""
    records: Records
    """Accelerations, inputs and twins are not kept."""
    step_error: NDArray[np.float64]
    """As from :func:`gen.simulation.simulate.step_errors`."""


@dataclass(eq=False)
class _Part:
    """A part under way."""

    place: int
    numbers: range
    checked: bool
    rows: dict[int, tuple[Records, int]] = field(default_factory=dict)
    """Records and place in them, by number of the record."""
    simulated: int = 0


@dataclass(eq=False)
class _Pending:
    """Something that follows when some integrations are done."""

    left: int
    then: Callable[[], None]


def made_records(recipe: Recipe, numbers: range) -> Records:
    """Make the records with the given numbers."""
    (made,) = made_parts(recipe, [numbers])
    return made.records


def made_parts(
    recipe: Recipe, parts: Sequence[range], report: Report = lambda _place, _count: None, share: float = 1.0
) -> Iterator[MadePart]:
    """Make the records of parts, each as soon as it is complete.

    Parameters
    ----------
    recipe : Recipe
        The recipe.
    parts : sequence of range
        Numbers of the records of each part, in rising order.
    report : callable
        Called with the place of a part and the number of its records that are simulated.
    share : float
        Of ``WINDOW_BYTES``, for records that are under way at a time.
    """
    yield from _Making(recipe, parts, report, share).made()


class _Making:
    """Records under way."""

    def __init__(self, recipe: Recipe, parts: Sequence[range], report: Report, share: float) -> None:
        self._recipe, self._report = recipe, report
        self._families = Families(recipe)
        self._waiting: Waiting[_Pending] = Waiting(timeline(recipe))
        self._parts = [_Part(place, numbers, has_checks(recipe, numbers)) for place, numbers in enumerate(parts)]
        self._blocks = deque(_blocks(parts, self._families))
        self._window = share * WINDOW_BYTES / _bytes_of_a_record(recipe)
        self._under_way = 0
        self._ready: list[Family] = []
        self._made: deque[MadePart] = deque()

    def made(self) -> Iterator[MadePart]:
        """Parts as they are complete."""
        while True:
            while self._made:
                yield self._made.popleft()
            if sum(len(family.scenarios) for family in self._ready) >= _JUDGED:
                self._judge()
            elif self._waiting.has_full_batch():
                self._count(self._waiting.integrate_fullest())
            elif self._blocks and self._under_way < self._window:
                self._draw()
            elif self._ready:
                self._judge()
            elif self._waiting:
                self._count(self._waiting.integrate_oldest() if self._blocks else self._waiting.integrate_fullest())
            elif self._blocks:
                self._draw()
            else:
                return

    def _draw(self) -> None:
        numbers = self._blocks.popleft()
        self._under_way += sum(self._part_of(number) is not None for number in numbers)
        for family in self._families.drawn(numbers):
            self._wait(family.integrations, lambda family=family: self._simulated(family))

    def _wait(self, integrations: Sequence[Integration], then: Callable[[], None]) -> None:
        """Call ``then`` when integrations are done."""
        if integrations:
            self._waiting.add(integrations, _Pending(len(integrations), then))
        else:
            then()

    def _count(self, done: list[tuple[Integration, _Pending]]) -> None:
        for _, pending in done:
            pending.left -= 1
            if not pending.left:
                pending.then()

    def _simulated(self, family: Family) -> None:
        """A family is simulated for the first time."""
        self._ready.append(family)
        for scenario in family.scenarios:
            part = self._part_of(scenario.record.number)
            if part is not None:
                part.simulated += 1
                self._report(part.place, min(part.simulated, len(part.numbers) - 1))

    def _judge(self) -> None:
        """Measure and judge the families that are ready; those that are final go to their parts."""
        families = sorted(self._ready, key=lambda family: family.scenarios[0].record.number)
        self._ready = []
        made, again = self._families.judged(families)
        made = Records(replace(made.response, twins=None), made.measured)
        redrawn = {scenario.record.number for family in again for scenario in family.scenarios}
        light = _light(made)
        for place, scenario in enumerate(made.measured.scenarios):
            number = scenario.record.number
            part = None if number in redrawn else self._part_of(number)
            if part is not None:
                part.rows[number] = (made if part.checked else light, place)
                if len(part.rows) == len(part.numbers):
                    self._check_steps(part)
        for family in again:
            self._wait(family.integrations, lambda family=family: self._ready.append(family))

    def _check_steps(self, part: _Part) -> None:
        """Let the step checks of a part wait, whose records are final."""
        records = picked([part.rows[number] for number in part.numbers])
        part.rows.clear()
        response = records.response
        finer = step_checks(records.measured.scenarios, self._recipe, response) if part.checked else {}

        def then() -> None:
            self._under_way -= len(part.numbers)
            errors = step_changes(finer, response, self._recipe)
            self._made.append(MadePart(part.place, _light(records), errors))

        self._wait(list(finer.values()), then)

    def _part_of(self, number: int) -> _Part | None:
        """The part that a record belongs to; None for one that is only judged with others."""
        place = bisect_right(self._parts, number, key=lambda part: part.numbers.start) - 1
        return self._parts[place] if place >= 0 and number in self._parts[place].numbers else None


def _blocks(parts: Sequence[range], families: Families) -> Iterator[range]:
    """Numbers of the records that are drawn together: of whole families, none twice."""
    size, drawn = max(_DRAWN // families.size, 1) * families.size, 0
    for part in parts:
        needed = families.numbers(part)
        for first in range(max(needed.start, drawn), needed.stop, size):
            drawn = min(first + size, needed.stop)
            yield range(first, drawn)


def _bytes_of_a_record(recipe: Recipe) -> int:
    stored = 2 if recipe.recording.converter.kind == "adc" else 4
    return _RECORD_BYTES + stored * recipe.n_samples * len(recipe.recording.channels)


def _light(made: Records) -> Records:
    """Records without their accelerations and inputs."""
    count = len(made.measured.scenarios)
    response = replace(made.response, acceleration=np.empty((count, 0, 0), np.float32), inputs=[None] * count)
    return Records(response, made.measured)
