"""Command that diagnoses a recording of the user, or each of a folder."""

import os
from collections.abc import Sequence
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING

import click

from raceway.console import show
from raceway.console.options import A_PATH, checked_file, checked_pages, json_option, model_option
from raceway.console.progress_bar import notice_compilation, warn
from raceway.diagnosis.tables import INDEX, LIST, LIST_KIND, rows_of, show_table, write_index
from raceway.importing.reading_options import Reading, Speeds, check_speed, reading_options, rpm_option

if TYPE_CHECKING:
    from gen.physics.bearing import Bearing
    from raceway.importing.recorded import Recorded

ONE_TURN = 60.0  # rpm; lower speeds may be meant in Hz


def _checked_output(context: click.Context, option: click.Parameter, path: Path | None) -> Path | None:
    """Page of a recording, or folder for the pages of a folder of them."""
    recording: Path = context.params["recording"]
    if path is not None and recording.is_dir():
        if path.resolve() == recording.resolve():
            raise click.BadParameter(f"{path} is the folder of the recordings; give another one for the pages")
        from gen.corpus import check_result  # not at the top: help needs nothing of gen

        checked_pages(context, option, path)
        check_result(path / LIST, LIST_KIND)
        return path
    return path and checked_file(path, (".html",), "page")


@click.command()
@click.argument("recording", metavar="RECORDING|FOLDER", type=A_PATH, is_eager=True)
@click.option(
    "--bearing",
    "bearings",
    multiple=True,
    metavar="BEARING",
    help="Designation in the catalogue, such as 6205; a geometry: n_balls=8,pitch_diameter_mm=33.5,ball_diameter_mm=7.938; or the orders "
    "that its maker prints: bpfo=3.585,bpfi=5.415,bsf=2.357,ftf=0.398. "
    "Repeat it for alternatives; without it, the whole catalogue is searched.",
)
@rpm_option("by default the one that the file states, or else 300 to 6,000 rpm are searched")
@click.option(
    "--speed-table",
    "speed_table",
    type=A_PATH,
    metavar="FILE.csv",
    help="Speeds of the recordings of a FOLDER in place of --rpm: a table with the columns file and rpm.",
)
@reading_options
@click.option(
    "--healthy",
    type=A_PATH,
    multiple=True,
    metavar="FILE",
    help="Recording of the same machine with a healthy bearing, for which --rate, --unit and --channel hold, too; give the option again "
    "for further ones.",
)
@model_option
@click.option(
    "-o",
    "--output",
    type=A_PATH,
    metavar="REPORT",
    callback=_checked_output,
    help="Page with pictures: .html; of a FOLDER a folder of such pages, with index.html and diagnoses.csv.",
)
@json_option
def diagnose(
    recording: Path,
    bearings: tuple[str, ...],
    speeds: Speeds | None,
    speed_table: Path | None,
    reading: Reading,
    healthy: tuple[Path, ...],
    model: Path | None,
    output: Path | None,
    as_json: bool,
) -> None:
    """Diagnose the bearing in a vibration recording.

    RECORDING is a text, Excel, MATLAB, NumPy, WAV, Parquet, TDMS or UFF file of at least 8 turns of the shaft and 3 kHz, better 10 s and
    20 kHz. The answer is one sentence: what is wrong, how sure that is, and which lines of the signal tell it; or "unsure", with the reason
    and what would help. For a FOLDER it is a table with a row for each recording; a file that states another rate or unit than the options
    is read as it states, but a WAV file at the rate of the option.

      raceway diagnose pump.csv --bearing 6205 --rpm 1772 --rate 12000 --unit g -o pump.html
      raceway diagnose fan.wav --bearing 6205 --rpm 1400-1600
      raceway diagnose fan.wav --bearing 6203 --bearing 6205 --rpm 1480
      raceway diagnose motor.mat --channel '*_DE_time' --bearing 6205 --rpm 1750 --rate 12000 --unit g
      raceway diagnose volts.csv --channel x,y --unit V --sensitivity 100 --bearing 6308 --rpm 990 --rate 25600
      raceway diagnose pump.csv --healthy new.csv --bearing 6205 --rpm 1772 --rate 12000 --json
      raceway diagnose spring_campaign --channel 1 --bearing 6205 --rpm 1480 -o pages
      raceway diagnose spring_campaign --channel 1 --bearing 6205 --speed-table speeds.csv

    All axes of one sensor are used, such as x, y, z; --channel chooses. Give a speed, a bearing or both. The answer names the pair of
    bearing and speed that explains the lines, and names no part if pairs that cannot be told apart give different answers.

    --json prints, of a FOLDER in a list, verdict, probabilities, shaft_rpm, evidence (line, order, frequency_hz, level_db, harmonic,
    band), levels and explanations (bearing, alike, shaft_rpm, uncertainty_rpm, lines, as_given), and further facts.

    The first call trains the three parts of the reference model, in about half a minute.
    docs/diagnose.md tells how to record and how to read the page.
    """
    from gen.corpus import make_result_folder
    from raceway.importing.user_folder import readings_of, recordings_in, set_aside

    check_speed(speeds, reading, speed_table)
    candidates = _bearings(bearings)
    several = recording.is_dir()
    unusable: dict[Path, str] = {}
    # a table of speeds may lie among the recordings
    tables = [] if speed_table is None else [speed_table]
    paths = recordings_in(recording, [*healthy, *tables]) if several else [recording]
    by_file = _speeds_by_file(speed_table, recording, paths, healthy)
    # the lines alone fit many bearings
    needs_speed = not (bearings or speeds or by_file)
    readings = readings_of(paths, reading, unusable if several else None, needs_speed=needs_speed)
    first = next(readings, None)  # before the model, so that whatever is missing is told at once
    if first is None:
        raise click.UsageError(f"no recording can be used; the first of {len(paths)}: {next(iter(unusable.values()))}")
    # healthy recordings are read before the model, so that a wrong file is told at once
    compared = [_read_healthy(path, recording, reading) for path in healthy]
    references = [recorded for recorded, *_ in compared]
    doubts = _doubts(speeds) + tuple(note for *_, notes in compared for note in notes)
    for sentence in doubts:
        warn(sentence)
    from gen.support.garbage import keep_garbage

    # the libraries of the model hold much that is never freed, and collecting garbage among it takes time
    with keep_garbage():
        from gen.physics.bearing import orders
        from raceway.diagnosis import diagnose_recording, given_of
        from raceway.diagnosis.diagnosis_facts import assumptions, diagnosis_facts
        from raceway.kept_models import open_model

        loaded, source = open_model(model)

    nominal, answers = {name: orders(bearing) for name, bearing in candidates.items()}, []
    # one recording at a time, read when its turn comes
    for path, recorded, used, of_file in chain((first,), readings):
        own_speeds = by_file.get(path.name, speeds)
        of_file += _doubts(by_file.get(path.name))
        if own_speeds is None and (rpm := recorded.rpm):
            own_speeds = rpm, rpm
            # the mean of a measured course is told already
            if not used.speed_column:
                of_file += (f"{path.name}: it states a speed of {rpm:g} rpm, which is used.",)
        own = given_of(nominal, own_speeds)
        # channels have their names in this recording, also those of the healthy ones
        recorded, *alike = [each.renamed(recorded.matched) for each in (recorded, *references)]
        with set_aside(path, unusable if several else None), notice_compilation():
            diagnosis = diagnose_recording(recorded, own, loaded, healthy=alike)
        if path in unusable:
            continue
        notes = tuple(dict.fromkeys(of_file + doubts))
        for sentence in of_file + diagnosis.warnings:
            warn(f"{f'{path.name}: ' if several else ''}{sentence.removeprefix(f'{path.name}: ')}")
        # signs in place of bytes that are no text, which not every disk takes
        readable = os.fsencode(path.name).decode(errors="backslashreplace")
        page = output and (output / f"{readable}.html" if several else output)
        if page is not None:
            from raceway.diagnosis.diagnosis_page import write_diagnosis  # matplotlib takes 0.3 s to load

            if not page.parent.is_dir():  # of a folder of recordings
                make_result_folder(page.parent)
            facts = assumptions(recorded, candidates, diagnosis, used, healthy, source, notes)
            write_diagnosis(diagnosis, recorded, page, healthy=alike, name=path.name, assumed=facts)
        answers.append(diagnosis_facts(diagnosis, recorded, path, source, page, notes))
    # files that could not be used stand in the table, too
    rows = rows_of(answers, unusable)
    if several and output is not None:
        write_index(rows, recording.resolve().name, output)
    if as_json:
        errors = [{"recording": path, "error": sentence} for path, sentence in unusable.items()]
        show.as_json([*answers, *errors] if several else answers[0])
        return
    if several:
        show_table(rows)
    else:
        show.text(answers[0]["sentence"], *(f"- {sentence}" for sentence in answers[0]["advice"]))
    if output is not None:
        show.text("", f"{output / INDEX if several else output}: pictures, evidence and what was assumed.")


