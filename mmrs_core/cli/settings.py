"""What holds for every command: the global options, and the plug-ins that they leave."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from mmrs_core.plugins import Plugins

NO_PLUGINS = "--no-plugins"
DEBUG = "--debug"
QUIET_MIGRATION = "--quiet-migration"


@dataclass(frozen=True, slots=True)
class Settings:
    """The global options, which may stand anywhere on the command line.

    Attributes:
        only_core: load no plug-in but the core's own.
        debug: show where unexpected errors come from.
        json: one JSON object is wanted on standard output.
        quiet_migration: do not list what is not just as it was in models of other tools.
    """

    only_core: bool = False
    debug: bool = False
    json: bool = False
    quiet_migration: bool = False

    def plugins(self) -> Plugins:
        """Return the plug-ins, loaded now.

        Raises:
            PluginError: if one is broken or two conflict.
        """
        from mmrs_core.plugins import load_plugins

        return load_plugins(only_core=self.only_core, quiet_migration=self.quiet_migration)


def taken_from(arguments: Sequence[str]) -> tuple[Settings, list[str]]:
    """Return the global options and the arguments without them; nothing after ``--`` is an option.

    >>> taken_from(["plan", "field", "--debug"])[1]
    ['plan', 'field']
    """
    end = arguments.index("--") if "--" in arguments else len(arguments)
    options = arguments[:end]
    settings = Settings(
        NO_PLUGINS in options, DEBUG in options, "--json" in options, QUIET_MIGRATION in options
    )
    rest = [argument for argument in options if argument not in (NO_PLUGINS, DEBUG, QUIET_MIGRATION)]
    return settings, [*rest, *arguments[end:]]


def settings_of(context: typer.Context) -> Settings:
    """Return the settings of a running command."""
    found = context.find_object(Settings)
    return found if found is not None else Settings()


Json = Annotated[bool, typer.Option("--json", help="Print the result as JSON.")]
