"""``raceway export``: its forms, its output and its errors."""

import pytest

from gen.sharing.exporting import FORMS
from raceway.commands import exporting
from tests.corpora import write_corpus


@pytest.fixture(scope="module")
def corpus(tmp_path_factory):
    folder = tmp_path_factory.mktemp("corpus") / "c"
    write_corpus(folder)
    return folder


def test_the_command_offers_every_form():
    assert tuple(FORMS) == exporting.FORMS
    assert all(f"\n  {form} " in exporting.export.help for form in FORMS)


def test_an_export_says_how_many_records_and_files_there_are(run, told, corpus, tmp_path):
    done = run(
        "export", corpus, "-o", tmp_path / "out", "--to", "wav", "--where", "fault == 'inner'", "--channels", "b"
    )
    assert done.exit_code == 0
    assert "2 records as wav in 5 files" in done.stdout
    found = told("export", corpus, "-o", tmp_path / "told", "--to", "wav", "--split", "test")
    assert found == {
        "export": str(tmp_path / "told"), "to": "wav", "records": 3, "channels": 2, "files": 6,
        "bytes": sum(path.stat().st_size for path in (tmp_path / "told").rglob("*") if path.is_file()),
    }  # fmt: skip


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (["--to", "wav", "--channels", "z"], "channels: there is no channel 'z'"),
        (["--to", "wav", "--where", "falt == 1"], "falt"),
        (["--to", "xls"], "xls"),
    ],
    ids=lambda value: "_".join(value) if isinstance(value, list) else "",
)
def test_a_wrong_choice_is_one_sentence_and_writes_nothing(run, corpus, tmp_path, options, sentence):
    done = run("export", corpus, "-o", tmp_path / "out", *options)
    assert done.exit_code == 2
    assert sentence in done.stderr
    assert list(tmp_path.iterdir()) == []
