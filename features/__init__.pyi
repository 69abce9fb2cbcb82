from .auditing import audit_splits as audit_splits
from .baselines import Model as Model
from .table.network_input import envelope_orders as envelope_orders
from .ranking import rank_features as rank_features
from .table.speed_search import shaft_speed as shaft_speed
from .table.corpus_features import feature_table as feature_table
from .table.indicators import feature_names as feature_names, indicators as indicators
from .table.waveforms import open_waveforms as open_waveforms
