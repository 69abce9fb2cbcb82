"""The ensemble of a model as arrays, which predict the same bits without scikit-learn: importing it takes two seconds.

``Model -> PlainModel -> file of NumPy arrays``
"""

import io
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np
from scipy.special import softmax

from features.baselines.calibration import Calibration
from features.signal.rows import FloatArray
from gen.corpus import write_durably

if TYPE_CHECKING:
    from features.baselines.models import Model

TEXTS = ("name", "classes", "features", "groups")
SHORTER = "shorter_"
NUMBERS = ("band", "durations")
NODES = ("children_left", "children_right", "feature", "threshold")


class PlainModel(NamedTuple):
    """Facts of a model, medians that replace missing features, nodes of all trees, and logistic regression of scaled features.

    The roots are those of the trees, a leaf has no children (-1), and ``shares`` are those of the classes at each node. ``shorter`` is
    the same for shorter records.
    """

    name: str
    classes: tuple[str, ...]
    features: tuple[str, ...]
    groups: tuple[str, ...]
    band: tuple[float, float]
    durations: tuple[float, ...]
    calibration: Calibration
    weights: FloatArray
    medians: FloatArray
    nodes: dict[str, Any]
    roots: Any
    shares: FloatArray
    mean: FloatArray
    scale: FloatArray
    slopes: FloatArray
    intercept: FloatArray
    shorter: "PlainModel | None" = None

    @classmethod
    def of(cls, model: "Model") -> Self:
        """The arrays of a fitted ensemble."""
        (imputer, forest), (_, scaler, regression) = (
            [step for _, step in one.steps] for one in model.estimator.estimators_
        )
        trees = [one.tree_ for one in forest.estimators_]
        roots = np.cumsum([0, *(tree.node_count for tree in trees)])
        nodes = {name: np.concatenate([getattr(tree, name) for tree in trees]) for name in NODES}
        for name in NODES[:2]:
            first = np.repeat(roots[:-1], np.diff(roots))
            nodes[name] = np.where(nodes[name] < 0, -1, nodes[name] + first)
        shares = np.concatenate([tree.value[:, 0] for tree in trees])
        held: dict[str, Any] = {name: getattr(model, name) for name in (*TEXTS, *NUMBERS, "calibration")}
        held |= {"weights": np.array(model.estimator.weights, float), "medians": imputer.statistics_}
        held |= {"nodes": nodes, "roots": roots[:-1], "shares": shares}
        held |= {"mean": scaler.mean_, "scale": scaler.scale_}
        held |= {"slopes": regression.coef_, "intercept": regression.intercept_}
        return cls(**held, shorter=None if model.shorter is None else cls.of(model.shorter))

    def probabilities(self, rows: FloatArray) -> FloatArray:
        """Probability of each class before calibration, shape (record, feature) to (record, class)."""
        filled = np.where(np.isnan(rows), self.medians, rows)
        single, row = filled.astype(np.float32), np.arange(len(rows))[:, None]
        left, right, feature, threshold = (self.nodes[name] for name in NODES)
        place = np.broadcast_to(self.roots, (len(rows), len(self.roots)))
        while (left[place] >= 0).any():
            below = np.where(single[row, feature[place]] <= threshold[place], left[place], right[place])
            place = np.where(left[place] < 0, place, below)
        forest = np.zeros((len(rows), len(self.classes)))
        for tree in range(len(self.roots)):  # added one after the other, as scikit-learn does
            forest += self.shares[place[:, tree]]
        regression = softmax((filled - self.mean) / self.scale @ self.slopes.T + self.intercept, axis=1)
        return np.average([forest / len(self.roots), regression], axis=0, weights=self.weights)

    def save(self, path: Path) -> None:
        """Write a file of arrays, whole or not at all."""
        file = io.BytesIO()
        np.savez(file, **_arrays(self))
        write_durably(file.getvalue(), path)

    @classmethod
    def read(cls, path: Path) -> Self | None:
        """Model of a file, None if it is missing, damaged or of another version."""
        try:
            with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as file:
                return cls._read(dict(file))
        except (OSError, ValueError, EOFError, KeyError, TypeError, AttributeError, zipfile.BadZipFile):
            return None

    @classmethod
    def _read(cls, arrays: dict[str, Any]) -> Self:
        held = {name: array for name, array in arrays.items() if not name.startswith(SHORTER)}
        its = {name.removeprefix(SHORTER): array for name, array in arrays.items() if name not in held}
        held["nodes"] = {name: held.pop(name) for name in NODES}
        held |= {name: tuple(held[name].tolist()) for name in (*TEXTS[1:], *NUMBERS)}
        held |= {"name": str(held["name"]), "calibration": Calibration.model_validate_json(str(held["calibration"]))}
        return cls(**held, shorter=cls._read(its) if its else None)


def _arrays(model: PlainModel) -> dict[str, Any]:
    """Arrays of a file by their name."""
    facts: dict[str, Any] = model._asdict() | {"calibration": model.calibration.model_dump_json()}
    nodes, shorter = facts.pop("nodes"), facts.pop("shorter")
    its = {} if shorter is None else _arrays(shorter)
    return facts | nodes | {f"{SHORTER}{name}": array for name, array in its.items()}
