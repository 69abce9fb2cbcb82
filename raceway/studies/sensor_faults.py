"""Pictures of every sensor fault and of a gear mesh, each beside the clean record, from the values of the recipe ``dirty_sensors``."""

from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure
from numpy.typing import NDArray

from features.report.pictures import INK, STYLE, VERMILION, WIDTH, picture, thin
from features.signal.spectra import psd
from gen.corpus import write_durably
from gen.measurement.gear import gear_mesh
from gen.measurement.measure import measure
from gen.measurement.sensor_faults import disturb
from gen.recipe import Recipe, read_recipe
from gen.scenarios import Purpose, Scenario, draw_scenarios
from gen.simulation.simulate import simulate

FloatArray = NDArray[np.floating]

DURATION = 2.0  # s, long enough to part the sidebands of a gear
SEGMENT = 0.5  # s, of the power spectral density
FAINTEST_DB = 80.0  # below the highest density drawn


class View(NamedTuple):
    """What to draw of a sensor fault: title, class of the bearing, window of the waveform [s], and band of the spectrum [Hz]."""

    title: str
    bearing: str
    window: float
    band: tuple[float, float]


VIEWS = {
    "loose_mount": View("Loose mount: resonance and rattle", "inner", 0.04, (0, 6000)),
    "saturation": View("Saturated amplifier", "inner", 0.02, (0, 6000)),
    "mains_hum": View("Mains hum", "healthy", 0.2, (0, 500)),
    "drift": View("Drift of the baseline", "healthy", DURATION, (0, 100)),
    "dropped_samples": View("Dropped samples", "healthy", 0.05, (0, 6000)),
    "gain_steps": View("Gain steps", "healthy", DURATION, (0, 6000)),
    "emi_bursts": View("EMI bursts", "healthy", 0.05, (0, 6000)),
    "gear_mesh": View("Gear mesh with sidebands of both gears", "healthy", 0.1, (0, 2500)),
}


def write_sensor_fault_pictures(output: Path) -> list[str]:
    """Draw one picture of each fault into a folder; returns the file names."""
    recipe = _with_every_fault(read_recipe("dirty_sensors"))
    fs, scenarios = recipe.recording.sample_rate_hz, draw_scenarios(recipe)
    of_bearing = {
        fault: next(one for one in scenarios if one.specimen.fault == fault)
        for fault in sorted({view.bearing for view in VIEWS.values()})
    }
    clean = {fault: _clean_record(scenario) for fault, scenario in of_bearing.items()}
    names = []
    for name, view in VIEWS.items():
        scenario, signal = of_bearing[view.bearing], clean[view.bearing]
        gear = name == "gear_mesh"
        shown = _with_gear(signal, scenario, fs) if gear else disturb(signal, _only(scenario, name), fs)[0]
        names.append(f"sensor-{name.replace('_', '-')}.png")
        write_durably(picture(draw_beside(signal[0], shown[0], fs, view), "png"), output / names[-1])
    return names


def _with_every_fault(recipe: Recipe) -> Recipe:
    """The recipe with long records, each of which has all sensor faults and a gear."""
    faults, gear = recipe.sensor_faults, recipe.background.gear_mesh
    always: dict[str, Any] = {name: section.model_copy(update={"probability": 1.0}) for name, section in faults}
    geared = {"gear_mesh": gear and gear.model_copy(update={"probability": 1.0})}
    return recipe.model_copy(
        update={
            "recording": recipe.recording.model_copy(update={"duration_s": DURATION}),
            "sensor_faults": faults.model_copy(update=always),
            "background": recipe.background.model_copy(update=geared),
        }
    )


def _clean_record(scenario: Scenario) -> FloatArray:
    """Record of a scenario without sensor faults and gear, shape (channel, time) [m s-2]."""
    rig = replace(scenario.rig, sensor_faults=None, background=replace(scenario.rig.background, gear=None))
    sound = replace(scenario, rig=rig, record=replace(scenario.record, sensor_faults=None))
    measured = measure(simulate([sound]).acceleration, [sound])
    return measured.signal[0] / (measured.counts_per_unit or 1.0)


def _only(scenario: Scenario, name: str) -> Scenario:
    """The scenario with one of its sensor faults, and the first channel alone on a loose mount."""
    rig, record = scenario.rig.sensor_faults, scenario.record.sensor_faults
    if rig is None or record is None:
        raise ValueError("scenario: has no sensor faults; draw it from a recipe that has them.")
    mounts = rig.loose_mounts[:1] if name == "loose_mount" else (None,)
    mounts += (None,) * (len(rig.loose_mounts) - 1)
    of_rig = {key: getattr(rig, key) if key == name else None for key in ("saturation", "mains_hum")}
    steps = record.gain_steps if name == "gain_steps" else ()
    of_record = {
        key: getattr(record, key) if key == name else None for key in ("drift", "dropped_samples", "emi_bursts")
    }
    return replace(
        scenario,
        rig=replace(scenario.rig, sensor_faults=replace(rig, loose_mounts=mounts, **of_rig)),
        record=replace(scenario.record, sensor_faults=replace(record, gain_steps=steps, **of_record)),
    )


def _with_gear(signal: FloatArray, scenario: Scenario, fs: float) -> FloatArray:
    """Record of a machine with the gear of its rig, at a constant speed."""
    gear = scenario.rig.background.gear
    if gear is None:
        raise ValueError("scenario: has no gear; draw it from a recipe that has one.")
    angles = 2 * np.pi * scenario.record.conditions.shaft_rate / fs * np.arange(signal.shape[1])
    level = scenario.rig.gain * scenario.rig.background_rms
    return signal + level * gear_mesh(gear, angles, scenario.rng(Purpose.GEAR_PHASE))


@rc_context(STYLE)
def draw_beside(clean: FloatArray, shown: FloatArray, fs: float, view: View) -> Figure:
    """Waveform round the largest change and power spectral density of a record with a fault, over those without.

    ``clean`` and ``shown`` have shape (time,) [m s-2].
    """
    figure = Figure(figsize=(2 * WIDTH, 2.6), layout="constrained")
    figure.suptitle(view.title, x=0.01, ha="left", fontsize=11, fontweight="bold")
    waveform, density = figure.subplots(1, 2)
    size = min(round(view.window * fs), len(clean))
    first = int(np.clip(np.argmax(np.abs(shown - clean)) - size // 3, 0, len(clean) - size))
    window, top = slice(first, first + size), -np.inf
    for signal, colour, width, label in ((shown, VERMILION, 1.0, "with the fault"), (clean, INK, 0.5, "without")):
        time, values = thin(np.arange(len(clean))[window] / fs, signal[window])
        waveform.plot(time, values, color=colour, linewidth=width, label=label)
        frequencies, power = psd(signal[None], fs, SEGMENT)
        visible = (frequencies >= view.band[0]) & (frequencies <= view.band[1])
        level = 10 * np.log10(np.maximum(power[0, visible], np.finfo(float).tiny))
        density.plot(frequencies[visible], level, color=colour, linewidth=width)
        top = max(top, level.max())
    waveform.set(xlabel="time [s]", ylabel="acceleration [m/s²]", xlim=(first / fs, (first + size) / fs))
    density.set(
        xlabel="frequency [Hz]", ylabel="PSD [dB re 1 (m/s²)²/Hz]", xlim=view.band, ylim=(top - FAINTEST_DB, top + 5)
    )
    figure.legend(*waveform.get_legend_handles_labels(), loc="outside upper right", ncols=2)
    return figure
