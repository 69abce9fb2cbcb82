"""Diagnosis of one recording: a class with its probability, and the lines in the signal that speak for it.

``recording -> quality, speed, prediction, evidence -> Diagnosis``

======== ==================================================================================
module   responsibility
======== ==================================================================================
spectrum averaged envelope spectra in several bands, and the level that noise exceeds
evidence lines of fault families that stand above the floor
quality  signals that tell nothing, and signals to be read with care
wording  sentences
diagnose verdict, probabilities and evidence of a recording
======== ==================================================================================
"""

from features.diagnosis.diagnose import Diagnosis, Recorded, diagnose
from features.diagnosis.evidence import FALSE_ALARM, LEAST_LEVEL, Line, line_facts

__all__ = ["FALSE_ALARM", "LEAST_LEVEL", "Diagnosis", "Line", "Recorded", "diagnose", "line_facts"]
