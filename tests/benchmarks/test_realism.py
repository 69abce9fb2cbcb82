"""The tables and verdicts of the benchmark of realism, on made-up sets, and the import of UESTC from made-up files."""

import numpy as np
import pytest
import scipy.io

from benchmarks.realism import real_corpora, table
from gen.corpus import FAULTS, SIGNAL, open_corpus
from raceway.comparing import compare
from raceway.comparing.measures import MEASURES
from tests.pulses import write_pulses


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sets")
    made, like = write_pulses(folder / "made"), write_pulses(folder / "like", seed=1)
    return compare(made, [like, write_pulses(folder / "bright", ringing=4200.0, seed=2)])


def test_the_table_has_a_row_per_measure_and_a_cell_per_class(found):
    lines = list(table(found))
    assert len(lines) == 2 + len(MEASURES)
    assert {line.count("|") for line in lines} == {7}
    assert "→" not in "".join(lines)
    assert list(table(found, found))[2].count("→") == 4


def test_parts_of_a_uestc_recording_are_joined_converted_and_given_their_true_speed(tmp_path):
    volts = np.random.default_rng(0).standard_normal((2, 8000, 1))
    for name in ("O_1400", "N_800"):
        (tmp_path / "uestc" / "Data" / name).mkdir(parents=True)
        for part in (1, 2):
            path = tmp_path / "uestc" / "Data" / name / f"{name}_{part}.mat"
            scipy.io.savemat(path, {"Data": volts[part - 1]})
    assert real_corpora(tmp_path, tmp_path / "one") == [tmp_path / "one" / "uestc"]
    with open_corpus(tmp_path / "one" / "uestc") as corpus:
        assert [FAULTS[code] for code in corpus["fault"].values] == ["healthy", "outer"]
        np.testing.assert_allclose(corpus["shaft_rate"].values, [800 / 60, 1.061 * 1400 / 60])
        joined = np.concatenate(volts)[:10_000, 0] / 0.01022
        np.testing.assert_allclose(corpus[SIGNAL].values[0, 0], joined, rtol=1e-5)
