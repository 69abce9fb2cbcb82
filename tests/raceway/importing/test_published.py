"""Published sets on small made-up files in the layout of their descriptions: files, classes, units, rates, speeds and lives."""

import numpy as np
import pytest
import scipy.io

from gen.corpus import FAULTS, open_corpus, validate_corpus
from gen.support.errors import CorpusError
from raceway.importing import import_set
from raceway.importing.label_keys import Labels
from raceway.importing.published import UNTRIED, published_sets

G = 9.80665
SIGNAL = np.random.default_rng(7).normal(size=33_000)


def mat(path, **variables):
    scipy.io.savemat(path, variables)


def text(path, *columns, header=""):
    np.savetxt(
        path, np.stack(columns, axis=-1), fmt="%.6f", delimiter="\t" if not header else ",", header=header, comments=""
    )


def paderborn(path):
    """Seven signals, each with its name and data; the last is the vibration."""
    empty = {"Name": "force", "Data": np.zeros(10)}
    mat(
        path,
        **{path.stem: {"X": [], "Y": np.array([*[empty] * 6, {"Name": "vibration_1", "Data": SIGNAL}], dtype=object)}},
    )


def ims(path):
    text(
        path,
        *[SIGNAL[:20_480] * factor for factor in ((1, 0, 2, 0, 3, 0, 4, 0) if "1st" in str(path) else (1, 2, 3, 4))],
    )


def xjtu(path):
    header = "Horizontal_vibration_signals,Vertical_vibration_signals"
    text(path, SIGNAL[:32_768], -SIGNAL[:32_768], header=header)


def ottawa(path):
    mat(path, x=np.stack([SIGNAL, SIGNAL, 0 * SIGNAL, 0 * SIGNAL, SIGNAL], axis=-1))


# of each set files with the class, specimen, speed [rpm] and load [N] that their rows tell
UNIT = {"unit": "g"}
SETS = {
    "cwru_48k": ({"97.mat": ("healthy", 0, 1797, None), "48k_IR007_1_110.mat": ("inner", 1, 1772, None),
                  "217.mat": ("inner", 3, 1730, None), "204@6_3.mat": ("outer", 10, 1730, None)},
                 lambda path: mat(path, **{f"X{number(path):03d}_DE_time": np.tile(SIGNAL, 7)}), {}),
    "cwru_fan_end": ({"278_0.mat": ("inner", 1, 1797, None), "309_1.mat": ("outer", 11, 1772, None),
                      "318_3.mat": ("outer", 13, 1730, None)},
                     lambda path: mat(path, **{f"X{number(path):03d}_FE_time": SIGNAL}), {}),
    "paderborn": ({"K001/N15_M07_F10_K001_1.mat": ("healthy", 0, 1500, 1000), "KA04/N09_M07_F10_KA04_20.mat": ("outer", 1, 900, 1000),
                   "KB27/N15_M01_F10_KB27_2.mat": ("compound", 2, 1500, 1000), "KI21/N15_M07_F04_KI21_3.mat": ("inner", 3, 1500, 400)},
                  paderborn, UNIT),
    "ottawa": ({"1_Healthy/H_12_0.mat": ("healthy", 12, 1750, None), "2_Inner/I_1_2.mat": ("inner", 1, 1750, 400),
                "4_Ball/B_12_1.mat": ("ball", 12, 1750, 0), "5_Cage/C_16_1.mat": ("cage", 16, 1750, 400)}, ottawa, UNIT),
    "xjtu": ({"35Hz12kN/Bearing1_1/1.csv": ("unknown", 0, 2100, 12_000), "40Hz10kN/Bearing3_5/12.csv": ("unknown", 1, 2400, 10_000)},
             xjtu, {}),
    "ims": ({"1st_test/2003.10.22.12.06.24": ("unknown", 0, 2000, None), "2nd_test/2004.02.12.10.32.39": ("unknown", 4, 2000, None)},
            ims, UNIT),
}  # fmt: skip


def number(path):
    return int(
        next(part for part in path.stem.replace("@", "_").split("_")[::-1] if len(part) > 1 and part.isdecimal())
    )


def imported(name, folder, **options):
    done = import_set(name, folder / "set", folder / "corpus", **options)
    assert validate_corpus(done.path) == []
    with open_corpus(done.path) as corpus:
        return done, corpus.load()


def write(folder, names, writer):
    for name in names:
        path = folder / "set" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        writer(path)


