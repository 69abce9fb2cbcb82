"""Laws of damage: every change of a stored corpus is detected, and a failed write leaves no file."""

import errno
import io
import json
import os
import shutil
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.corpus import (
    SIGNAL,
    check_new,
    finish_corpus,
    open_corpus,
    part_name,
    read_manifest,
    validate_corpus,
    write_manifest,
)
from gen.corpus.schema import FORMAT
from gen.support.errors import CorpusError
from tests.corpora import SIZES, dataset, write_corpus, write_parts
from tests.disks import full_disk
from tests.tampering import edit_manifest, edited, manifest_content, seal

FORMS = ("c", "c.nc")


def assert_refused(corpus, sentence, problems=1):
    """The corpus is not opened, and validation says why, in the same words."""
    with pytest.raises(CorpusError, match=sentence) as refused:
        open_corpus(corpus)
    found = validate_corpus(corpus)
    assert len(found) == problems
    assert str(refused.value) in found
    assert "\n" not in found[0]


FILES = ("c.nc", f"c/parts/{part_name(1)}", "c/index.nc")


@pytest.mark.parametrize("name", FILES)
@given(share=st.floats(0, 1), mask=st.integers(1, 255), how=st.sampled_from(["changed", "cut", "longer"]))
def test_a_file_with_any_other_byte_is_refused_by_name(nine, tmp_path_factory, name, share, mask, how):
    corpus = tmp_path_factory.mktemp("bytes") / name.partition("/")[0]
    (shutil.copytree if corpus.suffix != ".nc" else shutil.copyfile)(nine / corpus.name, corpus)
    path = corpus.parent / name
    content = bytearray(path.read_bytes())
    place = int(share * (len(content) - 1))
    if how == "changed":
        content[place] ^= mask
    elif how == "cut":
        del content[place:]
    else:
        content.insert(place, mask)
    path.write_bytes(content)
    place = r"in manifest\.json for this part" if "parts" in name else "at its end"
    assert_refused(corpus, rf"{path}: its bytes do not have the hash that Raceway stored {place}: ")


def link_out(path, outside):
    path.rename(outside / f"moved-{path.name}")
    path.symlink_to(outside / f"moved-{path.name}")


def make_pipe(path):
    path.unlink()
    os.mkfifo(path)


def other_index(folder):
    write_corpus(folder.with_name("other"), SIZES[::-1])
    shutil.copyfile(folder.with_name("other") / "index.nc", folder / "index.nc")


def part(folder, number):
    return folder / "parts" / part_name(number)


@pytest.mark.parametrize("name", ["manifest.json", "index.nc", f"parts/{part_name(1)}", "recipe.yaml"])
def test_a_folder_in_the_place_of_a_file_is_refused(copied_folder, name):
    (copied_folder / name).unlink(missing_ok=True)
    (copied_folder / name).mkdir()
    (problem,) = validate_corpus(copied_folder)
    assert problem.startswith(f"{copied_folder / name}: is not a plain file; copy it again")


@pytest.mark.parametrize("name", ["manifest.json", "index.nc", f"parts/{part_name(1)}"])
@pytest.mark.parametrize("code", [errno.EACCES, errno.EIO])
def test_a_file_that_the_system_cannot_read_is_refused(copied_folder, monkeypatch, name, code):
    """A test may run as root, who may read everything."""
    opened = io.open

    def unreadable(file, *args, **kwargs):
        if Path(file) == copied_folder / name:
            raise OSError(code, os.strerror(code), file)
        return opened(file, *args, **kwargs)

    monkeypatch.setattr(io, "open", unreadable)
    assert_refused(
        copied_folder, rf"could not be read \({os.strerror(code)}\); get permission to read it, or copy it again\."
    )


def test_a_path_that_no_system_has_is_refused(tmp_path):
    assert_refused(tmp_path / ("x" * 300), r"x: could not be read \(File name too long\)")


@pytest.mark.parametrize(
    "alter", [lambda file: file.chmod(0o600), lambda file: os.link(file, file.with_suffix(".backup"))]
)
def test_a_corpus_stays_open_when_its_files_get_other_permissions_or_a_second_name(nine, tmp_path, alter):
    shutil.copytree(nine, tmp_path / "all")
    with open_corpus(tmp_path / "all" / "c") as opened:
        for file in (tmp_path / "all" / "c" / "parts").iterdir():
            alter(file)
        assert opened[SIGNAL].values.shape == opened[SIGNAL].shape


