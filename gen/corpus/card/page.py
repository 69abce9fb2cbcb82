"""The whole data card: a page in Markdown on the records of a corpus, their faults, labels and terms of use."""

from pathlib import Path

from gen.corpus.card import additions, labels, origin
from gen.corpus.card.contents import contents
from gen.corpus.card.markdown import plain_text
from gen.corpus.card.opening import opening
from gen.corpus.card.ranges import ranges
from gen.corpus.card.terms import citation, terms
from gen.corpus.files import CARD_SUFFIX, corpus_around, place_of, write_text_durably
from gen.corpus.index import open_corpus
from gen.corpus.manifest import RECIPE_NAME, corpus_files, read_manifest, recipe_text
from gen.support.errors import CorpusError


def card_folder(path: Path) -> Path:
    """Folder of the data card of a corpus: its own, or for a single file ``NAME.nc`` the folder ``NAME.card`` beside it."""
    return path.with_suffix(CARD_SUFFIX) if path.is_file() else path


def check_card(path: Path) -> None:
    """Refuse a file of records that lies in a corpus, or has something else than its data card in the folder for it."""
    folder = card_folder(path)
    if folder == path:
        return
    if (corpus := corpus_around(place_of(path).parent)) is not None:
        raise CorpusError(f"{path}: is a file of the corpus {corpus}; give that corpus.")
    is_card = (folder / additions.CARD_NAME).exists() and corpus_around(folder) is None
    if not is_card and any(folder.glob("[!.]*")):  # hidden files are those of a killed call
        raise CorpusError(f"{folder}: holds no data card of raceway; move it, or give the corpus another name.")


def data_card(path: Path | str) -> str:
    """Data card of a finished corpus, made from its files: the same files give the same page.

    Raises
    ------
    CorpusError
        If the corpus is unfinished, or one of its files is missing or of another size than in the manifest.
    """
    path = Path(path)
    manifest = read_manifest(path)
    added = additions.read_additions(card_folder(path), manifest)
    with open_corpus(path, check="size") as corpus:
        title = plain_text(corpus.attrs.get("title", "Untitled corpus"))
        lines = [
            f"# {title}",
            "",
            *origin.origin(corpus, manifest),
            "",
            *contents(corpus, manifest.signals),
            *terms(manifest.publication),
            *additions.pictures(added.pictures),
            *opening(path, corpus_files(path, "size")[0]),
            *ranges(corpus),
            *labels.findings(corpus),
            *additions.scores(added.scores),
            *citation(title, manifest, manifest.publication),
            *origin.rebuilding(corpus, manifest),
            *origin.left_out(manifest),
            *labels.meanings(corpus),
            "",
        ]
    return "\n".join(lines)


def write_card(path: Path | str) -> None:
    """Write the data card of a finished corpus, ``README.md``, whole or not at all, and beside that of a single file its recipe."""
    path = Path(path)
    if path.is_file() and (recipe := recipe_text(path)) is not None:
        write_text_durably(recipe, card_folder(path) / RECIPE_NAME)
    write_text_durably(data_card(path), card_folder(path) / "README.md")
