"""Laws of conditions on records: each gives the records that its own words ask for, and nothing is evaluated as Python."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from gen import open_corpus
from gen.corpus.choice import chosen_channels, chosen_records
from gen.corpus.where import MOST_CHARACTERS, records_where
from gen.support.errors import CorpusError
from tests import corpora

RATE = np.array([10.0, 20.0, 30.0, np.nan, -5.0])
FAULTS = ["healthy", "inner", "outer"]
FAULT = ["healthy", "inner", "inner", "outer", "healthy"]
CLASSES = {"flag_values": [0, 1, 2], "flag_meanings": " ".join(FAULTS)}
VARIABLES = {
    "rate": (RATE, {"units": "Hz"}),
    "load": (np.array([10.0, 5.0, np.nan, np.nan, -5.0]), {"units": "N"}),
    "width": (np.array([0.0, 0.3e-3, 0.7e-3, 1e-3, np.nan]), {"units": "m"}),
    "rig": (np.arange(5, dtype=np.int32), {"units": "1"}),
    "fault": (np.array([FAULTS.index(name) for name in FAULT], np.int8), CLASSES),
    "bearing": (np.array(["6205", "6205", "N 205 E", "it's", ""], object), {}),
}
DATA = {name: xr.DataArray(values, attrs=attrs) for name, (values, attrs) in VARIABLES.items()}
NUMBERS = {"==": np.equal, "<": np.less, "<=": np.less_equal, ">": np.greater, ">=": np.greater_equal}


def holds(text):
    return np.isin(np.arange(len(RATE)), records_where(text, DATA))


def comparisons():
    """Pairs of a text and the records that it holds for, made without the parser."""

    def numeric(name, sign, number):
        return f"{name} {sign} {number!r}", NUMBERS[sign](VARIABLES[name][0], number)

    def classes(names):
        return f"fault in [{', '.join(map(repr, names))}]", np.isin(FAULT, names)

    numbers = st.one_of(st.integers(-10, 40), st.floats(-50, 50, allow_nan=False))
    return st.one_of(
        st.builds(numeric, st.sampled_from(["rate", "load", "rig"]), st.sampled_from([*NUMBERS]), numbers),
        st.builds(classes, st.lists(st.sampled_from(FAULTS), min_size=1)),
    )


def conditions():
    def joined(word, one, other):
        combine = np.logical_and if word == "and" else np.logical_or
        return f"({one[0]}){word}({other[0]})", combine(one[1], other[1])

    return st.recursive(
        comparisons(),
        lambda inner: st.one_of(
            st.builds(joined, st.sampled_from(["and", "or"]), inner, inner),
            st.builds(lambda one: (f"not ({one[0]})", ~one[1]), inner),
        ),
        max_leaves=8,
    )


@given(conditions())
def test_a_condition_holds_for_the_records_that_its_words_ask_for(pair):
    text, expected = pair
    assert np.array_equal(holds(text), expected)


@pytest.mark.parametrize(
    ("text", "records"),
    [
        ("rig == 0 or rig == 1 and rate > 15", [0, 1]),  # and binds more strongly than or
        ("not rig == 0 and rig < 3", [1, 2]),  # not binds more strongly than and
        ("rate != 20", [0, 2, 3, 4]),  # NaN differs from every number, and all else is false for it
        ("not (rate == 20)", [0, 2, 3, 4]),
        ("rate == load", [0, 4]),
        ("fault != 'inner'", [0, 3, 4]),
        ("fault not in ('inner', 'outer')", [0, 4]),
        ("bearing == \"it's\" or bearing in ('N 205 E', '')", [2, 3, 4]),
        ("rate>=+1.5e1 and\n rig<2", [1]),
        ("10 < rate <= 30", [1, 2]),
        ("rate_rpm > 900", [1, 2]),
        ("width_mm >= 0.3 and width_um <= 700 and width > 0", [1, 2]),
        ("width_mm == 0.7 or load_kn == 0.01", [0, 2]),
        ("rate - 2 * load == 10 or rig / 3 == 1", [1, 3]),
        ("rig == 0 & rate < 15 | rig == 3", [0, 3]),
        ("~(rig == 0) & not (rig > 2)", [1, 2]),
        ("bearing == '@rate' or bearing == '`rig`' or bearing == '|' or rig == 2", [2]),
    ],
)
def test_conditions_read_as_they_are_written(text, records):
    assert np.flatnonzero(holds(text)).tolist() == records


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "invalid syntax at character 1; an example is fault == 'inner' and width_mm > 0.5."),
        ("fualt == 'inner'", "there is no column fualt; the nearest are fault; a text stands in quotes."),
        ("fault not in ('iner', 'outer')", "fault has no value 'iner'"),
        ("widthmm > 1", "there is no column widthmm; the nearest are width_mm, width_m, width; a text"),
        ("width > 0.5 mm", "invalid syntax at character 13; an example is fault == 'inner' and width_mm > 0.5."),
        ("bearing == 6205", "'bearing == 6205' compares texts with numbers; texts stand in quotes, and numbers do"),
        ("bearing + bearing == bearing", "cannot be evaluated"),
        ("bearing == 'a' * 999999999", "cannot be part of a condition"),
        ("fault < 'inner'", "Unordered Categoricals can only compare equality or not"),
        ("rate = 3", "at character 6; equality is written =="),
        ("1 == 1", "'1 == 1' compares no column"),
        ("rate > [1][0]", "'[1][0]' cannot be part of a condition"),
        ("(rate > 1", "was never closed"),
        ("rate", "'rate' compares no column"),
        ("rate > 1 and rig", "'rate > 1 and rig' cannot be part of a condition"),
        (f"rig == {'9' * 5000}", f"at most {MOST_CHARACTERS}"),
        ("(" * 900 + "rig == 1" + ")" * 900, "too many nested parentheses"),
        ("not " * 900 + "rig == 1", "maximum recursion depth"),
    ],
)
def test_a_wrong_condition_is_refused_with_its_place(text, sentence):
    with pytest.raises(CorpusError) as refused:
        holds(text)
    assert sentence in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    "text",
    [
        "__import__('os')",
        "@__builtins__ == 1",
        "`rig` == 1",
        "rate.real > 1",
        "index == 1",
        "rate[rate.pipe(print)] > 1",
        "[x for x in rig] == 1",
        "(lambda: 1)() == rig",
        "rig == (y := 1)",
        "f'{rig}' == bearing",
        "rig ** 9 ** 9 ** 9 > 1",
        "rig << 1 > 2",
        "rig == 1 if rate > 2 else 3",
        "rig > 1; import os",
    ],
)
def test_nothing_but_comparisons_of_columns_reaches_pandas(text, monkeypatch):
    monkeypatch.setattr(pd.DataFrame, "eval", lambda *_args, **_named: pytest.fail("it was evaluated"))
    with pytest.raises(CorpusError, match=r"^where: "):
        holds(text)


@given(st.text(alphabet="ab()<>=!'\"., \\\n1e-+notrigfl", max_size=60))
def test_any_text_is_a_condition_or_gets_one_sentence(text):
    try:
        found = holds(text)
    except CorpusError as refused:
        sentence = str(refused)
    else:
        sentence = "where: " * (found.shape == RATE.shape)
    assert sentence.startswith("where: ")


@pytest.fixture(scope="module")
def corpus(tmp_path_factory):
    """Datasets of nine records with all classes, splits in turn, and the channels a and b."""
    folder = tmp_path_factory.mktemp("choice") / "corpus"
    corpora.write_corpus(folder)
    with open_corpus(folder) as opened:
        yield opened


def chosen(corpus, *choice, **named):
    return chosen_records([corpus], *choice, **named)[0].tolist()


def test_condition_and_split_both_apply(corpus):
    assert chosen(corpus, "rig >= 2", "test") == [2, 5, 8]
    assert chosen(corpus, split="train") == [0, 3, 6]
    assert chosen(corpus) == list(range(9))


def test_a_choice_without_records_or_of_an_unknown_split_is_refused(corpus):
    with pytest.raises(CorpusError, match=r"where 'rig > 99' and split 'test': none of 9 records is chosen"):
        chosen(corpus, "rig > 99", "test")
    with pytest.raises(CorpusError, match="there is no split 'tets'; allowed are train, validation, test"):
        chosen(corpus, split="tets")


def test_channels_are_chosen_by_name_in_the_order_of_the_corpus():
    names = ["a", "b"]
    assert chosen_channels(names, None) == chosen_channels(names, ["b", "a"]) == (0, 1)
    assert chosen_channels(names, ("b",)) == (1,)
    with pytest.raises(CorpusError, match="there is no channel 'aa'; the nearest is a"):
        chosen_channels(names, ["a", "aa"])
    for none in ([], "a"):
        with pytest.raises(CorpusError, match="is not a list of names; allowed are a, b"):
            chosen_channels(names, none)


@pytest.mark.parametrize("text", ["A&B", "R|S", "it's & so", 'a "b" | c'])
def test_signs_in_quotes_are_part_of_the_text(text):
    names = [text, text.replace("&", " and ").replace("|", " or "), "x"]
    data = {"specimen": xr.DataArray(np.array(names, object)), "rig": xr.DataArray(np.arange(3))}
    assert records_where(f"specimen == {text!r}", data).tolist() == [0]
    assert records_where(f"specimen != {text!r}&rig < 2|rig == 2", data).tolist() == [1, 2]


@given(st.sampled_from(["2", "205", "it", "6205", "", "x"]), st.booleans())
def test_a_part_of_a_text_chooses_the_records_whose_text_holds_it(part, negated):
    """As Python means it; pandas would look for the part among all texts of the column."""
    expected = [(part in bearing) is not negated for bearing in VARIABLES["bearing"][0]]
    assert holds(f"{part!r} {'not in' if negated else 'in'} bearing").tolist() == expected
    assert (
        holds(f"rig < 3 and {part!r} {'not in' if negated else 'in'} bearing").tolist()
        == (np.array(expected) & (np.arange(5) < 3)).tolist()
    )
