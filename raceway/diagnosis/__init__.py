"""Diagnosis of one recording: a class with its probability, and the lines in the signal that speak for it.

``recording -> quality, bearing and speed, prediction, evidence -> Diagnosis``

================ ============================================================================
module           responsibility
================ ============================================================================
spectrum         averaged envelope spectra in several bands, and the level that noise exceeds
evidence         lines of fault families that stand above the floor
search           pairs of bearing and speed that explain the lines
quality          signals that tell nothing, and signals to be read with care
levels           rms, peak, crest factor, kurtosis and velocity
wording          sentences
verdict          agreement of classifier and lines
result           a recording, and its diagnosis
diagnosis_facts  facts of a diagnosis for programs and for its page
diagnosis_page   page of a diagnosis
tables           diagnoses of a folder: table, index page and CSV file
answer           verdict, probabilities and evidence of a recording
arrays           one call for a recording that is at hand as an array
diagnose_command the command diagnose
================ ============================================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
