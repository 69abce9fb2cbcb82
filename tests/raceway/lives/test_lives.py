"""``raceway life`` and ``raceway prognose`` on a few lives."""

import re

import pytest

from gen.corpus import open_corpus, unit_counts
from gen.generation.corpus import generate
from gen.recipe import Recipe
from gen.support.errors import CorpusError
from gen.support.units import range_text
from raceway.lives.life_pictures import draw_life
from tests.conftest import small_with
from tests.recipes import LIVES


@pytest.fixture(scope="module")
def lives(tmp_path_factory):
    folder = tmp_path_factory.mktemp("lives") / "c"
    generate(Recipe(small_with(LIVES)), folder)
    return folder


def test_a_picture_has_the_course_of_one_life(lives):
    with open_corpus(lives) as corpus:
        damaged = corpus.isel(record=(corpus.event.values == 1) & (corpus.stage.values > 0))
        longest = damaged.bearing.to_series().value_counts()
    figure = draw_life(lives)
    assert figure.axes[0].get_title("left").split(":")[0] in longest[longest == longest.max()].index
    spall = figure.axes[2].lines[0].get_ydata()
    assert 0 == spall[0] < spall[-1] <= 6
    figure.canvas.draw()
    numbers = [label.get_text() for label in figure.axes[1].get_yticklabels(which="both") if label.get_text()]
    assert all(float(number) > 0 for number in numbers)
    assert len(numbers) > 1
    assert figure.axes[3].get_ylabel() == "dB re 1 (m/s²)²/Hz"
    assert figure.axes[1].get_legend().get_window_extent().y0 >= figure.axes[1].bbox.y1


def test_lives_are_told_in_hours(run, told, lives):
    (shown,) = re.findall(r"rul ([\d.,]+ to [\d.,]+ h \([\d.,]+ to [\d.,]+ s\))", run("info", lives).stdout)[:1]
    low, high = told("info", lives)["severities"]["healthy"]["rul"]
    assert shown == range_text("rul", low, high, "s")
    assert float(shown.split()[2].replace(",", "")) == pytest.approx(high / 3600, rel=0.01)


def test_a_bearing_that_is_not_there_is_named(lives, tiny_corpus):
    with pytest.raises(CorpusError, match="has no bearing 6205 #99; it has 6205 #0, "):
        draw_life(lives, "6205 #99")
    with pytest.raises(CorpusError, match="has no lives"):
        draw_life(tiny_corpus)


@pytest.mark.usefixtures("tables_once")
def test_the_commands_draw_and_score(run, lives, tmp_path):
    drawn = run("life", lives, "-o", tmp_path / "x.png", "--bearing", 1).stdout
    assert drawn == f"{tmp_path / 'x.png'}: life of 6205 #1 of {lives}.\n"
    assert (tmp_path / "x.png").read_bytes().startswith(b"\x89PNG")
    assert "are among those of the training" in run("prognose", lives, "--test", lives).stderr
    shown = run("prognose", lives, "--folds", 2)
    with open_corpus(lives) as corpus:
        assert f"of {unit_counts(corpus).specimens} bearings" in shown.stdout
    hours = [cell for row in shown.stdout.splitlines()[1:6] for cell in (*row.split()[1:4], row.split()[-1])]
    assert len(hours) == 20
    assert all(re.fullmatch(r"\d{1,3}(,\d{3})*\.\d", cell) for cell in hours), hours
    assert re.search("^early warning .* missed .* 90 % .* time left$", shown.stdout, re.MULTILINE)
    assert all(f"{column}: " in shown.stdout for column in ("missed", "delay", "time left"))


@pytest.mark.usefixtures("tables_once")
def test_without_twins_early_warning_is_left_out_but_not_for_those_who_ask_for_it(run, tmp_path):
    generate(Recipe(small_with(LIVES | {"truth": {"twins": False}})), tmp_path / "c")
    sentence = (
        "knows of no spall when it can first be seen; early warning needs simulated lives with truth.twins: true.\n"
    )
    shown = run("prognose", tmp_path / "c", "--folds", 2)
    assert shown.stderr.endswith(f"\nwarning: no early warning: the feature table: {sentence}")
    assert "early warning" not in shown.stdout
    refused = run("prognose", tmp_path / "c", "--false-alarms", 1)
    assert (refused.exit_code, refused.stderr) == (2, f"{tmp_path / 'c'}: {sentence}")


@pytest.mark.usefixtures("tables_once")
@pytest.mark.parametrize(("options", "code", "begun"), [((), 0, "warning: "), (("--false-alarms", 1), 2, "")])
def test_a_reason_against_early_warning_says_what_is_missing(run, lives, monkeypatch, options, code, begun):
    def refuse(*_, **__):
        raise CorpusError("a training has one bearing; use more bearings.")

    monkeypatch.setattr("raceway.lives.early_warning.warn_early", refuse)
    shown = run("prognose", lives, "--folds", 2, *options)
    assert shown.exit_code == code
    assert shown.stderr.splitlines()[-1] == f"{begun}no early warning: a training has one bearing; use more bearings."


@pytest.mark.parametrize("rate", ["nan", "inf", "-1"])
def test_a_rate_of_false_alarms_that_is_none_is_refused_before_any_feature_is_computed(run, lives, monkeypatch, rate):
    monkeypatch.setattr("raceway.lives.lives_commands.table_of", lambda *_, **__: pytest.fail("features were computed"))
    result = run("prognose", lives, "--false-alarms", rate)
    assert result.exit_code == 2
    assert "--false-alarms" in result.stderr


@pytest.mark.parametrize("options", [(), ("--test",)])
def test_only_lives_are_scored_and_others_are_refused_before_any_feature_is_computed(
    run, lives, tiny_corpus, monkeypatch, options
):
    monkeypatch.setattr("raceway.lives.lives_commands.table_of", lambda *_: pytest.fail("features were computed"))
    result = run("prognose", *([lives] if options else []), *options, tiny_corpus)
    assert result.exit_code == 2
    sentence = f"{tiny_corpus}: has no lives; make one of a recipe with life, such as run_to_failure.\n"
    assert result.stderr == sentence
    assert run("life", tiny_corpus, "-o", "x.png").stderr == sentence


def test_generate_says_why_records_are_fewer_than_asked(run, lives, tmp_path):
    recipe = lives / "recipe.yaml"
    told = run("generate", recipe, "-o", lives).stdout
    with open_corpus(lives) as corpus:
        records = corpus.sizes["record"]
    assert f": {records} records in" in told
    assert f"The other {480 - records} of 480 snapshots would come after the end of a life.\n" in told
    assert "snapshots" not in run("generate", recipe, "-o", tmp_path / "c", "--parts", "0").stdout
