"""Signals of shape (row, time) in, spectra and levels of fault lines out: pure NumPy.

============ =================================================================
module       responsibility
============ =================================================================
rows         compilation of loops over records, sums in a fixed order, windows
spectra      power spectra, Fourier coefficients, whitening
demodulation analytic signals of bands, envelope spectra and their floor
lines        levels of fault lines and combs at orders of the shaft
shape        impulsiveness, slow fluctuation, statistics of the waveform
============ =================================================================
"""
