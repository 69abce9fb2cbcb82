"""The feature table of a corpus that a command names, with progress and warnings."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from raceway.console import show
from raceway.console.options import USUAL, USUAL_ANALYSIS, Analysis, Team
from raceway.console.progress_bar import notice, progress, warn

if TYPE_CHECKING:
    import xarray as xr

    from features.baselines import Model
    from features.table.recording_speeds import Speed


def notice_of_unknown(corpus: Path, unknown: int) -> None:
    """Say how many records of a corpus are left out because their class is not known."""
    if unknown:
        notice(f"{corpus}: {show.count_text(unknown, 'record')} of class unknown left out.")


def table_of(
    corpus: Path,
    speed: "Speed" = "off",
    team: Team = USUAL,
    analysis: Analysis = USUAL_ANALYSIS,
    window: float | None = None,
) -> "xr.Dataset":
    """Feature table of a corpus, with progress, and warnings of labelled speeds that differ from the lines."""
    from features import feature_table
    from features.table.corpus_features import band_warnings
    from features.table.definitions import GROUPS
    from features.table.recording_speeds import speed_warnings
    from gen.corpus import read_manifest

    options = team.options(read_manifest(corpus).records) | analysis.options()
    with progress("computing features", "blocks") as report:
        table = feature_table(
            corpus, analysis.with_groups(GROUPS), speed=speed, window=window, **options, progress=report
        )
    for sentence in (*band_warnings(table), *speed_warnings(table)):
        warn(sentence)
    return table


def tables_for(
    model: "Model",
    corpora: Sequence[Path],
    speed: "Speed" = "off",
    team: Team = USUAL,
    channel: str | tuple[str, ...] | None = None,
) -> "list[xr.Dataset]":
    """Feature tables of corpora that are scored together, as a model takes them: in its band, and cut into records as long as its own."""
    from features.baselines.classifying import suited_to

    suited = suited_to(model, *corpora)
    analysis = Analysis(channel, suited.band, tuple(model.groups))
    return [table_of(corpus, speed, team, analysis, suited.window) for corpus in corpora]
