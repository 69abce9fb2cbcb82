"""Features of vibration records: a corpus in, a feature table, scores and a report out.

It uses the format of a corpus and not the simulator, so that recordings of real machines are treated in the same way.

``corpus -> feature_table -> evaluate -> report``

=========== =================================================================================
module      responsibility
=========== =================================================================================
faults      the fault classes: colour, lines and telling features of each, in one table
signal      spectra, envelope spectra, levels of fault lines, statistics of the waveform [pure]
indicators  the feature vector of records, in four groups [pure]
transformer the feature vector as a scikit-learn transformer
table       corpus -> feature table (record, feature), part by part
table_files feature tables on disk
waveforms   signals of a corpus as an array that is read when it is indexed
baselines   classifiers on a feature table, scored by specimen or rig beside their controls
realism     synthetic records against real ones: AUC of measures, class by class
report      figures of records, corpora and scores, and one page with all of them
=========== =================================================================================
"""

from typing import TYPE_CHECKING

from gen.lazy import lazy_names

if TYPE_CHECKING:
    from features.baselines import evaluate
    from features.table import feature_table
    from features.waveforms import open_waveforms

__all__ = ["evaluate", "feature_table", "open_waveforms"]

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "features.baselines": ("evaluate",),
        "features.table": ("feature_table",),
        "features.waveforms": ("open_waveforms",),
    },
)
