"""Laws of extension: old records, files and splits never change, and an interrupted extension is completed by the same call."""

import importlib
import shutil

import pytest

from gen.corpus import (
    EXTENSION_NAME,
    JOURNAL_NAME,
    open_corpus,
    part_name,
    read_manifest,
    sha256,
    validate_corpus,
    write_manifest,
)
from gen.corpus.files import forget_hashes
from gen.corpus.record_hashes import record_hashes
from gen.errors import CorpusError, RecipeError
from gen.extending import extend, new_block
from gen.generation import generate
from gen.replaying import replay
from tests.corpora import write_corpus
from tests.kills import killed

EXTENDING, GENERATION = importlib.import_module("gen.extending"), importlib.import_module("gen.generation")
SMALLER = {"corpus.records_per_part": 4, "corpus.undetected": "redraw"}


def contents(folder):
    """Hash of every file of a corpus, by its path."""
    forget_hashes()
    return {str(path.relative_to(folder)): sha256(path) for path in folder.rglob("*") if path.is_file()}


def parts(folder):
    return {name: found for name, found in contents(folder).items() if name.startswith("parts/")}


def numbers(folder):
    with open_corpus(folder) as corpus:
        named = ("rig", "specimen", "recording", "split", "fault")
        return list(zip(*(corpus[name].values.tolist() for name in named), strict=True)), record_hashes(corpus)


@pytest.fixture(scope="module")
def recipe_file(write_recipe, tmp_path_factory):
    return write_recipe(tmp_path_factory.mktemp("recipe") / "small.yaml", SMALLER)


@pytest.fixture(scope="module")
def begun(recipe_file, tmp_path_factory):
    """Four parts; the last of seven specimens has one record instead of two, and the second of two rigs three specimens of four."""
    return generate(recipe_file, tmp_path_factory.mktemp("begun") / "corpus", records=13).directory


@pytest.fixture(scope="module")
def with_specimens(begun, tmp_path_factory):
    """The same corpus with one specimen more in both rigs."""
    folder = shutil.copytree(begun, tmp_path_factory.mktemp("specimens") / "corpus")
    made = extend(folder, specimens=1)
    assert (made.records, made.added, made.parts, made.kept) == (17, 4, 5, 0)
    return folder


@pytest.fixture(scope="module")
def extended(with_specimens, tmp_path_factory):
    """The same corpus with one specimen more in both rigs, then with one rig more."""
    folder = shutil.copytree(with_specimens, tmp_path_factory.mktemp("extended") / "corpus")
    made = extend(folder, rigs=1)
    assert (made.records, made.added, made.parts, made.kept) == (25, 8, 7, 0)
    return folder


@pytest.fixture
def copied(begun, tmp_path):
    return shutil.copytree(begun, tmp_path / "copy")


def test_old_records_and_their_parts_do_not_change(begun, extended):
    assert parts(begun).items() < parts(extended).items()
    (old_numbers, old_hashes), (new_numbers, new_hashes) = numbers(begun), numbers(extended)
    assert (new_numbers[:13], new_hashes[:13]) == (old_numbers, old_hashes)
    assert len(set(new_hashes)) == 25


def test_an_extended_corpus_is_sound_and_records_of_all_blocks_can_be_made_again(extended):
    assert validate_corpus(extended) == []
    assert all(replay(extended, record).identical for record in (0, 12, 13, 16, 17, 24))
    assert [*read_manifest(extended).overrides.extensions] == [{"specimens": 1}, {"rigs": 1}]
    assert not {EXTENSION_NAME, JOURNAL_NAME} & contents(extended).keys()


def test_new_numbers_go_on_where_the_old_ones_end(extended):
    found, _ = numbers(extended)
    assert [row[0] for row in found[13:]] == [0, 0, 1, 1] + [2] * 8
    assert [row[1] for row in found[13:]] == [7, 7, 8, 8, 9, 9, 10, 10, 11, 11, 12, 12]
    assert [row[2] for row in found] == list(range(25))


