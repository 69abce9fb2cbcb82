from .arrays import diagnose as diagnose
from .answer import diagnose_recording as diagnose_recording
from .evidence import FALSE_ALARM as FALSE_ALARM, LEAST_LEVEL as LEAST_LEVEL, Line as Line, line_facts as line_facts
from .levels import Levels as Levels
from .result import Diagnosis as Diagnosis
from .search import ANY_RATE as ANY_RATE, Given as Given, Pair as Pair, given_of as given_of
