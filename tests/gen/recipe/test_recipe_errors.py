"""Broken recipes, each with its error sentence: where, what was found, what is allowed or what to do."""

import io

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ruamel.yaml import YAML

from gen.generation.plan import plan
from gen.recipe import read_recipe
from gen.support.errors import RacewayError, RecipeError

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
    ("0.5}", "0.0}", "faults[1].width_mm: 0 is not in (0, 60]; for a bearing without a fault use kind: healthy."),
    ("0.5}", "1,5}", "faults[1]: 5 is not a key; keys are words, and decimals have a point, not a comma."),
    ("0.5}", "{low: 1, high: 2}}", "faults[1].width_mm: {'high': 2, 'low': 1} is neither a number nor a distribution;"),
    ("0.5}", "uniform(1, 2)}", "faults[1].width_mm: 'uniform(1' ends too early; within braces a distribution needs quotes."),
    ("name: whole", "name: a/b", "name: 'a/b' is not allowed here; it must be 1 to 64 letters, digits, dots, dashes or underscores."),
    # distributions
    ("1500, 1800", "1800, 1500", "operation.shaft_rpm: low 1800.0 is above high 1500.0; swap them."),
    ("uniform(1500", "loguniform(0", "operation.shaft_rpm: low 0.0 is not above 0;"),
    ("'uniform(1500, 1800)'", ".inf", "operation.shaft_rpm: inf is not allowed here; it must be a finite number."),
    ("0.5}", "[1, .nan], n_spalls: 2}", "faults[1].width_mm[1]: nan is not allowed here; it must be a finite number."),
    ("uniform", "gaussian", "operation.shaft_rpm: 'gaussian' is no distribution; choose from constant, uniform, loguniform"),
    ("uniform", "unifrom", "operation.shaft_rpm: 'unifrom' is no distribution; did you mean uniform?"),
    ("uniform(1500, 1800)", "choice()", "operation.shaft_rpm: values of choice(values): is missing; give it."),
    (
        "uniform(1500, 1800)",
        "choice(1, 2, weights=(1,))",
        "operation.shaft_rpm: 1 weights for 2 values; give one each, not all 0.",
    ),
    ("1500", "0", "operation.shaft_rpm: 0 is not in [1, 100000]."),
    # choices
    ("kind: outer", "kind: gear", "faults[1].kind: 'gear' is not one of healthy, inner, outer, ball, cage, distributed, compound."),
    ('["6205"]', '["6299"]', "bearing.designations: '6299' is neither in the catalogue nor in entries; did you mean "),
    ('["6205"]', "[]", "bearing.designations: is empty; give at least one."),
    ("{name: sensor,", "{name: sensor, body: table,", "recording.channels[0].body.table: "),
    # keys that contradict each other
    ("weight: 1}\n  - {kind: outer,", "weight: 0}\n  - {kind: outer, weight: 0,", "faults all have weight 0; give at least one"),
    ("test: 0.25", "test: 0.6, validation: 0.4", "corpus.split: validation and test leave nothing to train on"),
    ("shaft_mass_kg: 5", "resonator: null", "recording.channels: body sensor needs machine.resonator; give one, or use body: housing."),
    ("duration_s: 0.1", "duration_s: 0.001", "recording.duration_s: 12 samples are too few; use at least 16."),
    ("angle_deg: 90}", "angle_deg: 90}, {name: sensor}", "recording.channels: two channels have the same name; give each its own."),
    # errors found while drawing
    ("kind: outer, width_mm: 0.5", "kind: ball, width_mm: 12", "does not fit the ball radius of 3.97 mm; keep width_mm below 5.56."),
    ("shaft_mass_kg: 5", "shaft_mass_kg: 1.0e-4", "steps per sample at 12000 Hz; soften the machine or raise recording.sample_rate_hz."),
    ("12000", "12000\n  oversampling: 1", "is too fast for a step of 83.3 us; raise recording.oversampling to "),
    # user-defined bearings, rollers
    ('["6205"]}', "[mine], entries: {mine: {n_balls: 20, pitch_diameter_mm: 50, ball_diameter_mm: 9}}}",
     "bearing.entries.mine: 20 of 9 mm do not fit a pitch circle of 50 mm; keep ball_diameter_mm below 7.461."),
    ('["6205"]}', "[mine], entries: {other: {n_balls: 9, pitch_diameter_mm: 50, ball_diameter_mm: 9}}}",
     "bearing.designations: 'mine' is neither in the catalogue nor in entries; "),
    ('["6205"]}', '["6205"], entries: {"6205": {n_balls: 9, pitch_diameter_mm: 50, ball_diameter_mm: 9}}}',
     "bearing.entries: 6205 is in the catalogue already; give your own bearing another name."),
    ('["6205"]}', '["6205"], entries: {a b: {n_balls: 9, pitch_diameter_mm: 50, ball_diameter_mm: 9}}}',
     "bearing.entries.a b: 'a b' is not allowed here; it must be 1 to 64 letters"),
    ('["6205"]', "[NU205]", "bearing.designations: NU205 is in the catalogue without the length of its rollers"),
    ('["6205"]}', "[mine], entries: {mine: {n_rollers: 20, pitch_diameter_mm: 50, roller_diameter_mm: 7}}}",
     "bearing.entries.mine.n_rollers: a bearing with rollers needs roller_length_mm;"),
    ('["6205"]}', "[mine], entries: {mine: {n_rollers: 20, n_balls: 20, pitch_diameter_mm: 50, roller_length_mm: 7}}}",
     "bearing.entries.mine.n_rollers: n_balls says the same; give one of them."),
    # traces and roughness
    ("0.5}", "0.5, profile: trace}", "faults[1].profile: trace and trace_um belong together; give both or neither."),
    ("0.5}", "0.5, trace_um: [0, 3, 0]}", "faults[1].profile: trace and trace_um belong together; give both or neither."),
    ("0.5}", "0.5, profile: trace, trace_um: [0, 3]}", "faults[1].trace_um: 2 is too few; give at least 3."),
    ("0.5}", f"0.5, profile: trace, trace_um: {[1] * 2001}}}", "faults[1].trace_um: 2001 is too many; give at most 2000."),
    ("0.5}", "0.5, profile: rectangular, roughness_um: 1}",
     "faults[1].roughness_um: only a geometric or traced spall has a floor, not rectangular."),
    # broken cages, wear and compounds
    (OUTER, "{kind: cage, width_mm: 1}", "faults[1].width_mm: no such key; allowed are kind, knock_n, level, operation, "),
    (OUTER, "{kind: compound, parts: []}", "faults[1].parts: is empty; give at least 2."),
    (OUTER, "{kind: compound, parts: [{kind: cage}, {kind: cage}]}",
     "faults[1].parts: cage, cage are not all different; several spalls of one part"),
    (OUTER, "{kind: compound, parts: [{kind: cage}, {kind: distributed, site: outer}]}",
     "faults[1].parts[1].kind: 'distributed' is not one of inner, outer, ball, cage."),
    (OUTER, "{kind: compound, parts: [{kind: cage}, {kind: outer}]}", "faults[1].parts[1].width_mm: is missing; give it."),
    (OUTER, "{kind: compound, parts: [{kind: cage}, {width_mm: 1}]}", "faults[1].parts[1]: this needs a kind: inner, outer, ball, cage."),
    (OUTER, "{kind: compound, parts: [{kind: cage}, {kind: ball, width_mm: 6}]}",
     "does not fit the ball radius of 3.97 mm; keep width_mm below 5.56."),
    (OUTER, "{kind: compound, parts: [{kind: cage, weight: 1}, {kind: outer, width_mm: 1}]}",
     "faults[1].parts[0].weight: no such key; allowed are kind, knock_n, pitch_error_deg."),
    # profiles
    (RPM, RPM + ", speed_profile: {kind: table, times_s: [0, 0], percent: [9, 9]}",
     "operation.speed_profile: times_s do not rise; sort them, each once."),
    (RPM, RPM + ", speed_profile: {kind: table, times_s: [0, 1e-308], percent: [9, 10]}",
     "operation.speed_profile.times_s: two are 1e-308 s apart; keep them at least 1e-06 s apart."),
    (RPM, RPM + ", speed_profile: {kind: table, times_s: [0, 1], percent: [9]}",
     "operation.speed_profile: 2 times_s for 1 percent; give one each."),
    (RPM, RPM + ", load_profile: {kind: steps, levels_percent: [50, 99], step_s: 0.06}",
     "operation.load_profile.step_s: 0.06 s is longer than a level; keep it below 0.05."),
    (RPM, RPM + ", speed_profile: {from_percent: 9, to_percent: 99}",
     "operation.speed_profile: this needs a kind: ramp, run_up, steps, table."),
    (RPM, RPM + ", speed_profile: {kind: spline}", "operation.speed_profile.kind: 'spline' is not one of ramp, run_up, steps, table."),
    # heat, oil, axial load, machine faults
    (RPM, RPM + ", temperature_celsius: 40",
     "operation.temperature_celsius: has no effect without oil; give contact.lubricant, or leave it out."),
    (RPM, RPM + ", axial_load_n: 100", "operation.axial_load_n: needs a contact angle; give specimen.contact_angle_deg"),
    ("machine: {shaft_mass_kg: 5}", "contact: {lubricant: {viscosity_100_mm2_s: 80}}",
     "rig 0: oil of 68 mm2/s at 40 C has no lower viscosity at 100 C; keep viscosity_100_mm2_s below viscosity_40_mm2_s."),
    # shares
    (RPM, RPM + ", load_n: 'uniform(0, 1) * thrust'",
     f"operation.load_n: there is no quantity 'thrust'; allowed are {LOADS}."),
    (RPM, RPM + ", axial_load_n: 'uniform(0, 1) * laod_n'",
     "operation.axial_load_n: there is no quantity 'laod_n'; did you mean load_n?"),
    (RPM, RPM + ", load_n: 'uniform(0, 1) * shaft_rpm'",
     f"operation.load_n: shaft_rpm is of another kind than load_n; allowed are {LOADS}."),
    (RPM, RPM + ", load_n: 'uniform(0, 1) * load_n'",
     "operation.load_n: load_n is a share of load_n; give one of them a range of its own."),
    (RPM, RPM + ", load_n: '1 * axial_load_n', "
     "axial_load_n: '2 * least_axial_load_n'",
     "operation.load_n: load_n is a share of axial_load_n, which is a share of load_n; give one of them a range of its own."),
    ("machine: {shaft_mass_kg: 5}", "machine: {bow_n: '1 * static_rating_n'}",
     "machine.bow_n: static_rating_n is not known here; allowed are misalignment_n."),
    (RPM, RPM + ", load_n: '1 * axial_load_n', axial_load_n: '1 * load_n'",
     "operation.load_n: load_n is a share of axial_load_n, which is a share of load_n; give one of them a range of its own."),
    ("shaft_mass_kg: 5",
     ("load_angle_deg: 'uniform(-100, -10)', "
      "misalignment_angle_deg: 'uniform(2, 4) * load_angle_deg'"),
     "machine.misalignment_angle_deg: as a share of load_angle_deg it can be -400, which is not in [-360, 360]."),
    (RPM, RPM + ", load_n: '1 * bow_n'",
     "operation.load_n: as a share of bow_n it can be 0, which is not in [1, "),
    (RPM, RPM + ", temperature_celsius: '1 * load_n'",
     "operation.temperature_celsius: a value in degC has no share; give it a range of its own."),
    (RPM, RPM + ", load_n: '1 * 3'", "operation.load_n: '1 * 3' is neither a number nor a distribution;"),
    ("shaft_mass_kg: 5", "bow_n: '1 * load_n'",
     "machine.bow_n: load_n is drawn after bow_n, not with it or before it; allowed are misalignment_n."),
    ("machine: {shaft_mass_kg: 5}", "specimen: {contact_angle_deg: '1 * jitter_deg'}",
     "specimen.contact_angle_deg: jitter_deg is drawn after contact_angle_deg, not with it or before it; allowed are "),
    ("machine: {shaft_mass_kg: 5}", "specimen: {contact_angle_deg: '5 * free_contact_angle_deg'}",
     "specimen 0: contact_angle_deg: a share of 5 of free_contact_angle_deg gives 50.9, which is not in [0, 30]; change the range"),
    ("machine: {shaft_mass_kg: 5}", "path: {direct: '1 * load_n'}",
     "path.direct: there are shares in bearing, machine, machine.resonator, contact.lubricant, "),
    (OUTER, "{kind: outer, width_mm: 1, n_spalls: '1 * width_mm'}",
     "faults[1].n_spalls: a count has no share; give it a range of its own."),
    (OUTER, "{kind: ball, width_mm: '1 * ball_spacing_mm'}",
     "faults[1].width_mm: ball_spacing_mm is not known here; allowed are depth_um, roughness_um, "),
    (OUTER, "{kind: compound, parts: [{kind: cage}, {kind: outer, width_mm: '1 * lod_n'}]}",
     "faults[1].parts[1].width_mm: there is no quantity 'lod_n'; allowed are depth_um, "),
    # conditions per rig, and of one fault
    (RPM, "'uniform(1500, 1800, per=machine)'",
     "operation.shaft_rpm: per of uniform(low, high): 'machine' is not allowed here; it must be 'rig', 'specimen' or 'record'."),
    (RPM, "'uniform(1500, 1800, scatter_percent=2)'",
     "operation.shaft_rpm: scatter_percent needs a value to scatter about; give per=rig or per=specimen."),
    (RPM, "'uniform(1, 1800, per=rig, scatter_percent=2)'", "operation.shaft_rpm: 0.98 is not in [1, 100000]."),
    ("shaft_mass_kg: 5", "shaft_mass_kg: 'constant(5, per=rig)'",
     "machine.shaft_mass_kg: the level of a draw can be chosen for quantities of operation alone; leave per out."),
    ("0.5}", "0.5, operation: {load_n: 0}}", "faults[1].operation.load_n: 0 is not in [1, 1e+07]."),
    ("0.5}", "0.5, operation: {load_n: 1e6}}",
     "faults[1].operation.load_n: gives an equivalent static load of at least 1e+06 N, and 1.58e+04 N"),
    ("0.5}", "0.5, operation: {axial_load_n: 9}}",
     "faults[1].operation.axial_load_n: needs a contact angle; give specimen.contact_angle_deg"),
    ("0.5}", "0.5, operation: {load_n: '1 * shaft_rpm'}}",
     "faults[1].operation.load_n: shaft_rpm is of another kind than load_n; allowed are "),
    ("0.5}", "0.5, level: {faulty_db: 3}}",
     "faults[1].level: works with level.kind: snr alone, because a physical level is that of the rig;"),
    ("0.5}", "0.5, level: {gain: 3}}", "faults[1].level.gain: no such key; allowed are faulty_db, healthy_db, rms_m_s2."),
    (OUTER, "{kind: compound, parts: [{kind: cage, operation: {load_n: 9}}, {kind: outer, width_mm: 1}]}",
     "faults[1].parts[0].operation: no such key; allowed are kind, knock_n, pitch_error_deg."),
    # rungs
    (
        "machine:",
        "storage: {records_per_part: 1}\ntruth: {undetected: redraw}\nmachine:",
        "truth.undetected: redraw judges all 2 records of a specimen together, and a part has 1; raise storage.records_per_part, or",
    ),
    ("rigs: 2", "rigs: 2, rungs: [0, 1, 0.5]", "corpus.rungs: 0.5 after 1 does not rise; sort them, each once."),
    ("rigs: 2", "rigs: 1000000, rungs: [0, 1]", "records_per_specimen * rungs are 16000000 records, and the limit"),
    # sensors
    ("angle_deg: 90", "body: {}", "recording.channels[0].body: no body has a weight above 0; give one, such as body: sensor."),
    ("angle_deg: 90", "body: {sensor: 0}", "recording.channels[0].body: no body has a weight above 0; give one, such as body: sensor."),
    ("angle_deg: 90", "path: {direct: 0}", "recording.channels[0].path.direct: 0 without modes transmits nothing;"),
    # more than a recipe may ask for
    ("rigs: 2", "rigs: 1000000000000", "corpus: rigs * specimens_per_rig * records_per_specimen are 8000000000000 records, and the "),
    ("rigs: 2", "rigs: 1" + 50 * "0", "are 1e18 or more records, and the limit is 10000000;"),
    ("specimens_per_rig: 4", "specimens_per_rig: 1000000", "corpus.specimens_per_rig: asks for 1000000 specimens, and the limit is"),
    ("12000\n  duration_s: 0.1", "200000\n  duration_s: 600",
     "recording: a record of all channels, settle_s included, has 120040000 samples, and the limit is 25000000;"),
    ("12000\n  duration_s: 0.1\n", "20000\n  duration_s: 600\n",
     "storage.records_per_part: 16 records need 192128000 samples, and the limit is 150000000;"),
    # files that are no recipes
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


