"""End of a command: an exit code, and one sentence on standard error if it failed.

0 done; 1 checked and found wanting; 2 bad usage or input; 70 an error of Raceway itself; 130 interrupted; 141 standard output closed.
"""

import os
import re
import sys
import traceback
from collections.abc import Callable
from typing import Any

import click

from raceway.console.interruption import INTERRUPTED, leave_if_interrupted

OWN = ("gen", "features", "raceway")
DONE, FOUND_WANTING, BAD_INPUT, INTERNAL_ERROR, NO_READER = 0, 1, 2, 70, 141


class NoReader(click.ClickException):
    """The reader of standard output has closed it."""

    exit_code = NO_READER


def exit_code(call: Callable[[], Any]) -> int:
    """Run a command, print one sentence on standard error if it fails, and return its exit code."""
    try:
        return int(call() or DONE)
    except NoReader:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # the last flush of Python must not fail
        return NO_READER
    except (Exception, KeyboardInterrupt) as error:  # noqa: BLE001 - the outermost call: no traceback may pass
        leave_if_interrupted()
        if os.environ.get("RACEWAY_TRACEBACK"):
            traceback.print_exc()
        code, sentence = _verdict(error)
        click.echo(printable(sentence), err=True)
        return code


def _verdict(error: BaseException) -> tuple[int, str]:
    match error:
        case click.Abort() | KeyboardInterrupt():
            return INTERRUPTED, "interrupted."
        case click.exceptions.NoArgsIsHelpError():
            return BAD_INPUT, error.format_message()
        case click.NoSuchOption(option_name=option, ctx=click.Context() as ctx) if option in _of_all_commands(ctx):
            rest = ctx.command_path.removeprefix("raceway ")
            return BAD_INPUT, f"{ctx.command_path}: {option} is for all commands; put it between raceway and {rest}."
        case click.UsageError(ctx=click.Context(params={"model": None}) as ctx) if (
            "extra argument" in error.message and ".skops" in f"{error.message} {[*ctx.params.values()]}"
        ):
            return BAD_INPUT, f"{ctx.command_path}: a model is no argument; give it with --model FILE.skops."
        case click.UsageError():
            command = error.ctx.command_path if error.ctx else "raceway"
            return BAD_INPUT, f"{command}: {_in_plain_words(error.format_message().rstrip('.'))}; see {command} --help."
        case click.ClickException():
            return error.exit_code, error.format_message()
        case _ if _is_foreseen(error):
            return BAD_INPUT, _with_options(str(error))
        case _ if type(error).__name__ == "KilledWorker":
            return BAD_INPUT, "several workers of the cluster died; use fewer workers, or fewer records per part."
        case MemoryError():
            return (
                BAD_INPUT,
                f"this needs more memory than there is ({error}); take a smaller file, or fewer records at a time.",
            )
        case OSError(strerror=str() as reason):
            where = f"{error.filename}: " if error.filename else ""
            return BAD_INPUT, f"{where}{reason}; choose another place, or correct that one."
        case OSError() | RuntimeError() if "NetCDF" in str(error) or "HDF" in str(error):
            return BAD_INPUT, f"a file of the corpus cannot be read ({error}); raceway validate DIR names it."
        case ModuleNotFoundError(name=str() as name) if name.partition(".")[0] not in OWN:
            package = name.partition(".")[0]
            return (
                BAD_INPUT,
                f"this needs the Python module {package}, which is not installed; install the package that has it.",
            )
        case _ if (of_plugin := _error_of_plugin(error)) is not None:
            return BAD_INPUT, str(of_plugin)
        case _:
            what = f"{type(error).__name__}: {error}"
            return INTERNAL_ERROR, f"internal error ({what}); please report it with the output of RACEWAY_TRACEBACK=1."


def _in_plain_words(message: str) -> str:
    """Message of click, which calls a number by the type of its option.

    >>> _in_plain_words("'12 kHz' is not a valid float range"), _in_plain_words("'2.5' is not a valid integer range")
    ("'12 kHz' is no number; give it without a unit", "'2.5' is no whole number")
    """
    message = re.sub("is not a valid float( range)?", "is no number; give it without a unit", message)
    return re.sub("is not a valid integer( range)?", "is no whole number", message)


def _with_options(sentence: str) -> str:
    """Sentence about a choice from a corpus, with options in place of parameters.

    >>> _with_options("corpus: channels: there is no channel 'x'; ..."), _with_options("where: there is no column x; ...")
    ("corpus: --channels: there is no channel 'x'; ...", '--where: there is no column x; ...')
    """
    sentence = re.sub("(^|: )(where|to|channels(?=: there is no)): ", r"\1--\2: ", sentence)
    return re.sub("^rename: ", "--rename-channel: ", sentence)


def _of_all_commands(context: click.Context) -> list[str]:
    """Options that stand between ``raceway`` and a command."""
    return [name for option in context.find_root().command.params for name in option.opts]


def _is_foreseen(error: BaseException) -> bool:
    """Whether ``gen`` or ``features`` raised the error on purpose; their errors exist only if ``gen.support.errors`` is loaded."""
    errors = sys.modules.get("gen.support.errors")
    return errors is not None and isinstance(error, errors.RacewayError)


def _error_of_plugin(error: BaseException) -> Exception | None:
    from gen.support.plugins import error_of_plugin  # not at the top: help needs nothing of gen

    return error_of_plugin(error)


def printable(text: str) -> str:
    r"""Text without control characters: names and titles in files of others could control the terminal.

    >>> printable("ball\x1b[2J of a\nrig")
    'ball?[2J of a\nrig'
    """
    return "".join(letter if letter.isprintable() or letter == "\n" else "?" for letter in text)
