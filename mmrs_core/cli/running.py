"""Runs one command line from arguments to exit code."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import takewhile
from typing import Any

import typer

from mmrs_core.cli.app import program_for
from mmrs_core.cli.as_typed import take_as_typed
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
        return result if isinstance(result, int) else 0
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
