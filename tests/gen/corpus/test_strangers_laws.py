"""Laws of files from strangers, with right checksums: what leads out of a file or is not in the format is refused in one sentence."""

import shutil
import zlib
from contextlib import suppress
from itertools import product
from pathlib import Path

import h5py
import numpy as np
import pytest

from features.table.corpus_features import feature_table
from gen.corpus import SIGNAL, open_corpus, part_name, read_manifest, validate_corpus
from gen.corpus.schema import operating_problems
from gen.support.errors import CorpusError, RacewayError
from raceway.console.summary import corpus_facts
from raceway.sharing.card.additions import CardAdditions, CardPicture, write_additions
from tests.corpora import write_corpus
from tests.tampering import edit_manifest, edited, seal

FILE, PART, INDEX = "c.nc", f"c/parts/{part_name(0)}", "c/index.nc"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    place = tmp_path_factory.mktemp("made")
    write_corpus(place / "c", (9,))
    write_corpus(place / "c.nc", (9,))
    return place


@pytest.fixture
def copied(made, tmp_path):
    return shutil.copytree(made, tmp_path / "copy")


def secret(folder: Path) -> Path:
    """File of this machine that no corpus should read; its values would be believed."""
    path = folder / "secret.nc"
    if not path.exists():
        with h5py.File(path, "w") as file:
            file["load"], file[SIGNAL] = np.full(9, 12.5), np.full((9, 2, 50), 7, np.int16)
    return path


def replaced(name, link):
    """Put something in the place of a variable; its attributes stay if it can have any."""

    def change(file):
        outside = secret(Path(file.filename).parent)
        old, attributes = file[name], dict(file[name].attrs)
        shape, dtype = old.shape, old.dtype
        del file[name]
        link(file, name, shape, dtype, outside)
        if not isinstance(file.get(name, getlink=True), h5py.HardLink):
            return
        for key in attributes.keys() - {"DIMENSION_LIST", "CLASS", "NAME"}:
            file[name].attrs[key] = attributes[key]

    return change


def external_link(file, name, _shape, _dtype, outside):
    file[name] = h5py.ExternalLink(str(outside), name)


def soft_link(file, name, *_):
    file[name] = h5py.SoftLink("/ftf" if name != SIGNAL else "/nothing")


def external_storage(file, name, shape, dtype, outside):
    file.create_dataset(name, shape, dtype, external=[(str(outside), 0, int(np.prod(shape)) * dtype.itemsize)])


def virtual(file, name, shape, dtype, outside):
    layout = h5py.VirtualLayout(shape, dtype)
    layout[:] = h5py.VirtualSource(str(outside), name, shape, dtype)
    file.create_virtual_dataset(name, layout)


LINKS = {
    "an external link": (external_link, "{} is a soft or external link"),
    "a soft link": (soft_link, "{} is a soft or external link"),
    "external storage": (external_storage, "the values of {} are in another file"),
    "a virtual dataset": (virtual, "{} is a virtual dataset"),
}


def assert_a_sentence(corpus, sentence=""):
    """Validation finds something, opening and features refuse the corpus or read it, and nothing ends in another error."""
    found = validate_corpus(corpus)
    assert any(sentence in problem for problem in found), found
    assert not any("\n" in problem for problem in found)
    with suppress(CorpusError):
        open_corpus(corpus).load()
    with suppress(CorpusError):
        corpus_facts(corpus)
    with suppress(RacewayError):
        feature_table(corpus, groups=("time",))


@pytest.mark.parametrize(("place", "name"), [(FILE, "load"), (FILE, SIGNAL), (PART, SIGNAL), (INDEX, "fault")])
@pytest.mark.parametrize("kind", LINKS)
def test_nothing_in_a_file_leads_out_of_it(copied, place, kind, name):
    link, sentence = LINKS[kind]
    with edited(copied / place) as file:
        replaced(name, link)(file)
    corpus = copied / place.partition("/")[0]
    if corpus.is_dir():
        seal(corpus)
    assert_a_sentence(corpus, sentence.format(name))


