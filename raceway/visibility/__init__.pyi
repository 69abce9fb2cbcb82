from .fault_limits import FaultLimit as FaultLimit, limit as limit
