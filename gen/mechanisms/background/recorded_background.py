"""A recording of a healthy machine as background, in place of noise that is drawn.

The recording is a corpus of healthy records in one file, known by its SHA-256. Its records are cut into segments of the length of a record,
and the segments are shared out: each specimen has a stretch of its own, so that a split by specimen or by rig has no segment on both sides.
The recording has the vibration of its healthy bearing already, so a healthy record is a segment alone, and a fault adds its difference.
"""

import functools
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, StringConstraints

from gen.corpus.fault_classes import FAULTS, HEALTHY
from gen.corpus.schema import SIGNAL
from gen.drawing import Count, Probability
from gen.mechanisms.background.source import BackgroundSource
from gen.support.errors import RecipeError
from gen.support.limits import check_limit

Float32Array = NDArray[np.float32]


class RecordedBackground(BackgroundSource):
    """A recording of the healthy machine, in place of the noise and of the healthy bearing of the model."""

    place = "recording"

    probability: Probability = 1.0
    """Share of the rigs whose background is recorded."""
    # where the file lies is no part of what a corpus is made from
    file: Annotated[str, Field(min_length=1, max_length=1000, exclude=True)]
    """Corpus of healthy records in one file, as `raceway imitate` and `raceway import` write it; its path from the current folder on."""
    sha256: Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{64}$")]
    """SHA-256 of the file; another file is refused."""
    stretches: Count
    """Number of parts that the recording is cut into, each of whole segments of the length of a record. Every specimen has a part of its
    own, so that no segment is on both sides of a split."""
    licence: Annotated[str, StringConstraints(min_length=1, max_length=200)] | None = None
    """Licence of the recording, for the data card."""

    @property
    def origin(self) -> str:
        """Sentence on the recording, for the card and the manifest."""
        licence = self.licence or "not stated"
        return f"Background: cut from the recording {Path(self.file).name}, SHA-256 {self.sha256}, licence {licence}."

    def segment(self, recipe: Any, specimen: int, rng: np.random.Generator) -> Float32Array:
        """One of the segments of a specimen for a record, over the rms of the whole recording, shape (channel, time) [1].

        Raises
        ------
        RecipeError
            If the file is not the recording, or does not fit the ``recipe``.
        """
        signals, of_each = self.cut(recipe)
        count, place = len(signals) * of_each, specimen % self.stretches
        first, stop = (count * end // self.stretches for end in (place, place + 1))
        row, number = divmod(int(rng.integers(first, stop)), of_each)
        return signals[row, :, number * recipe.n_samples : (number + 1) * recipe.n_samples]

    def cut(self, recipe: Any) -> tuple[Float32Array, int]:
        """Signals of the recording, shape (record, channel, time) [1], and number of segments in each; errors as of :meth:`segment`."""
        signals, fs = _signals(self.file, self.sha256)
        of_each, asked = signals.shape[2] // recipe.n_samples, recipe.recording
        problem = None
        if fs != asked.sample_rate_hz:
            problem = (
                f"is sampled at {fs:g} Hz, and recording.sample_rate_hz is {asked.sample_rate_hz:g}; give the same"
            )
        elif signals.shape[1] != len(asked.channels):
            problem = f"has {signals.shape[1]} channels, and recording.channels {len(asked.channels)}; give as many"
        elif len(signals) * of_each < self.stretches:
            problem = (
                f"has {len(signals) * of_each} segments of {asked.duration_s:g} s, and stretches asks for {self.stretches}; "
                "lower it with corpus.rigs, shorten recording.duration_s, or give a longer recording"
            )
        if problem is not None:
            raise RecipeError(f"background.recording: {self.file} {problem}.")
        return signals, of_each


@functools.lru_cache(maxsize=4)
def _signals(file: str, sha: str) -> tuple[Float32Array, float]:
    """Signals of a corpus over their rms, shape (record, channel, time) [1], and their sample rate [Hz]."""
    from gen.corpus import open_corpus, sha256  # xarray takes a second to load, and few recipes need it

    place = f"background.recording.file: {file}"
    if not Path(file).is_file():
        raise RecipeError(
            f"{place}: there is no {Path(file).absolute()}; run the command in the folder from which its path leads to the file."
        )
    # nothing is read from a file that the recipe does not mean
    if sha256(Path(file)) != sha:
        raise RecipeError(f"{place}: is another file than that of sha256; give the right one, or its own sha256.")
    with open_corpus(file, check="size") as corpus:
        check_limit("record_samples", corpus[SIGNAL].size, f"{place}: has", RecipeError)
        signals, fs = corpus[SIGNAL].values.astype(np.float32), float(corpus["sample_rate"].values[0])
        healthy = (corpus["fault"].values == FAULTS.index(HEALTHY)).all()
    rms = float(np.sqrt(np.mean(np.square(signals, dtype=np.float64))))
    if not (healthy and 0 < rms < np.inf):
        raise RecipeError(f"{place}: has a record that is not healthy, or samples that are no vibration; leave it out.")
    signals /= np.float32(rms)
    return signals, fs