@pytest.mark.parametrize("name", FILES[:2])
def test_a_changed_file_whose_time_was_put_back_is_seen_as_changed(nine, tmp_path, name):
    shutil.copytree(nine, tmp_path / "all")
    corpus, path = tmp_path / "all" / name.partition("/")[0], tmp_path / "all" / name
    before = path.stat()
    with open_corpus(corpus) as opened:
        content = bytearray(path.read_bytes())
        content[len(content) // 2] ^= 1
        path.write_bytes(content)
        os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))
        with pytest.raises(CorpusError, match="changed since the corpus was opened"):
            opened[SIGNAL].values  # noqa: B018
    assert_refused(corpus, "its bytes do not have the hash")


NO_MANIFEST = r"manifest\.json: not the manifest of a corpus"
REFUSED = {
    "a part is missing": (lambda c: part(c, 1).unlink(), r"part-00001\.nc: is missing; copy it again"),
    "a part stands for another": (lambda c: shutil.copyfile(part(c, 0), part(c, 2)), r"part-00002\.nc: its bytes do not have the hash"),
    "the manifest is gone": (lambda c: (c / "manifest.json").unlink(), r"has no manifest\.json, so it is not a corpus"),
    "the manifest lists no parts": (
        lambda c: write_manifest(c, {"raceway_format": FORMAT, "records": 0}), "is marked complete and lists no parts",
    ),
    "the title of the manifest is altered": (
        lambda c: (c / "manifest.json").write_text((c / "manifest.json").read_text().replace('"title": "', '"title": "My ')),
        r"manifest\.json: its bytes do not have the hash",
    ),
    "the index is gone": (lambda c: (c / "index.nc").unlink(), r"index\.nc: is missing; copy it again"),
    "the index is that of another corpus": (other_index, r"index\.nc is that of other parts than manifest\.json lists"),
    "a part is a link out of the corpus": (lambda c: link_out(part(c, 1), c.parent), r"part-00001\.nc: is a link"),
    "the index is a link out of the corpus": (
        lambda c: link_out(c / "index.nc", c.parent), r"index\.nc: is a link that leads out of the corpus",
    ),
    "the folder of the parts is a link": (lambda c: link_out(c / "parts", c.parent), r"part-00000\.nc: is a link"),
    "a part is a pipe": (lambda c: make_pipe(part(c, 0)), r"part-00000\.nc: is not a plain file; copy it again"),
    "the manifest counts other records": (lambda c: edit_manifest(c, records=8), "its counts are not those of its parts"),
    "the manifest counts a part wrongly": (
        lambda c: edit_manifest(c, {0: {"records": 4}}, records=10), r"index\.nc: .*conflicting sizes for dimension 'record'",
    ),
    "the manifest lists a part twice": (
        lambda c: edit_manifest(c, {1: {"name": part_name(0)}}), "it lists a part more than once",
    ),
    "more records cannot be used than there are": (
        lambda c: edit_manifest(c, {1: {"signals": {"dead": 121_306}}}, signals={"dead": 121_306}),
        "its counts are not those of its parts",
    ),
    "the sum of unusable records is another": (
        lambda c: edit_manifest(c, signals={"dead": 1}), "its counts are not those of its parts",
    ),
    "the manifest is huge": (lambda c: os.truncate(c / "manifest.json", 60_000_000), r"raceway --limit manifest_bytes=NUMBER"),
    "the corpus is unfinished": (lambda c: edit_manifest(c, complete=False), "is unfinished; run the raceway"),
    "the folder has the format before": (lambda c: edit_manifest(c, raceway_format=2), r"manifest\.json: corpus"),
}  # fmt: skip


@pytest.mark.parametrize("damage", REFUSED)
def test_a_damaged_folder_is_refused_with_the_file_named_and_found_by_validation(copied_folder, damage):
    break_it, sentence = REFUSED[damage]
    break_it(copied_folder)
    assert_refused(copied_folder, sentence, problems=3 if "parts is a link" in damage else 1)


@pytest.mark.parametrize(
    "text", [b"", b"{", b"{}", b"[[]]", b"[" * 10**5, b'{"records": ' + b"9" * 5000 + b"}", b'{"title": "\xff"}']
)
def test_a_text_that_is_no_manifest_is_refused(copied_folder, text):
    (copied_folder / "manifest.json").write_bytes(text)
    assert_refused(copied_folder, NO_MANIFEST)


