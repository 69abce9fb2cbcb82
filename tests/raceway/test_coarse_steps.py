"""Records whose step is too coarse: generate, info and validate say how many, and which key to change."""

import re

import pytest

SENTENCE = re.compile(
    r"[1-9]\d* of the \d+ records whose step was checked change by more than 5 % \(up to \d+ %\) at half the step; "
    r"raise recording\.oversampling above \d+\."
)


@pytest.fixture(scope="module")
def fast(tiny_recipe, tmp_path_factory):
    """Recipe of a shaft that turns so fast that a ball passes a spall within one of the steps that the recipe asks for."""
    path = tmp_path_factory.mktemp("fast") / "fast.yaml"
    given = tiny_recipe.read_text().replace("uniform(4500, 6000)", "60000")
    path.write_text(given.replace("duration_s: 0.1", "duration_s: 0.1, oversampling: 4"))
    return path


def test_every_command_that_shows_a_corpus_tells_of_coarse_steps(run, told, fast, tmp_path):
    made = run("generate", fast, "-o", tmp_path / "c", "--workers", 1)
    assert made.exit_code == 0
    sentence = SENTENCE.search(made.stderr)
    assert sentence is not None
    assert sentence[0] in run("info", tmp_path / "c").stdout
    assert sentence[0] in told("info", tmp_path / "c")["warnings"]
    checked = run("validate", tmp_path / "c")
    assert (checked.exit_code, checked.stdout) == (0, f"{tmp_path / 'c'}: sound.\n")
    assert sentence[0] in checked.stderr
