"""Broken recipes, each with the sentence it gets: where, what was found, what is allowed or what to do."""

import io

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ruamel.yaml import YAML

from gen.errors import RacewayError, RecipeError
from gen.plan import plan
from gen.recipe import read_recipe

WHOLE = """\
name: whole
title: A recipe with nothing wrong
corpus: {rigs: 2, specimens_per_rig: 4, records_per_specimen: 2, split: {test: 0.25}}
recording:
  sample_rate_hz: 12000
  duration_s: 0.1
  channels: [{name: sensor, angle_deg: 90}]
bearing: {kind: catalogue, designations: ["6205"]}
machine: {shaft_mass_kg: 5}
operation: {shaft_rpm: {kind: uniform, low: 1500, high: 1800}}
faults:
  - {kind: healthy, weight: 1}
  - {kind: outer, width_mm: 0.5}
"""

TABLE = [
    # keys
    ("rigs: 2", "rig: 2", "corpus.rig: no such key; did you mean rigs?"),
    ("machine:", "mashine:", "mashine: no such key; did you mean machine?"),
    ("width_mm", "width", "faults[1].width: no such key; did you mean width_mm?"),
    ("shaft_mass_kg", "colour", "machine.colour: no such key; allowed are "),
    ("rigs: 2, ", "", "corpus.rigs: is missing; give it."),
    (", width_mm: 0.5", "", "faults[1].width_mm: is missing; give it."),
    ("low: 1500, ", "", "operation.shaft_rpm.low: is missing; give it."),
    # values
    ("0.5}", "0.0}", "faults[1].width_mm: 0 is not in (0, 60]; for a bearing without a fault use kind: healthy."),
    ("0.5}", "-1}", "faults[1].width_mm: -1 is not in (0, 60]"),
    ("0.5}", "wide}", "faults[1].width_mm: 'wide' is neither a number nor a distribution; write 1.5 or {kind: uniform"),
    ("0.5}", "1,5}", "faults[1]: 5 is no key; keys are words, and decimals have a point, no comma."),
    ("0.5}", "true}", "faults[1].width_mm: True is neither a number nor a distribution; write 1.5 or {kind: uniform"),
    ("0.5}", "[1, 2]}", "faults[1].width_mm: [1, 2] is neither a number nor a distribution;"),
    ("0.5}", "{low: 1, high: 2}}", "faults[1].width_mm: this needs a kind, such as kind: uniform."),
    ("0.5}", ".nan}", "faults[1].width_mm.value: nan is not allowed here; it must be a finite number."),
    ("rigs: 2", "rigs: 0", "corpus.rigs: 0 is not allowed here; it must be greater than or equal to 1."),
    ("rigs: 2", "rigs: 2.5", "corpus.rigs: 2.5 is not allowed here; it must be a whole number."),
    ("rigs: 2", "rigs: '2'", "corpus.rigs: '2' is not allowed here; it must be a whole number."),
    ("12000", "900", "recording.sample_rate_hz: 900 is not allowed here; it must be greater than or equal to 1000."),
    ("12000", "12 kHz", "recording.sample_rate_hz: '12 kHz' is not allowed here; it must be a number."),
    ("test: 0.25", "test: 1.0", "corpus.split.test: 1.0 is not allowed here; it must be less than 1."),
    ("name: whole", "name: a/b", "name: 'a/b' is not allowed here; it must be 1 to 64 letters, digits, dots, dashes or underscores."),
    ("angle_deg: 90", "angle_deg: 400", "recording.channels[0].angle_deg: 400 is not in [-360, 360]."),
    # distributions
    ("low: 1500, high: 1800", "low: 1800, high: 1500", "operation.shaft_rpm: low 1800.0 is above high 1500.0; swap them."),
    ("kind: uniform, low: 1500", "kind: loguniform, low: 0", "operation.shaft_rpm: low 0.0 is not above 0;"),
    ("kind: uniform", "kind: gaussian", "operation.shaft_rpm.kind: 'gaussian' is not one of constant, uniform, loguniform"),
    ("kind: uniform, low: 1500, high: 1800", "kind: choice, values: []", "operation.shaft_rpm.values: is empty; give at least one."),
    (
        "kind: uniform, low: 1500, high: 1800",
        "kind: choice, values: [1, 2], weights: [1]",
        "operation.shaft_rpm: 1 weights for 2 values; give one each, not all 0.",
    ),
    ("low: 1500", "low: 0", "operation.shaft_rpm: 0 is not in [1, 100000]."),
    # choices
    ("kind: outer", "kind: gear", "faults[1].kind: 'gear' is not one of healthy, inner, outer, ball, cage, worn, compound."),
    ('["6205"]', '["6299"]', "bearing.designations: '6299' is neither in the catalogue nor in entries; did you mean "),
    ('["6205"]', "[]", "bearing.designations: is empty; give at least one."),
    ("{name: sensor,", "{name: sensor, body: table,", "recording.channels[0].body.table: "),
    # what does not go together
    ("weight: 1}\n  - {kind: outer,", "weight: 0}\n  - {kind: outer, weight: 0,", "faults all have weight 0; give at least one"),
    ("specimens_per_rig: 4", "specimens_per_rig: 1", "corpus.specimens_per_rig: 1 is not enough for healthy and faulty bearings"),
    ("test: 0.25", "test: 0.6, validation: 0.4", "corpus.split: validation and test leave nothing to train on"),
    ("shaft_mass_kg: 5", "resonator: null", "recording.channels: body sensor needs machine.resonator; give one, or use body: housing."),
    ("duration_s: 0.1", "duration_s: 0.001", "recording.duration_s: 12 samples are too few; use at least 16."),
    ("angle_deg: 90}", "angle_deg: 90}, {name: sensor}", "recording.channels: two channels have one name; give each its own."),
    # what turns out when it is drawn
    ("kind: outer, width_mm: 0.5", "kind: ball, width_mm: 12", "does not fit a ball radius of 3.97 mm; keep width_mm below 5.56."),
    ("shaft_mass_kg: 5", "shaft_mass_kg: 1.0e-4", "steps per sample at 12000 Hz; soften the machine or raise recording.sample_rate_hz."),
    ("machine: {shaft_mass_kg: 5}", "machine: 5", "machine: 5 is not allowed here; it must be a section with keys of its own."),
    ("[{name: sensor, angle_deg: 90}]", "3", "recording.channels: 3 is not allowed here; it must be a list."),
    ("12000", "12000\n  oversampling: 1", "is too fast for a step of 83.3 us; raise recording.oversampling to "),
    # what is no recipe
    ("name: whole", "name: [whole", "is not valid YAML ("),
    ("name: whole", "name: whole\nname: twice", "is not valid YAML ("),
    ("title: A recipe", "title: !!python/name:os.system A recipe", "is not valid YAML ("),
    (WHOLE, "- 1\n- 2\n", "a recipe is a mapping that starts with name:, title: and corpus:; see raceway recipes."),
    (WHOLE, "", "a recipe is a mapping that starts with name:"),
]  # fmt: skip