@pytest.mark.parametrize(
    ("faults", "sentence"),
    [
        (
            "[{kind: healthy}]",
            "corpus.rungs: no entry of faults with a weight above 0 has a severity; add a fault, or leave rungs out.",
        ),
        (
            f"[{{kind: healthy, weight: 0.5}}, {OUTER}]",
            (
                "corpus.rungs: rung 0 makes at least 50 % of all records healthy, and the weights of faults ask for 33.3 %; "
                "give kind: healthy a weight of 1 or more, or leave out rung 0."
            ),
        ),
    ],
)
def test_rungs_that_the_faults_cannot_meet_are_refused(tmp_path, faults, sentence):
    pairs = WHOLE[: WHOLE.index("faults:")].replace("rigs: 2", "rigs: 2, rungs: [0, 1]")
    assert sentence_of(tmp_path, f"{pairs}faults: {faults}\n") == sentence


def test_every_thing_that_is_wrong_gets_a_sentence_of_its_own(tmp_path):
    said = sentence_of(
        tmp_path, WHOLE.replace("rigs: 2", "rigs: 0").replace("machine:", "mashine:").replace("0.5}", "0}")
    )
    assert [line.partition(":")[0] for line in said.splitlines()] == ["corpus.rigs", "faults[1].width_mm", "mashine"]


def test_a_thousand_things_that_are_wrong_are_not_all_told(tmp_path):
    said = sentence_of(tmp_path, WHOLE + "path: {" + ", ".join(f"odd{n}: 1" for n in range(1000)) + "}\n").splitlines()
    assert len(said) == 21
    assert said[-1] == "there are up to 980 more errors; correct these first."


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
