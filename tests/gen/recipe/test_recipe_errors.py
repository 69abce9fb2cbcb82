"""Broken recipes, each with its error sentence: where, what was found, what is allowed or what to do."""

import io

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ruamel.yaml import YAML

from gen.generation.plan import plan
from gen.recipe import Recipe, make_recipe, read_recipe
from gen.support.errors import RacewayError, RecipeError
from tests.conftest import small_with
from tests.recipes import LIVES

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
operation: {shaft_rpm: 'uniform(1500, 1800)'}
faults:
  - {kind: healthy, weight: 1}
  - {kind: outer, width_mm: 0.5}
"""

LOADS = "axial_load_n, bow_n, misalignment_n, static_rating_n, least_axial_load_n"
RPM = "'uniform(1500, 1800)'"
OUTER = "{kind: outer, width_mm: 0.5}"

TABLE = [
    # keys
    ("1500, ", "", "operation.shaft_rpm: high of uniform(low, high): is missing; give it."),
    # values
    ("0.5}", "1,5}", "faults[1]: 5 is not a key; keys are words, and decimals have a point, not a comma."),
    ("0.5}", "uniform(1, 2)}", "faults[1].width_mm: 'uniform(1' ends too early; close its bracket, and within braces give it quotes."),
    # distributions
    ("1500, 1800", "1800, 1500", "operation.shaft_rpm: low 1800.0 is above high 1500.0; swap them."),
    ("uniform(1500", "loguniform(0", "operation.shaft_rpm: low 0.0 is not above 0;"),
    ("0.5}", "[1, .nan], n_spalls: 2}", "faults[1].width_mm[1]: nan is not allowed here; it must be a finite number."),
    ("uniform", "gaussian", "operation.shaft_rpm: 'gaussian' is no distribution; choose from constant, uniform, loguniform"),
    ("uniform(1500, 1800)", "choice(1, 2, weights=(1,))", "operation.shaft_rpm: 1 weights for 2 values; give one"),
    # choices
    ("kind: outer", "kind: gear", "faults[1].kind: 'gear' is not one of healthy, inner, outer, ball, cage, distributed, compound; one of"),
    ("machine: {", "background: {hiss: {}}\nmachine: {", "; one of a plug-in needs it installed, and raceway doctor lists those."),
    ('["6205"]', '["6299"]', "bearing.designations: '6299' is neither in the catalogue nor in entries; did you mean "),
    ("{name: sensor,", "{name: sensor, body: table,", "recording.channels[0].body: 'table' is not allowed here; it must be"),
    ("machine: {", "truth: {twins: 'yes'}\nmachine: {", "truth.twins: 'yes' is not allowed here; it must be true or false."),
    # keys that contradict each other
    ("weight: 1}\n  - {kind: outer,", "weight: 0}\n  - {kind: outer, weight: 0,", "faults all have weight 0; give at least one"),
    ("test: 0.25", "test: 0.6, validation: 0.4", "corpus.split: validation and test leave nothing to train on"),
    ("shaft_mass_kg: 5", "resonator: null", "recording.channels: body sensor needs machine.resonator; give one, or use body: housing."),
    ("duration_s: 0.1", "duration_s: 0.001", "recording.duration_s: 12 samples are too few; use at least 16."),
    ("angle_deg: 90}", "angle_deg: 90}, {name: sensor}", "recording.channels: two channels have the same name; give each its own."),
    # errors found while drawing
    ("shaft_mass_kg: 5", "shaft_mass_kg: 1.0e-4", "steps per sample at 12000 Hz; soften the machine or raise recording.sample_rate_hz."),
    ("12000", "12000\n  oversampling: 1", "is too fast for a step of 83.3 us; raise recording.oversampling to "),
    # user-defined bearings, rollers
    ('["6205"]}', "[mine], entries: {mine: {n_balls: 20, pitch_diameter_mm: 50, ball_diameter_mm: 9}}}",
     "bearing.entries.mine: 20 of 9 mm do not fit a pitch circle of 50 mm; keep ball_diameter_mm below 7.461."),
    ('["6205"]}', '["6205"], entries: {"6205": {n_balls: 9, pitch_diameter_mm: 50, ball_diameter_mm: 9}}}',
     "bearing.entries: 6205 is in the catalogue already; give your own bearing another name."),
    ('["6205"]', "[NU205]", "bearing.designations: NU205 is in the catalogue without the length of its rollers"),
    ('["6205"]}', "[mine], entries: {mine: {n_rollers: 20, pitch_diameter_mm: 50, roller_diameter_mm: 7}}}",
     "bearing.entries.mine.n_rollers: a bearing with rollers needs roller_length_mm;"),
    ('["6205"]}', "[mine], entries: {mine: {n_rollers: 20, n_balls: 20, pitch_diameter_mm: 50, roller_length_mm: 7}}}",
     "bearing.entries.mine.n_rollers: n_balls says the same; give one of them."),
    # traces and roughness
    ("0.5}", "0.5, profile: trace}", "faults[1].profile: trace and trace_um belong together; give both or neither."),
    ("0.5}", "0.5, profile: trace, trace_um: [0, 3]}", "faults[1].trace_um: 2 is too few; give at least 3."),
    ("0.5}", "0.5, profile: rectangular, roughness_um: 1}", "faults[1].roughness_um: only a geometric or traced"),
    # broken cages, wear and compounds
    (OUTER, "{kind: cage, width_mm: 1}", "faults[1].width_mm: no such key; allowed are kind, knock_n, level, operation, "),
    (OUTER, "{kind: compound, parts: []}", "faults[1].parts: is empty; give at least 2."),
    (OUTER, "{kind: compound, parts: [{kind: cage}, {kind: cage}]}", "faults[1].parts: cage, cage are not all"),
    (OUTER, "{kind: compound, parts: [{kind: cage}, {kind: distributed, site: outer}]}", "'distributed' is not one"),
    (OUTER, "{kind: compound, parts: [{kind: cage}, {width_mm: 1}]}", "faults[1].parts[1]: this needs a kind: inner, outer, ball, cage."),
    (OUTER, "{kind: compound, parts: [{kind: cage, weight: 1}, {kind: outer, width_mm: 1}]}",
     "faults[1].parts[0].weight: no such key; allowed are kind, knock_n, pitch_error_deg."),
    # profiles
    (RPM, RPM + ", speed_profile: {kind: table, times_s: [0, 0], percent: [9, 9]}", "times_s do not rise"),
    (RPM, RPM + ", speed_profile: {kind: table, times_s: [0, 1e-308], percent: [9, 10]}", "times_s: two are 1e-308"),
    (RPM, RPM + ", speed_profile: {kind: table, times_s: [0, 1], percent: [9]}", "speed_profile: 2 times_s"),
    (RPM, RPM + ", load_profile: {kind: steps, levels_percent: [50, 99], step_s: 0.06}", "step_s: 0.06 s is longer"),
    # heat, oil, axial load, machine faults
    (RPM, RPM + ", temperature_celsius: 40", "operation.temperature_celsius: has no effect without oil; give"),
    (RPM, RPM + ", axial_load_n: 100", "operation.axial_load_n: needs a contact angle; give specimen.contact_angle_deg"),
    ("machine: {shaft_mass_kg: 5}", "contact: {lubricant: {viscosity_100_mm2_s: 80}}", "has no lower viscosity at"),
    # shares
    (RPM, RPM + ", load_n: 'uniform(0, 1) * thrust'",
     f"operation.load_n: there is no quantity 'thrust'; allowed are {LOADS}."),
    (RPM, RPM + ", load_n: 'uniform(0, 1) * shaft_rpm'",
     f"operation.load_n: shaft_rpm is of another kind than load_n; allowed are {LOADS}."),
    (RPM, RPM + ", load_n: 'uniform(0, 1) * load_n'", "operation.load_n: load_n is a share of load_n; give one of"),
    (RPM, RPM + ", load_n: '1 * axial_load_n', axial_load_n: '1 * load_n'", "operation.load_n: load_n is a share"),
    ("shaft_mass_kg: 5",
     ("load_angle_deg: 'uniform(-100, -10)', "
      "misalignment_angle_deg: 'uniform(2, 4) * load_angle_deg'"),
     "machine.misalignment_angle_deg: as a share of load_angle_deg it can be -400, which is not in [-360, 360]."),
    (RPM, RPM + ", load_n: '1 * bow_n'", "operation.load_n: as a share of bow_n it can be 0, which is not in [1, "),
    (RPM, RPM + ", temperature_celsius: '1 * load_n'", "operation.temperature_celsius: a value in degC has no"),
    (RPM, RPM + ", load_n: '1 * 3'", "operation.load_n: '1 * 3' is neither a number nor a distribution;"),
    ("shaft_mass_kg: 5", "bow_n: '1 * load_n'", "machine.bow_n: load_n is drawn after bow_n, not with it or before"),
    ("machine: {shaft_mass_kg: 5}", "specimen: {contact_angle_deg: '5 * free_contact_angle_deg'}",
     "specimen 0: contact_angle_deg: a share of 5 of free_contact_angle_deg gives 50.9, which is not in [0, 30]; change the range"),
    ("machine: {shaft_mass_kg: 5}", "path: {direct: '1 * load_n'}", "path.direct: there are shares in bearing"),
    (OUTER, "{kind: outer, width_mm: 1, n_spalls: '1 * width_mm'}", "faults[1].n_spalls: a count has no share"),
    (OUTER, "{kind: ball, width_mm: '1 * ball_spacing_mm'}", "faults[1].width_mm: ball_spacing_mm is not known"),
    # conditions per rig, and of one fault
    (RPM, "'uniform(1500, 1800, per=machine)'", "operation.shaft_rpm: per of uniform(low, high): 'machine' is not"),
    (RPM, "'uniform(1500, 1800, scatter_percent=2)'", "operation.shaft_rpm: scatter_percent needs a value to"),
    (RPM, "'uniform(1, 1800, per=rig, scatter_percent=2)'", "operation.shaft_rpm: 0.98 is not in [1, 100000]."),
    ("shaft_mass_kg: 5", "shaft_mass_kg: 'constant(5, per=rig)'", "machine.shaft_mass_kg: per can be chosen for"),
    ("0.5}", "0.5, operation: {load_n: 1e6}}", "faults[1].operation.load_n: gives an equivalent static load of at"),
    ("0.5}", "0.5, level: {faulty_db: 3}}", "faults[1].level: works with level.kind: snr alone, because a physical"),
    # a range in brackets is answered with the numbers of the user
    (RPM, "[1400, 1500]", "operation.shaft_rpm: is a list; give one number, or a distribution such as uniform(1400, 1500)."),
    (RPM, "[900, 1400, 1500]", "operation.shaft_rpm: is a list; give one number, or a distribution such as choice(900, 1400, 1500)."),
    (RPM, "[]", "operation.shaft_rpm: is a list; give one number, or a distribution such as choice(1, 2)."),
    # rungs
    ("machine:", "storage: {records_per_part: 1}\ntruth: {undetected: redraw}\nmachine:", "truth.undetected: redraw judges"),
    ("rigs: 2", "rigs: 2, rungs: [0, 1, 0.5]", "corpus.rungs: 0.5 after 1 does not rise; sort them, each once."),
    # sensors
    ("angle_deg: 90", "body: {}", "recording.channels[0].body: no body has a weight above 0; give one, such as body: sensor."),
    ("angle_deg: 90", "path: {direct: 0}", "recording.channels[0].path.direct: 0 without modes transmits nothing;"),
    # more than a recipe may ask for
    ("rigs: 2", "rigs: 1000000000000", "corpus: rigs * specimens_per_rig * records_per_specimen are 8000000000000 records, and the "),
    ("rigs: 2", "rigs: 1" + 50 * "0", "are 1e18 or more records, and the limit is 10000000;"),
    ("specimens_per_rig: 4", "specimens_per_rig: 1000000", "corpus.specimens_per_rig: asks for 1000000 specimens, and the limit is"),
    ("12000\n  duration_s: 0.1", "200000\n  duration_s: 600", "recording: a record of all channels, settle_s"),
    ("12000\n  duration_s: 0.1\n", "20000\n  duration_s: 600\n", "storage.records_per_part: 16 records need"),
    # files that are no recipes
    ("name: whole", "name: [whole", "is not valid YAML ("),
    (WHOLE, "- 1\n- 2\n", "a recipe is a mapping that starts with name:, title: and corpus:; see raceway recipes."),
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


@pytest.mark.parametrize(
    ("faults", "sentence"),
    [
        ("[{kind: healthy}]", "corpus.rungs: no entry of faults with a weight above 0 has a severity; add a fault"),
        (f"[{{kind: healthy, weight: 0.5}}, {OUTER}]", "corpus.rungs: rung 0 makes at least 50 % of all records"),
    ],
)
def test_rungs_that_the_faults_cannot_meet_are_refused(tmp_path, faults, sentence):
    pairs = WHOLE[: WHOLE.index("faults:")].replace("rigs: 2", "rigs: 2, rungs: [0, 1]")
    assert sentence in sentence_of(tmp_path, f"{pairs}faults: {faults}\n")


def test_every_thing_that_is_wrong_gets_a_sentence_of_its_own(tmp_path):
    said = sentence_of(
        tmp_path, WHOLE.replace("rigs: 2", "rigs: 0").replace("machine:", "mashine:").replace("0.5}", "0}")
    )
    assert [line.partition(":")[0] for line in said.splitlines()] == ["corpus.rigs", "faults[1].width_mm", "mashine"]


def test_a_thousand_things_that_are_wrong_are_not_all_told(tmp_path):
    said = sentence_of(tmp_path, WHOLE + "path: {" + ", ".join(f"odd{n}: 1" for n in range(1000)) + "}\n").splitlines()
    assert len(said) == 21
    assert said[-1] == "there are up to 980 more errors; correct these first."


@given(
    st.dictionaries(
        st.sampled_from([*Recipe.model_fields, "odd"]),
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


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"operation.load_n": 15_000}, "1.07 times the dynamic rating"),
        ({"life": {"cadence_h": 40, "end": {"length_mm": 0.3}}}, "begins longer than life.end.length_mm"),
        ({"life": {"cadence_h": 40, "end": {"peak_m_s2": 900}}}, "above the full scale of the converter"),
        ({"life": {"cadence_h": 1e-3}}, "its end is never reached"),
        ({"life": {"cadence_h": 1, "withdrawal_h": 2}}, "its end is never reached"),
        ({"life": {"cadence_h": 1e6}}, "longer than half of the lives"),
        ({"life": {"cadence_h": 40, "damaged_cadence_h": 50}}, "longer than cadence_h"),
        ({"life": {"cadence_h": 40, "damaged_from_mm": 6}}, "beyond life.end.length_mm"),
        ({"life": {"cadence_h": 40, "entry_h": 3000, "withdrawal_h": 2000}}, "before entry_h"),
        ({"faults": [{"kind": "inner", "profile": "trace", "trace_um": [0, 3, 0], "width_mm": 0.3}]}, "would stretch"),
        ({"life": {"cadence_h": 40, "history_h": 1e-4}}, "life.history_h: is too short"),
        ({"life": {"cadence_h": 40, "temperature_history_k": 3}}, "no effect without oil"),
        (
            {"life": {"cadence_h": 40, "knocks_share": 0.5}, "background": {}},
            "no effect without knocks; give background.knocks or background.impulses",
        ),
        ({"faults": [{"kind": "cage"}]}, "cage has no life"),
        ({"faults": [{"kind": "healthy"}]}, "healthy has no life"),
        ({"faults": [{"kind": "inner", "width_mm": 0.3, "n_spalls": 2}]}, "one spall grows"),
        ({"operation.load_n": "uniform(3000, 4000)"}, "add per=specimen"),
        ({"storage.records_per_part": 60}, "a multiple of the 40 snapshots"),
        ({"records": 60}, "a multiple of the 40 snapshots"),
        ({"level": {"kind": "snr", "healthy_db": 0, "faulty_db": 0, "rms_m_s2": 1}}, "a drawn level would hide the"),
        ({"truth": {"undetected": "redraw"}}, "a life is never drawn again"),
        ({"bearing": {"n_balls": 9, "pitch_diameter_mm": 40, "ball_diameter_mm": 8}}, "no dynamic rating"),
        ({"specimen.contact_angle_deg": 10, "operation.axial_load_n": 3000}, "under radial loads alone"),
    ],
)
def test_a_life_that_cannot_be_is_refused_in_one_sentence(changes, sentence):
    with pytest.raises(RecipeError) as error:
        Recipe(small_with(LIVES | changes))
    assert sentence in str(error.value)
    assert "\n" not in str(error.value)


def test_an_overload_test_must_be_asked_for():
    life = LIVES["life"] | {"accelerated": True, "cadence_h": 0.1, "history_h": 10}
    assert Recipe(small_with(LIVES | {"operation.load_n": 15_000, "life": life})).life.accelerated


MOUNT = {"probability": 1, "frequency_hz": 500, "damping_percent": 5, "holding_m_s2": 3}
ROLLERS = {"n_rollers": 13, "pitch_diameter_mm": 39, "roller_length_mm": 9}


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"operation.load_n": "normal(0, 1, 50, 60)"}, "mean 0.0 lies 6 sd or more outside low 50.0 and high 60.0"),
        ({"sensor_faults": {"loose_mount": MOUNT | {"loose_channels": [0, 0]}}}, "name some, each once"),
        (
            {"sensor_faults": {"loose_mount": MOUNT | {"loose_channels": [0], "probability": 0.5}}},
            "probability: does not act on channels that are named",
        ),
        (
            {"bearing": ROLLERS | {"roller_diameter_mm": "uniform(0.1, 0.2)*roller_length_mm"}},
            "can be 0.0231 to 0.0462 of pitch_diameter_mm",
        ),
        ({"level": {"kind": "physical", "background_m_s2": "uniform(1, 2, per=specimen)"}}, "of operation alone"),
    ],
)
def test_a_key_that_would_not_act_as_it_says_is_refused(changes, sentence):
    with pytest.raises(RecipeError) as error:
        Recipe(small_with(changes))
    assert sentence in str(error.value)


def test_a_share_of_the_length_of_a_roller_is_one_of_the_pitch_circle_too():
    Recipe(small_with({"bearing": ROLLERS | {"roller_diameter_mm": "uniform(0.6, 0.8)*roller_length_mm"}}))


def test_records_are_counted_where_faults_have_defaults():
    faults = {"defaults": {"width_mm": 1}, "entries": [{"kind": "inner"}, {"kind": "healthy"}]}
    assert make_recipe(n=7, faults=faults).n_records == 14
