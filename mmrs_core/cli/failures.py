"""Turns whatever ends a command into what the user reads and what the shell gets."""

from __future__ import annotations

import traceback
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import typer

from mmrs_core.cli.output import one_line, report, say_json, tell
from mmrs_core.cli.settings import DEBUG, NO_PLUGINS, Settings
from mmrs_core.cli.verdict_words import verdict_line
from mmrs_core.errors import (
    InfeasibleError,
    InternalError,
    InvalidModelError,
    MmrsError,
    PluginError,
    UnreadableError,
    UnsupportedError,
)
from mmrs_core.languages.codes import refusal

if TYPE_CHECKING:
    from mmrs_core.contributions.checks import Verdict
    from mmrs_core.diagnostics import Diagnostic

MODEL_INVALID = 1
UNREADABLE = 3

_WITHOUT_PLUGINS = f"{DEBUG} prints the traceback; {NO_PLUGINS} runs without plug-ins"
_HELP = "Usage: "
"""How the message begins when a command is called without arguments: with its help."""


class RefusedError(MmrsError):
    """A behaviour that is unsafe, or not known to be safe.

    Attributes:
        verdicts: the violated or unknown properties, at least one.
    """

    def __init__(self, message: str, verdicts: Sequence[Verdict]) -> None:
        super().__init__(message)
        self.verdicts = tuple(verdicts)


@dataclass(frozen=True, slots=True)
class Failure:
    """Why a command ended.

    Attributes:
        message: one line, the culprit first.
        details: further lines, each a reason of its own.
        diagnostics: faults of the user's models.
    """

    exit_code: int
    message: str
    details: tuple[str, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()


def ended_by(error: Exception, settings: Settings) -> int:
    """Print what an error means for the user; return the exit code."""
    if settings.debug:
        for line in "".join(traceback.format_exception(error)).splitlines():
            tell(line)
    failure = failure_of(error)
    report(failure.diagnostics)
    usage = failure.message.startswith(_HELP)
    for line in failure.message.splitlines() if usage else [f"mmrs: {one_line(failure.message)}"]:
        tell(line)
    for detail in failure.details:
        tell(f"  - {one_line(detail)}")
    if settings.json:
        say_json({**error.found, "error": failure} if isinstance(error, MmrsError) else {"error": failure})
    return failure.exit_code


def failure_of(error: Exception) -> Failure:
    """Return what an error means for the user."""
    match error:
        case InvalidModelError():
            return Failure(error.exit_code, str(error), (), error.diagnostics)
        case InfeasibleError():
            if len(error.reasons) == 1 and error.reasons[0] in str(error):
                return Failure(error.exit_code, str(error))
            return Failure(error.exit_code, _without_list(error, error.reasons), error.reasons)
        case UnreadableError():
            return Failure(error.exit_code, str(error), (), refusal(error))
        case RefusedError():
            return Failure(error.exit_code, str(error), tuple(map(verdict_line, error.verdicts)))
        case UnsupportedError():
            return Failure(error.exit_code, _without_list(error, error.elements), error.elements)
        case InternalError():
            return Failure(error.exit_code, *_unexpected(error))
        case PluginError():
            return Failure(error.exit_code, str(error), (_WITHOUT_PLUGINS,))
        case MmrsError():
            return Failure(error.exit_code, str(error))
        case typer.TyperException():
            return Failure(error.exit_code, _usage(error))
        case OSError():
            return Failure(UNREADABLE, _about_file(error))
        case _:
            return Failure(MODEL_INVALID, *_unexpected(error))


def _without_list(error: MmrsError, listed: Sequence[str]) -> str:
    """Return the message up to where it begins to list what follows in full."""
    first = listed[0] if listed else ""
    words = str(error)
    return words.partition(first)[0].rstrip(": ") or words if first else words


def _usage(error: typer.TyperException) -> str:
    if error.format_message().startswith(_HELP):
        return error.format_message()
    message = (
        error.format_message().rstrip(".").removeprefix("Invalid value: ").replace(": Value error,", ":")
    )
    command = getattr(getattr(error, "ctx", None), "command_path", "")
    where = f"{'' if message.endswith('?') else ';'} try '{command} --help'" if command else ""
    return message[:1].lower() + message[1:] + where


def _about_file(error: OSError) -> str:
    name = error.filename2 or error.filename
    reason = (error.strerror or str(error)).lower()
    return f"{name}: {reason}" if name else reason


def _unexpected(error: Exception) -> tuple[str, tuple[str, ...]]:
    summary = " ".join(str(error).split()) or "no message"
    message = f"internal error: {type(error).__name__}: {summary}"
    return message, (f"please report it with your models and what {DEBUG} shows",)
