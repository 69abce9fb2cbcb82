"""Laws of records made in memory and of the corpora written from them: the same records as from a recipe, whole, and made again from it."""

from contextlib import nullcontext

import numpy as np
import pytest
import xarray as xr

import gen
import raceway
from gen.corpus import SIGNAL, read_manifest
from gen.support.errors import CorpusError, RecipeError, SimulationError

SHORT = {"waviness_nm": 20, "sample_rate_hz": 12000, "duration_s": 0.1, "settle_s": 0.06, "seed": 5}
OUTER, INNER = gen.outer(width_mm=0.8), gen.inner(width_mm=0.4)
QUICK = gen.read_recipe("quickstart")
SNR = {"kind": "snr", "faulty_db": 3, "healthy_db": 3}


@pytest.fixture(scope="module")
def ladder():
    """Three records of each of two faults, in two parts."""
    return gen.records([OUTER, INNER], 3, records_per_part=4, shaft_rpm=gen.uniform(3000, 4000), **SHORT)


def test_the_largest_severity_sets_the_level_of_a_group_in_whatever_order_it_is_given():
    snr = {"kind": "snr", "faulty_db": 5, "healthy_db": 0}
    drawn = gen.draw_scenarios(gen.make_recipe(OUTER, rungs=[0, 0.5, 1], level=snr, **SHORT))
    rising, falling = gen.simulate(drawn), gen.simulate(drawn[::-1])
    np.testing.assert_array_equal(falling[SIGNAL].values[::-1], rising[SIGNAL].values)


def replayed(directory):
    """Whether the first and the last record are made again."""
    with gen.open_corpus(directory) as corpus:
        records = corpus.sizes["record"]
    return all(gen.replay(directory, record).identical for record in {0, records - 1})


def test_one_record_is_the_only_one_of_records():
    record = gen.record(OUTER, **SHORT)
    assert record[SIGNAL].dims == ("channel", "elapsed_time")
    assert record["bpfo"].dims == ()
    alone = gen.records(OUTER, name="record", **SHORT).isel(record=0)
    assert record.drop_attrs(deep=False).identical(alone.drop_attrs(deep=False))


@pytest.mark.usefixtures("started_processes")
def test_records_do_not_depend_on_the_number_of_workers(ladder):
    again = gen.records([OUTER, INNER], 3, workers=2, records_per_part=4, shaft_rpm=gen.uniform(3000, 4000), **SHORT)
    assert again.identical(ladder)


def test_the_corpus_of_a_whole_dataset_has_its_recipe_and_the_records_of_it(ladder, tmp_path):
    written = gen.write_corpus(ladder, tmp_path / "written")
    gen.generate(written / "recipe.yaml", tmp_path / "generated")
    assert gen.validate_corpus(written) == []
    with gen.open_corpus(written) as corpus, gen.open_corpus(tmp_path / "generated") as generated:
        assert corpus.drop_attrs().equals(generated.drop_attrs())
        assert np.array_equal(corpus[SIGNAL].values, ladder[SIGNAL].values)
    with pytest.raises(CorpusError, match="was not generated from a recipe as a whole; choose another name"):
        gen.generate(written / "recipe.yaml", written)


def saved(dataset, folder):
    dataset.to_netcdf(folder / "saved.nc")
    return xr.open_dataset(folder / "saved.nc")


@pytest.mark.parametrize(
    "changed",
    [
        lambda ladder, _: ladder.isel(record=2),
        lambda ladder, _: xr.concat([ladder.isel(record=[5, 3]), ladder.isel(record=0)], "record"),
        lambda ladder, folder: saved(ladder.isel(record=[3]).transpose("elapsed_time", "channel", "record"), folder),
    ],
    ids=["one", "joined", "transposed and saved"],
)
def test_every_record_of_a_dataset_that_was_cut_or_joined_is_replayed(ladder, tmp_path, changed):
    directory = gen.write_corpus(changed(ladder, tmp_path), tmp_path / "corpus")
    assert gen.validate_corpus(directory) == []
    assert replayed(directory)