def _read_healthy(path: Path, recording: Path, reading: Reading) -> "tuple[Recorded, Reading, tuple[str, ...]]":
    """Healthy recording, read with the options of the recording, or of a folder as it states."""
    from gen.support.errors import CorpusError
    from raceway.importing.user_folder import read_as_stated, read_recording

    try:
        return (read_as_stated if recording.is_dir() else read_recording)(path, reading)
    except CorpusError as error:
        if recording.suffix == path.suffix:
            raise
        raise CorpusError(
            f"{error} It is read as {recording.name} is: write both in one form, such as .csv with the same names of columns."
        ) from None


def _speeds_by_file(
    table: Path | None, folder: Path, recordings: Sequence[Path], healthy: Sequence[Path]
) -> dict[str, Speeds]:
    """Speeds of the recordings of a folder by the names of their files; empty without a table."""
    if table is None:
        return {}
    if not folder.is_dir():
        raise click.UsageError(f"--speed-table is for a FOLDER; give the speed of {folder.name} with --rpm")
    from raceway.importing.speed_tables import read_speed_table

    return read_speed_table(table, recordings, healthy)


def _doubts(speeds: Speeds | None) -> tuple[str, ...]:
    """Sentence on a speed that may be in Hz."""
    if speeds is None or speeds[1] >= ONE_TURN:
        return ()
    typed, meant = ("-".join(f"{factor * speed:g}" for speed in dict.fromkeys(speeds)) for factor in (1, 60))
    return (f"{typed} rpm is less than one turn a second; if it is Hz, give {meant} rpm.",)


def _bearings(texts: tuple[str, ...]) -> dict[str, "Bearing"]:
    """Bearings by name: those that are given, or the catalogue."""
    from gen.physics.bearing_text import bearing_from_text, geometry_text
    from gen.physics.catalogue import CATALOGUE

    bearings = {
        geometry_text(bearing) if bearing.designation == "own" else bearing.designation: bearing
        for bearing in map(bearing_from_text, texts)
    }
    return bearings or dict(CATALOGUE)
