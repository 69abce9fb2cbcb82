"""The facts of a machine, and their advice."""

import json
import re
from importlib.metadata import PackageNotFoundError

import pytest
from click.testing import CliRunner

from raceway.cli import cli
from raceway.studies import doctor
from tests.paths import ROOT


@pytest.fixture
def idle(monkeypatch):
    monkeypatch.setattr(doctor, "_speed", lambda: doctor.Finding("speed of the kernel", "not measured"))


@pytest.mark.usefixtures("idle")
def test_the_machine_of_the_tests_has_all_that_is_needed():
    made = CliRunner().invoke(cli, ["doctor", "--json"], standalone_mode=False)
    facts = json.loads(made.stdout)
    assert facts["problems"] == 0
    assert {"Python", "numba", "cores", "compiled kernels", "codec zstd", "reader ncdump", "speed of the kernel"} <= {
        one["subject"] for one in facts["findings"]
    }
    assert all((one["state"] == "fine") == (one["advice"] == "") for one in facts["findings"])


def test_a_library_that_is_missing_or_too_old_is_a_problem_with_its_remedy(monkeypatch):
    def found(name):
        if name == "skops":
            raise PackageNotFoundError
        return {"xarray": "2020.1"}.get(name, "9999")

    monkeypatch.setattr(doctor, "version", found)
    problems = {one.subject: one for one in doctor._requirements() if one.state == "problem"}
    assert problems["skops"].advice.startswith("pip install 'skops>=")
    assert re.fullmatch(r"Raceway needs (xarray>=[\d.]+): pip install '\1'\.", problems["xarray"].advice)


def test_a_slow_machine_is_told_so_and_an_unknown_one_gets_no_verdict(monkeypatch):
    monkeypatch.setattr("gen.simulation.kernels.is_compiled", lambda _: True)
    monkeypatch.setattr(
        "raceway.studies.timing.bench", lambda *_: type("Bench", (), {"kernel_record_steps_per_second": 1e6})
    )
    for published, state in (
        ({doctor.processor_key(): 1.1e6}, "fine"),
        ({doctor.processor_key(): 2e6}, "note"),
        ({}, "fine"),
    ):
        monkeypatch.setattr(doctor, "PUBLISHED", published)
        assert doctor._speed().state == state
    assert "no figure is published" in doctor._speed().value


def test_the_pages_publish_the_speed_that_doctor_compares_with():
    (published,) = doctor.PUBLISHED.values()
    for page in ("README.md", "docs/running.md"):
        assert f"{published / 1e6:.0f} million record-steps/s" in " ".join((ROOT / page).read_text().split())