def test_generate_makes_lost_parts_of_an_extended_corpus_again(extended, recipe_file, tmp_path):
    """All parts of all blocks are made together, and have the bytes that they had when each block was made alone."""
    folder, before = shutil.copytree(extended, tmp_path / "copy"), contents(extended)
    shutil.rmtree(folder / "parts")
    made = generate(recipe_file, folder, records=13)
    assert (made.records, made.parts, made.kept) == (25, 7, 0)
    assert contents(folder) == before
    (folder / "parts" / part_name(5)).unlink()
    assert generate(recipe_file, folder, records=13).kept == 6
    assert contents(folder) == before


def interrupted_after(n_parts, monkeypatch):
    """Let the making of parts end with Ctrl-C after some parts."""
    made = GENERATION._made

    def some(*given):
        for number, item in enumerate(made(*given)):
            if number == n_parts:
                raise KeyboardInterrupt
            yield item

    monkeypatch.setattr(GENERATION, "_made", some)


def test_an_interrupted_extension_leaves_the_corpus_readable_and_is_completed(
    with_specimens, extended, recipe_file, monkeypatch, tmp_path
):
    copied, before = shutil.copytree(with_specimens, tmp_path / "copy"), contents(with_specimens)
    with monkeypatch.context() as patched:
        interrupted_after(1, patched)
        with pytest.raises(KeyboardInterrupt):
            extend(copied, rigs=1)
    left = contents(copied)
    assert {name: left[name] for name in before} == before
    assert validate_corpus(copied) == []
    with pytest.raises(CorpusError, match="is being extended; run the raceway extend command"):
        generate(recipe_file, copied, records=13)
    with pytest.raises(
        CorpusError, match=r"an extension by 1 rigs is unfinished; complete it with raceway extend --rigs 1"
    ):
        extend(copied, specimens=1)
    assert extend(copied, rigs=1).kept == 1
    assert contents(copied) == contents(extended)


@pytest.mark.parametrize("broken", ["write_manifest", "write_card", "unlink"])
def test_an_extension_that_ended_while_its_files_were_replaced_is_completed(
    copied, with_specimens, monkeypatch, broken
):
    """Between index and manifest the corpus cannot be read, and the error says what to do; afterwards it is the new one."""
    with monkeypatch.context() as patched:

        def ended(*_given, **_facts):
            raise KeyboardInterrupt

        if broken == "unlink":
            patched.setattr(EXTENDING.Path, "unlink", ended)
        else:
            patched.setattr(f"gen.corpus.finishing.{broken}", ended)
        with pytest.raises(KeyboardInterrupt):
            extend(copied, specimens=1)
    if broken == "write_manifest":
        with pytest.raises(CorpusError, match="run the raceway extend command that began an extension of it again"):
            open_corpus(copied)
    else:
        assert validate_corpus(copied) == []
    assert extend(copied, specimens=1).records == 17
    assert contents(copied) == contents(with_specimens)


def test_a_killed_extension_leaves_the_old_or_the_new_corpus_or_one_that_is_completed(copied, with_specimens, tmp_path):
    folder, old, new = tmp_path / "killed", contents(copied), contents(with_specimens)
    shutil.copytree(copied, folder)
    for _ in killed(lambda: extend(folder, specimens=1), moments=5):
        left = contents(folder)
        if left != new:
            assert {name: left[name] for name in old if name.startswith("parts/")} == parts(copied)
            whole = {name: found for name, found in left.items() if not name.endswith(".tmp")}
            assert EXTENSION_NAME in left or whole == old
            assert extend(folder, specimens=1).added == 4
            assert contents(folder) == new
        shutil.rmtree(folder)
        shutil.copytree(copied, folder)


def test_records_that_cannot_be_simulated_are_left_out(write_recipe, tmp_path, monkeypatch):
    """Every second rig has a resonance that Runge-Kutta cannot hold."""
    monkeypatch.setattr("gen.simulation.steps.COARSEST_STEP", float("inf"))
    resonance = {"kind": "grid", "values": [1500, 5900]}
    changes = {"recording.oversampling": 1, "machine.resonator.frequency_hz": resonance, "corpus.rigs": 2}
    folder = generate(write_recipe(tmp_path / "r.yaml", changes), tmp_path / "c").directory
    before = read_manifest(folder).failures
    made = extend(folder, specimens=2)
    assert (made.records, made.added, len(made.failures)) == (12, 4, 12)
    assert made.failures[:8] == before
    assert [sentence.split(" diverged")[0] for sentence in made.failures[8:]] == [f"record {n}" for n in range(20, 24)]
    assert validate_corpus(folder) == []
    assert replay(folder, 11).identical


