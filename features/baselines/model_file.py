"""Model files: archives of skops, which name the type of every object and contain no code.

A file is read only if skops or this module trusts each type in it, so no code of the file runs. The content of the arrays is not checked:
load only models of people you trust.

skops numbers objects by their address in memory and names arrays at random. `write_model_file` numbers both by their first appearance, so
that equal models give equal bytes in every process.
"""

import io
import json
import warnings
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import skops.io
from sklearn.exceptions import InconsistentVersionWarning
from skops.io.exceptions import UntrustedTypesFoundException

from gen.corpus import write_durably
from gen.support.errors import CorpusError
from gen.support.limits import check_limit

TRUSTED = (
    "features.baselines.estimators.EnvelopeRule",
    "numpy.dtype",
    "sklearn.ensemble._hist_gradient_boosting.predictor.TreePredictor",
    "sklearn.tree._tree.Tree",
    "sklearn.utils._bunch.Bunch",
)
"""Types in the models of Raceway that skops does not trust by itself."""
_SCHEMA = "schema.json"
_SHARED = (
    "ObjectNode",
    "NdArrayNode",
)  # loaders of objects that have several owners, such as the members of an ensemble
_MOMENT = (1980, 1, 1, 0, 0, 0)  # earliest date of the zip format, used for all members


def read_model_file(path: Path) -> Any:
    """Read the objects of a model file.

    Raises
    ------
    CorpusError
        If it is missing, damaged or larger than the limit, names a type that no model of Raceway contains, or was made with another
        version of scikit-learn.
    """
    if not path.is_file():
        reason = "not a file" if path.exists() else "no such file"
        raise CorpusError(f"{path}: {reason}; give a model made with raceway train.")
    check_limit("file_bytes", path.stat().st_size, f"{path}: has", CorpusError)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", InconsistentVersionWarning)
            return skops.io.load(path, trusted=TRUSTED)
    except UntrustedTypesFoundException as error:
        foreign = sorted(set(skops.io.get_untrusted_types(file=path)) - set(TRUSTED))
        raise CorpusError(
            f"{path}: holds {', '.join(foreign)}, which no model of raceway contains; give a model made with raceway train."
        ) from error
    except InconsistentVersionWarning as error:
        raise CorpusError(
            f"{path}: was trained with scikit-learn {error.original_sklearn_version}, and {error.current_sklearn_version} is installed; "
            "train it again with raceway train."
        ) from error
    except Exception as error:  # the readers of zip, JSON and NumPy raise many unrelated types for a damaged file
        reason = (str(error) or type(error).__name__).splitlines()[0]
        raise CorpusError(f"{path}: not a readable model ({reason}); train it again with raceway train.") from error


def write_model_file(content: Mapping[str, Any], path: Path) -> None:
    """Write a model file, whole or not at all; equal objects give equal bytes in any process."""
    with zipfile.ZipFile(io.BytesIO(skops.io.dumps(dict(content)))) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    arrays: dict[bytes, str] = {}
    schema = _renumber(json.loads(members.pop(_SCHEMA)), members, arrays, {})
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_STORED) as archive:
        text = json.dumps(schema, separators=(",", ":")).encode()
        for name, held in {**{name: array for array, name in arrays.items()}, _SCHEMA: text}.items():
            entry = zipfile.ZipInfo(name, _MOMENT)
            entry.create_system = 3  # Unix on every system
            archive.writestr(entry, held)
    write_durably(file.getvalue(), path)


def _renumber(value: Any, members: Mapping[str, bytes], arrays: dict[bytes, str], numbers: dict[Any, int]) -> Any:
    """Part of a schema with its objects and arrays numbered by first appearance.

    Parameters
    ----------
    value
        The part.
    members
        Arrays of the archive by name.
    arrays, numbers
        New name of each array, and new number of each shared object by the number that skops gave it; both are extended.
    """
    if isinstance(value, list):
        return [_renumber(part, members, arrays, numbers) for part in value]
    if not isinstance(value, dict):
        return value
    number = value.get("__id__")
    if number in numbers:
        return {"__id__": numbers[number]}  # skops looks up the number of an object before it reads the rest
    fields = {key: part for key, part in value.items() if key != "__id__"}
    if value.get("__loader__") in _SHARED:
        fields["__id__"] = numbers[number] = len(numbers) + 1
    if fields.get("__loader__") == "NdArrayNode" and fields["type"] == "numpy":
        fields["file"] = arrays.setdefault(_without_padding(members[fields["file"]]), f"{len(arrays)}.npy")
    return {key: _renumber(part, members, arrays, numbers) for key, part in fields.items()}


def _without_padding(content: bytes) -> bytes:
    """The same ``.npy`` file with zeros between the fields of a record, which NumPy leaves uninitialised."""
    array = np.load(io.BytesIO(content), allow_pickle=False)
    if array.dtype.names is None:
        return content
    clean = np.zeros(array.shape, array.dtype)
    for name in array.dtype.names:
        clean[name] = array[name]
    file = io.BytesIO()
    np.save(file, clean, allow_pickle=False)
    return file.getvalue()
