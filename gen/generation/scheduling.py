"""Records of several parts made together, so that the batches of the kernel are full.

Parts are drawn block after block, and every integration waits until its batch is full: those of records, of their twins, of faults drawn
again and of step checks. Only so many records are drawn beyond the first part that is not complete; if all of them wait, the oldest get a
batch that is not full. A record does not depend on its batch, so the parts are those that would be made one by one.
"""

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import count, islice
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from gen.generation.step_checks import has_checks, step_changes, step_checks
from gen.generation.undetected import Families, Family, MadeRecords, pick
from gen.recipe import Recipe
from gen.scenarios import settings_of
from gen.simulation.batches import Integration, Waiting, integrate_together
from gen.simulation.simulate import open_integrations
from gen.simulation.timeline import timeline

# Records under way. 1,800 records of domain_randomised take 4 % longer with 500 than with 1000, and 1 % with 600; but the first part of
# 300 records is complete after 35 % of the time with 600, and after 52 % with 1000.
WINDOW_RECORDS = 600
WINDOW_BYTES = 64e6  # of a process: signals, scenarios and kernel inputs of the records under way
_RECORD_BYTES = 16_000  # of a record besides its signal
_DRAWN, _JUDGED = 128, 64  # records in a block; functions that take many records at once need some


class MadePart(NamedTuple):
    """Records of one part."""

    place: int
    """Of the part among those that are made."""
    records: MadeRecords
    step_error: NDArray[np.float64]
    """As from :func:`gen.generation.step_checks.step_changes`."""


STAGES = ("draw", "integrate", "measure", "check", "write")

Result = TypeVar("Result")


@dataclass(eq=False)
class _Part:
    """A part under way."""

    place: int
    numbers: range
    checked: bool
    finished: bool = False
    rows: dict[int, tuple[MadeRecords, int]] = field(default_factory=dict)
    """Final records: each by its number, as a place in records that were measured together."""
    absent: int = 0
    """Records that a life does not have because it has ended."""


@dataclass(eq=False)
class _Pending:
    """A call that follows when some integrations are done."""

    left: int
    then: Callable[[], None]


def make_records(recipe: Recipe, numbers: range) -> MadeRecords:
    """Make the records with the given numbers."""
    (records,) = made_parts(recipe, [numbers], lambda made: made.records)
    return records


def made_parts(recipe: Recipe, parts: Iterable[range], finish: Callable[[MadePart], Result]) -> Iterator[Result]:
    """Make the records of parts; yields the result of ``finish`` for each, in the order in which they are complete.

    Parameters
    ----------
    recipe : Recipe
        The recipe.
    parts : iterable of range
        Numbers of the records of each part, in rising order; they may have no end.
    finish : callable
        Called with each part.
    """
    making = Making(recipe, parts, finish)
    while (step := making.next_step()) is not None:
        yield from step.do()


class Step(NamedTuple):
    """Some work on records under way."""

    stage: str
    """One of ``STAGES``."""
    do: Callable[[], Iterable[Any]]
    """Does it; returns the results of parts that are finished."""
    per_sample: int = 0
    """Steps of the kernel in a sample, summed over the records that are integrated."""


