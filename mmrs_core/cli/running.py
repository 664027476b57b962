"""Runs one command line from arguments to exit code."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import takewhile
from pathlib import Path
from typing import Any

import typer

from mmrs_core.cli.app import program_for
from mmrs_core.cli.failures import MODEL_INVALID, ended_by
from mmrs_core.cli.interruption import INTERRUPTED, interrupted
from mmrs_core.cli.output import tell
from mmrs_core.cli.settings import Settings, taken_from
from mmrs_core.errors import MmrsError, PluginError

_ROBOTS = "--robots"


def run_command(arguments: Sequence[str], program: str) -> int:
    """Run ``mmrs`` or ``mmrs-gen``; return the exit code, whatever happens."""
    settings, rest = taken_from(arguments)
    source = ""
    try:
        called = program_for(program, rest, settings)
        source = called.source
        command = typer.main.get_command(called.app)
        line = spread(rest, frozenset(flags_of(command)))
        take_as_typed(command, line)
        _keep_examples(command)
        result = command.main(line, prog_name=program, standalone_mode=False, obj=settings)
        code = result if isinstance(result, int) else 0
        return _interrupted() if code == INTERRUPTED and interrupted() else code
    except typer.Exit as ending:
        return ending.exit_code
    except (typer.Abort, KeyboardInterrupt):
        return _interrupted()
    except SystemExit as ending:
        return ending.code if isinstance(ending.code, int) else MODEL_INVALID
    except Exception as error:
        return _interrupted() if interrupted() else _ended_by(error, source, settings)


def spread(arguments: Sequence[str], flags: frozenset[str]) -> list[str]:
    """Return the arguments with ``--robots A B`` written as ``--robots A --robots B``.

    Where no plain argument stands before, the last file is the command's own argument.

    Args:
        arguments: of a command, its name left out.
        flags: options that take no value.

    >>> spread(["m.xmi", "--robots", "a", "b", "--json"], frozenset({"--json"}))
    ['m.xmi', '--robots', 'a', '--robots', 'b', '--json']
    >>> spread(["--robots", "a", "m.xmi"], frozenset())
    ['--robots', 'a', 'm.xmi']
    """
    written: list[str] = []
    rest, named = list(arguments), False
    while rest:
        argument = rest.pop(0)
        if argument == _ROBOTS:
            files = list(takewhile(_is_plain, rest))
            del rest[: len(files)]
            own = files.pop() if len(files) > 1 and not named else None
            written += [part for file in files for part in (_ROBOTS, file)] or [_ROBOTS]
            written += [own] if own is not None else []
            named = named or own is not None
            continue
        written.append(argument)
        if not _is_plain(argument) and argument not in flags and "=" not in argument:
            written += rest[:1]
            del rest[:1]
        named = named or _is_plain(argument)
    return written


def _is_plain(argument: str) -> bool:
    return not argument.startswith("-")


def flags_of(command: object) -> Iterator[str]:
    """Yield the options of a command of typer's, and of the commands in it, that take no value."""
    for parameter in getattr(command, "params", ()):
        if getattr(parameter, "is_flag", False):
            yield from parameter.opts
    yield "--help"
    for inner in getattr(command, "commands", {}).values():
        yield from flags_of(inner)


def _keep_examples(command: Any) -> None:
    """Keep each example in a help on one line, however long, so that it can be copied."""
    if command.help:
        command.help = re.sub(r"\n\n(Examples?: )", "\n\n\b\n\\1", command.help)
    for inner in getattr(command, "commands", {}).values():
        _keep_examples(inner)


def _interrupted() -> int:
    tell("mmrs: interrupted")
    return INTERRUPTED


def _ended_by(error: Exception, source: str, settings: Settings) -> int:
    if source and not isinstance(error, MmrsError | OSError | typer.TyperException):
        fault = PluginError(f"{source} fails: {error!r}")
        fault.__cause__, error = error, fault
    try:
        return ended_by(error, settings)
    except typer.Exit as ending:
        return ending.exit_code


_MAKERS: Mapping[object, Callable[[Any], object]] = {str: str, list[str]: str, Path: Path, list[Path]: Path}


class AsTyped:
    """How an argument or option gets its value: texts and paths as they were typed.

    For its own conversion, typer imports pydantic, which takes longer than validating a mission.
    """

    def __init__(self, make: Callable[[Any], object] | None, own: Callable[[], Any]) -> None:
        self._make = make
        self._own = own

    def coerce(self, value: Any, param: Any, ctx: object) -> object:
        """Return the value for the command; typer is asked unless it is a default, a text or a readable path.

        Raises:
            typer.BadParameter: if typer refuses it.
        """
        many = param.multiple or param.nargs == -1
        if value is None:
            return () if many else None
        if value is param.default and not isinstance(value, Path):
            return value
        made = [self._make(each) for each in (value if many else (value,))] if self._make else [None]
        if None in made or any(isinstance(each, Path) and _is_unreadable(each) for each in made):
            return self._own().coerce(value, param=param, ctx=ctx)
        return made if many else made[0]


def _is_unreadable(path: Path) -> bool:
    return os.access(path, os.F_OK) and not os.access(path, os.R_OK)


def take_as_typed(command: Any, line: Sequence[str]) -> None:
    """Let a command, and those in it that a command line names, take values as they were typed."""
    for parameter in command.get_params(typer.Context(command)):
        made = AsTyped(_MAKERS.get(parameter.type_descriptor.annotation), parameter.get_runtime_param)
        parameter.get_runtime_param = lambda made=made: made
        if parameter.param_type_name == "argument":
            parameter.display_type_rich = lambda ctx: None  # its help says more than "<list[Path]>"
    for name, inner in getattr(command, "commands", {}).items():
        if name in line:
            take_as_typed(inner, line)