def test_a_manifest_without_its_hash_is_refused(copied_folder):
    (copied_folder / "manifest.json").write_text(json.dumps(manifest_content(copied_folder)))
    with pytest.raises(CorpusError, match=r"manifest\.json: its bytes do not have the hash that Raceway stored in it"):
        open_corpus(copied_folder)


@pytest.mark.parametrize("name", ["../x", "/etc/passwd", 7])
def test_no_name_of_a_part_leads_out(copied_folder, name):
    edit_manifest(copied_folder, {1: {"name": name}})
    assert_refused(copied_folder, NO_MANIFEST + r" \(parts\.1\.name")


def set_fact(name, value):
    def change(path):
        with edited(path) as found:
            found.attrs[name] = value

    return change


REFUSED_FILES = {
    "is empty": (lambda f: os.truncate(f, 0), "its bytes do not have the hash that Raceway stored"),
    "has the format before": (set_fact("raceway_format", 2), "corpus format 2, this version of raceway reads format 4"),
    "has no format": (set_fact("raceway_format", "x"), "corpus format x, this version of raceway reads format 4"),
    "counts more useless records than it has": (
        set_fact("signals", '{"dead": 121306}'), "its counts are not those of its parts",
    ),
    "has counts that are no JSON": (set_fact("signals", "{"), r"has unreadable facts"),
    "has facts that are nested without end": (set_fact("warnings", "[" * 10_000), "has unreadable facts"),
    "is marked incomplete": (set_fact("complete", "false"), "is unfinished"),
}  # fmt: skip


@pytest.mark.parametrize("damage", REFUSED_FILES)
def test_a_file_that_is_none_of_the_format_is_refused(copied_file, damage):
    break_it, sentence = REFUSED_FILES[damage]
    break_it(copied_file)
    assert_refused(copied_file, sentence)


FACTS = {
    "title": "Another title",
    "publication": {"license": "MIT"},
    "warnings": ["all is well"],
    "versions": {"raceway": "9"},
    "parts_sha256": "0" * 64,
}


@pytest.mark.parametrize("fact", FACTS)
def test_a_changed_fact_of_the_manifest_is_found(copied_folder, fact):
    edit_manifest(copied_folder, **{fact: FACTS[fact]})
    with_problem = [problem for problem in validate_corpus(copied_folder) if fact in problem]
    assert with_problem or fact == "parts_sha256"
    if fact == "parts_sha256":
        assert_refused(copied_folder, r"index\.nc is that of other parts than manifest\.json lists")


def test_a_changed_recipe_is_found(tiny_corpus, tmp_path):
    recipe = shutil.copytree(tiny_corpus, tmp_path / "c") / "recipe.yaml"
    recipe.write_bytes(recipe.read_bytes().replace(b"i", b"j", 1))
    (problem,) = validate_corpus(recipe.parent)
    assert problem.startswith(f"{recipe}: is missing or is not the recipe that index.nc has")
    recipe.unlink()
    assert validate_corpus(recipe.parent) == [problem]


@pytest.mark.parametrize("name", ["recipe_sha256", "sources_sha256"])
def test_a_part_of_another_recipe_or_of_other_sources_is_found(tiny_corpus, tmp_path, name):
    folder = shutil.copytree(tiny_corpus, tmp_path / "c")
    with edited(part(folder, 2)) as found:
        found.attrs[name] = "0" * 64
    seal(folder)
    assert any(
        f"part-00002.nc: its {name} is not that of manifest.json" in problem for problem in validate_corpus(folder)
    )


@pytest.mark.parametrize("name", ["fault", "shaft_rate", "bearing"])
@pytest.mark.parametrize("where", ["index", "part"])
def test_validation_finds_an_index_that_differs_from_its_parts(copied_folder, name, where):
    with edited(copied_folder / "index.nc" if where == "index" else part(copied_folder, 0)) as found:
        found[name][2] = found[name][1]
    seal(copied_folder)
    assert any(f"part-00000.nc: {name} differs from index.nc" in problem for problem in validate_corpus(copied_folder))