@pytest.mark.parametrize(
    ("changed", "stored", "replayable"),
    [
        (lambda ladder: ladder.isel(elapsed_time=slice(100)), np.int16, 0),
        (lambda ladder: ladder.assign(acceleration=1.001 * ladder[SIGNAL]), np.float32, 0),
        (lambda ladder: ladder.assign(acceleration=ladder[SIGNAL].where(ladder.fault == 1, 0.1)), np.float32, 3),
        (lambda ladder: ladder.isel(record=[1, 1]), np.int16, 2),
        (lambda ladder: ladder.drop_vars(["snr", "clipped"]), np.int16, 6),
        (lambda ladder: ladder.drop_vars("draws"), np.float32, 0),
        (
            lambda ladder: xr.concat([ladder, gen.records(OUTER, converter={"kind": "float32"}, **SHORT)], "record"),
            np.float32,
            7,
        ),
    ],
    ids=["cut", "scaled", "half changed", "twice", "without truth", "without scenarios", "two converters"],
)
def test_a_record_that_was_changed_is_written_without_its_scenario(ladder, tmp_path, changed, stored, replayable):
    dataset = changed(ladder)
    is_changed = "draws" in dataset and replayable < dataset.sizes["record"]
    with pytest.warns(UserWarning, match="are unknown") if is_changed else nullcontext():
        directory = gen.write_corpus(dataset, tmp_path / "corpus")
    assert gen.validate_corpus(directory) == []
    assert (directory / "recipe.yaml").exists() == (replayable == 6)
    with gen.open_corpus(directory) as corpus:
        assert corpus[SIGNAL].encoding["dtype"] == stored
        np.testing.assert_array_equal(corpus[SIGNAL], dataset[SIGNAL].astype(np.float32))
        with_scenario = corpus["draws"].values != "" if "draws" in corpus else np.zeros(corpus.sizes["record"], bool)
    assert with_scenario.sum() == replayable
    for record in np.flatnonzero(with_scenario)[-1:]:
        assert gen.replay(directory, record).identical
    for record in np.flatnonzero(~with_scenario)[-1:]:
        with pytest.raises(CorpusError, match=f"record {record} has no scenario"):
            gen.replay(directory, record)


def test_a_changed_record_loses_the_truth_of_its_old_signal_and_no_other(ladder, tmp_path):
    changed = ladder.fault.values != 1
    half = ladder.assign(acceleration=ladder[SIGNAL].where(~xr.DataArray(changed, dims="record"), 0.1))
    lost = {**dict.fromkeys(("snr", "fault_snr", "fault_share", "background_rms", "gain"), np.nan), "detectable": 2}
    with pytest.warns(UserWarning, match=f"of 3 of 6 records were changed .* that {', '.join(lost)} of these are"):
        directory = gen.write_corpus(half, tmp_path / "corpus")
    assert ["were changed after their simulation" in told for told in read_manifest(directory).warnings] == [True]
    with gen.open_corpus(directory) as corpus:
        for name in ("n_spalls", "width", "true_shaft_rate", "clipped", *lost):
            expected = np.where(changed & (name in lost), lost.get(name), ladder[name])
            np.testing.assert_array_equal(corpus[name].values.astype(float), expected.astype(float), name)


@pytest.mark.parametrize(
    ("changed", "sentence"),
    [
        (lambda ladder: ladder.isel(record=[]), "acceleration has the axes {'record': 0, 'channel': 1, 'elapsed_time'"),
        (lambda ladder: ladder.drop_vars(["fault", SIGNAL]), "the Dataset has no variable acceleration, fault;"),
        (lambda ladder: ladder.assign(draws=("record", ['{"name": "x", "wrong": 1}'] * 6)), "drop the variable draws"),
        (lambda ladder: ladder.assign(fault=ladder.fault + 7), "fault has values other than 0 healthy, 1 inner"),
        (
            lambda ladder: ladder.assign(fault=ladder.fault.where(ladder.fault != 2)),
            "fault: a value is missing or no whole number",
        ),
        (lambda ladder: ladder.assign(clipped=ladder.clipped + 0.5), "clipped: a value is missing or no whole number"),
        (lambda ladder: ladder.assign(mine=("record", np.arange(6))), "mine: needs one value for each record and the"),
        (
            lambda ladder: ladder.assign(mine=ladder[SIGNAL].std("elapsed_time").isel(channel=0)),
            "and role, one of operating, label, latent, provenance; set them in its attrs, or drop it.",
        ),
        (
            lambda ladder: ladder.assign(mine=("record", np.arange(6), {"long_name": "rms", "role": "feature"})),
            "and role, one of operating, label, latent, provenance; set them in its attrs, or drop it.",
        ),
    ],
)
def test_a_dataset_that_is_not_in_the_format_is_refused(ladder, tmp_path, changed, sentence):
    with pytest.raises(CorpusError, match=r".") as caught:
        gen.write_corpus(changed(ladder), tmp_path / "corpus")
    assert sentence in str(caught.value)
    assert not any(tmp_path.iterdir())


