"""Command that computes features, and the feature table that further commands need."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from raceway.console import show
from raceway.console.corpus_table import table_of
from raceway.console.options import (
    A_CORPUS,
    Analysis,
    Team,
    band_option,
    channels_option,
    file_option,
    group_option,
    json_option,
    speed_option,
    worker_options,
)

if TYPE_CHECKING:
    from features.table.recording_speeds import Speed


@click.command()
@click.argument("corpus", metavar="DIR", type=A_CORPUS, required=False)
@file_option("FILE", "Feature table: .nc or .parquet.", (".nc", ".parquet"), kind="feature table", required=False)
@click.option("--list", "listed", is_flag=True, help="List the features with unit, range and meaning instead.")
@channels_option
@band_option
@group_option
@speed_option
@worker_options
@json_option
def features(
    corpus: Path | None,
    output: Path | None,
    listed: bool,
    channel: tuple[str, ...] | None,
    band: tuple[float, float] | None,
    groups: tuple[str, ...],
    speed: "Speed",
    team: Team,
    as_json: bool,
) -> None:
    """Compute the features of every record of DIR.

    The table has one row per record, with the features of its signal and all its labels. It does not depend on the number of workers.
    Several channels are further columns of a Parquet file, and a dimension of a netCDF file. For CSV, read the Parquet file with pandas.

      raceway features corpus -o features.nc
      raceway features corpus -o features.parquet
      raceway features corpus -o features.nc --channel fan_end --band 300 9000
      raceway features corpus -o features.parquet --channel drive_end,fan_end
      raceway features recordings -o features.nc --speed correct
      raceway features corpus -o features.nc --workers 8
      raceway features --list
    """
    if listed:
        _list_features(Analysis(band=band), as_json)
        return
    if corpus is None or output is None:
        raise click.UsageError("Missing argument 'DIR' or option '-o' / '--output': only --list needs neither.")
    from features.table.table_files import check_destination, write_table

    check_destination(output)
    first, *more = channel or (None,)
    table = table_of(corpus, speed, team, Analysis(channel if more else first, band, groups))
    write_table(table, output)
    records, columns = table.sizes["record"], table.sizes["feature"]
    missing = table.attrs["records_with_missing_features"]
    if as_json:
        facts = {"table": output, "records": records, "features": columns, "records_with_missing_features": missing}
        other = table.attrs.get("recordings_with_other_speed")  # none if speeds were not estimated
        show.as_json(facts | {"recordings_with_other_speed": other})
        return
    lacking = f"; some are missing in {show.count_text(missing, 'record')}" if missing else ""
    show.text(f"{output}: {columns} features of {show.count_text(records, 'record')}{lacking}.")


def _list_features(analysis: Analysis, as_json: bool) -> None:
    from features.table.definitions import ALL_GROUPS, define_features

    defined = define_features(ALL_GROUPS, analysis.options()["band"])
    if as_json:
        show.as_json({"features": [feature._asdict() for feature in defined]})
        return
    rows = ((feature.group, feature.name, feature.unit, feature.range, feature.meaning) for feature in defined)
    show.columns([("group", "feature", "unit", "range", "meaning"), *rows])
