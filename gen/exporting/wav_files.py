"""WAV: one file per record, one channel of the file per sensor, and a table of labels with the scale.

Counts of the converter are stored as they are (16-bit PCM); a corpus in floating point gives files in 32-bit floating point.
"""

from pathlib import Path

import numpy as np

from gen.corpus.schema import SIGNAL
from gen.exporting.columns import Export
from gen.exporting.tables import label_table, record_file
from gen.support.errors import CorpusError

_BLOCK_BYTES = 8_000_000  # of single precision
_MOST_CHANNELS = 65_535


def write_wav(export: Export, folder: Path) -> str:
    """Write ``labels.csv``, ``variables.csv`` and ``records/``; returns the page about them.

    Raises
    ------
    CorpusError
        If there are more channels or samples than a WAV file can hold.
    """
    from scipy.io import wavfile

    chosen = export.chosen
    if len(chosen.channels) > _MOST_CHANNELS or 4 * len(chosen.channels) * chosen.samples >= 2**32 - 100:
        raise CorpusError("wav: a record exceeds the 4 GB or the 65535 channels of a WAV file; choose fewer channels.")
    rate = round(chosen.sample_rate)
    scale = 1.0 if chosen.scale is None else chosen.scale
    with label_table(export, folder, ["m_s2_per_unit"]) as write:
        for block in export.blocks(_BLOCK_BYTES):
            files = [record_file(folder, number, "wav") for number in block.numbers]
            for file, signal in zip(files, block.as_stored()[SIGNAL].values, strict=True):
                wavfile.write(folder / file, rate, np.ascontiguousarray(signal.T))
            write(block, [(file, scale) for file in files])
    form = "32-bit floating point [m s-2]" if chosen.scale is None else "16-bit counts of the converter"
    return export.page(_READING.format(form=form, rate=rate, channels=", ".join(export.channels)))


_READING = """\
`labels.csv` has one row for each record and `variables.csv` the unit and meaning of its columns. `file` is the file of the
signal: {form}, channels {channels} in this order. The acceleration in m s-2 is the stored number times `m_s2_per_unit`.
A WAV file states a whole number of hertz ({rate}); the exact rate is `sample_rate`. A missing sample is -32768 in counts.

    import pandas, scipy.io.wavfile
    labels = pandas.read_csv("labels.csv")
    rate, stored = scipy.io.wavfile.read(labels["file"][0])
    acceleration = stored * labels["m_s2_per_unit"][0]

Programs that scale 16-bit samples to the range from -1 to 1 (librosa, soundfile, MATLAB's audioread) need a further factor
of 32768.
"""
