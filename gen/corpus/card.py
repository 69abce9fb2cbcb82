"""Data card of a corpus: a page in Markdown on its records, its faults and its labels."""

import numpy as np
import xarray as xr

from gen.corpus.recoverable import NUMBERS, recoveries
from gen.corpus.schema import FAULT_NAMES, SIGNAL, SPLITS
from gen.corpus.signals import SignalCounts, described
from gen.corpus.visible import fault_counts


def data_card(corpus: xr.Dataset, signals: SignalCounts, *, origin: str) -> str:
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
    for code, name in FAULT_NAMES.items():
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
    if "detectable" in corpus:
        lines += ["", *_visible_faults(corpus), *_recoverable_labels(corpus)]
    lines += ["", "| variable | unit | role | meaning |", "|---|---|---|---|"]
    for name, variable in corpus.variables.items():
        if name != SIGNAL and variable.dims == ("record",):
            attributes = (variable.attrs.get(key, "") for key in ("units", "role", "long_name"))
            lines.append(f"| `{name}` | " + " | ".join(plain_text(value) for value in attributes) + " |")
    return "\n".join([*lines, "", "Open it with `gen.open_corpus(folder)` or any netCDF-4 reader on `corpus.nc`.", ""])


def _visible_faults(corpus: xr.Dataset) -> list[str]:
    """Paragraph on the faults that can be seen in their records, and on those that were drawn again."""
    counts = fault_counts(corpus)
    if counts is None:
        return []
    if counts.unjudged == counts.records:
        return ["What the faults add to the records is not known: `corpus.truth` of the recipe is `none`."]
    seen = (
        f"Of {counts.records} records labelled with a fault, the fault can be seen in {counts.detectable} (`detectable`): its line in the "
        f"squared envelope of some band would be a false alarm of noise with a probability below one in a thousand."
    )
    again = f"the fault of {counts.redrawn_specimens} specimens, the level of {counts.redrawn_levels} records"
    return [f"{seen} Drawn again because the fault could not be seen: {again}."]


def _recoverable_labels(corpus: xr.Dataset) -> list[str]:
    """Table of the rank correlations of labels with simple numbers of the records."""
    found = recoveries(corpus)
    if not found:
        return []
    rows = [f"| `{row.label}` | {row.fault} | {row.number} | {row.correlation:+.2f} | {row.items} |" for row in found]
    meaning = (
        f"Which labels can be recovered from the signals? The table has the closest of {', '.join(NUMBERS)} to each label, by Spearman's "
        f"rank correlation over specimens, or over records where the label changes from record to record. Chance alone reaches "
        f"2 / sqrt(count); a label with less than that cannot be recovered from these numbers."
    )
    return [
        "",
        meaning,
        "",
        "| label | fault | closest number | rank correlation | count |",
        "|---|---|---|---:|---:|",
        *rows,
    ]


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