@pytest.mark.parametrize(
    "changed",
    [
        lambda ladder: ladder.where(ladder.width > 0, drop=True),
        lambda ladder: ladder.drop_attrs(),
        lambda ladder: ladder.assign(fault=ladder.fault + 100),
    ],
)
def test_classes_that_lost_their_codes_or_names_are_refused(ladder, changed):
    with pytest.raises(CorpusError, match=r"no code with a name, .* choose records with isel or sel\.$"):
        gen.open_corpus(changed(ladder))


def test_records_of_two_recipes_in_one_dataset_are_replayed_and_their_machines_keep_apart(ladder, tmp_path):
    other = gen.records(OUTER, 4, bearing="6206", level=SNR, rungs=[0, 1], **SHORT | {"seed": 6})
    both = xr.concat([other.isel(record=[3]), ladder.isel(record=[4, 1]), other.isel(record=[0])], "record")
    directory = gen.write_corpus(both, tmp_path / "corpus")
    assert gen.validate_corpus(directory) == []
    assert not (directory / "recipe.yaml").exists()
    assert replayed(directory)
    with gen.open_corpus(directory) as corpus:
        assert corpus["rig"].values.tolist() == [0, 1, 1, 0]
        assert corpus["pair"].values.tolist() == [0, -1, -1, 1]
        assert corpus["identity"].values.tolist() == both["identity"].values.tolist()


def test_a_record_that_cannot_be_simulated_is_an_error_or_left_out_with_a_warning(tmp_path):
    crushing = {"load_n": gen.grid([500, 30_000]), "bearing": "6205"}
    with pytest.warns(UserWarning, match=r"1 of 3 records are left out; the first: record 1: .*static rating"):
        records = gen.records(OUTER, 3, **SHORT, **crushing)
    assert records["recording"].values.tolist() == [0, 2]
    directory = gen.write_corpus(records, tmp_path / "corpus")
    assert gen.validate_corpus(directory) == []
    assert replayed(directory)


def test_gen_record_makes_one_record_alone():
    with pytest.raises(
        RecipeError, match=r"the keys ask for 4 records; gen\.record makes one, gen\.records makes several"
    ):
        gen.record(OUTER, rigs=2, specimens_per_rig=2)
    with pytest.raises(RecipeError, match="workers: 0 is not allowed; use 1 or more"):
        gen.records(OUTER, workers=0)
    with pytest.raises(SimulationError):
        gen.record(OUTER, shaft_rpm=100_000, oversampling=1, **SHORT)


def test_drawn_scenarios_give_the_records_of_their_recipe(ladder):
    scenarios = gen.read_scenarios(ladder)
    assert scenarios == gen.draw_scenarios(gen.read_recipe(ladder))
    again, unchecked = gen.simulate(scenarios).drop_vars("step_error"), ladder.drop_vars("step_error")
    assert again.drop_attrs(deep=False).identical(unchecked.drop_attrs(deep=False))


def test_every_record_of_scenarios_made_by_hand_is_replayed_from_its_own(tmp_path):
    recipe = gen.make_recipe([OUTER, INNER], 3, rungs=[0, 0.5, 1], level=SNR, **SHORT)
    scenarios = gen.draw_scenarios(recipe)
    faster = [scenario.with_(operation={"shaft_rpm": 60 * 61}) for scenario in scenarios]
    records = gen.simulate(faster[3:] + faster[:3])
    assert np.allclose(records["true_shaft_rate"], 61, rtol=0.02)
    directory = gen.write_corpus(records.isel(record=[2, 0, 1, 5, 4, 3]), tmp_path / "corpus")
    assert gen.validate_corpus(directory) == []
    assert replayed(directory)
    with gen.open_corpus(directory) as corpus:
        (stored,) = gen.read_scenarios(corpus.isel(record=1))
    assert stored.edited(level=faster[3].recipe.level) == faster[3]
    assert replayed(gen.write_corpus(records.isel(record=[0, 1]), tmp_path / "cut"))


