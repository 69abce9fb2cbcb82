"""Command that draws one record of a corpus, or a recording of the user."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from raceway.console import show
from raceway.console.options import A_PATH, Analysis, band_option, picture_option
from raceway.console.progress_bar import warn
from raceway.importing.reading_options import Reading, check_speed, drawing_options, rpm_option

if TYPE_CHECKING:
    from raceway.reports.pictures import DrawnRecord

_ONE_CHANNEL = "a picture shows one channel; give one with --channel"
VIEWS = ("waveform", "psd", "envelope", "kurtogram", "coherence", "orders", "waterfall", "cepstrum")


@click.command()
@click.argument("source", metavar="DIR|FILE", type=A_PATH)
@click.option(
    "--record",
    type=int,
    metavar="I",
    help="Of a corpus: number of the record, from 0; without it, an example of each class is drawn.",
)
@click.option(
    "--view", type=click.Choice(VIEWS), help="One view of a record; by default waveform, PSD and envelope spectrum."
)
@picture_option
@click.option("--healthy", metavar="I|FILE", help="Record of the same corpus, or recording, drawn under it as healthy.")
@click.option(
    "--bearing", metavar="BEARING", help="Of a recording: designation, geometry or orders, as for raceway diagnose."
)
@rpm_option("a recording needs it, or --speed-column")
@band_option
@drawing_options
def plot(
    source: Path,
    record: int | None,
    view: str | None,
    output: Path,
    healthy: str | None,
    bearing: str | None,
    speeds: tuple[float, float] | None,
    band: tuple[float, float] | None,
    reading: Reading,
) -> None:
    """Draw records of a corpus, or a recording.

      raceway plot corpus -o classes.png
      raceway plot corpus --record 17 -o record.png
      raceway plot corpus --record 17 --view waterfall -o run_up.png
      raceway plot corpus --record 17 --healthy 3 --view envelope -o record.png --channel fan_end --band 2000 9000
      raceway plot pump.csv --bearing 6205 --rpm 1797 --rate 12000 --view kurtogram -o pump.png
      raceway plot run_up.wav --bearing 6205 --rpm 600-3000 --view orders -o run_up.png

    The views: waveform, psd (power spectral density), envelope (spectrum of the squared envelope), kurtogram (kurtosis by band),
    coherence (spectral coherence), orders (order spectrum of the signal), waterfall (envelope spectra over time), cepstrum. Without
    --record, a corpus is drawn as waveform and envelope spectrum of one record of each class.

    Lines of the fault are shaded, their sidebands dotted, lines of other faults dashed. A recording has no known fault. At a speed that
    varies, --rpm is its range; the speed is then found in the signal, and the lines are drawn over orders of the shaft.
    """
    check_speed(speeds, reading)
    of_corpus = _is_corpus(source)
    if record is not None and not of_corpus:
        raise click.UsageError(f"--record is for a corpus, and {source} is a recording; leave it out")
    # a number is a record of the same corpus, anything else a file
    number = int(healthy) if of_corpus and healthy is not None and healthy.isdecimal() else None
    under_path = None if healthy is None else source if number is not None else Path(healthy)
    if of_corpus and (under_path is None or _is_corpus(under_path)):
        _refuse_options_of_recordings(source)
    # without any choice: a record of each class
    if of_corpus and not reading.channels and (record, view, healthy, band) == (None,) * 4:
        _draw_classes(source, output)
        return
    from gen.support.errors import CorpusError
    from raceway.reports.pictures import draw_record, write_picture
    from raceway.reports.views import draw_view

    shown = _shown(source, record, bearing, speeds, band, reading)
    if band is not None and shown.recorded_band.high < band[1]:
        low, high = shown.recorded_band
        warn(f"{source}: is recorded up to half its sample rate of {shown.fs:g} Hz; the band is {low:g}-{high:g} Hz.")
    under = None if under_path is None else _shown(under_path, number, bearing, speeds, band, reading)
    try:
        figure = draw_record(shown, under) if view is None else draw_view(view, shown, under)
    except ValueError as error:
        raise CorpusError(f"{source}: cannot be drawn as {view or 'a record'}: {error}") from None
    write_picture(figure, output)
    what = source.name if record is None else f"record {record} of {source}"
    show.text(f"{output}: {what}.")


def _refuse_options_of_recordings(corpus: Path) -> None:
    """A corpus states what these options say, which would act on nothing."""
    context = click.get_current_context()
    names = {"bearing", "speeds", *Reading._fields} - {"channels"}
    for option in context.command.params:
        if option.name in names and context.params[option.name] is not None:
            raise click.UsageError(f"{option.opts[0]} is for a recording, and {corpus} is a corpus; leave it out")


def _draw_classes(corpus: Path, output: Path) -> None:
    from gen.corpus import open_corpus
    from gen.support.errors import CorpusError
    from raceway.reports.examples import draw_overview
    from raceway.reports.pictures import write_picture

    with open_corpus(corpus) as opened:
        try:
            figure = draw_overview(opened)
        except ValueError as error:
            raise CorpusError(f"{corpus}: {error}") from None
    write_picture(figure, output)
    show.text(f"{output}: a record of each class of {corpus}.")


def _is_corpus(source: Path) -> bool:
    return source.is_dir() or source.suffix == ".nc"


def _shown(
    source: Path,
    record: int | None,
    bearing: str | None,
    speeds: tuple[float, float] | None,
    band: tuple[float, float] | None,
    reading: Reading,
) -> "DrawnRecord":
    from gen import bearing_orders
    from gen.support.units import rpm_to_hertz
    from raceway.reports.subject import shown_record, shown_recording

    options = Analysis(band=band).options()
    if len(reading.channels) > 1:
        raise click.UsageError(_ONE_CHANNEL)
    if _is_corpus(source):
        if record is None:
            raise click.UsageError(f"{source} is a corpus: give the number of a record with --record")
        return shown_record(source, record, next(iter(reading.channels), 0), options["band"])
    if bearing is None or (speeds is None and reading.speed_column is None):
        raise click.UsageError(f"{source} is a recording: give --bearing and --rpm, which tell where its lines lie")
    from raceway.importing.user_folder import read_recording

    # what was assumed of the file is told
    recorded, _, notes = read_recording(source, reading)
    for note in notes:
        warn(note)
    if len(recorded.signals) > 1:
        raise click.UsageError(f"{_ONE_CHANNEL}; {source.name} has {', '.join(recorded.signals)}")
    (signal,) = recorded.signals.values()
    # the mean of a measured course is exact
    low, high = (recorded.rpm or 0.0,) * 2 if speeds is None else speeds
    rates = rpm_to_hertz(low), rpm_to_hertz(high)
    shown = shown_recording(source.name, signal, recorded.fs, rates, bearing_orders(bearing), options["band"])
    return shown._replace(unit=recorded.unit)
