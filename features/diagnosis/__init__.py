"""Diagnosis of one recording: a class with its probability, and the lines in the signal that speak for it.

``recording -> quality, bearing and speed, prediction, evidence -> Diagnosis``

======== ==================================================================================
module   responsibility
======== ==================================================================================
spectrum averaged envelope spectra in several bands, and the level that noise exceeds
evidence lines of fault families that stand above the floor
search   pairs of bearing and speed that explain the lines
quality  signals that tell nothing, and signals to be read with care
levels   rms, peak, crest factor, kurtosis and velocity
wording  sentences
verdict  agreement of classifier and lines
diagnose verdict, probabilities and evidence of a recording
arrays   one call for a recording that is at hand as an array
======== ==================================================================================
"""

from features.diagnosis.arrays import diagnose
from features.diagnosis.diagnose import Diagnosis, Recorded, diagnose_recording
from features.diagnosis.evidence import FALSE_ALARM, LEAST_LEVEL, Line, line_facts
from features.diagnosis.levels import ACCELERATION, Levels
from features.diagnosis.search import ANY_RATE, Given, Pair

__all__ = [
    "ACCELERATION",
    "ANY_RATE",
    "FALSE_ALARM",
    "LEAST_LEVEL",
    "Diagnosis",
    "Given",
    "Levels",
    "Line",
    "Pair",
    "Recorded",
    "diagnose",
    "diagnose_recording",
    "line_facts",
]