def test_scenarios_of_one_rig_that_were_given_different_paths_and_backgrounds_keep_their_own(ladder):
    first, other, *_ = gen.read_scenarios(ladder)
    other = other.edited(origin=other.origin.model_copy(update={"rig": first.origin.rig}))
    some = [first, other.with_(path={"direct": 0.1}), other.with_(background={"slope": 2.0})]
    together = gen.simulate(some)
    for place, scenario in enumerate(some):
        alone = gen.simulate([scenario])
        np.testing.assert_array_equal(together[SIGNAL].values[place], alone[SIGNAL].values[0])


MISFITS = {
    "a bearing that is not known": ({"bearing": {"designations": ["205"]}}, r"bearing\.designations: '205' is neither"),
    "a width beyond the race": (
        {"faults": [{"kind": "inner", "width_mm": 59}], "bearing": {"designations": ["608"]}},
        "specimen 1: a spall of 59 mm does not fit the inner radius",
    ),
    "one width for two spalls": ({"faults": [{"kind": "inner", "n_spalls": 2, "width_mm": [1]}]}, "is a list of 1 numbers"),
    "two faults": ({"faults": [{"kind": "healthy"}, {"kind": "cage"}]}, "origin: is that of one record without life; keep"),
    "two records": ({"corpus": {"rigs": 2}}, "origin: is that of one record without life; keep"),
}  # fmt: skip


@pytest.mark.parametrize("misfit", MISFITS)
def test_a_change_that_no_recipe_allows_is_refused(ladder, misfit):
    change, sentence = MISFITS[misfit]
    with pytest.raises(RecipeError, match=sentence):
        gen.read_scenarios(ladder)[1].with_(**change)


def test_scenarios_of_different_recordings_are_simulated_in_different_calls(ladder):
    first, other, *_ = gen.read_scenarios(ladder)
    for change in ({"seed": 6}, {"truth": {"twins": False}}, {"recording": {"duration_s": 0.2}}):
        with pytest.raises(SimulationError, match=r"scenarios\[1\]: its recording or truth is not that of"):
            gen.simulate([first, other.with_(**change)])


WRONG_TYPES = [
    (lambda _: gen.write_corpus(None, "corpus"), CorpusError, "NoneType given in place of a Dataset"),
    (lambda _: gen.read_recipe(xr.Dataset()), RecipeError, "recipe_text of the Dataset: there is none; give a"),
    (lambda _: gen.read_recipe(xr.Dataset(attrs={"recipe_text": "{"})), RecipeError, "Dataset: line 1: is not valid"),
    (lambda _: gen.read_scenarios(3), CorpusError, "int given in place of a Dataset; give records"),
    (lambda some: gen.simulate(some[0]), RecipeError, "scenarios: Scenario given; give a list of scenarios"),
    (lambda some: gen.simulate([some[0], "a"]), RecipeError, "scenarios: str given; give a list of scenarios"),
    (lambda _: gen.simulate(None), RecipeError, "scenarios: NoneType given; give a list"),
    (lambda _: gen.draw_scenarios("quickstart"), RecipeError, "recipe: str given; give one that gen.make_recipe"),
    (lambda _: gen.outer(0.8), RecipeError, "outer fault: 0.8 has no name; give keys by name"),
    (lambda _: gen.read_recipe(None), RecipeError, "recipe: NoneType given; give a path, the name of"),
    (lambda _: gen.read_recipe("name: a\ntitle: b"), RecipeError, "recipe: is a text in place of a path or a name"),
    (lambda _: gen.read_recipe("n" * 5000), RecipeError, "recipe: is a text in place of a path or a name"),
    (lambda _: gen.write_recipe({}, "recipe.yaml"), RecipeError, "recipe: dict given; give one that gen.make_recipe"),
    (lambda _: raceway.publish("corpus", [1]), CorpusError, r"publication: \[1\] is not a mapping; give keys"),
]


@pytest.mark.parametrize(("call", "error", "sentence"), WRONG_TYPES)
def test_an_argument_of_another_type_is_one_sentence(call, error, sentence, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(error, match=sentence) as caught:
        call(gen.draw_scenarios(QUICK, 0, 1))
    assert str(caught.value).endswith(".")
    assert list(tmp_path.iterdir()) == []
