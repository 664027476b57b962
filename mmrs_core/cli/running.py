"""Runs one command line from arguments to exit code."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import typer

from mmrs_core.cli.app import app_of
from mmrs_core.cli.as_typed import take_as_typed
from mmrs_core.cli.failures import MODEL_INVALID, ended_by
from mmrs_core.cli.interruption import INTERRUPTED, interrupted
from mmrs_core.cli.output import tell
from mmrs_core.cli.parameters import spread
from mmrs_core.cli.settings import taken_from


def run_command(arguments: Sequence[str], program: str) -> int:
    """Run ``mmrs`` or ``mmrs-gen``; return the exit code, whatever happens."""
    settings, rest = taken_from(arguments)
    try:
        name, app, rest = app_of(program, rest, settings)
        command = typer.main.get_command(app)
        line = spread(rest, frozenset(flags_of(command)))
        take_as_typed(command, line)
        result = command.main(line, prog_name=name, standalone_mode=False, obj=settings)
        return result if isinstance(result, int) else 0
    except typer.Exit as ending:
        return ending.exit_code
    except (typer.Abort, KeyboardInterrupt):
        return _interrupted()
    except SystemExit as ending:
        return ending.code if isinstance(ending.code, int) else MODEL_INVALID
    except Exception as error:
        return _interrupted() if interrupted() else _ended_by(error, arguments)


def flags_of(command: object) -> Iterator[str]:
    """Yield the options of a command of typer's, and of the commands in it, that take no value."""
    for parameter in getattr(command, "params", ()):
        if getattr(parameter, "is_flag", False):
            yield from parameter.opts
    yield "--help"
    for inner in getattr(command, "commands", {}).values():
        yield from flags_of(inner)


def _interrupted() -> int:
    tell("mmrs: interrupted")
    return INTERRUPTED


def _ended_by(error: Exception, arguments: Sequence[str]) -> int:
    try:
        return ended_by(error, taken_from(arguments)[0])
    except typer.Exit as ending:
        return ending.exit_code
