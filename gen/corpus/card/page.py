"""The whole data card: a page in Markdown on the records of a corpus, their faults, labels and terms of use."""

from pathlib import Path

from gen.corpus.card import additions, labels, origin
from gen.corpus.card.contents import contents
from gen.corpus.card.markdown import plain_text
from gen.corpus.card.opening import opening
from gen.corpus.card.ranges import ranges
from gen.corpus.card.terms import citation, terms
from gen.corpus.files import write_text_durably
from gen.corpus.index import open_corpus
from gen.corpus.manifest import read_manifest


def data_card(directory: Path | str) -> str:
    """Data card of a finished corpus, made from the files in its folder: the same files give the same page.

    Raises
    ------
    CorpusError
        If the corpus is unfinished, or one of its files is missing or of another size than in the manifest.
    """
    directory = Path(directory)
    manifest = read_manifest(directory)
    added = additions.read_additions(directory, manifest)
    with open_corpus(directory, check="size") as corpus:
        title = plain_text(corpus.attrs.get("title", "Untitled corpus"))
        lines = [
            f"# {title}",
            "",
            *origin.origin(corpus, manifest),
            "",
            *contents(corpus, manifest.signals),
            *terms(manifest.publication),
            *additions.pictures(added.pictures),
            *opening(directory / "parts" / manifest.parts[0].name),
            *ranges(corpus, origin.recipe_files(directory)),
            *labels.findings(corpus),
            *additions.scores(added.scores),
            *citation(title, manifest, manifest.publication),
            *origin.rebuilding(manifest),
            *origin.left_out(manifest),
            *labels.meanings(corpus),
            "",
        ]
    return "\n".join(lines)


def write_card(directory: Path | str) -> None:
    """Write the data card of a finished corpus, ``README.md``, whole or not at all."""
    directory = Path(directory)
    write_text_durably(data_card(directory), directory / "README.md")
