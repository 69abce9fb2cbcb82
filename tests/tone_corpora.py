"""Small corpora of tones whose order of the shaft is that of the class, written without a simulation."""

import numpy as np

from tests.corpora import write_records

FS = 4000.0
TONES = (4.0, 9.0, 14.0, 19.0)  # orders of the classes


def write_corpus(folder, *, specimens=16, records=3, parts=2, noise=0.5, seed=0, **changed):
    """Write parts of 0.25 s of tone and noise, of four classes; specimen after specimen, on rigs of four specimens."""
    rng = np.random.default_rng(seed)
    specimen = np.repeat(np.arange(specimens), records)
    count, fault = len(specimen), specimen % 4
    columns = {
        "shaft_rate": rng.uniform(20, 40, count),
        "sample_rate": np.full(count, FS),
        "fault": fault,
        "n_spalls": (fault > 0).astype(int),
        "width": 1e-3 * (fault > 0),
        "rig": specimen // 4,
        "specimen": specimen,
        "recording": np.arange(count),
        "identity": [f"tones-{seed}/{one // 4}/{one}/{number}/-1" for number, one in enumerate(specimen)],
    } | changed
    turns = columns["shaft_rate"][:, None] * np.arange(1000) / FS
    tone = np.sin(2 * np.pi * (np.array(TONES)[fault][:, None] * turns + rng.uniform(size=(count, 1))))
    signal = (rng.uniform(0.5, 2, (count, 1)) * (tone + noise * rng.standard_normal(tone.shape))).astype(np.float32)
    write_records(folder, signal, FS, columns, title="tones", text="made up", per_part=-(-count // parts))
    return signal