def test_a_part_with_another_scale_than_the_first_is_not_read(copied_folder):
    with edited(part(copied_folder, 1)) as found:
        found[SIGNAL].attrs.modify("scale_factor", found[SIGNAL].attrs["scale_factor"] * 2)
    seal(copied_folder)
    with (
        open_corpus(copied_folder) as corpus,
        pytest.raises(CorpusError, match=r"part-00001\.nc: its signal has another shape or type than the corpus"),
    ):
        corpus[SIGNAL].load()


def with_values(name, value):
    def change(part):
        part[name].values[1] = value
        return part

    return change


def with_attribute(name, key, value):
    def change(part):
        part[name].attrs[key] = value
        return part

    return change


FOUND_IN_PARTS = {
    "a class that does not exist": (with_values("fault", 9), "fault has values other than 0 healthy, 1 inner"),
    "a split that does not exist": (with_values("split", -1), "split has values other than 0 train, 1 validation, 2 test."),
    "a missing variable": (lambda part: part.drop_vars("bpfo"), "bpfo"),
    "a wrong unit": (with_attribute("load", "units", "lbf"), "load is in 'lbf', not 'N'"),
    "a wrong type": (lambda part: part.assign(rig=part["rig"].astype("f8").assign_attrs(part["rig"].attrs)), "rig"),
    "no role": (with_attribute("draws", "role", "secret"), "draws needs a long_name and a role"),
    "a missing sample": (with_values(SIGNAL, -32768), "has samples that are not finite"),
}  # fmt: skip


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("damage", FOUND_IN_PARTS)
def test_validation_finds_records_that_are_not_in_the_format(tmp_path, damage, form):
    """A folder is not even written: its data card cannot be made."""
    change, sentence = FOUND_IN_PARTS[damage]
    try:
        write_parts(tmp_path / form, [change(dataset(0, 3)), change(dataset(3, 4))])
    except CorpusError as error:
        problems = [str(error)]
    else:
        problems = validate_corpus(tmp_path / form)
    assert any(sentence in problem for problem in problems)


@pytest.mark.parametrize("form", FORMS)
def test_counts_of_useless_records_are_those_of_the_signals(tmp_path, form):
    dead = dataset(3, 4)
    dead[SIGNAL].values[2] = 0
    write_parts(tmp_path / form, [dataset(0, 3), dead])
    assert read_manifest(tmp_path / form).signals == {"dead": 1}
    assert validate_corpus(tmp_path / form) == []
    none = {}
    if form == "c":
        edit_manifest(tmp_path / form, {1: {"signals": none}}, signals=none)
    else:
        set_fact("signals", json.dumps(none))(tmp_path / form)
    assert any("1 dead of its records cannot be used, none are listed" in p for p in validate_corpus(tmp_path / form))


@pytest.mark.parametrize("form", FORMS)
def test_a_full_disk_leaves_no_half_corpus(tmp_path, form):
    with (
        full_disk(),
        pytest.raises(CorpusError, match=rf"{form}.*: could not be written .* free some space") as refused,
    ):
        write_parts(tmp_path / form, [dataset(0, 20, samples=5000)])
    assert ".tmp" not in str(refused.value)
    assert list(tmp_path.iterdir()) == []


def test_no_corpus_is_written_over_anything(copied_folder, copied_file):
    for corpus in (copied_folder, copied_file):
        before = {path: path.read_bytes() for path in [*corpus.rglob("*"), corpus] if path.is_file()}
        for refuse in (check_new, write_corpus):
            with pytest.raises(CorpusError, match="exists"):
                refuse(corpus)
        assert all(path.read_bytes() == content for path, content in before.items())


def test_a_full_disk_leaves_the_last_manifest_and_index_as_they_were(copied_folder):
    rows, before = (
        read_manifest(copied_folder).parts,
        {path: path.read_bytes() for path in copied_folder.iterdir() if path.is_file()},
    )
    assert len(before[copied_folder / "index.nc"]) > 20_000
    with full_disk():
        with pytest.raises(CorpusError, match=r"manifest\.json: could not be written"):
            write_manifest(copied_folder, {"title": "x" * 30_000})
        with pytest.raises(CorpusError, match=r"index\.nc: could not be written"):
            finish_corpus(copied_folder, rows)
    assert {path: path.read_bytes() for path in copied_folder.iterdir() if path.is_file()} == before
    assert validate_corpus(copied_folder) == []
