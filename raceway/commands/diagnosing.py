"""Command that diagnoses one recording of the user."""

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from raceway.console import show
from raceway.console.options import A_PATH, file_option, json_option
from raceway.console.progress import notice, notice_compilation

if TYPE_CHECKING:
    from features.diagnosis import Diagnosis, Recorded
    from gen.physics.bearing import Bearing

UNITS = ("g", "m/s2", "V")


def _number_or_name(_context: click.Context, _option: click.Parameter, text: str | None) -> int | str | None:
    return int(text) if text is not None and text.isdecimal() else text


def _a_number(_context: click.Context, _option: click.Parameter, value: float | None) -> float | None:
    if value is not None and math.isnan(value):  # it passes every range
        raise click.BadParameter("nan is not a number")
    return value


@click.command()
@click.argument("recording", metavar="RECORDING", type=A_PATH)
@click.option(
    "--bearing",
    required=True,
    metavar="BEARING",
    help="Designation in the catalogue, such as 6205, or a geometry: n_balls=8,pitch_diameter_mm=33.5,ball_diameter_mm=7.938.",
)
@click.option(
    "--rpm",
    "shaft_rpm",
    type=click.FloatRange(0.001, 1e7),
    required=True,
    callback=_a_number,
    metavar="RPM",
    help="Speed of the shaft during the recording.",
)
@click.option(
    "--rate",
    type=click.FloatRange(1, 1e8),
    callback=_a_number,
    metavar="HZ",
    help="Sample rate; a WAV file states its own.",
)
@click.option(
    "--unit",
    type=click.Choice(UNITS),
    default="m/s2",
    show_default=True,
    help="Unit of the values; V needs --sensitivity.",
)
@click.option(
    "--sensitivity",
    type=click.FloatRange(1e-6, 1e6),
    callback=_a_number,
    metavar="MV_PER_G",
    help="Of the sensor [mV per g], with --unit V.",
)
@click.option(
    "--column",
    callback=_number_or_name,
    metavar="NAME",
    help="Column of a table by name or number from 0; channel of a WAV file.",
)
@click.option("--variable", metavar="NAME", help="Variable of a MATLAB file; by default the only signal in it.")
@click.option(
    "--healthy",
    type=A_PATH,
    metavar="FILE",
    help="Recording of the same machine with a healthy bearing, read in the same way.",
)
@click.option("--model", type=A_PATH, metavar="MODEL", help="Model file; by default the reference model of this user.")
@click.option(
    "--speed",
    type=click.Choice(["off", "check", "correct"]),
    default="check",
    show_default=True,
    help="Believe --rpm, check it against the lines of the recording, or replace it where they clearly tell another speed.",
)
@file_option("REPORT", "Page with pictures: .html.", (".html",), kind="page", required=False)
@json_option
def diagnose(
    recording: Path,
    bearing: str,
    shaft_rpm: float,
    rate: float | None,
    unit: Any,
    sensitivity: float | None,
    column: int | str | None,
    variable: str | None,
    healthy: Path | None,
    model: Path | None,
    speed: Any,
    output: Path | None,
    as_json: bool,
) -> None:
    """Diagnose the bearing in a vibration recording.

    RECORDING is a .csv, .txt, .tsv, .dat, .npy, .mat or .wav file of at least 0.05 s, better 10 s, at 10 kHz or more. The answer is one
    sentence: what is wrong, how sure that is, and which lines of the signal tell it; or "unsure", with the reason and what would help.

      raceway diagnose pump.csv --bearing 6205 --rpm 1772 --rate 12000 --unit g -o pump.html
      raceway diagnose fan.wav --bearing 6205 --rpm 1480
      raceway diagnose motor.mat --variable DE_time --bearing 6205 --rpm 1750 --rate 12000 --unit g
      raceway diagnose volts.csv --column 2 --unit V --sensitivity 100 --bearing 6308 --rpm 990 --rate 25600
      raceway diagnose pump.csv --healthy new.csv --bearing 6205 --rpm 1772 --rate 12000 --json

    --json prints verdict, probabilities, shaft_rpm and evidence (line, order, frequency_hz, level_db, harmonic, band) and further facts.

    Without --model the reference model is used; the first call trains it, which takes some minutes, and so does
    raceway train domain_randomised. docs/diagnose.md tells how to record and how to read the page.
    """
    from gen.importers.bearing_text import bearing_from_text
    from gen.importers.signals import read_signal

    known = bearing_from_text(bearing)
    reading: dict[str, Any] = {
        "variable": variable,
        "column": column,
        "unit": unit,
        "sensitivity": sensitivity,
        "rate": rate,
    }
    paths = [path for path in (recording, healthy) if path is not None]
    signals = [read_signal(path, **reading) for path in paths]
    recorded = [
        _recording(signal.values, _rate(path, signal.fs), shaft_rpm, known, path)
        for path, signal in zip(paths, signals, strict=True)
    ]
    loaded, source = _model(model)
    from features.diagnosis import diagnose as run

    with notice_compilation():
        diagnosis = run(recorded[0], loaded, healthy=recorded[1] if healthy else None, speed=speed)
    # the diagnosis itself warns of an implausible rms
    notes = tuple(note for signal in signals for note in signal.warnings if "its rms" not in note)
    for sentence in (*notes, *diagnosis.warnings):
        notice(f"warning: {sentence}")
    if output is not None:
        from features.report.diagnosis import write_diagnosis

        facts = _assumptions(recorded[0], known, unit, sensitivity, rate, speed, healthy, source, notes)
        write_diagnosis(diagnosis, recorded[0], output, name=recording.name, assumed=facts)
    if as_json:
        show.as_json(_facts(diagnosis, recorded[0], recording, source, output, notes))
        return
    show.text(diagnosis.sentence, *(f"- {sentence}" for sentence in diagnosis.advice))
    if output is not None:
        show.text("", f"{output}: pictures, evidence and what was assumed.")


