"""Laws of conditions on records: each gives the records that its own words ask for, and nothing is evaluated as Python."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gen import open_corpus
from gen.corpus.choice import chosen_channels, chosen_records
from gen.corpus.where import DEEPEST, MOST_CHARACTERS, Column, records_where
from gen.support.errors import CorpusError
from tests import corpora

RATE = np.array([10.0, 20.0, 30.0, np.nan, -5.0])
COLUMNS = {
    "rate": Column(RATE),
    "load": Column(np.array([10.0, 5.0, np.nan, np.nan, -5.0])),
    "rig": Column(np.array([0, 1, 2, 3, 4], np.int32)),
    "fault": Column(np.array([0, 1, 1, 2, 0], np.int8), {0: "healthy", 1: "inner", 2: "outer"}),
    "bearing": Column(np.array(["6205", "6205", "N 205 E", "it's", ""], object)),
}
NUMBERS = {"==": np.equal, "<": np.less, "<=": np.less_equal, ">": np.greater, ">=": np.greater_equal}


def holds(text):
    return records_where(text, list(COLUMNS), COLUMNS.__getitem__)


def comparisons():
    """Pairs of a text and the records that it holds for, made without the parser."""

    def numeric(name, sign, number):
        return f"{name} {sign} {number!r}", NUMBERS[sign](COLUMNS[name].values, number)

    def classes(names):
        codes = [code for code, name in COLUMNS["fault"].flags.items() if name in names]
        return f"fault in ({', '.join(map(repr, names))})", np.isin(COLUMNS["fault"].values, codes)

    numbers = st.one_of(st.integers(-10, 40), st.floats(-50, 50, allow_nan=False))
    return st.one_of(
        st.builds(numeric, st.sampled_from(["rate", "load", "rig"]), st.sampled_from([*NUMBERS]), numbers),
        st.builds(classes, st.lists(st.sampled_from(["healthy", "inner", "outer"]), min_size=1)),
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
@settings(deadline=None)
def test_a_condition_holds_for_the_records_that_its_words_ask_for(pair):
    text, expected = pair
    assert np.array_equal(holds(text), expected)


@pytest.mark.parametrize(
    ("text", "records"),
    [
        ("rig == 0 or rig == 1 and rate > 15", [0, 1]),  # and binds more strongly than or
        ("not rig == 0 and rig < 3", [1, 2]),  # not binds more strongly than and
        ("15 < rate", [1, 2]),
        ("rate != 20", [0, 2, 4]),  # a comparison with NaN is false, != too
        ("not (rate == 20)", [0, 2, 3, 4]),
        ("rate == load", [0, 4]),
        ("fault != 'inner'", [0, 3, 4]),
        ("fault not in ('inner', 'outer')", [0, 4]),
        ("bearing == \"it's\" or bearing in ('N 205 E', '')", [2, 3, 4]),
        ("rate>=+1.5e1 and\n rig<2", [1]),
        ("rate < -.5", [4]),
        ("10 < rate <= 30", [1, 2]),
        (" 1 <= rig<3 ", [1, 2]),
        ("rate not in [20, 30]", [0, 4]),
        (f"rate < 1{'0' * 400}", [0, 1, 2, 4]),
    ],
)
def test_conditions_read_as_they_are_written(text, records):
    assert np.flatnonzero(holds(text)).tolist() == records


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "character 1: invalid syntax; an example is fault == 'inner' and shaft_rate > 20."),
        ("fualt == 'inner'", "character 1: there is no variable fualt; the nearest is fault."),
        ("rig > 1 and fault == 'iner'", "character 22: fault has no value 'iner'; allowed are healthy, inner, outer."),
        ("bearing == '\u00e9' or rigg > 1", "character 19: there is no variable rigg"),
        ("fault == 1", "put its value in quotes; allowed are healthy, inner, outer."),
        ("fault == inner", "put its value in quotes, such as 'inner'."),
        ("fault < 'inner'", "has no order"),
        ("bearing == 6205", "bearing is a text; put its value in quotes."),
        ("rate == 'fast'", "write the number without quotes"),
        ("rate == fault", "rate has numbers and fault has not"),
        ("rate = 3", "character 6: invalid syntax; equality is written =="),
        ("1 == 1", "neither side"),
        ("rate > 1.5e1and rig < 2", "character 12: invalid decimal literal"),
        ("rate > nan", "there is no variable nan"),
        ("rate > 1j", "found '1j' where the name of a variable, a number or a text in quotes should be"),
        ("rate == True", "found 'True' where"),
        ("(rate > 1", "was never closed"),
        ("rate > 1)", "character 9: unmatched ')'"),
        ("fault in (inner)", "inner is a name; put a text in quotes: 'inner'."),
        ("1 in (1, 2)", "neither side"),
        ("bearing == '6205", "character 12: unterminated string literal"),
        ("bearing == '\\d'", "invalid escape sequence"),
        ("rate", "found 'rate' where a comparison"),
        ("rate is 3", "where a comparison"),
        ("__import__('os')", "found \"__import__('os')\" where a comparison"),
        ("rig == __import__('os').getpid()", "found \"__import__('os').getpid()\" where"),
        ("rate.real > 1", "found 'rate.real' where"),
        ("[x for x in rig] == 1", "found '[x for x in rig]' where"),
        ("not " * (DEEPEST + 1) + "rig == 1", f"more than {DEEPEST} deep"),
        ("rig == " + "-" * 3900 + "1", "character"),
        ("rig == " + "-" * 500 + "1", "found '------------------------------' where"),
        ("rig in (1, " * 150 + "1" + ")" * 150, "found 'rig in (1, rig"),
        ("(" * 900 + "rig == 1" + ")" * 900, "too many nested parentheses"),
        ("rig == 1 or " * 1000, f"at most {MOST_CHARACTERS}"),
    ],
)
def test_a_wrong_condition_is_refused_with_its_place(text, sentence):
    with pytest.raises(CorpusError) as refused:
        holds(text)
    assert sentence in str(refused.value)
    assert "\n" not in str(refused.value)


@given(st.text(alphabet="ab()<>=!'\"., \\\n1e-+notrigfl", max_size=60))
@settings(deadline=None)
def test_any_text_is_a_condition_or_gets_one_sentence(text):
    try:
        found = holds(text)
    except CorpusError as refused:
        sentence = str(refused)
    else:
        sentence = "where: character " * (found.shape == RATE.shape)
    assert sentence.startswith("where: character ")


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
