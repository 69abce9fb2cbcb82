"""Signals of shape (row, time) in, spectra and levels of fault lines out: pure NumPy.

============ =================================================================
module       responsibility
============ =================================================================
rows         what loops over records share: compilation, sums, windows
spectra      power spectra, Fourier coefficients, whitening
demodulation bands as analytic signals, envelope spectra and their floor
lines        levels of fault lines and combs at orders of the shaft
shape        impulsiveness, slow fluctuation, time statistics
============ =================================================================
"""
