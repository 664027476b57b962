"""Commands that plug-ins add to the command line."""

from __future__ import annotations

from dataclasses import dataclass

CORE_COMMANDS = frozenset(
    {
        "demo",
        "new",
        "validate",
        "plan",
        "check",
        "generate",
        "explain",
        "simulate",
        "replay",
        "preview",
        "show",
        "convert",
        "export",
        "diff",
        "import",
        "bus",
        "report",
        "control",
        "run",
        "plugin",
        "metamodel",
    }
)
"""The names that plug-ins cannot have."""


@dataclass(frozen=True, slots=True)
class Command:
    """A command: its help is shown without importing the plug-in's code.

    Attributes:
        name: as typed after ``mmrs``.
        help: one line.
        entry: ``package.module:function``; called with the remaining arguments as a list of strings,
            returns the exit code. Or ``package.module:app``, an application of typer, whose commands
            find the global options by `mmrs_core.cli.settings.settings_of`; shells complete its commands,
            options and values.
    """

    name: str
    help: str
    entry: str
