"""The versions of an installation, and advice where one is missing or too old."""

from importlib.metadata import PackageNotFoundError

from raceway.commands import doctor_command


def test_the_machine_of_the_tests_has_all_that_is_needed(told, run):
    facts = told("doctor")
    assert facts["problems"] == 0
    assert {"Python", "raceway", "numba", "pyarrow"} <= {one["subject"] for one in facts["findings"]}
    assert all(one["state"] == "fine" and one["advice"] == "" for one in facts["findings"])
    assert run("doctor").stdout.endswith("\nEverything that Raceway needs is installed.\n")


def test_a_library_that_is_missing_or_too_old_is_a_problem_with_its_remedy(run, monkeypatch):
    def found(name):
        if name in ("dask", "pyarrow"):
            raise PackageNotFoundError
        return {"xarray": "2020.1"}.get(name, "9999")

    monkeypatch.setattr(doctor_command, "version", found)
    shown = run("doctor")
    assert shown.exit_code == 1
    lines = [line for line in shown.stdout.splitlines() if line and not line.startswith("fine")]
    starts = (
        "problem  xarray: 2020.1; pip install 'xarray>=",
        "problem  dask: missing; pip install 'dask>=",
        "note     pyarrow: missing; pip install 'pyarrow>=",
        "2 problems.",
    )
    assert [line.startswith(start) for line, start in zip(lines, starts, strict=True)] == [True] * len(starts)
