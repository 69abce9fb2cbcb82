"""Small corpora of tones whose order of the shaft is that of the class, written without a simulation."""

import numpy as np

from gen.corpus import SCHEMA, make_dataset, part_name, write_index, write_manifest, write_part

FS = 4000.0
TONES = (4.0, 9.0, 14.0, 19.0)  # orders of the classes


def write_corpus(folder, *, specimens=16, records=3, parts=2, noise=0.5, seed=0, **changed):
    """Write parts of 0.25 s of tone and noise, of four classes; specimen after specimen, on rigs of four specimens."""
    rng = np.random.default_rng(seed)
    (folder / "parts").mkdir(parents=True)
    specimen = np.repeat(np.arange(specimens), records)
    count, fault = len(specimen), specimen % 4
    columns = {v.name: np.array(["made up"] * count, object) if v.dtype == "str" else np.zeros(count) for v in SCHEMA}
    columns |= {
        "shaft_rate": rng.uniform(20, 40, count),
        "sample_rate": np.full(count, FS),
        "fault": fault,
        "n_spalls": (fault > 0).astype(int),
        "width": 1e-3 * (fault > 0),
        "rig": specimen // 4,
        "specimen": specimen,
        "recording": np.arange(count),
    } | changed
    turns = columns["shaft_rate"][:, None] * np.arange(1000) / FS
    tone = np.sin(2 * np.pi * (np.array(TONES)[fault][:, None] * turns + rng.uniform(size=(count, 1))))
    signal = (rng.uniform(0.5, 2, (count, 1)) * (tone + noise * rng.standard_normal(tone.shape))).astype(np.float32)
    attributes = {"title": "tones", "source": "made up", "history": ""}
    rows = []
    for number, block in enumerate(np.array_split(np.arange(count), parts)):
        part = {name: values[block] for name, values in columns.items()}
        dataset = make_dataset(signal[block][:, None], FS, ("housing",), part, attributes=attributes)
        rows.append(write_part(dataset, folder / "parts" / part_name(number)))
    write_index(folder, rows)
    write_manifest(folder, rows, complete=True)
    return signal
