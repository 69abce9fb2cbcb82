"""Signals of shape (record, time) in, spectra and levels of fault lines out: pure NumPy and SciPy.

The names that an analyst calls are at the top: ``from features import signal; signal.order_spectrum(y, per_turn)``.

============ ========================================================================================
module       responsibility
============ ========================================================================================
arguments    arguments of the public functions: records, numbers and bands, or a sentence
rows         compilation of loops over records, sums in a fixed order, windows
spectra      power spectra, cepstra, Fourier coefficients, whitening
demodulation analytic signals of bands, envelope spectra and their floor
orders       signals at equal angles of the shaft in place of equal times, their spectra and averages
tacho        angle of the shaft from the pulses of a tacho, with those that it missed
velocity     rms velocity of ISO 20816-3
lines        levels of fault lines and combs at orders of the shaft
speed        shaft speed that fits fault lines and shaft harmonics together
tracking     course of the shaft speed of a run-up, where it can be believed
modulation   phase wander, sidebands and cyclostationarity of a line of an envelope
colour       roll-off, centroid and tonality of a power spectrum
shape        impulsiveness, slow fluctuation, statistics of the waveform
cyclic       spectral coherence, enhanced envelope spectrum, and their thresholds
envelopes    envelope spectrum of a band of records
impulsive    kurtogram, band in which a fault line stands out
============ ========================================================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
