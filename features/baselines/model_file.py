"""Model files: archives of skops, which name the type of every object and contain no code.

A file is read only if skops or this module trusts each type in it, so no code of the file runs. The content of the arrays is not checked:
load only models of people you trust.
"""

import io
import warnings
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

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
    # before memory is taken for it
    check_limit("file_bytes", path.stat().st_size, f"{path}: has", CorpusError)
    return unpack(path.read_bytes(), path)


def unpack(packed: bytes, path: Path | str) -> Any:
    """Objects of an archive; ``path`` is the file that it comes from, and the errors are those of a file."""
    try:
        with warnings.catch_warnings():
            # objects of another scikit-learn may load and predict something else
            warnings.simplefilter("error", InconsistentVersionWarning)
            with zipfile.ZipFile(io.BytesIO(packed)) as archive:
                unpacked = sum(member.file_size for member in archive.infolist())
            check_limit("file_bytes", unpacked, f"{path}: unpacked has", CorpusError)
            return skops.io.loads(packed, trusted=TRUSTED)
    except CorpusError:
        raise
    except UntrustedTypesFoundException as error:
        foreign = sorted(set(skops.io.get_untrusted_types(data=packed)) - set(TRUSTED))
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


def pack(content: Mapping[str, Any]) -> bytes:
    """Archive of the content of a model."""
    return skops.io.dumps(dict(content), compression=zipfile.ZIP_DEFLATED)


def write_model_file(content: Mapping[str, Any], path: Path) -> None:
    """Write a model file, whole or not at all."""
    write_durably(pack(content), path)
