"""Background of a machine: noise, and one file for each source of vibration beside its bearings."""
