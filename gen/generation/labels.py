"""Variables stored with each record: operating conditions, labels and the truth of the simulation, copied from where they are known."""

from importlib.metadata import version
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus import DRAWS, FAULTS, LIFE, SIMULATED, SPLITS, identity, make_dataset
from gen.measurement.measure import Measured
from gen.mechanisms.background.section import labels_of
from gen.mechanisms.labels import LABELS
from gen.physics.bearing import orders
from gen.scenarios import Scenario, common_settings, scenario_texts, simulation_errors
from gen.simulation.simulate import Response


@simulation_errors()
def part_dataset(measured: Measured, response: Response, step_error: NDArray[np.float64] | None = None) -> xr.Dataset:
    """Measured records with their labels, in the layout of the corpus; ``step_error`` is NaN throughout if it is not given."""
    scenarios, rows = measured.scenarios, []
    settings = common_settings(scenarios)
    of_records = zip(scenarios, response.truth, measured.detectable, measured.chain_labels, strict=True)
    for one, truth, seen, chain in of_records:
        unseen = settings.undetected == "healthy" and not seen
        scenario = one.without_fault() if unseen else one
        labels = dict.fromkeys((label.name for label in LABELS), 0) | labels_of(scenario.rig.background) | chain
        for drawn in scenario.specimen.damage.values():
            labels |= {name: value for name, value in drawn.items() if name in labels}
        rows.append(_drawn(scenario) | (truth.without_fault() if unseen else truth)._asdict() | labels)
    columns: dict[str, Any] = {name: [row[name] for row in rows] for name in rows[0]}
    columns |= {
        "clipped": measured.clipped,
        "snr": measured.snr,
        "fault_snr": measured.fault_snr,
        "fault_share": measured.fault_share,
        "detectable": measured.detectable,
        "oversampling": response.oversampling,
        "step_phase": response.step_phase,
        "step_error": np.full(len(rows), np.nan) if step_error is None else step_error,
        DRAWS: scenario_texts(scenarios),
    }
    lives = [scenario.record.life for scenario in scenarios]
    if any(lives):
        columns |= {
            one.name: [np.nan if (value := getattr(life, one.name)) is None else value for life in lives]
            for one in LIFE
        }
        columns["bearing"] = [f"{one.rig.bearing.designation} #{one.specimen.number}" for one in scenarios]
    return make_dataset(
        measured.signal,
        settings.sample_rate,
        settings.channels,
        columns,
        extra=SIMULATED + LABELS + (LIFE if any(lives) else ()),
        counts_per_unit=measured.counts_per_unit,
        attributes={
            "title": f"Records of recipe {settings.recipe}",
            "history": f"simulated by raceway {version('raceway')} with recipe {settings.recipe}, seed {settings.seed}",
            "source": "simulation: Hertz contact shaft-bearing model, classical Runge-Kutta",
        },
    )


def _drawn(scenario: Scenario) -> dict[str, Any]:
    """Variables of one record that are copied from its scenario."""
    settings, rig, specimen, record = scenario.settings, scenario.rig, scenario.specimen, scenario.record
    conditions = record.conditions
    return {
        "sample_rate": settings.sample_rate,
        "axial_load": conditions.axial_load,
        "temperature": np.nan if rig.lubricant is None else conditions.temperature,
        **orders(rig.bearing)._asdict(),
        "bearing": rig.bearing.designation,
        "fault": FAULTS.index(specimen.fault),
        "parts": "+".join(specimen.damaged_parts),
        "n_spalls": len(specimen.spalls),
        "rig": rig.number,
        "specimen": specimen.number,
        "recording": record.number,
        "pair": record.pair,
        "rung": record.rung,
        "split": SPLITS.index(specimen.split),
        "source": f"{settings.recipe}/{record.number}",
        "identity": identity(settings.corpus, rig.number, specimen.number, record.number, record.pair),
        "diametral_clearance": specimen.properties["diametral_clearance"],
        "gain": rig.gain if record.snr is None else np.nan,
        "background_rms": rig.background_rms if record.snr is None else np.nan,
        "fault_tries": specimen.fault_try,
        "level_tries": record.level_try,
    }
