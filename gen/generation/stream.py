"""Records without end, straight into training: drawn, simulated and measured as they are needed, and none of them twice.

The records are those that :func:`gen.generate` makes of the same recipe, from the first on, and beyond its last one those of further rigs.
They are made in the parts of its corpus, in this process or in several, and come out in the order of their numbers.
"""

import warnings
from collections.abc import Callable, Generator, Iterator, Mapping
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import xarray as xr

from gen.drawing import Grid, quantities, sections_with_places
from gen.generation.compilation import compile_kernels
from gen.generation.identity import failures_of
from gen.generation.make_part import decoded, joined, make_part
from gen.recipe import Recipe, read_recipe
from gen.support.errors import RecipeError, SimulationError
from gen.support.executor import run, too_many

if TYPE_CHECKING:
    from gen.generation.torch_items import TorchStream

_LAST = 2**31 - 1  # number of a record


def stream(
    recipe: Path | str | Mapping[str, Any] | Recipe,
    *,
    batch: int = 64,
    workers: int = 1,
    seed: int | None = None,
    start: int = 0,
    notice: Callable[[str], None] = lambda _: None,
) -> "Stream":
    """Batches of fresh records of a recipe, without end.

    Parameters
    ----------
    recipe : path, str, mapping or Recipe
        As for :func:`gen.read_recipe`. Its ``records`` and the number of its rigs do not end the stream.
    batch : int
        Number of records of a batch.
    workers : int
        Number of processes that make records; 1 is this one.
    seed : int, optional
        Replaces that of the recipe.
    start : int
        Number of the first record.
    notice : callable, optional
        Called with a sentence when a kernel is about to be compiled, ahead of the first batch.

    Returns
    -------
    Stream
        Iterator of Datasets with the variables of a corpus: ``acceleration (record, channel, elapsed_time)`` in single precision [m s-2],
        labels and what is known on site. ``identity`` names each record, and ``gen.simulate(gen.read_scenarios(batch))`` makes it again.

    Raises
    ------
    RecipeError
        If the recipe cannot be simulated or has an end by nature (grids, quasi-random points), or a number is not allowed.
    ClusterError
        From the iterator, if a process ends before the stream does.
    SimulationError
        From the iterator, if no record of a part can be simulated.

    Examples
    --------
    >>> for batch in stream("domain_randomised", workers=4):  # doctest: +SKIP
    ...     train(batch["acceleration"].values, batch["fault"].values)
    """
    fresh = endless(read_recipe(recipe, seed=seed))
    for name, value, least in (("batch", batch, 1), ("workers", workers, 1), ("start", start, 0)):
        _check_number(name, value, least, fresh.n_records - 1)
    if (sentence := too_many(workers)) is not None:
        warnings.warn(sentence, stacklevel=2)
    return Stream(fresh, batch, workers, start, notice)


def torch_stream(
    recipe: Path | str | Mapping[str, Any] | Recipe,
    *,
    label: str = "fault",
    operating: bool = False,
    transform: Callable[..., Any] | None = None,
    seed: int | None = None,
    start: int = 0,
    notice: Callable[[str], None] = lambda _: None,
) -> "TorchStream":
    """Fresh records of a recipe without end, for the data loader of PyTorch.

    ``DataLoader(gen.torch_stream("domain_randomised"), batch_size=64, num_workers=2)`` works as it is. Each item is a pair: the signal in
    single precision, shape (channel, elapsed_time) [m s-2], and the label. The workers of the loader, and the ranks of
    ``torch.distributed``, share the records out among them; none of them is made twice.

    Parameters
    ----------
    recipe, seed, start, notice :
        As for :func:`gen.stream`.
    label : str
        Per-record variable that is the label; a class such as ``fault`` gives its code.
    operating : bool
        Gives each item, between signal and label, what is known on site: shaft rate, nominal orders and more by name, which the loader
        makes a tensor each.
    transform : callable, optional
        Called with each signal, and with what is known on site if ``operating`` asks for it, in the process that makes them; gives the
        signal of the item.

    Raises
    ------
    RecipeError
        As from :func:`gen.stream`; or if PyTorch is not installed.
    """
    try:
        from gen.generation.torch_items import TorchStream
    except ModuleNotFoundError:
        raise RecipeError(
            "torch_stream: needs PyTorch, which is not installed; install torch, or use gen.stream."
        ) from None
    fresh = endless(read_recipe(recipe, seed=seed))
    compile_kernels(fresh, notice)  # once, ahead of the workers of the loader
    return TorchStream(partial(records_from, fresh, start), label, operating, transform)