def test_workers_do_not_change_an_extension(with_specimens, extended, tmp_path):
    copied, shown = shutil.copytree(with_specimens, tmp_path / "copy"), []
    extend(copied, rigs=1, workers=2, progress=lambda *counts: shown.append(counts))
    assert contents(copied) == contents(extended)
    assert shown[-1] == (8, 8)


def test_the_new_block_is_known_before_it_is_made(begun):
    assert new_block(begun, rigs=1).records == range(13, 21)


def test_facts_of_the_manifest_stay_and_other_versions_are_told(copied):
    manifest, told = read_manifest(copied), []
    facts = manifest.model_dump(mode="json", exclude_unset=True, exclude={*EXTENDING._NOT_COPIED})
    facts |= {"versions": {**manifest.versions, "scipy": "0.1"}, "recordings": 77}
    write_manifest(copied, manifest.parts, complete=True, **facts)
    extend(copied, specimens=1, notice=told.append)
    assert [sentence.split(": ")[1].split(" ")[::2] for sentence in told] == [["scipy", "instead", "0.1."]]
    assert read_manifest(copied).versions["scipy"] == "0.1"
    assert read_manifest(copied).recordings == 77


def test_a_corpus_whose_machines_are_drawn_otherwise_now_is_refused(copied, monkeypatch):
    drawn = EXTENDING.draw_scenarios
    monkeypatch.setattr(
        EXTENDING, "draw_scenarios", lambda recipe, *of: drawn(recipe.model_copy(update={"seed": 99}), *of)
    )
    with pytest.raises(CorpusError, match="the installed libraries draw another machine for record"):
        extend(copied, specimens=1)


def test_a_corpus_of_an_older_version_is_refused_before_anything_is_made(copied, monkeypatch):
    before = contents(copied)
    monkeypatch.setattr(EXTENDING, "SIMULATED", [of._replace(units="dB") for of in EXTENDING.SIMULATED])
    with pytest.raises(CorpusError, match=r"was made by an older version of raceway.*; make another corpus"):
        extend(copied, specimens=1)
    assert contents(copied) == before


@pytest.mark.parametrize(
    ("facts", "sentence"),
    [
        ({}, "was not generated from a recipe"),
        ({"scenarios": "given"}, "holds some records of a recipe, or scenarios made by hand"),
        ({"selections": [{"records": 9, "parts_sha256": "0"}]}, "is a selection of another corpus; extend that one"),
        (
            {"origins": [{"parts": 3, "added": {}, "same_machines": "a"}]},
            "was merged from other corpora; extend one of",
        ),
    ],
)
def test_a_corpus_that_was_not_made_from_one_recipe_is_refused(tmp_path, facts, sentence):
    write_corpus(tmp_path)
    write_manifest(tmp_path, read_manifest(tmp_path).parts, complete=True, **facts)
    with pytest.raises(CorpusError, match=sentence):
        extend(tmp_path, rigs=1)


def test_a_corpus_that_lacks_a_part_is_refused_before_anything_is_made(copied):
    (copied / "parts" / part_name(1)).unlink()
    before = contents(copied)
    with pytest.raises(CorpusError, match=r"part-00001.nc: is missing; copy it again"):
        extend(copied, rigs=1)
    assert contents(copied) == before


def test_an_unfinished_corpus_is_refused(copied):
    manifest = read_manifest(copied)
    write_manifest(copied, manifest.parts, complete=False, overrides={})
    with pytest.raises(CorpusError, match="is unfinished; run the raceway generate command that began it again, then"):
        extend(copied, rigs=1)


@pytest.mark.parametrize("asked", [{}, {"rigs": 1, "specimens": 1}, {"rigs": 0}, {"specimens": -1}, {"rigs": 2**31}])
def test_one_positive_number_is_wanted(copied, asked):
    with pytest.raises(RecipeError, match=r"give one of the two numbers|use a whole number from 1 to"):
        extend(copied, **asked)


def test_an_extension_beyond_the_limits_is_refused_before_anything_is_written(copied):
    before = contents(copied)
    with pytest.raises(RecipeError, match="the extended corpus has 80000013 records, and the limit is"):
        extend(copied, rigs=10**7)
    assert contents(copied) == before
