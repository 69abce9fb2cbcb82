"""A command of the shell that fails ends the build; IPython itself would go on."""

import subprocess

from IPython import get_ipython


def system(command: str) -> None:
    """Run a command, print its output, and raise if it fails."""
    text = get_ipython().var_expand(command, depth=1)
    done = subprocess.run(text, shell=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)  # noqa: S602
    print(done.stdout, end="")  # noqa: T201
    done.check_returncode()


get_ipython().system = system
