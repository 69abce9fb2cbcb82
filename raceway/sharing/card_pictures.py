"""Pictures and scores of a data card: ``corpus -> pictures/*.png``, ``results.json -> scores``, both listed in ``card.json``.

``record-CLASS.png`` shows the waveform, power spectral density and squared envelope spectrum of one record of a class, ``content.png`` the
distributions of speed, load and severity by class. The same corpus and libraries give the same bytes.
"""

import io
from pathlib import Path

import xarray as xr
from matplotlib.figure import Figure
from PIL import Image
from pydantic import TypeAdapter, ValidationError

from features.baselines import Results
from gen.corpus import (
    UNKNOWN,
    class_counts,
    lock,
    open_corpus,
    read_manifest,
    remove_temporary_files,
    write_durably,
    writing,
)
from gen.support.errors import CorpusError
from gen.support.limits import check_limit
from raceway.reports.examples import examples_of
from raceway.reports.pictures import draw_record, picture
from raceway.reports.summaries import draw_content
from raceway.sharing.card.additions import (
    PICTURES,
    CardAdditions,
    CardPicture,
    CardScore,
    CardScores,
    read_additions,
    write_additions,
)
from raceway.sharing.card.card_page import card_folder, check_card
from raceway.sharing.publishing import describe

DPI = 110
COLOURS = 48  # of a picture: lines, text and shades look the same, and the file has half the size


def complete_card(path: Path, scores: Path | None = None) -> CardAdditions:
    """Draw the pictures of a corpus, take over scores, and write its data card; returns what was added.

    Without ``scores``, those that the card already has are kept.

    Raises
    ------
    CorpusError
        If the corpus is unfinished or altered, the scores are of another corpus, or a file cannot be written.
    """
    check_card(path)
    with open_corpus(path) as corpus:
        # a wrong file of scores is refused before anything is drawn
        rows = None if scores is None else read_scores(scores, corpus)
        manifest, folder = read_manifest(path), card_folder(path)
        with writing(folder):
            folder.mkdir(exist_ok=True)
        with lock(folder):
            remove_temporary_files(folder)
            # what an earlier call added stays, unless it is given again
            additions = read_additions(folder, manifest)
            write_additions(
                folder, additions
            )  # first, since it tells the folder of a card from one that holds something else
            pictures = _write_pictures(folder / PICTURES, corpus)
            added = CardAdditions(parts=additions.parts, pictures=pictures, scores=rows or additions.scores)
            write_additions(folder, added)
            describe(path)
    return added


def _write_pictures(folder: Path, corpus: xr.Dataset) -> tuple[CardPicture, ...]:
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
    drawn: list[CardPicture] = []
    # a typical record of each class
    for fault, (shown, caption) in examples_of(corpus).items():
        if shown is not None:
            drawn.append(CardPicture(name=f"record-{fault}.png", title=f"One record: {fault}", caption=caption))
            write_durably(small_png(draw_record(shown)), folder / drawn[-1].name)
    drawn.append(
        CardPicture(
            name="content.png",
            title="Records by rig, and distributions",
            caption="Records of each class, stacked; sizes of faults are of the records that have them.",
        )
    )
    write_durably(small_png(draw_content(corpus)), folder / drawn[-1].name)
    return tuple(drawn)


def small_png(figure: Figure) -> bytes:
    """Picture with few colours; equal figures give equal bytes."""
    figure.set_dpi(DPI)
    with Image.open(io.BytesIO(picture(figure, "png"))) as drawn:
        few = drawn.convert("RGB").quantize(COLOURS, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    stream = io.BytesIO()
    few.save(stream, "PNG", optimize=True)
    return stream.getvalue()


def read_scores(path: Path, corpus: xr.Dataset) -> CardScores:
    """Scores of a corpus from ``results.json`` of ``raceway benchmark``.

    Raises
    ------
    CorpusError
        If the file is none, or its scores are of another corpus: one with another title, or other counts of records.
    """
    # a file of scores comes from anywhere
    try:
        check_limit("manifest_bytes", path.stat().st_size if path.is_file() else 0, f"{path}:", CorpusError)
        results = TypeAdapter(Results).validate_json(path.read_bytes() if path.is_file() else b"")
    except (OSError, ValidationError):
        raise CorpusError(f"{path}: is not a file of scores; give results.json of raceway benchmark.") from None
    # scores belong to the card of the corpus that they were measured on
    here, tested = class_counts(corpus["fault"]), results.corpus
    here.pop(UNKNOWN, None)
    if tested.title != corpus.attrs.get("title") or tested.classes != here:
        raise CorpusError(
            f"{path}: has scores of another corpus ({tested.title!r}, {tested.records} records); run raceway benchmark on this one."
        )
    return CardScores(
        track=results.track,
        folds=results.folds,
        seed=results.seed,
        features=tuple(results.groups),
        classes=tuple(tested.classes),
        records=tested.records,
        raceway=results.versions.get("raceway", "unknown"),
        rows=tuple(
            CardScore(
                name=name,
                score=baseline.grouped.balanced_accuracy,
                interval=baseline.grouped.interval,
                random_records=baseline.leaky.balanced_accuracy,
                permuted_labels=baseline.null.balanced_accuracy,
            )
            for name, baseline in results.baselines.items()
        ),
    )
