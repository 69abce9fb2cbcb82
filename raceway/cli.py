"""The group of all commands, and the entry point ``raceway``."""

import logging
import os
import resource
import sys
from collections.abc import Mapping, Sequence
from typing import Any, NoReturn

import click

from raceway.commands import (
    benchmark_commands,
    corpus_commands,
    doctor_command,
    feature_commands,
    model_commands,
    plot_commands,
)
from raceway.comparing import compare_command
from raceway.console.ending import BAD_INPUT, NoReader, exit_code
from raceway.console.interruption import listen_for_signals
from raceway.console.plugin_commands import PluginGroup, keep_examples
from raceway.diagnosis import diagnose_command
from raceway.imitating import imitate_command
from raceway.importing import import_commands
from raceway.lives import lives_commands
from raceway.reports import explore_command
from raceway.sharing import card_command, copy_command
from raceway.visibility import limit_command

GROUPS: Mapping[str, tuple[click.Command, ...]] = {
    "Make corpora": (
        corpus_commands.recipes,
        corpus_commands.plan,
        corpus_commands.generate,
        imitate_command.imitate,
        import_commands.import_,
        copy_command.copy,
        card_command.card,
    ),
    "Look at them": (
        corpus_commands.info,
        corpus_commands.validate,
        corpus_commands.replay,
        plot_commands.plot,
        explore_command.explore,
        lives_commands.life,
        limit_command.limit,
        compare_command.compare,
    ),
    "Learn from them": (
        feature_commands.features,
        model_commands.train,
        model_commands.evaluate,
        benchmark_commands.benchmark,
        lives_commands.prognose,
        diagnose_command.diagnose,
    ),
    "Raceway itself": (doctor_command.doctor,),
}
"""Commands in the order of the work."""

LEAST_MEMORY = (
    1_000_000_000  # bytes that may be addressed; with less, a library that is loaded tries without end to get more
)
ROAD = """\
  raceway generate quickstart -o corpus              make labelled records
  raceway plot corpus --record 7 -o record.png       look at one of them
  raceway features corpus -o features.nc             compute features
  raceway train corpus -o model.skops                train a classifier
  raceway benchmark corpus -o report                 score classifiers without leakage
  raceway diagnose my.csv --bearing 6205 --rpm 1772  say what is wrong with a recording of your own
"""


def _of_plugin(name: str) -> click.Command:
    from gen.support.plugins import plugin  # not at the top: help needs nothing of gen

    return plugin("commands", name, click.Command)


class Raceway(PluginGroup):
    """The group of all commands; :mod:`raceway.console.ending` gives the exit code."""

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the commands in their groups."""
        added = tuple(filter(None, (self.get_command(ctx, name) for name in self.added())))
        groups = {**GROUPS, "Plug-ins": added} if added else GROUPS
        widest = max(len(command.name or "") for commands in groups.values() for command in commands)
        for title, commands in groups.items():
            with formatter.section(title):
                limit = formatter.width - 6 - widest
                formatter.write_dl(
                    [((command.name or "").ljust(widest), command.get_short_help_str(limit)) for command in commands]
                )

    def main(self, args: Sequence[str] | None = None, prog_name: str | None = None, **extra: Any) -> NoReturn:  # type: ignore[override]
        """Run a command line and exit."""
        extra["standalone_mode"] = False
        sys.exit(exit_code(lambda: super(Raceway, self).main(args, prog_name, **extra)))

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command; click alone would exit with 1 when standard output is closed."""
        try:
            result = super().invoke(ctx)
            if sys.stdout is not None:  # a parent can close it
                sys.stdout.flush()
        except BrokenPipeError:
            raise NoReader("") from None
        return result


@click.group(
    cls=Raceway,
    plugins="raceway.commands",
    make=_of_plugin,
    invoke_without_command=True,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(package_name="raceway", message="%(package)s %(version)s")
@click.option(
    "--limit",
    "limits",
    multiple=True,
    metavar="NAME=NUMBER",
    help="Raise a limit on the contents of files, by the name in its error.",
)
@click.option("--quiet", is_flag=True, help="Print no progress and no notices, only results, warnings and errors.")
@click.pass_context
def cli(ctx: click.Context, limits: tuple[str, ...], quiet: bool) -> None:  # noqa: ARG001 - read where notices are printed
    """Make labelled vibration corpora of healthy and damaged rolling bearings, and score classifiers on them.

    raceway without a command shows the first steps.

    RECIPE is a YAML file or the name of a recipe that ships with Raceway (raceway recipes). DIR is a corpus: a folder,
    or one .nc file. With --json a command prints JSON on standard output; progress and errors go to standard error.

    Exit codes:

      0 done   1 checked and found wanting   2 bad usage or input
      70 an error of Raceway itself   130 interrupted

    Completion of commands, options and recipes:

      eval "$(_RACEWAY_COMPLETE=bash_source raceway)"     in ~/.bashrc
      eval "$(_RACEWAY_COMPLETE=zsh_source raceway)"      in ~/.zshrc
      _RACEWAY_COMPLETE=fish_source raceway | source      in config.fish
    """
    if limits:
        from gen.support.limits import VARIABLE, parse_limits

        parse_limits(",".join(limits))
        os.environ[VARIABLE] = ",".join(filter(None, (os.environ.get(VARIABLE), *limits)))  # workers inherit it
    if ctx.invoked_subcommand is None:
        click.echo(f"{ROAD}\nEach command has examples: raceway generate --help. All commands: raceway --help.")


for commands in GROUPS.values():
    for command in commands:
        cli.add_command(command)
keep_examples(cli)


def main() -> NoReturn:
    """Run the command line of this process."""
    os.environ.setdefault("DASK_LOGGING__DISTRIBUTED", "critical")  # its errors come as exceptions too
    logging.getLogger("distributed.client").disabled = True
    os.environ["MPLBACKEND"] = (
        "agg"  # a notebook names a backend that this process may not have, and no command needs a window
    )
    memory, _ = resource.getrlimit(resource.RLIMIT_AS)
    if memory != resource.RLIM_INFINITY and memory < LEAST_MEMORY:
        sys.stderr.write(
            f"memory: the limit of this shell is {memory / 1e6:,.0f} MB; raise it with ulimit -v 2000000.\n"
        )
        sys.exit(BAD_INPUT)
    listen_for_signals()
    cli.main(prog_name="raceway")
