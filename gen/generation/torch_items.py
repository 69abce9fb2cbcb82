"""A stream as the data loader of PyTorch takes it; PyTorch must be installed."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from torch import distributed  # pyright: ignore[reportMissingImports] - an optional package
from torch.utils.data import IterableDataset, get_worker_info  # pyright: ignore[reportMissingImports]

from gen.support.errors import RecipeError


class TorchStream(IterableDataset[tuple[Any, Any]]):
    """Records without end, each as its signal and its label; made by :func:`gen.torch_stream`."""

    def __init__(self, shard: Callable[..., Iterator[Any]], label: str, transform: Callable[[Any], Any] | None) -> None:
        self.shard, self.label, self.transform = shard, label, transform

    def __iter__(self) -> Iterator[tuple[Any, Any]]:
        """Yield the records of this worker of the data loader, on this rank: no other worker of any rank has one of them."""
        worker = get_worker_info()
        place, count = (0, 1) if worker is None else (worker.id, worker.num_workers)
        if distributed.is_available() and distributed.is_initialized():
            place, count = distributed.get_rank() * count + place, distributed.get_world_size() * count
        for records in self.shard(shard=place, shards=count):
            if self.label not in records:
                raise RecipeError(f"label: there is no variable {self.label}; gen.stream shows what a record has.")
            for signal, label in zip(records["acceleration"].values, records[self.label].values, strict=True):
                whole = signal.astype(np.float32, copy=False)
                yield whole if self.transform is None else self.transform(whole), label.item()