class Stream(Iterator[xr.Dataset]):
    """Batches of records; made by :func:`stream`. It is closed when it ends its ``with`` block, or is no longer used.

    ``next_record`` is the number of the record that comes next: with it as ``start``, another stream goes on from here.
    """

    def __init__(self, recipe: Recipe, batch: int, workers: int, start: int, notice: Callable[[str], None]) -> None:
        self.recipe, self.batch, self.workers, self.notice = recipe, batch, workers, notice
        self.next_record = start
        self._batches: Generator[xr.Dataset] | None = None

    def __repr__(self) -> str:
        """Name of the recipe, and the next record."""
        return f"Stream of {self.recipe.name}: batches of {self.batch} records, next record {self.next_record}"

    def __next__(self) -> xr.Dataset:
        """Return the next batch."""
        if self._batches is None:
            compile_kernels(self.recipe, self.notice)
            self._batches = _batches(self.recipe, self.next_record, self.batch, self.workers)
        try:
            batch = next(self._batches)
        except BaseException:
            self.close()  # the next batch, if one is asked for, begins with the same record
            raise
        self.next_record = int(batch["recording"].values[-1]) + 1
        return batch

    def close(self) -> None:
        """End the workers; the next batch would start others."""
        if self._batches is not None:
            self._batches.close()
        self._batches = None

    def __enter__(self) -> Self:
        """Return the stream."""
        return self

    def __exit__(self, *_: object) -> None:
        """End the workers."""
        self.close()


def _batches(recipe: Recipe, first: int, size: int, workers: int) -> Generator[xr.Dataset]:
    """Records from the number ``first`` on, ``size`` at a time."""
    with closing(records_from(recipe, first, workers=workers)) as parts:
        ready: list[xr.Dataset] = []
        for records in parts:
            ready.append(records)
            if (count := sum(some.sizes["record"] for some in ready)) < size:
                continue
            whole = joined(ready)
            for start in range(0, count - size + 1, size):
                yield whole.isel(record=slice(start, start + size))
            ready = [whole.isel(record=slice(count - count % size, None))]


def _check_number(name: str, value: object, least: int, most: int) -> None:
    if type(value) is not int or not least <= value <= most:
        raise RecipeError(f"{name}: {value!r} is not allowed; give a whole number from {least} to {most:,}.")


def endless(recipe: Recipe) -> Recipe:
    """The recipe with as many records as numbers allow; RecipeError if it has an end by nature."""
    if recipe.corpus.sampling != "random":
        raise RecipeError(
            f"corpus.sampling: {recipe.corpus.sampling} covers a number of records, and a stream has no end; use random."
        )
    if recipe.origin is not None:
        raise RecipeError("origin: is that of one record, and a stream has no end; leave it out, or use gen.generate.")
    # values of a grid are taken in turn by number, and end
    for place, section in sections_with_places(recipe):
        for key, quantity in quantities(section).items():
            if isinstance(quantity, Grid):
                raise RecipeError(
                    f"{place}.{key}: a grid is finite, and a stream has no end; use choice, or gen.generate."
                )
    return recipe.model_copy(update={"records": _LAST // recipe.corpus.n_rungs * recipe.corpus.n_rungs})


def records_from(
    recipe: Recipe, first: int, *, workers: int = 1, shard: int = 0, shards: int = 1
) -> Generator[xr.Dataset]:
    """Records from the number ``first`` on, in rising order, a part at a time: every ``shards``-th part, beginning with ``shard``."""
    parts, warned = range(first // recipe.storage.records_per_part, recipe.n_parts)[shard::shards], False
    with closing(run(partial(make_part, recipe), map(recipe.records_of_part, parts), workers)) as results:
        # a part at a time, so that memory does not grow with the stream
        for part in results:
            failures = failures_of(part)
            if not part.sizes["record"]:
                raise SimulationError(failures[0])
            if failures and not warned:
                warnings.warn(f"some records are left out; the first: {failures[0]}", stacklevel=3)
                warned = True
            records = decoded([part])
            yield records.isel(record=records["recording"].values >= first)
