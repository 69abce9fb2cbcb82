"""``python -m raceway``: the same as the command ``raceway``."""

from raceway.cli import main

if __name__ == "__main__":
    main()
