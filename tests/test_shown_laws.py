"""An object is one line in a list; in print and in a notebook it states its facts, whatever text they hold."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

import gen
from features.baselines import Model, Scores
from gen.support.display import Shown, cell_text

SCORES = Scores(
    0.75, 0.7, 0.8, ("healthy", "inner"), ("healthy", "inner", "ball"), ((4, 0, 0), (1, 2, 1)), 8, (0.6, 0.9)
)
RECIPE = gen.read_recipe("quickstart")


class Titled(Shown):
    def _heading(self):
        return "A <b> heading"

    def _facts(self):
        return {"title": "<script>", "records": 0, "split": "", "reference": None}


@pytest.mark.parametrize("shown", [RECIPE, gen.draw_scenarios(RECIPE, 0, 1)[0], SCORES, Model(), Titled()], ids=repr)
def test_every_fact_is_on_a_line_and_in_a_row(shown):
    heading, *lines = str(shown).splitlines()
    assert repr(shown) == f"<{heading}>"
    rows = re.findall(r"<tr><th[^>]*>([^<]+)</th><td[^>]*>([^<]*)</td></tr>", shown._repr_html_())
    assert [line.split("  ")[0].strip() for line in lines] == [name for name, _ in rows] != []


def test_facts_without_a_value_are_left_out_and_text_is_no_markup():
    assert str(Titled()).splitlines() == ["A <b> heading", "title    <script>", "records  0"]
    assert "<script>" not in Titled()._repr_html_()
    assert "A &lt;b&gt; heading" in Titled()._repr_html_()


@given(st.text() | st.text("=+-@＝＋－＠ \t\r", min_size=1))
def test_no_cell_of_a_list_begins_a_formula_or_a_line(text):
    assert not cell_text(text).lstrip().startswith((*"=+-@＝＋－＠",))
    assert cell_text(text).isprintable()


def test_scores_tell_what_each_class_was_taken_for():
    assert "inner told as    healthy 1, inner 2, ball 1" in str(SCORES)


def test_the_steps_that_a_recipe_and_a_scenario_name_can_be_taken(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    recipe = gen.make_recipe(gen.outer(width_mm=1), duration_s=0.1)
    names = {
        "gen": gen,
        "recipe": recipe,
        "scenario": gen.draw_scenarios(recipe)[0],
    }
    for shown in (recipe, names["scenario"]):
        facts = shown._facts()
        for step in ", ".join(str(facts[key]) for key in ("next", "choose", "look") if key in facts).split("), "):
            code = step if step.endswith(")") else f"{step})"
            if "..." not in code:
                eval(code, names)  # noqa: S307 - our own text
    assert (tmp_path / "corpus").is_dir()
    assert gen.read_recipe(tmp_path / "my_recipe.yaml") == recipe
