"""Laws of packed files: the records, bytes and refusals of pack, open and unpack."""

import hashlib
import json
import shutil
from pathlib import Path

import h5py
import netCDF4
import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

from features import feature_table
from gen import CorpusError, open_corpus, pack, unpack, validate_corpus
from gen.corpus import SIGNAL, open_part, part_paths, read_channel, read_manifest
from gen.corpus.record_hashes import record_hashes
from tests import tone_corpora
from tests.corpora import SIZES, dataset, write_corpus
from tests.kills import killed

KINDS = [
    ("counts", "zlib", "zlib"),
    ("counts", "zlib", "none"),
    ("counts", "zstd", "zlib"),
    ("float32", "zlib", "zstd"),
]


def files_of(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A corpus with a recipe, a card and a picture."""
    found = tmp_path_factory.mktemp("packing") / "corpus"
    write_corpus(found)
    (found / "README.md").write_text("# Ein Körper\n", encoding="utf-8")
    (found / "recipe.yaml").write_text("name: small\n")
    (found / "pictures").mkdir()
    (found / "pictures" / "healthy.png").write_bytes(bytes(range(256)))
    return found


@pytest.fixture(scope="module")
def packed(folder):
    return pack(folder, folder.with_name("corpus-packed.nc")).file


@pytest.mark.parametrize(("kind", "stored", "codec"), KINDS)
def test_unpack_gives_back_every_byte(tmp_path, kind, stored, codec):
    write_corpus(tmp_path / "c", kind=kind, codec=stored)
    made = pack(tmp_path / "c", tmp_path / "c.nc", codec=codec)
    again = unpack(made.file, tmp_path / "d")
    assert (made.records, made.parts, again.same_bytes) == (sum(SIZES), len(SIZES), True)
    assert files_of(tmp_path / "c") == files_of(tmp_path / "d")


@settings(max_examples=4, deadline=None)
@given(sizes=st.lists(st.integers(1, 4), min_size=1, max_size=4))
def test_parts_of_any_sizes_come_back(tmp_path_factory, sizes):
    room = tmp_path_factory.mktemp("sizes")
    write_corpus(room / "c", sizes)
    pack(room / "c", room / "c.nc")
    unpack(room / "c.nc", room / "d")
    assert files_of(room / "c") == files_of(room / "d")


def test_recipe_card_and_pictures_come_back(folder, packed, tmp_path):
    unpack(packed, tmp_path / "d")
    assert files_of(tmp_path / "d") == files_of(folder)


def test_the_same_corpus_gives_the_same_file(folder, packed, tmp_path):
    shutil.copytree(folder, tmp_path / "moved")
    assert pack(tmp_path / "moved", tmp_path / "x.nc").file.read_bytes() == packed.read_bytes()


def test_a_packed_file_opens_as_its_folder_does(folder, packed):
    assert validate_corpus(packed) == []
    assert read_manifest(packed) == read_manifest(folder)
    with open_corpus(folder) as one, open_corpus(packed) as other:
        assert [*one.variables] == [*other.variables]
        assert all(one[name].variable.identical(other[name].variable) for name in one.variables)
        assert record_hashes(one) == record_hashes(other)


def test_paths_through_a_packed_file_are_its_parts(folder, packed):
    for path, through in zip(part_paths(folder), part_paths(packed), strict=True):
        assert through.name == path.name
        with open_part(path) as one, open_part(through) as other:
            assert one.identical(other)
        ours, theirs = (read_channel(place, 1, ("width", "fault")) for place in (path, through))
        np.testing.assert_array_equal(ours[0], theirs[0])
        np.testing.assert_array_equal(ours[1], theirs[1])


def test_features_do_not_depend_on_packing(tmp_path):
    tone_corpora.write_corpus(tmp_path / "c", specimens=4, parts=3)
    pack(tmp_path / "c", tmp_path / "c.nc")
    tables = [feature_table(tmp_path / name, ("shape",), workers=workers) for name, workers in (("c", 1), ("c.nc", 2))]
    xr.testing.assert_identical(*(table.drop_attrs(deep=False) for table in tables))


def test_any_reader_sees_chunks_of_one_record_and_no_virtual_layout(packed):
    with h5py.File(packed, locking=False) as file:
        assert file[SIGNAL].chunks == (1, 1, 50)
        assert not file[SIGNAL].is_virtual
        assert file[SIGNAL].compression == "gzip"
    with netCDF4.Dataset(packed) as file:
        assert file.title == "A corpus"
        assert "unpack" in file.comment


def test_deflated_chunks_are_copied_as_they_are(folder, packed):
    first = 0
    with h5py.File(packed, locking=False) as whole:
        for path in part_paths(folder):
            with h5py.File(path, locking=False) as part:
                records, channels, _ = part[SIGNAL].shape
                for record, channel in np.ndindex(records, channels):
                    chunk = whole[SIGNAL].id.read_direct_chunk((first + record, channel, 0))
                    assert chunk == part[SIGNAL].id.read_direct_chunk((record, channel, 0))
                first += records


def test_a_choice_holds_the_chosen_records_unchanged(folder, tmp_path):
    pack(folder, tmp_path / "x.nc", where="fault == 'inner' or fault == 'ball'", split="validation")
    with open_corpus(folder) as whole, open_corpus(tmp_path / "x.nc") as some:
        kept = np.flatnonzero(np.isin(whole["fault"], (1, 3)) & (whole["split"].values == 1))
        assert len(kept) == 2
        assert record_hashes(some) == record_hashes(whole.isel(record=kept))
    assert unpack(tmp_path / "x.nc", tmp_path / "d").same_bytes
    assert validate_corpus(tmp_path / "d") == validate_corpus(tmp_path / "x.nc") == []
    assert sorted(path.name for path in tmp_path.iterdir()) == ["d", "x.nc"]


def test_float32_stores_what_the_counts_decode_to(folder, tmp_path):
    pack(folder, tmp_path / "x.nc", channels=["b"], float32=True)
    with open_corpus(folder) as whole, open_corpus(tmp_path / "x.nc") as single:
        assert single[SIGNAL].dtype == np.float32
        np.testing.assert_array_equal(single[SIGNAL], whole[SIGNAL][:, 1:].astype(np.float32))
    unpack(tmp_path / "x.nc", tmp_path / "d")
    assert validate_corpus(tmp_path / "d") == []


def change_a_chunk(file):
    with h5py.File(file, "r+") as opened:
        counts = opened[SIGNAL][4, 1]
        counts[7] += 1
        opened[SIGNAL][4, 1] = counts


def change_a_label(file):
    with h5py.File(file, "r+") as opened:
        opened["width"][8] = 0.5


def change_a_time(file):
    with h5py.File(file, "r+") as opened:
        opened["elapsed_time"][3] += 1e-6


def damage_the_attributes(file):
    """Change one byte of the part of the file that h5py reads with the attributes, such that the file still opens."""
    whole = bytearray(file.read_bytes())
    place = whole.index(b"raceway_packed")
    whole[place + 1] ^= 4
    file.write_bytes(whole)


def with_contents(change):
    """Damage that keeps all hashes of the small files right, as a forger would."""

    def damage(file):
        with h5py.File(file, "r+") as opened:
            content = json.loads(np.asarray(opened["files/contents.json"]).tobytes())
            change(content)
            text = json.dumps(content).encode()
            del opened["files/contents.json"]
            stored = opened["files"].create_dataset("contents.json", data=np.frombuffer(text, "S1"))
            stored.attrs["sha256"] = np.bytes_(hashlib.sha256(text).hexdigest())

    return damage


FORGED = {
    "a type that asks for a gigabyte": lambda content: content["forms"][0]["variables"][0].update(type="|V999999999"),
    "a type of objects": lambda content: content["forms"][0]["variables"][0].update(type="O"),
    "a name with a path": lambda content: content["forms"][0]["variables"][0].update(name="../x"),
    "no attributes": lambda content: content["forms"][0]["variables"][0].update(attributes=3),
    "an attribute with a line break": lambda content: content["attributes"][0].update({"a\nb": "x"}),
    "an attribute of no type": lambda content: content["attributes"][0].update(a={"type": "x", "value": 3}),
    "a codec with a path": lambda content: content["forms"][0].update(codec="../x"),
}


@pytest.mark.parametrize("what", FORGED)
def test_a_forged_list_of_variables_is_refused_in_a_sentence(packed, tmp_path, what):
    file = Path(shutil.copy(packed, tmp_path / "x.nc"))
    with_contents(FORGED[what])(file)
    for call in (open_corpus, lambda file: unpack(file, tmp_path / "d")):
        with pytest.raises(CorpusError, match=r"not a whole packed corpus .its list of variables is altered: "):
            call(file)
    assert [path.name for path in tmp_path.iterdir()] == ["x.nc"]


@pytest.mark.parametrize("change", [{"name": "no_such"}, {"type": "<f8"}])
def test_a_list_of_other_variables_is_not_unpacked(packed, tmp_path, change):
    file = Path(shutil.copy(packed, tmp_path / "x.nc"))
    with_contents(lambda content: [of["variables"][-1].update(change) for of in content["forms"]])(file)
    with pytest.raises(CorpusError, match="its list of variables does not fit them"):
        unpack(file, tmp_path / "d")
    assert [path.name for path in tmp_path.iterdir()] == ["x.nc"]


def cut_a_chunk(file):
    with h5py.File(file, "r+") as opened:
        chunk = opened[SIGNAL].id.read_direct_chunk((2, 0, 0))[1]
        opened[SIGNAL].id.write_direct_chunk((2, 0, 0), chunk[:-9])


def change_the_manifest(file):
    with netCDF4.Dataset(file, "r+") as opened:
        opened["files/manifest.json"].set_auto_chartostring(False)
        opened["files/manifest.json"][0:1] = b" "


def of_another_layout(file):
    with netCDF4.Dataset(file, "r+") as opened:
        opened.raceway_packed = np.int32(7)


DAMAGE = {
    "a sample": (change_a_chunk, r"record 4 is damaged: its hash differs; copy the file again"),
    "a label": (change_a_label, r"record 8 is damaged: its hash differs"),
    "a time": (change_a_time, r"its channels or times are damaged: their hash differs; copy the file again"),
    "the attributes": (damage_the_attributes, r"is a file and no packed corpus"),
    "a chunk": (cut_a_chunk, r"damaged \(.*\); generate or copy it again"),
    "the manifest": (change_the_manifest, r"not a whole packed corpus \(manifest\.json is altered: its hash differs\)"),
    "the layout": (of_another_layout, r"packed in layout 7, this version of raceway reads 1; pack the corpus again"),
    "the end of the file": (lambda file: file.write_bytes(file.read_bytes()[:-4000]), r"is a file and no packed corpus|truncated"),
}  # fmt: skip


@pytest.mark.parametrize("what", DAMAGE)
def test_damage_is_refused_in_a_sentence(packed, tmp_path, what):
    file = Path(shutil.copy(packed, tmp_path / "x.nc"))
    damage, sentence = DAMAGE[what]
    damage(file)
    with pytest.raises(CorpusError, match=sentence):
        open_corpus(file)
    with pytest.raises(CorpusError, match=sentence):
        unpack(file, tmp_path / "d")
    assert len(validate_corpus(file)) == 1
    assert [path.name for path in tmp_path.iterdir()] == ["x.nc"]


def test_a_file_that_another_command_made_meanwhile_is_kept(folder, tmp_path):
    file = tmp_path / "x.nc"
    with pytest.raises(CorpusError, match="exists now, made by another command"):
        pack(folder, file, progress=lambda *_: file.write_text("another"))
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [("x.nc", "another")]


def test_what_a_killed_pack_of_a_choice_leaves_is_removed_by_the_next(folder, tmp_path):
    for _ in killed(lambda: pack(folder, tmp_path / "x.nc", split="train", float32=True), moments=4):
        (tmp_path / "x.nc").unlink(missing_ok=True)
    pack(folder, tmp_path / "x.nc", split="train", float32=True)
    assert [path.name for path in tmp_path.iterdir()] == ["x.nc"]


def test_an_index_without_its_parts_is_refused(folder, tmp_path):
    shutil.copy(folder / "corpus.nc", tmp_path)
    with pytest.raises(CorpusError, match=r"is the index of a corpus without its parts, so it holds no signals; copy"):
        open_corpus(tmp_path / "corpus.nc")
    with pytest.raises(CorpusError, match="is one file of a corpus; give the folder"):
        open_corpus(folder / "corpus.nc")
    with netCDF4.Dataset(tmp_path / "corpus.nc") as index:
        assert index.comment.startswith("This file alone holds no signals: they lie in parts/ beside it.")


def test_nothing_that_exists_is_overwritten(folder, packed, tmp_path):
    with pytest.raises(CorpusError, match="exists; give another name"):
        pack(folder, packed)
    (tmp_path / "note").touch()
    with pytest.raises(CorpusError, match="is not an empty folder"):
        unpack(packed, tmp_path)
    with pytest.raises(CorpusError, match="is one file already"):
        pack(packed, tmp_path / "x.nc")


def test_parts_of_different_kinds_are_refused(folder, tmp_path):
    from gen.corpus import part_name, write_index, write_manifest, write_part

    shutil.copytree(folder, tmp_path / "c")
    rows = read_manifest(folder).parts
    rows[1] = write_part(dataset(3, 4).drop_vars("draws"), tmp_path / "c" / "parts" / part_name(1))
    write_index(tmp_path / "c", rows)
    write_manifest(tmp_path / "c", rows, complete=True)
    with pytest.raises(CorpusError, match=r"part-00001\.nc: has other variables or another scale than part-00000\.nc"):
        pack(tmp_path / "c", tmp_path / "x.nc")
    assert not (tmp_path / "x.nc").exists()


def test_a_killed_pack_leaves_a_whole_file_or_none(folder, packed, tmp_path):
    for _ in killed(lambda: pack(folder, tmp_path / "x.nc"), moments=5):
        if (tmp_path / "x.nc").exists():
            assert (tmp_path / "x.nc").read_bytes() == packed.read_bytes()
            (tmp_path / "x.nc").unlink()
    pack(folder, tmp_path / "x.nc")
    assert [path.name for path in tmp_path.iterdir()] == ["x.nc"]


def test_a_killed_unpack_leaves_a_whole_corpus_or_none(folder, packed, tmp_path):
    for _ in killed(lambda: unpack(packed, tmp_path / "d"), moments=5, seed=1):
        if (tmp_path / "d").exists():
            assert files_of(tmp_path / "d") == files_of(folder)
            shutil.rmtree(tmp_path / "d")
    unpack(packed, tmp_path / "d")
    assert [path.name for path in tmp_path.iterdir()] == ["d"]
