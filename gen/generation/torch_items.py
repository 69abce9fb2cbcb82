"""A stream as the data loader of PyTorch takes it; PyTorch must be installed."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from torch import distributed  # pyright: ignore[reportMissingImports] - an optional package
from torch.utils.data import IterableDataset, get_worker_info  # pyright: ignore[reportMissingImports]

from gen.corpus.choice import operating_variables, per_record
from gen.corpus.where import nearest
from gen.support.errors import RecipeError


class TorchStream(IterableDataset[tuple[Any, ...]]):
    """Records without end, each as its signal and its label; made by :func:`gen.torch_stream`."""

    def __init__(
        self, shard: Callable[..., Iterator[Any]], label: str, operating: bool, transform: Callable[..., Any] | None
    ) -> None:
        self.shard, self.label, self.operating, self.transform = shard, label, operating, transform

    def __iter__(self) -> Iterator[tuple[Any, ...]]:
        """Yield the records of this worker of the data loader, on this rank: no other worker of any rank has one of them."""
        worker = get_worker_info()
        place, count = (0, 1) if worker is None else (worker.id, worker.num_workers)
        if distributed.is_available() and distributed.is_initialized():
            # workers of the loader within ranks of the training
            place, count = distributed.get_rank() * count + place, distributed.get_world_size() * count
        for records in self.shard(shard=place, shards=count):
            if self.label not in records:
                raise RecipeError(f"label: there is no variable {self.label}{nearest(self.label, per_record(records))}")
            variables = operating_variables(records) if self.operating else {}
            for place, (signal, label) in enumerate(
                zip(records["acceleration"].values, records[self.label].values, strict=True)
            ):
                on_site = (
                    [{name: _plain(values[place]) for name, values in variables.items()}] if self.operating else []
                )
                whole = signal.astype(np.float32, copy=False)
                yield whole if self.transform is None else self.transform(whole, *on_site), *on_site, _plain(label)


def _plain(value: Any) -> Any:
    """A number in single precision, as the signals are; a code or a text as it is in Python."""
    array = np.asarray(value)
    return np.float32(array) if array.dtype.kind == "f" else array.item()
