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
NODES = ("children_left", "children_right", "feature", "threshold")


class PlainModel(NamedTuple):
    """Facts of a model, medians that replace missing features, nodes of all trees, and logistic regression of scaled features.

    The roots are those of the trees, a leaf has no children (-1), and ``shares`` are those of the classes at each node.
    """

    name: str
    classes: tuple[str, ...]
    features: tuple[str, ...]
    groups: tuple[str, ...]
    band: tuple[float, float]
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
        held: dict[str, Any] = {name: getattr(model, name) for name in (*TEXTS, "band", "calibration")}
        held |= {"weights": np.array(model.estimator.weights, float), "medians": imputer.statistics_}
        held |= {"nodes": nodes, "roots": roots[:-1], "shares": shares}
        held |= {"mean": scaler.mean_, "scale": scaler.scale_}
        return cls(**held, slopes=regression.coef_, intercept=regression.intercept_)

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
        facts: dict[str, Any] = self._asdict() | {"calibration": self.calibration.model_dump_json()}
        nodes = facts.pop("nodes")
        file = io.BytesIO()
        np.savez(file, **facts, **nodes)
        write_durably(file.getvalue(), path)

    @classmethod
    def read(cls, path: Path) -> Self | None:
        """Model of a file, None if it is missing, damaged or of another version."""
        try:
            with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as file:
                held: dict[str, Any] = dict(file)
            held["nodes"] = {name: held.pop(name) for name in NODES}
            held |= {name: tuple(held[name].tolist()) for name in (*TEXTS[1:], "band")}
            held |= {
                "name": str(held["name"]),
                "calibration": Calibration.model_validate_json(str(held["calibration"])),
            }
            return cls(**held)
        except (OSError, ValueError, EOFError, KeyError, TypeError, AttributeError, zipfile.BadZipFile):
            return None
