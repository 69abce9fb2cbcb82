"""``docs/developing.md`` lists files that exist, for the tasks it promises."""

import re

import pytest

from tests.paths import ROOT

TASKS = (
    "fault class", "source of vibration", "fault of the measuring chain", "command", "feature group", "channel", "importer",
    "form of copy", "baseline", "bearing", "label",
)  # fmt: skip
PAGE = (ROOT / "docs" / "developing.md").read_text(encoding="utf-8")
FILE = re.compile(r"^(\d+)\. `([\w/.-]+)`: (.+(?:\n   .+)*)", re.MULTILINE)


def steps(task):
    """Number, file and sentence of each step of a task."""
    _, _, section = PAGE.partition(f"\n### A{'n' if task[0] in 'aeiou' else ''} {task}\n")
    return FILE.findall(section.partition("\n### ")[0])


@pytest.mark.parametrize("task", TASKS)
def test_a_task_lists_its_files_in_order_and_says_what_to_do_in_each(task):
    found = steps(task)
    assert [int(number) for number, _, _ in found] == list(range(1, len(found) + 1))
    assert found
    assert all(len(sentence.split()) >= 3 and sentence.endswith(".") for _, _, sentence in found)


@pytest.mark.parametrize("task", TASKS)
def test_every_file_of_a_task_exists_and_a_new_one_has_a_folder(task):
    files = [ROOT / file for _, file, _ in steps(task)]
    missing = [file for file in files if not (file.parent.is_dir() if "NAME" in file.stem else file.is_file())]
    assert missing == []


def test_no_numbered_step_escapes_the_check():
    assert sum(len(steps(task)) for task in TASKS) == len(re.findall(r"^\d+\. ", PAGE, re.MULTILINE))


def test_every_name_that_a_task_puts_in_a_file_is_there():
    """``NAMES``, ``_CODECS`` ...: a constant that a sentence names stands in the file of its step."""
    for task in TASKS:
        for _, file, sentence in steps(task):
            if (ROOT / file).is_file():
                text = (ROOT / file).read_text(encoding="utf-8")
                named = re.findall(r"(?:to|in) `(_?[A-Z][A-Z_]+)`(?! in)", sentence)
                assert [name for name in named if not re.search(rf"\b{name}\b", text)] == [], f"{task}: {file}"