def _rate(path: Path, fs: float | None) -> float:
    if fs is None:
        raise click.UsageError(f"{path} does not state its sample rate; give it with --rate HZ")
    return fs


def _recording(values: Any, fs: float, shaft_rpm: float, bearing: "Bearing", path: Path) -> "Recorded":
    import numpy as np

    from features.diagnosis import Recorded
    from features.indicators import Orders
    from gen.physics.bearing import orders
    from gen.support.units import rpm_to_hertz

    nominal = Orders(*(np.asarray(order) for order in orders(bearing)))
    return Recorded(values, fs, rpm_to_hertz(shaft_rpm), nominal, str(path))


def _model(path: Path | None) -> tuple[Any, Path]:
    """Model and its file, or the reference model."""
    if path is None:
        from raceway.studies.reference_model import load_reference_model

        return load_reference_model()
    from features.baselines.models import Model

    return Model.load(path), path


def _facts(
    diagnosis: "Diagnosis", recorded: "Recorded", path: Path, source: Path, output: Path | None, notes: tuple[str, ...]
) -> dict[str, Any]:
    from features.diagnosis import FALSE_ALARM, line_facts

    return {
        "verdict": diagnosis.verdict,
        "probabilities": diagnosis.probabilities,
        "shaft_rpm": 60 * diagnosis.shaft_rate,
        "evidence": [line_facts(line) for line in diagnosis.evidence],
        "sentence": diagnosis.sentence,
        "advice": diagnosis.advice,
        "warnings": (*notes, *diagnosis.warnings),
        "labelled_rpm": 60 * diagnosis.labelled_rate,
        "threshold": diagnosis.threshold,
        "false_alarm": FALSE_ALARM,
        "band": None if diagnosis.spectrum is None else [round(edge, 1) for edge in diagnosis.spectrum.band],
        "duration_s": len(recorded.signal) / recorded.fs,
        "sample_rate_hz": recorded.fs,
        "windows": diagnosis.windows,
        "recording": path,
        "model": source,
        "report": output,
    }


def _assumptions(
    recorded: "Recorded",
    bearing: "Bearing",
    unit: str,
    sensitivity: float | None,
    rate: float | None,
    speed: str,
    healthy: Path | None,
    source: Path,
    notes: tuple[str, ...],
) -> list[tuple[str, str]]:
    """Facts for the page, by name."""
    orders = ", ".join(f"{name.upper()} {float(order):.3f}" for name, order in recorded.orders._asdict().items())
    angle = f", contact angle {math.degrees(bearing.contact_angle):.3g}°"
    facts = {
        "bearing": f"{bearing.designation}: {bearing.n_balls} {bearing.rolling_element}s of {1e3 * bearing.ball_diameter:.4g} mm on "
        f"{1e3 * bearing.pitch_diameter:.4g} mm{angle}, outer ring fixed",
        "orders": orders,
        "labelled speed": f"{60 * recorded.shaft_rate:,.6g} rpm ({speed})",
        "sample rate": f"{recorded.fs:,.6g} Hz, {'as given' if rate is not None else 'as the file states'}",
        "unit": unit + (f", {sensitivity:g} mV per g" if sensitivity is not None else ""),
        "healthy recording": "none" if healthy is None else healthy.name,
        "model": source.name,
        "notes": " ".join(notes),
    }
    return [(name, text) for name, text in facts.items() if text]
