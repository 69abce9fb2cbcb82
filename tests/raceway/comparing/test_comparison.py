"""A synthetic corpus against real ones: equal corpora are alike, every set counts equally, and errors are sentences."""

import numpy as np
import pytest

from gen.support.errors import CorpusError
from raceway.comparing import compare
from raceway.comparing import windows as windows_module
from raceway.comparing.windows import common_ground, measured_windows
from tests.pulses import write_pulses


@pytest.fixture(scope="module")
def dark(tmp_path_factory):
    return write_pulses(tmp_path_factory.mktemp("sets") / "dark", ringing=1500.0)


@pytest.fixture(scope="module")
def bright(tmp_path_factory):
    return write_pulses(tmp_path_factory.mktemp("sets") / "bright", ringing=4000.0, seed=1, records=30)


@pytest.fixture(scope="module")
def fast(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sets") / "fast"
    return write_pulses(folder, fs=20_000.0, duration=0.9, classes=("inner", "outer"), ringing=2500.0, seed=2)


@pytest.fixture(scope="module")
def found(dark, bright, fast):
    return compare(dark, [bright, fast])


def test_a_corpus_is_like_itself_in_every_measure(dark):
    alike = compare(dark, [dark])
    known = [value for table in alike.auc.values() for value in table.values() if value is not None]
    assert known == pytest.approx([0.5] * len(known))
    assert alike.yardstick == {}


def test_the_auc_is_above_one_half_where_real_values_are_higher(dark, bright):
    one, other = compare(dark, [bright]), compare(bright, [dark])
    for fault in ("inner", "outer", "ball"):
        assert one.auc[fault]["centroid"] == 1.0
        assert other.auc[fault]["centroid"] == 0.0


def test_every_real_set_counts_equally_whatever_its_size(found, dark, bright, fast):
    both = found.auc["outer"]["centroid"], found.auc["inner"]["kurtosis"]
    alone = [compare(dark, [real]) for real in (bright, fast)]
    # the window of the shorter records is used in all three comparisons
    assert found.counts["outer"]["centroid"] == {"synthetic": 12, "bright": 30, "fast": 24}
    assert both[0] == pytest.approx(np.mean([one.auc["outer"]["centroid"] for one in alone]), abs=1e-3)
    assert both[1] == pytest.approx(np.mean([one.auc["inner"]["kurtosis"] for one in alone]), abs=0.02)


def test_the_yardstick_puts_each_real_set_in_place_of_the_synthetic_one(found):
    assert set(found.yardstick) == {"bright", "fast"}
    assert set(found.yardstick["fast"]) == {"inner", "outer"}
    for fault in ("inner", "outer"):
        first, second = (found.yardstick[name][fault]["centroid"] for name in ("bright", "fast"))
        assert (first, second) == (0.0, 1.0)


def test_classes_are_those_of_the_synthetic_and_of_any_real_set(found):
    assert list(found.auc) == ["healthy", "inner", "outer", "ball"]
    assert "line_width" not in found.auc["healthy"]
    assert "cage_line" in found.auc["ball"]
    assert "fast" not in found.counts["ball"]["kurtosis"]


def test_at_most_so_many_windows_are_taken_evenly_from_all_specimens(tmp_path):
    specimen = np.repeat(np.arange(4), 12)
    folder = write_pulses(tmp_path / "set", classes=("outer",), records=48, specimen=specimen, rig=specimen // 2)
    taken = measured_windows(folder, "set", common_ground([folder], 5000.0, 0.1), 20)
    assert np.bincount(specimen[taken.record]).tolist() == [5, 5, 5, 5]
    assert len({(r, s) for r, s in zip(taken.record.tolist(), taken.start.tolist(), strict=True)}) == 20
    assert set(taken.start.tolist()) <= {0, 1200, 2400, 3600}


def test_no_more_than_a_block_of_signals_is_read_at_once(dark, monkeypatch):
    sizes = []
    whole = windows_module.read_windows

    def counted(corpus, record, start, length):
        sizes.append(len(record))
        return whole(corpus, record, start, length)

    monkeypatch.setattr(windows_module, "read_windows", counted)
    monkeypatch.setattr(windows_module, "BLOCK", 7)
    measured_windows(dark, "dark", common_ground([dark], 5000.0, None), 500)
    assert max(sizes) == 7
    assert sum(sizes) == 48


def test_a_sample_rate_too_low_for_the_band_is_refused(dark, tmp_path):
    slow = write_pulses(tmp_path / "slow", fs=8000.0)
    with pytest.raises(CorpusError, match="at most 4000 Hz"):
        compare(dark, [slow])
    with pytest.raises(CorpusError, match="given twice"):
        compare(dark, [slow, slow])
    assert compare(dark, [slow], top=4000.0).common.rate == 8000.0
    assert compare(dark, [slow], top=3000.0).auc["outer"]["energy_above_3500_hz"] is None


def test_records_without_a_signal_or_a_shaft_rate_are_left_out(tmp_path, dark):
    rates = np.full(14, 28.0)
    rates[0] = 0.0
    folder = write_pulses(tmp_path / "set", classes=("outer",), records=14, shaft_rate=rates, silent=(3, 5))
    assert compare(dark, [folder]).counts["outer"]["kurtosis"]["set"] == 11
