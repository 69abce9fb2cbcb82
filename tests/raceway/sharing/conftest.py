"""Corpora that are copied and joined."""

import pytest

from tests import tone_corpora


@pytest.fixture(scope="session")
def tones(tmp_path_factory):
    """Folders of three corpora of tones, each of 12 records, 4 specimens and one machine; change copies alone."""
    folders = [tmp_path_factory.mktemp("tones") / f"tones-{seed}" for seed in range(3)]
    for seed, folder in enumerate(folders):
        tone_corpora.write_corpus(folder, specimens=4, parts=1, seed=seed)
    return folders
