"""Signals of shape (row, time) in, spectra and levels of fault lines out: pure NumPy.

============ ======================================================================
module       responsibility
============ ======================================================================
rows         compilation of loops over records, sums in a fixed order, windows
spectra      power spectra, Fourier coefficients, whitening
demodulation analytic signals of bands, envelope spectra and their floor
orders       signals at equal angles of the shaft in place of equal times
lines        levels of fault lines and combs at orders of the shaft
speed        shaft speed that fits fault lines and shaft harmonics together
modulation   phase wander, sidebands and cyclostationarity of a line of an envelope
colour       roll-off, centroid and tonality of a power spectrum
shape        impulsiveness, slow fluctuation, statistics of the waveform
============ ======================================================================
"""
