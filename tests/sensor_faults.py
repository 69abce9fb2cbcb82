"""Every sensor fault and a gear, as sections of a recipe that is in every rig and record."""

SENSOR_FAULTS = {
    "loose_mount": {"probability": 1, "frequency_hz": 1500, "damping_percent": 4, "holding_m_s2": 8},
    "saturation": {"probability": 1, "limit_m_s2": 20, "knee_percent": 20, "recovery_s": 0.01},
    "mains_hum": {
        "probability": 1, "frequency_hz": 60, "rms_m_s2": 2, "deviation_percent": "uniform(-1, 1)"
    },
    "drift": {
        "probability": 1, "wander_m_s2": 3, "settling_m_s2": "uniform(5, 10)", "settling_time_s": 0.05
    },
    "dropped_samples": {"probability": 1, "count": 3, "gap_s": "uniform(0.001, 0.004)"},
    "gain_steps": {"probability": 1, "count": 2, "step_db": "choice(-6, 6)"},
    "emi_bursts": {"probability": 1, "rate_hz": 200, "frequency_hz": 3000, "decay_s": 0.001, "peak_m_s2": 30},
}  # fmt: skip

GEAR_MESH = {
    "probability": 1, "teeth": 20, "mate_teeth": 40, "count": 3, "level_db": "uniform(-6, 6)",
    "shaft_modulation": 0.4, "mate_modulation": 0.2, "phase_deg": 20,
}  # fmt: skip


def rarely(sections, probability):
    """The same sections with another probability."""
    return {name: {**section, "probability": probability} for name, section in sections.items()}
