"""Plug-ins: what other distributions add to Raceway by entry points.

The names of a group are known before anything of a plug-in is imported; its object is loaded when it is first used. Groups are
``raceway.mechanisms``, ``raceway.classes``, ``raceway.features``, ``raceway.importers`` and ``raceway.commands``. An error in the code of a
plug-in goes on to the command line, which names the plug-in (`error_of_plugin`).
"""

import functools
import traceback
from collections.abc import Container, Iterable, Mapping
from importlib.metadata import Distribution, EntryPoint, entry_points
from typing import Any

from gen.support.errors import RacewayError

GROUPS = ("mechanisms", "classes", "features", "importers", "commands")


@functools.cache
def plugins(group: str) -> Mapping[str, EntryPoint]:
    """Entry points of a group by their names, in the order of these.

    Raises
    ------
    RacewayError
        If two distributions have one name.
    """
    entries: dict[str, EntryPoint] = {}
    for entry in sorted(entry_points(group=f"raceway.{group}"), key=lambda entry: entry.name):
        if (other := entries.setdefault(entry.name, entry)) is not entry:
            raise RacewayError(
                f"{distribution(entry)}: its {entry.name} in raceway.{group} is also in {distribution(other)}; uninstall one of them."
            )
    return entries


@functools.cache
def plugin(group: str, name: str, of_type: type) -> Any:
    """Object of an entry point, of a type that its group asks for.

    Raises
    ------
    RacewayError
        If it cannot be loaded, or is of another type.
    """
    entry = plugins(group)[name]
    try:
        loaded = entry.load()
        reason = "" if isinstance(loaded, of_type) else f"it is no {of_type.__name__}"
    except Exception as error:  # noqa: BLE001 - code of other people
        loaded, reason = None, f"{type(error).__name__}: {error}"
    if reason:
        raise unusable(group, name, reason)
    return loaded


def unusable(group: str, name: str, reason: str) -> RacewayError:
    """Error about an object of a plug-in that breaks a rule of its group."""
    return RacewayError(
        f"{distribution(plugins(group)[name])}: its {name} in raceway.{group} cannot be used ({reason}); install another version, or "
        "uninstall it."
    )


def error_of_plugin(error: BaseException) -> RacewayError | None:
    """Error that names the plug-in, and the last line of its code, that another error came through; None if it came through none.

    A plug-in is called in many places, and its line tells more than the place. The frames of a worker process are among those of the error.
    """
    entries = [entry for group in GROUPS for entry in entry_points(group=f"raceway.{group}")]
    packages = {entry.module.partition(".")[0]: entry for entry in entries}
    named = None
    for frame, line in traceback.walk_tb(error.__traceback__):
        entry = packages.get(frame.f_globals.get("__name__", "").partition(".")[0])
        if entry is not None:
            place = f"{frame.f_code.co_filename.rpartition('/')[2]}, line {line}"
            named = RacewayError(
                f"{distribution(entry)}: {place}, in {frame.f_code.co_name}(): {type(error).__name__}: {error}; correct the plug-in, or "
                "uninstall it."
            )
    return named


def plugin_versions(group: str, names: Container[str]) -> dict[str, str]:
    """Versions of the distributions with some of the names of a group."""
    chosen = (entry.dist for name, entry in plugins(group).items() if name in names)
    return {dist.name: dist.version for dist in chosen if dist is not None}


def missing_distributions(versions: Iterable[str]) -> list[str]:
    """Those of the distributions that are not installed."""
    return [name for name in versions if not any(Distribution.discover(name=name))]


def distribution(entry: EntryPoint) -> str:
    """Name and version of the distribution of an entry point."""
    return "a plug-in" if entry.dist is None else f"{entry.dist.name} {entry.dist.version}"
