"""The data card: what a corpus holds, in Markdown, for whoever finds the folder."""

import numpy as np
import xarray as xr

from gen.corpus.schema import FAULTS, SIGNAL, SPLITS


def data_card(corpus: xr.Dataset, origin: str) -> str:
    """Markdown page about a corpus; ``origin`` is a paragraph on where it comes from and what one may do with it."""
    records, samples = corpus.sizes["record"], corpus.sizes["elapsed_time"]
    names = ", ".join(_plain(name) for name in corpus["channel"].values)
    fs = float(corpus["sample_rate"][0])
    fault, split = corpus["fault"].values, corpus["split"].values
    lines = [
        f"# {_plain(corpus.attrs['title'])}",
        "",
        origin,
        "",
        f"{records} records of {samples / fs:g} s at {fs:g} Hz, channels {names}, in m/s^2.",
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
    lines += ["", "| variable | unit | role | what it is |", "|---|---|---|---|"]
    for name, variable in corpus.variables.items():
        if name != SIGNAL and variable.dims == ("record",):
            attributes = (variable.attrs.get(key, "") for key in ("units", "role", "long_name"))
            lines.append(f"| `{name}` | " + " | ".join(_plain(value) for value in attributes) + " |")
    return "\n".join([*lines, "", "Open it with `gen.open_corpus(folder)` or any netCDF-4 reader on `corpus.nc`.", ""])


def _plain(text: object) -> str:
    """Text that cannot break out of its place in the page."""
    return " ".join(str(text).replace("|", "/").replace("<", "(").replace(">", ")").split())
