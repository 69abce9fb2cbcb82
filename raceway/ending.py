"""How a command ends: an exit code, and for people a sentence on stderr.

0 done; 1 checked and found wanting; 2 bad usage or input; 70 an error of Raceway itself; 130 interrupted; 141 nobody reads the output.
"""

import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable
from multiprocessing import resource_tracker
from types import FrameType
from typing import Any

import click

DONE, FOUND_WANTING, BAD_INPUT, INTERNAL_ERROR, INTERRUPTED, NO_READER = 0, 1, 2, 70, 130, 141


class Interrupted(click.ClickException):
    """Ctrl-C or SIGTERM; the message says what is kept and how to go on."""

    exit_code = INTERRUPTED


class NoReader(click.ClickException):
    """Standard output was closed by whoever read it."""

    exit_code = NO_READER


def exit_code(call: Callable[[], Any]) -> int:
    """Run a command, say what went wrong on stderr, and return its exit code."""
    try:
        return int(call() or DONE)
    except NoReader:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # what is left to flush goes nowhere
        return NO_READER
    except Exception as error:  # noqa: BLE001 - the outermost call: nothing may pass as a traceback
        if os.environ.get("RACEWAY_TRACEBACK"):
            traceback.print_exc()
        code, sentence = _verdict(error)
        click.echo(printable(sentence), err=True)
        return code


def _verdict(error: Exception) -> tuple[int, str]:
    if interrupted():
        return INTERRUPTED, str(error) if isinstance(error, Interrupted) else "interrupted."
    match error:
        case click.exceptions.NoArgsIsHelpError():
            return BAD_INPUT, error.format_message()
        case click.UsageError():
            command = error.ctx.command_path if error.ctx else "raceway"
            return BAD_INPUT, f"{command}: {error.format_message().rstrip('.')}; see {command} --help."
        case click.ClickException():
            return error.exit_code, error.format_message()
        case _ if _is_foreseen(error):
            return BAD_INPUT, str(error)
        case OSError(strerror=str() as reason):
            where = f"{error.filename}: " if error.filename else ""
            return BAD_INPUT, f"{where}{reason}; choose another place, or set it right there."
        case OSError() | RuntimeError() if "NetCDF" in str(error) or "HDF" in str(error):
            return BAD_INPUT, f"a file of the corpus cannot be read ({error}); raceway validate says which."
        case _:
            what = f"{type(error).__name__}: {error}"
            return INTERNAL_ERROR, f"internal error ({what}); please report it with what RACEWAY_TRACEBACK=1 shows."


def _is_foreseen(error: Exception) -> bool:
    """Whether ``gen`` or ``features`` made the sentence; they are not imported to find out, since that takes seconds."""
    errors = sys.modules.get("gen.errors")
    return errors is not None and isinstance(error, errors.RacewayError)


def printable(text: str) -> str:
    r"""Text without what could steer a terminal: names and titles come from strangers.

    >>> printable("ball\x1b[2J of a\nrig")
    'ball?[2J of a\nrig'
    """
    return "".join(letter if letter.isprintable() or letter == "\n" else "?" for letter in text)


def listen_for_signals() -> None:
    """Let Ctrl-C and SIGTERM raise KeyboardInterrupt in this process alone; the second ends it at once.

    A terminal sends Ctrl-C to the workers of a dask cluster too, and each would show a traceback. Here SIGINT is blocked, which every
    process and thread started later inherits, and one thread waits for it and wakes the main thread by SIGUSR1.
    """
    # first, because the tracker unblocks SIGINT in the thread that starts it
    resource_tracker.ensure_running()
    _on_signals(_interrupt)
    if (
        signal.getsignal(signal.SIGINT) is signal.default_int_handler
    ):  # not in the background of a script, where Ctrl-C is ignored
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        threading.Thread(target=_pass_on, daemon=True).start()


def _pass_on() -> None:
    while True:
        signal.sigwait({signal.SIGINT})
        signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGUSR1)


def _on_signals(handler: Callable[[int, FrameType | None], None]) -> None:
    signal.signal(signal.SIGUSR1, handler)
    signal.signal(signal.SIGTERM, handler)


def interrupted() -> bool:
    """Whether a signal has come; then whatever else goes wrong is its doing."""
    return signal.getsignal(signal.SIGUSR1) is _leave


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    _on_signals(_leave)
    raise KeyboardInterrupt


def _leave(_number: int, _frame: FrameType | None) -> None:
    show_cursor = "\x1b[?25h" if sys.stderr.isatty() else ""
    os.write(2, f"{show_cursor}interrupted.\n".encode())
    os._exit(INTERRUPTED)
