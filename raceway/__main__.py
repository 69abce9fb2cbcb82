"""``python -m raceway``: the same as the command ``raceway``."""

import sys
from importlib.util import find_spec


def hidden_package() -> str | None:
    """File of the present folder that Python would import in place of a package of Raceway."""
    for name in ("gen", "features"):
        spec = find_spec(name)
        if spec is not None and spec.submodule_search_locations is None:
            return spec.origin
    return None


if __name__ == "__main__":
    if (hiding := hidden_package()) is not None:
        sys.stderr.write(f"{hiding}: hides a package of Raceway; run the command raceway, or rename the file.\n")
        sys.exit(2)
    from raceway.cli import main

    main()