def text_type(file):
    del file["bearing"]
    file.create_dataset("bearing", data=["6205"] * 9, dtype=h5py.string_dtype())


def wide_text(file):
    """Terabytes of text that a file of some kilobytes declares."""
    del file["draws"]
    file.create_dataset("draws", (9, 10**12), "S1", chunks=(1, 4096))


def a_dimension(file):
    """A second name of what holds the size of a dimension, which is no value of any record."""
    del file["rig"]
    file["rig"] = file["draws_length"]


def short_text(file):
    """A chunk of text that HDF5 would read beyond its end."""
    file["draws"].id.write_direct_chunk((0, 0), zlib.compress(b"x"))


def no_utf8(file):
    stored, values = file["bearing"].id, file["bearing"][:]
    values[1, 0] = b"\xff"
    stored.write(h5py.h5s.ALL, h5py.h5s.ALL, values, mtype=stored.get_type())  # h5py writes other bytes by itself


def many_records(file):
    signal, attributes = file[SIGNAL], dict(file[SIGNAL].attrs)
    shape = (10**9, *signal.shape[1:])
    del file[SIGNAL]
    file.create_dataset(SIGNAL, shape, np.int16, chunks=(1, 1, shape[2])).attrs.update(
        {name: attributes[name] for name in ("scale_factor", "add_offset", "_FillValue")}
    )


def without_variables(file):
    for name in list(file):
        del file[name]


def odd_dimensions(file):
    for name in ("load", "fault"):
        file[name].attrs["DIMENSION_LIST"] = 3
        file[name].attrs["_Netcdf4Dimid"] = "x"
    file["channel"].attrs["CLASS"] = 7
    file["load"].attrs["NAME"] = 3.5


def two_dimensions(file):
    del file["load"]
    file["load"] = np.zeros((9, 2))


def reshaped(file, name, values):
    del file[name]
    file[name] = values


ODD = {
    "text of variable length": text_type,
    "text of a terabyte": wide_text,
    "a dimension for a label": a_dimension,
    "a chunk of text that is too short": short_text,
    "no variables": without_variables,
    "odd dimensions": odd_dimensions,
    "a label with two dimensions": two_dimensions,
    "a label without dimensions": lambda f: reshaped(f, "fault", np.int8(0)),
    "labels of fewer records": lambda f: reshaped(f, "fault", np.zeros(4, np.int8)),
    "a label of complex numbers": lambda f: reshaped(f, "load", np.zeros(9, complex)),
    "a label that is empty": lambda f: reshaped(f, "load", h5py.Empty("f8")),
    "a class with an attribute of lists": lambda f: f["fault"].attrs.create("flag_values", np.zeros((2, 2))),
    "numbers with the encoding of text": lambda f: f["fault"].attrs.create("_Encoding", "utf-8"),
    "text that is no UTF-8": no_utf8,
    "a name that is no UTF-8": lambda f: f.__setitem__(b"caf\xe9", np.zeros(9)),
    "a label that is packed": lambda f: f["load"].attrs.create("scale_factor", 2.0),
    "a group": lambda f: f.create_group("x"),
    "a variable of no known dimension": lambda f: f.create_dataset("x", data=np.zeros(4)),
    "a fact that is a list of numbers": lambda f: f.attrs.__setitem__("title", np.zeros((2, 2))),
    "a sample rate of zero": lambda f: f["sample_rate"].write_direct(np.zeros(9)),
    "an infinite order": lambda f: f["bpfo"].write_direct(np.full(9, np.inf)),
    "references for labels": lambda f: reshaped(f, "load", np.array([f["fault"].ref] * 9, dtype=h5py.ref_dtype)),
}  # fmt: skip
OF_SIGNALS = {
    "a billion records without chunks": many_records,
    "no signal": lambda f: f.pop(SIGNAL),
    "a scale of zero": lambda f: f[SIGNAL].attrs.modify("scale_factor", np.float32(0)),
    "a scale that is a list": lambda f: f[SIGNAL].attrs.create("scale_factor", np.zeros(9)),
    "no fill value": lambda f: f[SIGNAL].attrs.__delitem__("_FillValue"),
    "no channel names": lambda f: f.__delitem__("channel"),
}


