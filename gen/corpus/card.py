"""Pages in Markdown: the data card of a corpus, and the description of the format."""

import numpy as np
import xarray as xr

from gen.corpus.schema import FAULTS, FORMAT, SCHEMA, SIGNAL, SPLITS, Variable
from gen.corpus.signals import CLIPPED_SHARE, SignalCounts, described
from gen.corpus.simulated import SIMULATED


def data_card(corpus: xr.Dataset, origin: str, signals: SignalCounts) -> str:
    """Markdown page about a corpus; ``origin`` is a paragraph on its source and licence.

    ``signals`` counts the records that cannot be used.
    """
    records, samples = corpus.sizes["record"], corpus.sizes["elapsed_time"]
    names = ", ".join(plain_text(name) for name in corpus["channel"].values)
    fs = float(corpus["sample_rate"][0])
    fault, split = corpus["fault"].values, corpus["split"].values
    lines = [
        f"# {plain_text(corpus.attrs['title'])}",
        "",
        origin,
        "",
        f"{records} records of {samples / fs:g} s at {fs:g} Hz, channels {names}, in m/s^2.",
        f"Records that cannot be used: {described(signals)}.",
        "",
        "| fault | records | specimens | rigs | " + " | ".join(SPLITS) + " |",
        "|---|---:|---:|---:|" + "---:|" * len(SPLITS),
    ]
    for code, name in enumerate(FAULTS):
        of_class = fault == code
        if of_class.any():
            units = (np.unique(corpus[unit].values[of_class]).size for unit in ("specimen", "rig"))
            parts = ((of_class & (split == part)).sum() for part in range(len(SPLITS)))
            lines.append(
                f"| {name} | {of_class.sum()} | " + " | ".join(str(count) for count in (*units, *parts)) + " |"
            )
    pairs = np.unique(corpus["pair"].values) if "pair" in corpus else np.array([])
    if (pairs >= 0).any():
        groups = f"{(pairs >= 0).sum()} groups of records (`pair`) differ in the severity of their fault alone (`rung`)"
        lines += ["", f"{groups}; a specimen recorded before its damage counts as healthy too."]
    lines += ["", "| variable | unit | role | meaning |", "|---|---|---|---|"]
    for name, variable in corpus.variables.items():
        if name != SIGNAL and variable.dims == ("record",):
            attributes = (variable.attrs.get(key, "") for key in ("units", "role", "long_name"))
            lines.append(f"| `{name}` | " + " | ".join(plain_text(value) for value in attributes) + " |")
    return "\n".join([*lines, "", "Open it with `gen.open_corpus(folder)` or any netCDF-4 reader on `corpus.nc`.", ""])


_FORMAT = f"""# The corpus format, version {FORMAT}

A corpus is a folder:

| file | content |
|---|---|
| `corpus.nc` | all per-record variables, and the signal as an HDF5 virtual dataset over the parts: any netCDF-4 reader sees one file |
| `parts/part-00000.nc` ... | complete netCDF-4 files of some hundred records each |
| `manifest.json` | whether the corpus is complete; `signals`; bytes and SHA-256 of `corpus.nc` and of each part; recipe hash, versions |
| `recipe.yaml` | the recipe, if the corpus was simulated |
| `README.md` | the data card |

HDF5 reads a part that it cannot open as missing values, without an error: a part that is missing, or that exceeds
the number of files a process may open. `gen.open_corpus` therefore compares every file with the manifest before it
reads, refuses a missing or altered file, and reads the signal from the parts. `raceway validate` checks everything.
Further checks of a corpus from strangers: [security.md](security.md).

`signals` counts the records that no analysis can use: `clipped` if more than {CLIPPED_SHARE:.0%} of the samples of
a channel are at the ends of the converter, or in floating point at the largest and smallest value of the channel;
`dead` if all samples of a channel are zero, `constant` if they all have one other value, `not_finite` if a sample
is missing or not a number.

The signal is `{SIGNAL} (record, channel, elapsed_time)` in m s-2: 16-bit counts with `scale_factor`, which xarray
and netCDF4 apply when they read, or 32-bit floating point. Text is stored as fixed-length characters. Every other
variable has one value per record, and a `role`:

- `operating`: known to an analyst on site; features may use it,
- `label`: the target of a classifier,
- `latent`: known to the simulator alone,
- `provenance`: origin of the record.

Every corpus has the variables below. It can have further ones, numbers that are not packed or text, with a
`long_name` and a `role`:

"""


_SIMULATED = """
A corpus that `raceway generate` made also has these; `draws` holds every drawn value of the record, by the names of
the recipe's keys:

"""


def format_page() -> str:
    """Markdown page about the format; its tables are the schemas of all and of simulated corpora."""
    return _FORMAT + _table(SCHEMA) + _SIMULATED + _table(SIMULATED)


def _table(variables: tuple[Variable, ...]) -> str:
    rows = ["| variable | type | unit | role | meaning |", "|---|---|---|---|---|"]
    for variable in variables:
        flags = (
            f" ({', '.join(f'{code} {name}' for code, name in enumerate(variable.flags))})" if variable.flags else ""
        )
        cells = (f"`{variable.name}`", variable.dtype, variable.units, variable.role, variable.long_name + flags)
        rows.append(f"| {' | '.join(cells)} |")
    return "\n".join(rows) + "\n"


def plain_text(text: object) -> str:
    """Text from a stranger as one line without Markdown: no tag, link, picture, code or table cell.

    >>> plain_text("a|b <script> [x](http://y)  `z` ")
    "a/b (script) [x] (http://y) 'z'"
    """
    shown = " ".join(str(text).translate(_HARMLESS).split())
    shown = "".join(letter if letter.isprintable() else "?" for letter in shown)
    for link in ("](", "][", "]:"):
        shown = shown.replace(link, f"] {link[1]}")
    return shown


_HARMLESS = str.maketrans({"|": "/", "<": "(", ">": ")", "`": "'", "\\": "/"})
