"""Options that name healthy records of a rig, and the feature table of these."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from raceway.console.corpus_table import table_of
from raceway.console.options import A_PATH, Analysis, Decorator, Team
from raceway.console.progress_bar import notice
from raceway.importing.reading_options import DECIMAL_MARKS, MARKS, mark_of

if TYPE_CHECKING:
    import xarray as xr

    from features.table.recording_speeds import Speed


_OPTIONS = {key: f"--reference-{key}" for key in ("column", "variable", "rate", "delimiter", "decimal")}


def _number_or_name(_context: click.Context, _option: click.Parameter, text: str | None) -> int | str | None:
    return int(text) if text is not None and text.isdecimal() else text


def _existing(_context: click.Context, _option: click.Parameter, path: Path | None) -> Path | None:
    if path is not None and not path.exists():
        raise click.BadParameter(f"there is no {path}; give a corpus or a recording")
    return path


def reference_options(command: Any) -> Any:
    """Add the options for a reference: a corpus, or a recording and how it is read."""
    options: list[Decorator] = [
        click.option(
            "--reference",
            type=A_PATH,
            callback=_existing,
            metavar="DIR_OR_RECORDING",
            help="Corpus or recording of the same rig, healthy.",
        ),
        click.option(
            "--reference-rpm",
            type=click.FloatRange(0.001, 1e7),
            metavar="RPM",
            help="Speed of the recording, if DIR has several.",
        ),
        click.option(
            "--reference-rate",
            type=click.FloatRange(1, 1e8),
            metavar="HZ",
            help="Sample rate of the recording, if its file does not state it; by default that of DIR.",
        ),
        click.option(
            "--reference-column",
            callback=_number_or_name,
            metavar="NAME",
            help="Column of the recording by name or number from 0; channel of a WAV file.",
        ),
        click.option("--reference-variable", metavar="NAME", help="Variable of the recording, if it is a MATLAB file."),
        click.option(
            "--reference-delimiter",
            type=click.Choice([*MARKS]),
            callback=mark_of,
            help="Mark between columns of the recording, if it is a text.",
        ),
        click.option(
            "--reference-decimal",
            type=click.Choice(DECIMAL_MARKS),
            help="Decimal mark of the recording, if it is a text.",
        ),
    ]
    # click lists options from the last decorator to the first
    for option in reversed(options):
        command = option(command)
    return command


def reference_table(
    path: Path,
    corpus: Path,
    table: "xr.Dataset",
    speed: "Speed",
    team: Team,
    analysis: Analysis,
    reading: Mapping[str, Any],
) -> "xr.Dataset":
    """Feature table of a reference of the corpus whose own feature table is ``table``.

    ``reading`` has the values of the options that say how a recording is read; its speed is believed.
    """
    from features.baselines.reference_choice import check_durations, recording_reference
    from gen.support.units import rpm_to_hertz
    from raceway.importing.acceleration import Place, read_shape

    if path.is_file():
        place = Place(*(reading[f"reference_{key}"] for key in Place._fields))
        signal = read_shape(path, place, reading["reference_rate"], _OPTIONS)
        for note in signal.warnings:
            notice(f"warning: {note}")
        # a file without a rate is taken to be recorded as the corpus was
        fs = float(table["sample_rate"].max()) if signal.fs is None else signal.fs
        if signal.fs is None:
            notice(f"{path}: does not state its sample rate; {fs:g} Hz is used, as in {corpus} (--reference-rate).")
        rpm = reading["reference_rpm"]
        rate = None if rpm is None else rpm_to_hertz(rpm)
        return recording_reference(signal.values, fs, corpus, path, rate, analysis.options()["band"])
    # the corpus is its own reference: each rig has healthy records
    if path.resolve() == corpus.resolve():
        return table
    check_durations(corpus, path)
    return table_of(path, speed, team, analysis)
