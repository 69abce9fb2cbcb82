"""The page of the seed paper, and the command that writes it; experiments by hand are in tests/thorough/test_paper_experiments.py."""

import json

import pytest

from studies.ophel2025.__main__ import main


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """Folder with the page of one preset, and the numbers beside it."""
    folder = tmp_path_factory.mktemp("page") / "ophel"
    assert main(["--preset", "paper", "-o", str(folder)]) == 0
    return folder, json.loads((folder / "findings.json").read_text())["findings"]


def test_the_figures_and_the_statements_are_on_one_page(written):
    folder, findings = written
    assert sorted(path.name for path in folder.iterdir()) == ["findings.json", "ophel2025.html"]
    page = (folder / "ophel2025.html").read_text()
    assert page.count("data:image/png") == 4
    assert page.count("data:image/svg") == 2
    assert "src=" not in page.replace('src="data:', "")
    for finding in findings:
        assert f">{finding['id']}<" in page
        assert (f"paper, {finding['id']}: " in page) == (not finding["holds"])
        assert f"amended: {finding['amended']}" in page or not finding["amended"]


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (("--preset", "printed"), "'printed' is not one of 'paper', 'paper-hertz', 'paper-refit'"),
        (("--change", "stiffness=1"), "'stiffness' is none of housing_mass, ring_stiffness,"),
        (("--change", "housing_mass=0"), "housing_mass=0: give a number, above zero for a mass or a rate"),
        (("--preset", "paper", "--change", "support_stiffness_x=-1e9"), "paper-changed: the displacements grow"),
    ],
)
def test_an_experiment_that_cannot_be_run_is_refused_in_one_sentence(tmp_path, capsys, options, sentence):
    assert main([*options, "-o", str(tmp_path / "out")]) == 2
    error = capsys.readouterr().err
    assert sentence in error
    assert error.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_page_of_the_user_is_not_replaced(tmp_path, capsys):
    (tmp_path / "ophel2025.html").write_text("my own")
    assert main(["--preset", "paper", "-o", str(tmp_path)]) == 2
    assert "was not made by raceway" in capsys.readouterr().err
    assert (tmp_path / "ophel2025.html").read_text() == "my own"
