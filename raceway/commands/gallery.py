"""``raceway gallery``: a page of pictures of simulated signals."""

import time
from pathlib import Path

import click

from raceway.console import show
from raceway.console.options import json_option, pages_option
from raceway.console.progress import compilation_noticed


@click.command()
@pages_option("OUT", "Folder for index.html, its pictures, and the two small corpora they show.")
@json_option
def gallery(output: Path, as_json: bool) -> None:
    """Draw one page of simulated signals.

    The page has the seed paper's figures beside its statements, the envelope spectrum of every kind of fault (recipe every_fault), run-ups
    as waterfalls with the shaft orders drawn in (recipe run_up), and every fault of the measuring chain (recipe dirty_sensors).

      raceway gallery -o gallery
    """
    from raceway.studies.gallery import write_gallery

    start = time.monotonic()
    with compilation_noticed():
        page, pictures = write_gallery(output)
    if as_json:
        show.as_json({"page": page, "pictures": pictures})
        return
    show.text(f"{page}: {show.counted(len(pictures), 'picture')}, in {show.duration(time.monotonic() - start)}.")