class Making(Generic[Result]):
    """Records under way, on which one step after the other is done."""

    def __init__(self, recipe: Recipe, parts: Iterable[range], finish: Callable[[MadePart], Result]) -> None:
        self._recipe, self._finish = recipe, finish
        self._families = Families(recipe)
        self._waiting: Waiting[_Pending] = Waiting()
        self._parts: dict[int, _Part] = {}
        """Those from the first on that is not finished, by their places, which rise."""
        self._blocks = self._blocks_of(parts)
        self._block = next(self._blocks, None)
        self._window = min(WINDOW_RECORDS, WINDOW_BYTES / _bytes_of_a_record(recipe))
        self._ready: list[Family] = []
        self._complete: deque[_Part] = deque()
        self._checked: deque[MadePart] = deque()

    def next_step(self) -> Step | None:
        """The next step: what completes parts, then full batches, then new records; a batch that is not full if nothing else is left."""
        if self._checked:
            return Step("write", partial(self._write, self._checked.popleft()))
        if self._complete:
            return Step("check", partial(self._check_steps, self._complete.popleft()))
        if sum(len(family) for family in self._ready) >= _JUDGED:
            return Step("measure", self._judge)
        if self._waiting.has_full_batch():
            return self._integration(self._waiting.fullest())
        if self._block is not None and self._under_way(self._block) < self._window:
            return Step("draw", partial(self._draw, self._block))
        if self._ready:
            return Step("measure", self._judge)
        if self._waiting:
            return self._integration(self._waiting.fullest() if self._block is None else self._waiting.oldest())
        return None if self._block is None else Step("draw", partial(self._draw, self._block))

    def _integration(self, taken: list[tuple[Integration, _Pending]]) -> Step:
        return Step("integrate", partial(self._integrate, taken), sum(one.group.steps for one, _ in taken))

    def _under_way(self, block: range) -> int:
        """Number of records that were drawn ahead of a block, from the first part on that is not finished."""
        return sum(max(0, min(part.numbers.stop, block.start) - part.numbers.start) for part in self._parts.values())

    def _draw(self, numbers: range) -> Iterable[Result]:
        """Draw the next records."""
        self._block = next(self._blocks, None)
        families = self._families.draw(numbers)
        drawn = {run.scenario.record.number for family in families for run in family}
        for part in filter(None, map(self._part_of, {*numbers} - drawn)):
            part.absent += 1
        self._open(families)
        return ()

    def _open(self, families: list[Family]) -> None:
        """Let the integrations of families wait, which are judged after them."""
        for family in families:
            self._wait(open_integrations(family), partial(self._ready.append, family))

    def _integrate(self, taken: list[tuple[Integration, _Pending]]) -> Iterable[Result]:
        """Integrate one batch."""
        integrate_together([one for one, _ in taken], timeline(settings_of(self._recipe)))
        for _, pending in taken:
            pending.left -= 1
            if not pending.left:
                pending.then()
        return ()

    def _judge(self) -> Iterable[Result]:
        """Measure and judge families; those that are final go to their parts."""
        families = sorted(self._ready, key=lambda family: family[0].scenario.record.number)
        self._ready.clear()
        made, again = self._families.judge(families)
        made = MadeRecords(replace(made.response, twins=[]), made.measured)
        redrawn = {run.scenario.record.number for family in again for run in family}
        for part, rows in self._final(made, redrawn):
            # copies, so that no part holds the accelerations of another
            piece = pick([(made if part.checked else _light(made), place) for place, _ in rows])
            part.rows |= {number: (piece, place) for place, (_, number) in enumerate(rows)}
            if len(part.rows) + part.absent == len(part.numbers):
                self._complete.append(part)
        self._open(again)
        return ()

    def _final(self, made: MadeRecords, redrawn: set[int]) -> list[tuple[_Part, list[tuple[int, int]]]]:
        """Place and number of the records of each part that are not drawn again."""
        final: dict[_Part, list[tuple[int, int]]] = {}
        for place, scenario in enumerate(made.measured.scenarios):
            number = scenario.record.number
            part = None if number in redrawn else self._part_of(number)
            if part is not None:
                final.setdefault(part, []).append((place, number))
        return list(final.items())

    def _check_steps(self, part: _Part) -> Iterable[Result]:
        """Let the step checks of a part wait whose records are final; it is written after them."""
        records = pick([part.rows[number] for number in part.numbers if number in part.rows])
        part.rows.clear()
        scenarios, response = records.measured.scenarios, records.response
        finer = step_checks(scenarios, self._recipe, response) if part.checked else {}

        def then() -> None:
            errors = step_changes(finer, response, self._recipe)
            self._checked.append(MadePart(part.place, _light(records), errors))

        self._wait(open_integrations(finer.values()), then)
        return ()

    def _write(self, made: MadePart) -> Iterable[Result]:
        result = self._finish(made)
        self._parts[made.place].finished = True
        while self._parts and next(iter(self._parts.values())).finished:
            del self._parts[next(iter(self._parts))]
        return (result,)

    def _wait(self, integrations: Sequence[Integration], then: Callable[[], None]) -> None:
        """Call ``then`` when integrations are done."""
        if integrations:
            self._waiting.add(integrations, _Pending(len(integrations), then))
        else:
            then()

    def _part_of(self, number: int) -> _Part | None:
        """The part that a record belongs to; None for one that is only judged with others."""
        return next((part for part in self._parts.values() if number in part.numbers), None)

    def _blocks_of(self, parts: Iterable[range]) -> Iterator[range]:
        """Numbers of the records that are drawn together: of whole families, none twice. Their parts are known before they are drawn."""
        size, drawn = max(_DRAWN // self._families.size, 1) * self._families.size, 0
        known, coming = map(self._add_part, count(), parts), deque[range]()
        coming.extend(islice(known, 1))
        while coming:
            needed = self._families.numbers(coming.popleft())
            while (not coming or coming[-1].stop < needed.stop) and (further := next(known, None)) is not None:
                coming.append(further)
            for start in range(max(needed.start, drawn), needed.stop, size):
                drawn = min(start + size, needed.stop)
                yield range(start, drawn)

    def _add_part(self, place: int, numbers: range) -> range:
        self._parts[place] = _Part(place, numbers, has_checks(self._recipe, numbers))
        return numbers


def _bytes_of_a_record(recipe: Recipe) -> int:
    stored = 2 if recipe.recording.converter.kind == "adc" else 4
    return _RECORD_BYTES + stored * recipe.n_samples * len(recipe.recording.channels)


def _light(made: MadeRecords) -> MadeRecords:
    """Records without their accelerations and inputs."""
    count = len(made.measured.scenarios)
    response = replace(made.response, acceleration=np.empty((count, 0, 0), np.float32), inputs=[None] * count)
    return MadeRecords(response, made.measured)
