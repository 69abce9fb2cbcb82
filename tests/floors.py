"""The lowest version of every runtime dependency, as pyproject.toml states it: ``python -m tests.floors``.

``make floors`` gives these lines to pip as constraints. Packages that the dependencies need in turn are not
constrained: pip chooses the newest ones that fit.
"""

import re
import sys
import tomllib

from tests.paths import ROOT

REQUIREMENT = re.compile(r"(?P<name>[\w.-]+)(?:\[[\w,-]+\])?>=(?P<floor>[\d.]+)(?:,(?:!=|<)[\d.]+)*")


def floors() -> dict[str, str]:
    """Lowest version of each runtime dependency, those of the extra ``parquet`` included, by name."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    found = {}
    for requirement in project["dependencies"] + project["optional-dependencies"]["parquet"]:
        parts = REQUIREMENT.fullmatch(requirement)
        if parts is None:
            message = f"pyproject.toml: {requirement!r} states no floor; write NAME>=VERSION."
            raise ValueError(message)
        found[parts["name"]] = parts["floor"]
    return found


if __name__ == "__main__":
    sys.stdout.writelines(f"{name}=={floor}\n" for name, floor in floors().items())
