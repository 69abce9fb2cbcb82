"""Options refuse values of other types, reach the functions that they set, and keys of the JSON objects have the right values."""

import re

import click
import pytest
from click.types import FloatParamType, IntParamType

from features.baselines import Model
from features.table.recording_speeds import SPEEDS
from gen.support.errors import CorpusError
from gen.support.executor import cores
from raceway.commands import plot_commands as plotting
from raceway.console.options import names, speed_option
from raceway.importing.reading_options import _speeds
from raceway.reports.views import VIEWS
from tests.command_tree import COMMANDS


def refused_values(option):
    """Values that an option refuses by its type, its range or its form, each a tuple of words."""
    kind, least = option.type, getattr(option.type, "min", None)
    if option.callback is names:
        return [("x,",)]
    if option.callback is _speeds:
        return [("-3",), ("nan",), ("1900-1400",), ("1400-",), ("",)]
    if isinstance(kind, click.Tuple):
        return [("low", "high"), ("5000", "300")]
    if isinstance(kind, click.Choice | IntParamType | FloatParamType):
        return [("some",), *([] if least is None else [(str(least - 1),)])]
    return []


REFUSING = {
    f"{' '.join(words)} {option.opts[0]}": (words, option)
    for words, command in COMMANDS.items()
    for option in command.params
    if isinstance(option, click.Option) and not option.is_flag and refused_values(option)
}


@pytest.mark.parametrize("line", REFUSING)
def test_an_option_refuses_what_is_no_value_of_it_in_one_sentence(run, line):
    words, option = REFUSING[line]
    for wrong in refused_values(option):
        result = run(
            *words,
            *("x" for one in COMMANDS[words].params if one.is_eager and one.name == "recording"),
            option.opts[0],
            *wrong,
        )
        assert (result.exit_code, result.stdout, result.stderr.count("\n")) == (2, "", 1), result.output
        assert f"'{option.opts[0]}'" in result.stderr or f" '{option.opts[0]}' /" in result.stderr
        # no word of the library that reads the options
        assert " is not a valid " not in result.stderr


@pytest.mark.parametrize(
    ("choices", "registry"),
    [(plotting.VIEWS, VIEWS), (speed_option(lambda: None).__click_params__[0].type.choices, SPEEDS)],
)
def test_the_choices_of_an_option_are_those_of_its_registry(choices, registry):
    """The help loads none of the registries."""
    assert tuple(choices) == tuple(registry)


@pytest.fixture
def given(monkeypatch):
    """Replace a function by one that keeps the options it is called with and ends the command: ``given(path)``."""

    def replace(path):
        options = {}

        def called(*_positional, **named):
            options.update(named)
            raise CorpusError("stopped by the test.")

        monkeypatch.setattr(path, called)
        return options

    return replace


def test_the_refusal_of_a_classifier_of_the_user_says_where_it_is_taken(run, tiny_corpus, tmp_path):
    refused = run("train", tiny_corpus, "-o", tmp_path / "m.skops", "--estimator", "mine:make")
    assert "'mine:make' is no baseline; raceway benchmark takes your own" in refused.stderr


@pytest.mark.parametrize(("spelling", "unit"), [("mm/s^2", "mm/s2"), ("m/s²", "m/s2"), ("m s^-2", "m/s2"), ("g", "g")])
def test_units_are_taken_in_the_spellings_of_headers(spelling, unit):
    option = next(option for option in COMMANDS["diagnose",].params if option.name == "unit")
    assert option.type.convert(spelling, option, None) == unit


def test_benchmark_passes_on_grouping_folds_and_seed(run, given, tiny_corpus, tmp_path):
    options = given("features.baselines.benchmark")
    line = ("benchmark", tiny_corpus, "-o", tmp_path / "report")
    assert run(*line, "--track", "rig", "--folds", 2, "--seed", 9).exit_code == 2
    assert (options["tracks"], options["folds"], options["seed"]) == (("rig",), 2, 9)
    run(*line)
    assert (options["tracks"], options["folds"], options["seed"]) == (("specimen",), 5, 0)


@pytest.mark.parametrize(
    ("command", "more"),
    [
        ("features", ("-o", "new.nc")),
        ("train", ("-o", "new.skops")),
        ("evaluate", ("--model", "model")),
        ("benchmark", ("-o", "new")),
    ],
)
def test_commands_that_compute_features_pass_on_workers_and_scheduler(
    run, given, monkeypatch, tiny_corpus, command, more
):
    options = given("features.feature_table")
    monkeypatch.setattr("features.baselines.Model.load", lambda _: Model(groups=()))
    run(command, tiny_corpus, *more, "--workers", 3, "--scheduler", "tcp://a:1")
    assert (options["workers"], options["scheduler"]) == (3, "tcp://a:1")
    run(command, tiny_corpus, *more)
    assert 1 <= options["workers"] <= cores()
    assert options["scheduler"] is None


@pytest.mark.parametrize(
    ("records", "per_part", "cores", "workers"),
    [(2000, 500, 2, 2), (400, 50, 8, 1), (1000, 500, 8, 2), (2000, 2000, 8, 1), (4000, 500, 6, 6)],
)
def test_corpora_of_several_parts_get_a_worker_per_core_and_small_ones_one(
    run, given, tiny_recipe, tmp_path, monkeypatch, records, per_part, cores, workers
):
    monkeypatch.setattr("os.sched_getaffinity", lambda _: range(cores))
    text = tiny_recipe.read_text().replace("rigs: 2", f"rigs: {records // 24 + 1}")
    recipe = tmp_path / "large.yaml"
    recipe.write_text(text.replace("records_per_part: 12", f"records_per_part: {per_part}"))
    options = given("gen.generate")
    run("generate", recipe, "-o", tmp_path / "new", "--records", records)
    assert options["workers"] == workers


def test_a_plan_counts_the_records_that_cannot_be_simulated(run, told, tiny_recipe, tmp_path):
    text = tiny_recipe.read_text().replace("waviness_nm: 20", "waviness_nm: 20, contact_angle_deg: 10")
    loose = tmp_path / "loose.yaml"
    loose.write_text(text.replace("operation: {", "operation: {axial_load_n: 'uniform(10, 200)', "))
    planned = told("plan", loose)
    assert 0 < planned["left_out"] < planned["records"] == planned["drawn"] == 48
    assert sum(planned["steps_per_sample"].values()) == 48 - planned["left_out"]
    assert re.search(r"record \d+: an axial load of .* N is too small", planned["left_out_example"])
    shown = run("plan", loose).stdout
    assert f"without {planned['left_out']} that cannot be simulated" in shown
    assert f"One record that is left out: {planned['left_out_example']}" in shown
