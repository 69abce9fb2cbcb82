"""Small corpora of random records, written without a simulation."""

import numpy as np

from gen.corpus import FAULTS, SCHEMA, SIGNAL, Variable, identity, make_dataset, new_corpus

FS = 1000.0
COUNTS_PER_UNIT = 65.534
EXTRA = (Variable("draws", "str", "1", "provenance", "drawn values"),)
SIZES = (3, 4, 2)  # records of the parts


def columns(first, n):
    """Values of all per-record variables for records ``first`` to ``first + n``, all different where the type allows it."""
    numbers = np.arange(first, first + n)
    found = {variable.name: numbers * 1.5 + 0.25 for variable in SCHEMA if variable.dtype == "f8"}
    found |= dict.fromkeys(("rig", "specimen", "recording", "n_spalls"), numbers)
    texts = {"bearing": "6205", "source": "small/", "draws": "x" * 7}
    found |= {name: [text + "y" * number for number in numbers] for name, text in texts.items()}
    found["identity"] = [identity("0123456789ab", *[number] * 3) for number in numbers]
    return found | {"fault": numbers % len(FAULTS), "split": numbers % 3, "sample_rate": np.full(n, FS)}


def dataset(first, n, *, samples=50, kind="counts", channels=("a", "b")):
    rng = np.random.default_rng(first)
    counts = rng.integers(-32767, 32768, (n, len(channels), samples)).astype(np.int16)
    floating = kind == "float32"
    return make_dataset(
        (counts / COUNTS_PER_UNIT).astype(np.float32) if floating else counts,
        FS,
        channels,
        columns(first, n),
        extra=EXTRA,
        counts_per_unit=None if floating else COUNTS_PER_UNIT,
        attributes={"title": "A corpus", "history": "made by a test"},
    )


def write_corpus(target, sizes=SIZES, *, kind="counts", codec="zlib"):
    """Write parts of random records as a folder or a single file; return the parts as they were before writing."""
    starts = np.concatenate([[0], np.cumsum(sizes)])
    parts = [dataset(int(first), n, kind=kind) for first, n in zip(starts, sizes, strict=False)]
    return write_parts(target, parts, codec)


def write_parts(target, parts, codec="zlib"):
    """Write Datasets as the parts of a corpus: a folder or a single file."""
    with new_corpus(target, codec=codec, title="A corpus") as corpus:
        for part in parts:
            corpus.write(part)
    return parts


def write_records(folder, signal, fs, columns, *, title, text=None, per_part=None, extra=(), **facts):
    """Write signals of one channel, shape (record, time), in parts of so many records; return the path of the corpus.

    Variables that ``columns`` lacks are 0, or ``text`` (the title, if it is not given).
    """
    count, variables = len(signal), (*SCHEMA, *extra)
    other = {
        v.name: [title if text is None else text] * count if v.dtype == "str" else np.zeros(count) for v in variables
    }
    attributes = {"title": title, "source": title, "history": ""}
    with new_corpus(folder, title=title, **facts) as corpus:
        for start in range(0, count, per_part or count):
            rows = slice(start, start + (per_part or count))
            part = {name: column[rows] for name, column in (other | columns).items()}
            accelerations = np.asarray(signal[rows], np.float32)[:, None]
            corpus.write(make_dataset(accelerations, fs, ("housing",), part, extra=extra, attributes=attributes))
    return folder


def physical(part):
    scale = part[SIGNAL].attrs.get("scale_factor", 1.0)
    return part[SIGNAL].values * scale