def sentence_of(tmp_path, text):
    path = tmp_path / "whole.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(RacewayError) as caught:
        plan(path)
    return str(caught.value).replace(f"{path}: ", "")


def test_the_whole_recipe_has_nothing_wrong(tmp_path):
    path = tmp_path / "whole.yaml"
    path.write_text(WHOLE)
    assert plan(path).records == 16


@pytest.mark.parametrize(("whole", "broken", "sentence"), TABLE, ids=[sentence[:50] for _, _, sentence in TABLE])
def test_a_broken_recipe_gets_one_sentence(tmp_path, whole, broken, sentence):
    assert whole in WHOLE
    said = sentence_of(tmp_path, WHOLE.replace(whole, broken))
    assert sentence in said
    assert said.endswith((".", "?"))
    assert "\n" not in said


def test_every_thing_that_is_wrong_gets_a_sentence_of_its_own(tmp_path):
    said = sentence_of(
        tmp_path, WHOLE.replace("rigs: 2", "rigs: 0").replace("machine:", "mashine:").replace("0.5}", "0}")
    )
    assert [line.partition(":")[0] for line in said.splitlines()] == ["corpus.rigs", "faults[1].width_mm", "mashine"]


def test_a_recipe_that_swells_is_refused(tmp_path):
    layers = ["a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]"]
    layers += [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 10)}]" for n in range(1, 9)]
    assert "values once aliases are written out" in sentence_of(tmp_path, "\n".join([*layers, WHOLE]))


def test_a_recipe_of_a_megabyte_is_refused(tmp_path):
    assert "is no recipe; at most 1000000 are read." in sentence_of(tmp_path, "#" * 1_000_001)


@settings(deadline=None)
@given(
    st.dictionaries(
        st.sampled_from(
            [
                "name",
                "title",
                "corpus",
                "recording",
                "bearing",
                "machine",
                "operation",
                "faults",
                "level",
                "seed",
                "odd",
            ]
        ),
        st.recursive(
            st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
            lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
            max_leaves=8,
        ),
    )
)
def test_whatever_a_recipe_holds_it_is_refused_in_sentences(tmp_path_factory, data):
    stream = io.StringIO()
    YAML(typ="safe", pure=True).dump(data, stream)
    path = tmp_path_factory.mktemp("odd") / "odd.yaml"
    path.write_text(stream.getvalue(), encoding="utf-8")
    with pytest.raises(RecipeError) as caught:
        read_recipe(path)
    for line in str(caught.value).splitlines():
        assert line.startswith(f"{path}: ")
        assert line.endswith((".", "?"))
        assert len(line) < 2000
