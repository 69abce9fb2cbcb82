"""Facts of a diagnosis for programs and for its page."""

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gen.physics.bearing_text import geometry_text
from gen.support.units import from_si
from raceway.importing.reading_options import Reading

if TYPE_CHECKING:
    from gen.physics.bearing import Bearing
    from raceway.diagnosis import Diagnosis, Pair
    from raceway.importing.recorded import Recorded


def diagnosis_facts(
    diagnosis: "Diagnosis", recorded: "Recorded", path: Path, source: Path, output: Path | None, notes: tuple[str, ...]
) -> dict[str, Any]:
    """Facts of one diagnosis, for JSON."""
    from raceway.diagnosis import FALSE_ALARM, line_facts

    pairs = [(pair, True) for pair in diagnosis.explanations] + [(pair, False) for pair in diagnosis.elsewhere]
    return {
        "verdict": diagnosis.verdict,
        "probabilities": diagnosis.probabilities,
        "bearing": diagnosis.bearing,
        "shaft_rpm": from_si(diagnosis.shaft_rate, "rpm"),
        "evidence": [line_facts(line) for line in diagnosis.evidence],
        "levels": [level._asdict() for level in diagnosis.levels],
        "explanations": [_pair_facts(pair, as_given=as_given) for pair, as_given in pairs],
        "sentence": diagnosis.sentence,
        "advice": diagnosis.advice,
        "warnings": (*notes, *diagnosis.warnings),
        "given_rpm": [from_si(rate, "rpm") for rate in diagnosis.given.rates],
        "threshold": diagnosis.threshold,
        "missed_share": None if math.isnan(diagnosis.missed) else diagnosis.missed,
        "false_alarm": FALSE_ALARM,
        "band": None if diagnosis.spectrum is None else [round(edge, 1) for edge in diagnosis.spectrum.band],
        "channels": list(recorded.signals),
        "duration_s": recorded.duration,
        "sample_rate_hz": recorded.fs,
        "windows": diagnosis.windows,
        "recording": path,
        "model": source,
        "report": output,
    }


def _pair_facts(pair: "Pair", *, as_given: bool) -> dict[str, Any]:
    return {
        "bearing": pair.bearing,
        "alike": list(pair.alike),
        "shaft_rpm": round(from_si(pair.rate, "rpm"), 2),
        "uncertainty_rpm": round(from_si(pair.uncertainty, "rpm"), 2),
        "lines": pair.lines,
        "as_given": as_given,
    }


def assumptions(
    recorded: "Recorded",
    bearings: dict[str, "Bearing"],
    diagnosis: "Diagnosis",
    reading: Reading,
    healthy: tuple[Path, ...],
    source: Path,
    notes: tuple[str, ...],
) -> list[tuple[str, str]]:
    """Facts for the page, by name."""
    bearing = bearings[diagnosis.bearing]
    orders = ", ".join(f"{name.upper()} {float(order):.3f}" for name, order in diagnosis.orders._asdict().items())
    low, high = (f"{from_si(rate, 'rpm'):,.6g}" for rate in diagnosis.given.rates)
    sensitivity = "" if reading.sensitivity is None else f", {reading.sensitivity:g} mV per g"
    facts = {
        "bearing": f"{bearing.designation}: {geometry_text(bearing)}, outer ring fixed",
        "orders": orders,
        "given bearings": ", ".join(bearings) if len(bearings) > 1 else "",
        "speed": f"{low} rpm" if low == high else f"{low} to {high} rpm",
        "channels": ", ".join(recorded.signals),
        "sample rate": f"{recorded.fs:,.6g} Hz, {'as given' if reading.rate is not None else 'as the file states'}",
        "unit": f"{reading.unit or recorded.unit}{sensitivity}",
        "healthy recording": ", ".join(path.name for path in healthy) or "none",
        "model": source.name,
        "notes": " ".join(notes),
    }
    # what was not asked for needs no row
    return [(name, text) for name, text in facts.items() if text]
