"""Commands of ``raceway`` by the words that call them, those of groups too."""

from collections.abc import Iterator

import click

from raceway.cli import cli


def commands(group: click.Group = cli, *before: str) -> Iterator[tuple[tuple[str, ...], click.Command]]:
    """Words and command of every command and of every group, such as ``("import", "cwru")``."""
    context = click.Context(group)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None
        yield (*before, name), command
        if isinstance(command, click.Group):
            yield from commands(command, *before, name)


COMMANDS = {words: command for words, command in commands() if not isinstance(command, click.Group)}
