"""Changes to the small recipe of ``tests/conftest.py`` that use every feature of the model."""

EVERY_FAULT = [
    {"kind": "healthy"},
    {"kind": "inner", "width_mm": 0.5, "roughness_um": 1},
    {"kind": "outer", "width_mm": 3, "depth_um": 15, "n_spalls": 2, "profile": "half_sine"},
    {"kind": "ball", "width_mm": 0.5, "axis_wander_deg": 4},
    {"kind": "cage"},
    {"kind": "distributed", "site": "inner", "waviness_um": 0.3, "order": 10},
    {"kind": "distributed", "site": "outer", "waviness_um": 0.3},
    {
        "kind": "compound",
        "parts": [
            {"kind": "inner", "width_mm": 0.4},
            {"kind": "outer", "width_mm": 0.8, "profile": "trace", "trace_um": [0, 3, 10, 12, 8, 0]},
            {"kind": "cage", "knock_n": 30},
        ],
    },
]

# every record, healthy or faulty, has waviness, jitter, a schedule, oil, play and a resonance
EVERYTHING = {
    "corpus": {"rigs": 1, "specimens_per_rig": 16, "records_per_specimen": 2},
    "storage.records_per_part": 16,
    "recording.channels": [{"name": "fan_end", "body": "sensor", "path": {"direct": 0.1}}],
    "machine.bow_n": 30,
    "machine.misalignment_n": 20,
    "machine.looseness_um": 2,
    "contact": {"footprint": "hertz", "lubricant": {}},
    "specimen.ball_waviness_nm": 2,
    "specimen.contact_angle_deg": 10,
    "operation.axial_load_n": 300,
    "operation.load_wander_percent": 5,
    "operation.temperature_celsius": "uniform(20, 90)",
    "operation.inner_ring_hotter_k": 5,
    "operation.speed_profile": {"kind": "run_up", "from_percent": 50, "to_percent": 120, "lasting_s": 0.1},
    "operation.load_profile": {"kind": "steps", "levels_percent": [50, 100], "step_s": 0.02},
    "faults": EVERY_FAULT,
}

# spalls from too narrow to be seen in records of 0.2 s to plain ones, 400 records
LADDER = {
    "seed": 77,
    "corpus": {"rigs": 50, "specimens_per_rig": 8, "records_per_specimen": 1, "split": {"test": 0.25}},
    "storage.records_per_part": 400,
    "recording.duration_s": 0.2,
    "faults": [
        {"kind": "healthy"},
        {"kind": "outer", "width_mm": "loguniform(0.05, 1.5)", "angle_deg": "uniform(-40, 40)"},
    ],
    "level": {"kind": "physical", "background_m_s2": 2},
}

# of the twelve bearings some fail and some do not; each life has its spall long before its end
LIVES = {
    "corpus": {
        "rigs": 3,
        "specimens_per_rig": 4,
        "records_per_specimen": 40,
        "split": {"by": "specimen", "test": 0.25},
    },
    "storage.records_per_part": 80,
    "operation.shaft_rpm": "uniform(1400, 1800, per=specimen)",
    "operation.load_n": "uniform(4500, 6500, per=specimen)",
    "faults": [
        {"kind": "inner", "width_mm": 0.3, "angle_deg": "uniform(0, 360)", "roughness_um": 1},
        {"kind": "outer", "width_mm": 0.3, "angle_deg": "uniform(-40, 40)", "jagged_edge": {}},
        {"kind": "ball", "width_mm": 0.3, "axis_wander_deg": 4},
    ],
    "level": {"kind": "physical", "background_m_s2": 2},
    "life": {
        "cadence_h": 40,
        "growth_mm_per_mrev": 2,
        "history_h": 200,
        "load_history_percent": 10,
        "speed_history_percent": 3,
        "clearance_um_per_mrev": 0.05,
        "waviness_nm_per_mrev": 0.5,
    },
}
