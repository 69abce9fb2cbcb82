"""Schema of a corpus: dimensions, variables, units and roles.

``acceleration (record, channel, elapsed_time)`` is the signal. Every other variable has one value per record and a ``role``:
``operating`` (known to an analyst on site), ``label`` (the target of a classifier), ``latent`` (known to the simulator alone) or
``provenance`` (origin of the record). Features may use the signal and ``operating`` variables only.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from operator import attrgetter
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gen.corpus.fault_classes import FAULT_NAMES, file_codes, own_codes
from gen.support.errors import CorpusError

if TYPE_CHECKING:
    import xarray as xr

FORMAT = 4
SPLITS = ("train", "validation", "test")
ROLES = ("operating", "label", "latent", "provenance")
_CONTENT_OF_ROLES = {  # words of ISO 19115-1 in the attribute coverage_content_type of ACDD 1.3
    "operating": "auxiliaryInformation",
    "label": "referenceInformation",
    "latent": "referenceInformation",
    "provenance": "auxiliaryInformation",
}
SIGNAL = "acceleration"
RECIPE_TEXT = "recipe_text"  # global attribute with the recipe of all records, as YAML
DRAWS = "draws"  # variable of simulated corpora: the scenario of a record, as JSON of some kilobytes
IDENTITY = (
    "identity"  # joined corpora get new numbers from it, so that a machine has the same number in all of their records
)
SIGNAL_DIMS = ("record", "channel", "elapsed_time")
_RATES = ("shaft_rate", "load", "ftf", "bpfo", "bpfi", "bsf")
_HIGHEST = 1e8
NAMED = ("fault", "split")  # variables whose classes opened records have as words too, in NAME_name
MISSING_COUNT = -32768  # count of a missing sample (_FillValue); the converter never gives it


class Variable(NamedTuple):
    """One per-record variable, declared once: in the format, or beside the stage or mechanism that knows its value."""

    name: str
    dtype: str
    units: str
    role: str
    long_name: str
    value: Callable[[Any], Any] | None = None
    """Value of a record, from what its stage or mechanism knows of the record; None if it has the name of the variable there."""
    flags: Mapping[int, str] = {}
    """Names of the values of a class by their codes."""

    def column(self, records: Iterable[Any]) -> list[Any]:
        """Value of each record, NaN for None."""
        value = self.value or attrgetter(self.name)
        return [np.nan if (number := value(record)) is None else number for record in records]


SCHEMA = (
    Variable("shaft_rate", "f8", "Hz", "operating", "shaft rate as labelled on the machine"),
    Variable("sample_rate", "f8", "Hz", "operating", "sample rate"),
    Variable("load", "f8", "N", "operating", "radial load as labelled on the machine, NaN if unknown"),
    Variable("ftf", "f8", "1", "operating", "nominal fundamental train frequency in shaft orders"),
    Variable("bpfo", "f8", "1", "operating", "nominal ball pass frequency of the outer race in shaft orders"),
    Variable("bpfi", "f8", "1", "operating", "nominal ball pass frequency of the inner race in shaft orders"),
    Variable("bsf", "f8", "1", "operating", "nominal ball spin frequency in shaft orders"),
    Variable("bearing", "str", "1", "operating", "designation of the bearing"),
    Variable("fault", "i1", "1", "label", "fault class", flags=FAULT_NAMES),
    Variable("n_spalls", "i2", "1", "label", "number of spalls, -1 if unknown"),
    Variable(
        "width",
        "f8",
        "m",
        "label",
        "width of the widest spall along the rolling direction, 0 if healthy, NaN if unknown",
    ),
    Variable("depth", "f8", "m", "label", "depth of the widest spall, 0 if healthy, NaN if unknown"),
    Variable(
        "angle",
        "f8",
        "rad",
        "label",
        "angle of the widest spall on its race or ball, outer race counter-clockwise from x, NaN if healthy or unknown",
    ),
    Variable("rig", "i4", "1", "provenance", "number of the machine"),
    Variable("specimen", "i4", "1", "provenance", "number of the physical bearing"),
    Variable("recording", "i4", "1", "provenance", "number of the recording that the record was cut from"),
    Variable("split", "i1", "1", "provenance", "split that the record belongs to", flags=dict(enumerate(SPLITS))),
    Variable("source", "str", "1", "provenance", "file or recipe that the record comes from, and its place there"),
    Variable(
        IDENTITY,
        "str",
        "1",
        "provenance",
        "corpus that numbered the record first, and its rig, specimen, recording and pair there, with slashes between",
    ),
)


def identity(corpus: str, rig: int, specimen: int, recording: int, pair: int = -1) -> str:
    """Identity of a record, which stays when joined corpora get new numbers.

    >>> identity("0123456789ab", 0, 3, 7)
    '0123456789ab/0/3/7/-1'
    """
    return f"{corpus}/{rig}/{specimen}/{recording}/{pair}"


def signal_attributes(counts_per_unit: float | None) -> dict[str, Any]:
    """Attributes of the signal; with ``counts_per_unit``, also those for the conversion of counts to m s-2 (CF-1.11, section 8.1).

    Readers decode to the type of scale factor and offset. In single precision a count times the factor has a relative error of 6e-8, less
    than a hundredth of a count, so the counts come back when the signal is divided by the factor and rounded.
    """
    attributes: dict[str, Any] = {
        "units": "m s-2",
        "long_name": "acceleration of the sensor",
        "role": "signal",
    }
    if counts_per_unit is not None:
        attributes |= {
            "scale_factor": np.float32(1.0 / counts_per_unit),
            "add_offset": np.float32(0.0),
            "_FillValue": np.int16(MISSING_COUNT),
        }
    return attributes


def variable_attributes(variable: Variable) -> dict[str, Any]:
    """Attributes of a per-record variable, with CF flags for a class."""
    attributes: dict[str, Any] = {
        "units": variable.units,
        "long_name": variable.long_name,
        "role": variable.role,
    }
    attributes["coverage_content_type"] = (
        "thematicClassification" if variable.flags else _CONTENT_OF_ROLES[variable.role]
    )
    if variable.flags:
        attributes["flag_values"] = np.array([*variable.flags], dtype=variable.dtype)
        attributes["flag_meanings"] = " ".join(variable.flags.values())
    return attributes


def stored_unit(attributes: Mapping[Any, Any]) -> str:
    """Stored unit of a variable; that of a level in decibels is stored as 1, because CF has no unit for it.

    >>> stored_unit({"units": "m"}), stored_unit({"units": "1", "long_name": "bearing over background in decibels re 1"})
    ('m', 'dB')
    """
    in_decibels = "decibels" in str(attributes.get("long_name"))
    return "dB" if in_decibels else str(attributes.get("units", "1"))


def class_names(attributes: Mapping[Any, Any]) -> dict[int, str]:
    """Names of the values of a class by their codes, from the attributes of its variable; empty for other variables.

    >>> class_names({"flag_values": [0, 1], "flag_meanings": "train test"}), class_names({"units": "m"})
    ({0: 'train', 1: 'test'}, {})
    """
    codes = [int(code) for code in np.atleast_1d(attributes.get("flag_values", []))]
    return dict(zip(codes, str(attributes.get("flag_meanings", "")).split(), strict=False))


def with_own_codes(records: "xr.Dataset", place: object) -> "xr.Dataset":
    """Records or features of a file with the codes of ``fault`` in this process; they are read now if those of the file are others.

    Raises
    ------
    CorpusError
        If a record is of a class that this process does not have.
    """
    fault = records.variables.get("fault")
    if fault is None or fault.dtype.kind != "i" or not {"flag_values", "flag_meanings"} <= fault.attrs.keys():
        return records
    try:
        names = class_names(fault.attrs)
    except (ValueError, OverflowError):
        return records  # refused by the check of the format
    if names == FAULT_NAMES:
        return records
    return _with_codes(records, own_codes(fault.values, names, place, records.attrs), FAULT_NAMES)


def with_file_codes(records: "xr.Dataset", further: Sequence[str]) -> "xr.Dataset":
    """Records with the codes that ``fault`` has in a file whose ``further`` classes of plug-ins follow the built-in ones."""
    codes, names = file_codes(records["fault"].values, further)
    return records if names == FAULT_NAMES else _with_codes(records, codes, names)


def _with_codes(records: "xr.Dataset", codes: NDArray[Any], names: Mapping[int, str]) -> "xr.Dataset":
    fault = records["fault"]
    (variable,) = (variable for variable in SCHEMA if variable.name == "fault")
    return records.assign(fault=(fault.dims, codes, fault.attrs | variable_attributes(variable._replace(flags=names))))


def add_class_names(records: "xr.Dataset") -> None:
    """Add the coordinates ``fault_name`` and ``split_name``: classes in words, which no corpus holds and which have no role.

    Raises
    ------
    CorpusError
        If a code has no name, since records in memory were changed.
    """
    for name in NAMED:
        codes, names = records[name], class_names(records[name].attrs)
        if codes.dtype.kind not in "iu" or not np.isin(codes, [*names]).all():
            raise CorpusError(
                f"{name}: is no code with a name, since where and drop_attrs of xarray change variables; choose records with isel or sel."
            )
        words = np.array([names.get(code, "") for code in range(max(names) + 1)])
        records.coords[f"{name}_name"] = (
            codes.dims,
            words[codes.values],
            {"long_name": f"name of the {name}"},
        )


def listed_flags(names: Mapping[int, str]) -> str:
    """Codes of a class with their names.

    >>> listed_flags({0: "train", 1: "test"})
    '0 train, 1 test'
    """
    return ", ".join(f"{code} {name}" for code, name in names.items())


def make_dataset(
    signal: NDArray[np.int16] | NDArray[np.float32],
    fs: float,
    channels: tuple[str, ...],
    columns: Mapping[str, ArrayLike],
    *,
    extra: tuple[Variable, ...] = (),
    counts_per_unit: float | None = None,
    attributes: Mapping[str, Any],
) -> "xr.Dataset":
    """Records in the corpus layout, ready for :func:`gen.corpus.write_part`.

    Parameters
    ----------
    signal : array, shape (record, channel, elapsed_time)
        Converter counts (int16, with ``counts_per_unit`` [counts per m s-2]) or accelerations [m s-2] (float32).
    fs : float
        Sample rate [Hz].
    channels : tuple of str
        Name of each channel.
    columns : mapping
        One array of shape (record,) for each variable of ``SCHEMA`` and of ``extra``.
    extra : tuple of Variable
        Further per-record variables, such as those of simulated corpora; those of ``SCHEMA`` may be among them.
    counts_per_unit : float, optional
        Converter counts per m s-2, for int16 signals.
    attributes : mapping
        Global attributes: ``title``, ``history`` and others that describe the corpus.

    Raises
    ------
    CorpusError
        If a column is missing or unknown.
    """
    import xarray as xr  # not at the top: recipes use the names above, and xarray takes 0.25 s to load

    variables = {variable.name: variable for variable in SCHEMA + extra}
    # a column without a description would be a variable without a unit
    if variables.keys() != columns.keys():
        message = f"columns {sorted(variables.keys() ^ columns.keys())} are either missing or not described; give each exactly once."
        raise CorpusError(message)
    content = {"coverage_content_type": "modelResult" if DRAWS in variables else "physicalMeasurement"}
    data: dict[str, Any] = {SIGNAL: (SIGNAL_DIMS, signal, signal_attributes(counts_per_unit) | content)}
    for variable in variables.values():
        values, dtype = np.asarray(columns[variable.name]), np.dtype(variable.dtype)
        # joining and choosing with xarray turns numbers that are missing into floating ones
        if dtype.kind in "iu" and values.dtype.kind == "f" and (values != np.round(values)).any():
            raise CorpusError(
                f"{variable.name}: a value is missing or no whole number; leave its record out, or drop it."
            )
        values = values.astype(object if dtype.kind == "U" else dtype)
        data[variable.name] = ("record", values, variable_attributes(variable))
    content = {"coverage_content_type": "coordinate"}
    axis = {"units": "s", "long_name": "time since the start of the record", **content}
    named = {"long_name": "name of the channel", **content}
    coordinates = {
        "channel": ("channel", np.asarray(channels, dtype=object), named),
        "elapsed_time": ("elapsed_time", np.arange(signal.shape[2]) / fs, axis),
    }
    # CF calls text variables auxiliary coordinates
    labels = {variable.name: data.pop(variable.name) for variable in variables.values() if variable.dtype == "str"}
    return xr.Dataset(
        data,
        coordinates | labels,
        {"Conventions": "CF-1.11, ACDD-1.3", "raceway_format": FORMAT, **attributes},
    )


def schema_problems(dataset: "xr.Dataset", further: tuple[Variable, ...] = ()) -> list[str]:
    """Deviations of ``dataset`` from the format, one sentence each; ``further`` are variables that a corpus may have beside ``SCHEMA``."""
    problems = [f"variable {name} is missing." for name in _missing(dataset)]
    if problems:
        return problems
    if dataset[SIGNAL].dims != SIGNAL_DIMS:
        problems.append(f"{SIGNAL} has dimensions {dataset[SIGNAL].dims}, not {SIGNAL_DIMS}.")
    declared = {variable.name: variable for variable in SCHEMA + further}
    # further variables are allowed if they say what they are
    for name, array in dataset.variables.items():
        if name in (SIGNAL, "channel", "elapsed_time"):
            continue
        if array.dims != ("record",):
            problems.append(f"{name} has dimensions {array.dims}, not ('record',).")
        if array.attrs.get("role") not in ROLES or "long_name" not in array.attrs:
            problems.append(f"{name} needs a long_name and a role, one of {', '.join(ROLES)}.")
        problems += _values_problems(declared.get(str(name)), str(name), array)
    return problems or operating_problems({name: dataset[name].values for name in ("sample_rate", *_RATES)})


def records_in_memory(records: Any) -> "xr.Dataset":
    """One or several records that a user has, with the axes of the signal in the order of the format.

    Raises
    ------
    CorpusError
        If this is no Dataset, or one without a variable of the format or without a sample.
    """
    import xarray as xr

    if not isinstance(records, xr.Dataset):
        raise CorpusError(
            f"{type(records).__name__} given in place of a Dataset; give the folder or file of a corpus, or records of "
            "gen.records or gen.open_corpus."
        )
    missing = _missing(records)
    if missing:
        raise CorpusError(f"the Dataset has no variable {', '.join(missing)}; the format of corpora needs it.")
    # a single record has no axis of records
    rows = records if "record" in records.dims else records.reset_coords().expand_dims("record")
    if set(rows[SIGNAL].dims) != set(SIGNAL_DIMS) or not rows[SIGNAL].size:
        raise CorpusError(
            f"{SIGNAL} has the axes {dict(rows[SIGNAL].sizes)}; give at least one record with a channel and a sample."
        )
    return rows.transpose(*SIGNAL_DIMS)


def _missing(dataset: "xr.Dataset") -> list[str]:
    required = [SIGNAL, "channel", "elapsed_time", *(variable.name for variable in SCHEMA)]
    return [name for name in required if name not in dataset.variables]


def operating_problems(columns: Mapping[str, NDArray[Any]]) -> list[str]:
    """Sample rates, shaft rates, loads and orders that no analysis can use, one sentence each."""
    texts = [name for name in ("sample_rate", *_RATES) if name in columns and columns[name].dtype.kind not in "fiu"]
    if texts:
        return [f"{name} holds no numbers." for name in texts]
    rates = np.unique(columns.get("sample_rate", 1.0))
    if len(rates) != 1 or not 1 <= rates[0] <= _HIGHEST:
        shown = ", ".join(f"{rate:g}" for rate in rates[:3])
        return [f"sample_rate is {shown} Hz, not one rate from 1 to {_HIGHEST:g} Hz for all records."]
    wrong = [name for name in _RATES if name in columns and (np.abs(columns[name]) > _HIGHEST).any()]
    negative = [name for name in _RATES if name in columns and (columns[name] < 0).any()]
    return [f"{name} has values above {_HIGHEST:g}." for name in wrong] + [
        f"{name} has values below 0." for name in negative
    ]


def _values_problems(declared: Variable | None, name: str, array: "xr.Variable") -> list[str]:
    """Type, unit and classes of a variable other than those of the format."""
    try:
        flags = class_names(array.attrs)
    except (ValueError, OverflowError):
        return [f"{name} has flag_values that are not whole numbers."]
    # a variable of somebody else may have any type and unit
    if declared is None:
        return []
    kinds = "OUT" if declared.dtype == "str" else np.dtype(declared.dtype).kind
    if array.dtype.kind not in kinds:
        return [f"{name} is of type {array.dtype}, not {'text' if kinds == 'OUT' else np.dtype(declared.dtype)}."]
    if array.attrs.get("units") != declared.units:
        return [f"{name} is in {array.attrs.get('units')!r}, not {declared.units!r}."]
    if flags != dict(declared.flags):
        return [
            f"{name} has the classes {listed_flags(flags) or 'none'}, not {listed_flags(declared.flags) or 'none'}."
        ]
    if declared.flags and not np.isin(array.values, [*declared.flags]).all():
        return [f"{name} has values other than {listed_flags(declared.flags)}."]
    return []
