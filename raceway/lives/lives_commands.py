"""Commands for corpora of lives: a picture of a life, and scores of estimates of remaining life."""

from pathlib import Path

import click

from raceway.console import show
from raceway.console.corpus_table import table_of
from raceway.console.options import (
    A_CORPUS,
    USUAL_ANALYSIS,
    Team,
    corpus_argument,
    json_option,
    picture_option,
    worker_options,
)


@click.command()
@corpus_argument
@picture_option
@click.option(
    "--bearing", metavar="NAME", help="Bearing, such as '6206 #3'; by default the one with most damaged snapshots."
)
@click.option("--like", type=A_CORPUS, metavar="OTHER", help="Also draw all lives beside those of another corpus.")
def life(corpus: Path, output: Path, bearing: str | None, like: Path | None) -> None:
    """Draw the life of a bearing in DIR, a corpus of lives.

      raceway life corpus -o life.png
      raceway life corpus -o life.png --bearing "6206 #3"
      raceway life corpus -o life.png --like pronostia

    The picture has the spectra of its snapshots over its age, its rms, and the true length of its spall with the first detection.
    """
    from raceway.lives.life_pictures import draw_life
    from raceway.reports.pictures import write_picture

    write_picture(draw_life(corpus, bearing, like), output)
    show.text(f"{output}: a life of {corpus}.")


@click.command()
@corpus_argument
@click.option("--test", "tested", type=A_CORPUS, metavar="OTHER", help="Test on the bearings of another corpus.")
@click.option(
    "--folds", type=click.IntRange(2), default=5, show_default=True, help="Splits by bearing, without --test."
)
@worker_options
@json_option
def prognose(corpus: Path, tested: Path | None, folds: int, team: Team, as_json: bool) -> None:
    """Score estimates of remaining life on the bearings of DIR.

    No split parts the snapshots of a bearing. Each estimate stands beside those by age alone; without_signal is the boosting without
    features, its control.

      raceway prognose corpus
      raceway prognose corpus --test pronostia
      raceway prognose corpus --json
    """
    from gen.corpus import open_corpus
    from gen.support.units import from_si
    from raceway.lives.prognosis import SHARES, check_lives, score_lives

    # refused before the features are computed, which takes minutes
    for one in (corpus, tested or corpus):
        with open_corpus(one) as opened:
            check_lives(opened, str(one))
    tables = [None if one is None else table_of(one, "off", team, USUAL_ANALYSIS) for one in (corpus, tested)]
    assert tables[0] is not None  # noqa: S101
    scores = score_lives(tables[0], tables[1], folds=folds)
    if as_json:
        show.as_json({"lives": scores.to_dict("index")})
        return
    at = tuple(f"mae_{100 * share:.0f}" for share in SHARES)
    others = "phm_2012", "alpha_lambda", "concordance"
    show.table(
        (
            "estimate",
            *(f"error at {name[4:]} % [h]" for name in at),
            "PHM 2012",
            "within 20 %",
            "concordance",
            "before [h]",
        ),
        (
            (
                str(name),
                *(f"{from_si(row[column], 'h'):,.1f}" for column in at),
                *(f"{row[column]:.3f}" for column in others),
                f"{from_si(row['mae_before'], 'h'):,.1f}",
            )
            for name, row in scores.iterrows()
        ),
    )
    show.text("before: error while the bearing has no spall, where nothing may be better than without_signal.")
