"""Groups of commands to which plug-ins add theirs by entry points."""

import inspect
import re
from collections.abc import Callable
from importlib.metadata import entry_points
from typing import Any, NoReturn

import click


class PluginGroup(click.Group):
    """Commands that are built in, and those that ``make`` gives for the names of a group of entry points.

    Nothing of a plug-in is loaded before its command is called or listed, and a built-in command keeps its name.
    """

    def __init__(self, *args: Any, plugins: str, make: Callable[[str], click.Command], **keys: Any) -> None:
        super().__init__(*args, **keys)
        self.plugins, self.make = plugins, make

    def added(self) -> list[str]:
        """Names of the commands of plug-ins."""
        return sorted({entry.name for entry in entry_points(group=self.plugins)} - self.commands.keys())

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names of all commands."""
        return [*super().list_commands(ctx), *self.added()]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Command with a name; None if there is none. One that cannot be loaded has the reason as its help, and fails with it."""
        if cmd_name not in self.added():
            return super().get_command(ctx, cmd_name)
        try:
            command = self.make(cmd_name)
        except Exception as error:  # noqa: BLE001 - the other commands work
            command = _failing(cmd_name, error)
        keep_examples(command)
        return command


def _failing(name: str, error: Exception) -> click.Command:
    def fail() -> NoReturn:
        raise error

    return click.Command(name, callback=fail, help=str(error))


def keep_examples(command: click.Command) -> None:
    """Keep the line breaks of indented paragraphs of the help; click would remove them."""
    command.help = re.sub(r"\n\n(?= )", "\n\n\b\n", inspect.cleandoc(command.help or ""))
    for inner in getattr(command, "commands", {}).values():
        keep_examples(inner)
