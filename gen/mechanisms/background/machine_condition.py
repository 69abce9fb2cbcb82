"""What a condition of a machine is that is not well."""

from gen.mechanisms.background.source import MachineSource


class MachineCondition(MachineSource):
    """A condition of a machine, whatever that of its bearings: its key is its name in the label ``machine_condition``."""
