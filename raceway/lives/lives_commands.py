"""Commands for corpora of lives: a picture of a life, and scores of estimates of remaining life."""

from pathlib import Path

import click

from raceway.console import show
from raceway.console.corpus_table import table_of
from raceway.console.options import (
    A_CORPUS,
    Team,
    corpus_argument,
    finite,
    json_option,
    picture_option,
    worker_options,
)
from raceway.console.progress_bar import notice, warn


@click.command()
@corpus_argument
@picture_option
@click.option(
    "--bearing",
    metavar="NAME",
    help="Bearing, such as '6206 #3', or its number in the corpus, such as 3; by default the failed one with most damaged snapshots.",
)
@click.option(
    "--like",
    type=A_CORPUS,
    metavar="OTHER",
    help="Also draw the rms of bearings that failed beside those of another corpus.",
)
def life(corpus: Path, output: Path, bearing: str | None, like: Path | None) -> None:
    """Draw the life of a bearing in DIR, a corpus of lives.

      raceway life corpus -o life.png
      raceway life corpus -o life.png --bearing "6206 #3"
      raceway life corpus -o life.png --like pronostia

    The picture has the spectra of its snapshots over its age, its rms, and the true length of its spall with the first detection.
    """
    from raceway.lives.life_pictures import draw_life
    from raceway.reports.pictures import write_picture

    figure = draw_life(corpus, bearing, like)
    write_picture(figure, output)
    show.text(f"{output}: life of {figure.get_label()} of {corpus}.")


@click.command()
@corpus_argument
@click.option("--test", "tested", type=A_CORPUS, metavar="OTHER", help="Test on the bearings of another corpus.")
@click.option(
    "--folds",
    type=click.IntRange(2),
    metavar="K",
    default=5,
    show_default=True,
    help="Splits by bearing, without --test.",
)
@click.option(
    "--false-alarms",
    type=click.FloatRange(0),
    metavar="N",
    callback=finite,
    help="Snapshots above the threshold of a detector in 1,000 h before spalls begin; by default 1.",
)
@worker_options
@json_option
def prognose(
    corpus: Path, tested: Path | None, folds: int, false_alarms: float | None, team: Team, as_json: bool
) -> None:
    """Score remaining life and early warning on lives in DIR.

    No split parts the snapshots of a bearing. Each estimate stands beside those by age alone; without_signal is the boosting without
    features, its control. Where the corpus knows when a spall can first be seen, a second table has the delay of alarms beyond it, at a
    fixed rate of false alarms.

      raceway prognose corpus
      raceway prognose corpus --test pronostia
      raceway prognose corpus --json
    """
    from gen.corpus import open_corpus, specimen_numbers, unit_counts
    from gen.support.errors import CorpusError
    from gen.support.units import from_si
    from raceway.lives.early_warning import check_seen, warn_early
    from raceway.lives.prognosis import SHARES, bearing_folds, check_lives, score_lives

    # refused before the features are computed, which takes minutes
    for lives in (corpus, tested or corpus):
        with open_corpus(lives) as opened:
            check_lives(opened, str(lives))
            if tested is None:
                bearing_folds(specimen_numbers(opened), folds)
            if false_alarms is not None:
                check_seen(opened, str(lives))
    table, other = table_of(corpus, team=team), tested and table_of(tested, team=team)
    notice("estimating remaining lives, which can take minutes.")
    scores = score_lives(table, other, folds=folds)
    notice("setting thresholds of alarms, which can take minutes.")
    warned, rate = None, 1.0 if false_alarms is None else false_alarms
    try:
        warned = warn_early(table, other, alarms_per_1000_h=rate, folds=folds)
    except CorpusError as error:
        sentence = f"no early warning: {error}"
        # who asks for a rate wants early warning
        if false_alarms is not None:
            raise CorpusError(sentence) from None
        warn(sentence)
    if as_json:
        warnings = {} if warned is None else {"early_warning": warned.to_dict("index")}
        show.as_json({"lives": scores.to_dict("index")} | warnings)
        return
    errors = {f"mae_{100 * share:.0f}": f"error at {100 * share:.0f} % [h]" for share in SHARES}
    ratios = {"phm_2012": "PHM 2012", "alpha_lambda": "within 20 %", "concordance": "concordance"}
    columns = {**errors, **ratios, "mae_before": "before [h]"}
    rows = (
        [name, *(f"{row[key]:.3f}" if key in ratios else f"{from_si(row[key], 'h'):,.1f}" for key in columns)]
        for name, row in scores.iterrows()
    )
    show.table(("estimate", *columns.values()), rows)
    scored = unit_counts(table if other is None else other).specimens
    show.text(
        f"before: error while the bearing has no spall, of {scored} bearings. A boosting far below without_signal there is chance if "
        "bearings are few, and else a sign that features or splits give lives away. The other rows do not see the signal."
    )
    if warned is not None:
        rows = (
            [
                name,
                f"{row.alarms_per_1000_h:.2f}",
                f"{row.missed:.2f}",
                f"{from_si(row.delay, 'h'):,.1f}",
                f"{from_si(row.delay_90, 'h'):,.1f}",
                f"{row.time_left:.2f}",
            ]
            for name, row in warned.iterrows()
        )
        show.table(("early warning", "false alarms in 1,000 h", "missed", "delay [h]", "90 % [h]", "time left"), rows)
        show.text(
            "delay: from the first snapshot in which the spall can be seen at all, the median and that of nine of ten alarms; time left: "
            "share of the time to the last one; missed: share of the bearings with a visible spall that get no alarm."
        )
        if rate and warned["allowed"].min() < 1:
            notice(
                f"a training is too short for {rate:g} false alarms in 1,000 h: its threshold is its highest number."
            )