@pytest.mark.parametrize("name", SETS)
def test_files_get_the_labels_of_their_rows_and_the_state_of_the_set_is_told(tmp_path, name):
    files, writer, common = SETS[name]
    write(tmp_path, files, writer)
    done, corpus = imported(name, tmp_path, common=common)
    assert done.skipped == ()
    assert done.warnings[0] == f"{name}: {UNTRIED}."
    labels_of_files = {}
    for row in range(corpus.sizes["record"]):
        labels, load = corpus.isel(record=row), float(corpus["load"][row])
        fault = FAULTS[int(labels.fault)] if labels.fault < len(FAULTS) else "unknown"
        rpm = round(60 * float(labels.shaft_rate))
        file = str(labels.source.values).partition("#")[0].partition(":")[0]
        labels_of_files.setdefault(file, (fault, int(labels.specimen), rpm, None if np.isnan(load) else round(load)))
    assert labels_of_files == files
    assert float(corpus.sample_rate[0]) == {"xjtu": 25_600, "ims": 20_000, "paderborn": 64_000, "ottawa": 42_000}.get(
        name, 48_000 if name == "cwru_48k" else 12_000
    )


def test_healthy_copies_at_another_rate_are_no_recordings_of_48_khz(tmp_path):
    write(tmp_path, ["109.mat"], lambda path: mat(path, X109_DE_time=SIGNAL))
    write(tmp_path, ["98.mat"], lambda path: mat(path, X098_DE_time=SIGNAL))
    write(tmp_path, ["97.mat"], lambda path: mat(path, X097_DE_time=np.tile(SIGNAL, 7)))
    done, corpus = imported("cwru_48k", tmp_path)
    assert {text.partition("#")[0] for text in corpus.source.values.tolist()} == {
        "109.mat:X109_DE_time",
        "97.mat:X097_DE_time",
    }
    assert done.skipped[0].startswith("98.mat:X098_DE_time: is at 12000 Hz and the corpus at 48000 Hz")


def test_a_set_that_states_no_unit_asks_for_it(tmp_path):
    write(tmp_path, ["H_1_0.mat"], ottawa)
    with pytest.raises(CorpusError, match=r"^H_1_0.mat, column unit: is missing; give it with --set\.$"):
        import_set("ottawa", tmp_path / "set", tmp_path / "corpus")


def test_keys_of_the_caller_go_before_those_of_the_set(tmp_path):
    write(tmp_path, ["N_800_1.mat", "N_800_2.mat"], lambda path: mat(path, Data=SIGNAL))
    _, corpus = imported("uestc", tmp_path, common={"shaft_rpm": "812", "sensitivity_mv_per_m_s2": 1000})
    assert float(corpus.shaft_rate[0]) == 812 / 60
    np.testing.assert_array_equal(corpus.acceleration[0, 0], SIGNAL[:10_000].astype(np.float32))
    assert corpus.source.values[-1] == "N_800_1.mat:Data..N_800_2.mat:Data#50000"


def test_lives_of_sets_count_their_files_and_end_as_described(tmp_path):
    write(tmp_path, [f"1st_test/2003.10.22.12.{minute}.24" for minute in (10, 20, 30)], ims)
    write(tmp_path, [f"Bearing1_2/{n}.csv" for n in (1, 2, 11)], xjtu)
    _, corpus = imported("ims", tmp_path, common=UNIT)
    by_bearing = {
        name: corpus.isel(record=corpus.bearing.values == name) for name in set(corpus.bearing.values.tolist())
    }
    assert set(by_bearing) == {f"ZA-2115 1-{n}" for n in (1, 2, 3, 4)}
    assert by_bearing["ZA-2115 1-3"].rul.values.tolist() == [1200, 600, 0]
    assert np.isnan(by_bearing["ZA-2115 1-1"].rul.values).all()
    np.testing.assert_allclose(
        by_bearing["ZA-2115 1-4"].acceleration[0, 0], 4 * G * SIGNAL[:20_480], rtol=1e-4, atol=1e-4
    )
    done = import_set("xjtu", tmp_path / "set", tmp_path / "xjtu")
    with open_corpus(done.path) as lives:
        assert sorted(zip(lives.age.values, lives.rul.values, strict=True)) == [(0, 600), (60, 540), (600, 0)]
        assert lives.acceleration.shape == (3, 2, 32_768)
    assert "Bearing1_2: 8 snapshots are missing, the first is number 3." in done.warnings


@pytest.mark.parametrize("name", published_sets())
def test_every_row_of_every_set_has_keys_of_labels_or_of_its_pattern(name):
    published = published_sets()[name]
    keys = {*published.common, *published.in_turn, *(key for row in published.rows for key in row)}
    groups = {key for key in keys if f"(?P<{key}>" in published.pattern}
    assert keys - groups - {"subset"} <= {*Labels.model_fields}
    assert len(published.help) < 60
    assert published.tried == (name in ("cwru", "mfpt", "uestc", "femto"))
