from .auditing import audit_splits as audit_splits
from .baselines import Model as Model
from .diagnosis import diagnose as diagnose
from .line_bands import fault_bands as fault_bands, fault_metrics as fault_metrics
from .network_input import envelope_orders as envelope_orders
from .ranking import rank_features as rank_features, rank_series as rank_series
from .speed import shaft_speed as shaft_speed
from .table import feature_table as feature_table
from .transformer import IndicatorTransformer as IndicatorTransformer
from .waveforms import open_waveforms as open_waveforms
