from .velocity import velocity_rms as velocity_rms
from .orders import (
    angles_from_speed as angles_from_speed,
    order_map as order_map,
    order_spectrum as order_spectrum,
    resample_to_angle as resample_to_angle,
)
from .tacho import angles_from_tacho as angles_from_tacho
from .tracking import SpeedCourse as SpeedCourse, track_speed as track_speed
from .cyclic import (
    Coherence as Coherence,
    enhanced_envelope_spectrum as enhanced_envelope_spectrum,
    spectral_coherence as spectral_coherence,
)
from .envelopes import band_envelope_spectrum as band_envelope_spectrum
from .impulsive import (
    BandTree as BandTree,
    comb_bands as comb_bands,
    kurtogram as kurtogram,
)
from .spectra import cepstrum as cepstrum, psd as psd, whiten_cepstrally as whiten_cepstrally
