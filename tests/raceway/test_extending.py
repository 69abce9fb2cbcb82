"""The command that extends a corpus."""

import shutil

import pytest

from gen.corpus import EXTENSION_NAME, read_manifest, write_manifest


@pytest.fixture
def corpus(tiny_corpus, tmp_path):
    return shutil.copytree(tiny_corpus, tmp_path / "corpus")


def test_extend_adds_specimens_or_rigs(run, told, corpus):
    before = read_manifest(corpus)
    added = told("extend", corpus, "--specimens", 1)
    assert added["records"] == before.records + added["added"]
    assert read_manifest(corpus).parts[: len(before.parts)] == before.parts
    result = run("extend", corpus, "--rigs", 1)
    assert f"of the records are new.\nNext: raceway info {corpus}\n" in result.stdout
    assert result.stderr.splitlines()[-1].startswith("extending: ")
    assert "extended by 1 specimen in every rig, extended by 1 rig" in " ".join(run("info", corpus).stdout.split())
    assert told("validate", corpus)["valid"]
    assert told("replay", corpus, "--record", read_manifest(corpus).records - 1)["identical"]


def test_info_tells_of_an_unfinished_extension(run, corpus):
    write_manifest(corpus, read_manifest(corpus).parts, complete=False, name=EXTENSION_NAME)
    assert "the raceway extend command that began it completes it" in " ".join(run("info", corpus).stdout.split())


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("--rigs", 0), "0 is not in the range x>=1"),
        ((), "give one of the two numbers, rigs or specimens"),
        (("--rigs", 1, "--specimens", 1), "give one of the two numbers, rigs or specimens"),
        (("--rigs", 1), "no such folder"),
    ],
)
def test_extend_refuses_what_it_cannot_do(run, tmp_path, arguments, sentence):
    result = run("extend", tmp_path / "none", *arguments)
    assert result.exit_code == 2
    assert sentence in result.stderr