# facts that are read from the manifest, and names that are read from the index
HARMLESS = {("a fact that is a list of numbers", INDEX), ("no channel names", PART)}


@pytest.mark.parametrize(
    ("odd", "place"), [*product(ODD, (FILE, INDEX)), *product(OF_SIGNALS, (FILE, PART))], ids=lambda value: value
)
def test_what_is_not_in_the_format_is_refused_and_never_an_internal_error(copied, place, odd):
    with edited(copied / place) as file:
        (ODD | OF_SIGNALS)[odd](file)
    corpus = copied / place.partition("/")[0]
    if corpus.is_dir():
        seal(corpus)
    if (odd, place) in HARMLESS or odd == "odd dimensions":
        validate_corpus(corpus)
    else:
        assert_a_sentence(corpus)


def deflated(samples):
    """A chunk as HDF5 writes it: shuffled bytes in a zlib stream."""
    return zlib.compress(samples.view(np.uint8).reshape(len(samples), -1).T.tobytes())


CHUNKS = {
    "no stream": (b"no zlib stream", 0),
    "too short": (deflated(np.zeros(49, np.int16)), 0),
    "too long": (deflated(np.zeros(5000, np.int16)), 0),
    "cut short": (deflated(np.arange(50, dtype=np.int16))[:-4], 0),
    "without its filters": (np.zeros(50, np.int16).tobytes(), 3),
}


@pytest.mark.parametrize("place", [FILE, PART])
@pytest.mark.parametrize("chunk", CHUNKS)
def test_a_damaged_chunk_is_refused_when_it_is_read_and_found_by_validation(copied, place, chunk):
    corpus, (content, left_out) = copied / place.partition("/")[0], CHUNKS[chunk]
    with edited(copied / place) as file:
        file[SIGNAL].id.write_direct_chunk((1, 0, 0), content, left_out)
    if corpus.is_dir():
        seal(corpus)
    assert_a_sentence(corpus, "(damaged: a chunk")
    with open_corpus(corpus) as found:
        found[SIGNAL][0].load()
        with pytest.raises(CorpusError, match=r"\.nc: not a readable file of a corpus \(damaged: a chunk"):
            found[SIGNAL][1].load()


@pytest.mark.parametrize("name", ["p" * 300 + ".png", "../../x.png", "\0.png", "a\nb.png", ""])
def test_no_name_of_a_picture_is_an_internal_error_or_leads_out(copied, name):
    folder = copied / "c"
    picture = CardPicture(name=name, title="A picture", caption="")
    write_additions(folder, CardAdditions(parts=read_manifest(folder).parts_sha256, pictures=(picture,)))
    from raceway.sharing.card.card_page import data_card

    card = data_card(folder)
    assert "../" not in card.partition("## Pictures")[2].partition("\n## ")[0]


@pytest.mark.parametrize(
    "name",
    ["title", "records", "signals", "publication", "versions", "overrides", "parts_sha256", "failures", "importer"],
)
def test_no_fact_of_a_manifest_is_an_internal_error(copied, name):
    for value in (None, True, -1, 1e308, 10**40, "", "\0", [], {}, [[]], {"a": []}, "x" * 10**5):
        edit_manifest(copied / "c", **{name: value})
        assert not any("\n" in problem for problem in validate_corpus(copied / "c"))


@pytest.mark.parametrize("name", ["sample_rate", "shaft_rate", "bpfo"])
def test_a_rate_that_is_text_is_told(name):
    assert operating_problems({name: np.array(["25"])}) == [f"{name} holds no numbers."]
