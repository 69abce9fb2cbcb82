"""Corpora compared file by file."""

from gen.corpus import validate_corpus


def files(corpus):
    """Bytes of all files of a corpus by their names."""
    found = [corpus] if corpus.is_file() else [path for path in corpus.rglob("*") if path.is_file()]
    return {path.relative_to(corpus): path.read_bytes() for path in found}


def assert_the_same_corpus(corpus, whole):
    assert validate_corpus(corpus) == []
    assert files(corpus) == files(whole.path)
    assert not corpus.with_name(f"{corpus.name}.parts").exists()
