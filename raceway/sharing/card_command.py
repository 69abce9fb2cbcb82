"""Command that makes the data card of a corpus, with its terms of use, pictures and scores."""

import re
import shlex
from pathlib import Path
from typing import Any

import click

from raceway.console import show
from raceway.console.options import A_PATH, corpus_argument, json_option


def _creators(_context: click.Context, _option: click.Parameter, texts: tuple[str, ...]) -> list[dict[str, str]]:
    """Name and, if given, ORCID of each creator."""
    creators: list[dict[str, str]] = []
    for text in texts:
        match = re.fullmatch(r"\s*([^<>]*[^<>\s])\s*(?:<\s*([^<>]+?)\s*>)?\s*", text)
        if match is None:
            raise click.BadParameter(f"{text!r} is not a name; write 'Jane Doe' or 'Jane Doe <0000-0002-1825-0097>'")
        name, orcid = match.groups()
        creators.append({"name": name} | ({"orcid": orcid} if orcid else {}))
    return creators


@click.command()
@corpus_argument
@click.option("--license", metavar="SPDX", help="Licence as an SPDX identifier, such as CC-BY-4.0.")
@click.option(
    "--creator",
    "creators",
    multiple=True,
    metavar="'NAME <ORCID>'",
    callback=_creators,
    help="A person or organisation that made the corpus, with the ORCID if there is one. Repeatable.",
)
@click.option("--institution", metavar="NAME", help="Institution at which the corpus was made.")
@click.option("--doi", metavar="DOI", help="DOI of the corpus, such as 10.1000/182.")
@click.option("--references", multiple=True, metavar="TEXT", help="A paper or page on the corpus. Repeatable.")
@click.option("--contact", metavar="E-MAIL", help="E-mail address for questions.")
@click.option("--date", metavar="YYYY-MM-DD", help="Day on which the corpus was made.")
@click.option("--scores", type=A_PATH, metavar="FILE", help="results.json of raceway benchmark on this corpus.")
@json_option
def card(corpus: Path, scores: Path | None, as_json: bool, **facts: Any) -> None:
    """Complete the data card of DIR for publication.

    The card is DIR/README.md; that of a single file NAME.nc is NAME.card/README.md. It is made from the files of the corpus, with a
    picture of one record of each class and of the distributions (pictures). Facts that are given replace those of the corpus, also in
    index.nc and manifest.json, or in the attributes of the single file; the others stay. No record changes. Call it again after any
    change of the corpus, or if a call was interrupted.

      raceway card corpus --license CC-BY-4.0 --creator "Jane Doe <0000-0002-1825-0097>" --date 2026-03-31
      raceway card corpus --doi 10.1000/182 --references "J. Doe, Bearings, 2026"
      raceway benchmark corpus -o report
      raceway card corpus --scores report/results.json

    Next: read DIR/README.md, then raceway copy DIR -o NAME.nc
    """
    from gen.corpus import read_manifest
    from raceway.sharing import publish
    from raceway.sharing.card.card_page import card_folder
    from raceway.sharing.card_pictures import complete_card

    # facts that are given replace those of the corpus
    facts = {name: value for name, value in facts.items() if value}
    publish(corpus, read_manifest(corpus).publication | facts)
    publication = read_manifest(corpus).publication
    added = complete_card(corpus, scores)
    written = card_folder(corpus) / "README.md"
    rows = () if added.scores is None else added.scores.rows
    if as_json:
        pictures = [written.parent / "pictures" / picture.name for picture in added.pictures]
        scored = {row.name: row.score for row in rows}
        show.as_json({"card": written, "pictures": pictures, "scores": scored, "publication": publication})
        return
    scored = f", scores of {show.count_text(len(rows), 'classifier')}" if rows else ""
    show.text(f"{written}: {show.count_text(len(added.pictures), 'picture')}{scored}.")
    # what readers of a published corpus will look for
    missing = [
        name for name in ("license", "creator", "date") if not publication.get(name.replace("creator", "creators"))
    ]
    if missing:
        show.text(
            f"Before you publish it: raceway card {shlex.quote(str(corpus))} {' '.join(f'--{name} ...' for name in missing)}"
        )
