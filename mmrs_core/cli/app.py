"""The commands by name: the core's own, and those that plug-ins add."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Annotated, Any

import typer

from mmrs_core.cli.completion import is_completing, words_to_complete
from mmrs_core.cli.output import say, tell
from mmrs_core.cli.settings import DEBUG, NO_PLUGINS, QUIET_MIGRATION, Settings
from mmrs_core.contributions.commands import CORE_COMMANDS, CORE_GROUPS, CORE_NAMES, Command
from mmrs_core.errors import PluginError

_HELP = "Plan, verify and run missions of multi-robot teams."
_EPILOG = (
    "Exit codes: 0 success, 1 invalid model or failed mission, 2 usage error, 3 file not readable or "
    "writable, 4 no feasible plan, 5 link or robot lost, 130 interrupted."
)
_MORE = "'mmrs --help' lists exit codes and global options."


@dataclass(frozen=True, slots=True)
class CommandLine:
    """The application for one command line.

    Attributes:
        source: the plug-in whose command is called, as messages name it; empty: a command of the core.
    """

    app: typer.Typer
    source: str = ""


def program_for(name: str, arguments: Sequence[str], settings: Settings) -> CommandLine:
    """Return the application of ``mmrs`` or ``mmrs-gen`` for a command line.

    Of the core's commands, only the called one is imported; the others are there by name and help.
    Plug-ins are asked for their commands only if no command of the core is called: for the help,
    or for a command that the core does not know.

    Args:
        arguments: without the program's name; ignored where a shell asks for completions.

    Raises:
        PluginError: a plug-in is broken, or its command cannot be imported.
    """
    words = words_to_complete() if is_completing(name) else arguments
    called = next((word for word in words if not word.startswith("-")), None)
    if name == "mmrs-gen":
        return CommandLine(_generating(called))
    app = typer.Typer(rich_markup_mode=None, help=_HELP, epilog=_EPILOG, no_args_is_help=True)
    app.callback()(_global_options)
    _add_commands(app, CORE_COMMANDS, called)
    source = "" if called in CORE_NAMES else _add_plugin_commands(app, settings, called)
    _add_commands(app, CORE_GROUPS, called)
    return CommandLine(app, source)


def _generating(called: str | None) -> typer.Typer:
    """Return the application ``mmrs-gen``: the command ``generate``, or a group with ``explain`` alone."""
    app = typer.Typer(rich_markup_mode=None)
    command = next(
        each for each in CORE_COMMANDS if each.name == ("explain" if called == "explain" else "generate")
    )
    app.command(command.name, epilog=_MORE)(_imported(command))
    if called == "explain":
        app.callback()(_nothing)
    return app


def _add_commands(app: typer.Typer, commands: Iterable[Command], called: str | None) -> None:
    for command in commands:
        if command.name == called:
            _add(app, command, _imported(command))
        else:
            app.command(command.name, help=command.help)(_nothing)


def _add(app: typer.Typer, command: Command, entry: Any) -> None:
    """Add a command by what its entry names: an application, or a function that typer understands."""
    if not isinstance(entry, typer.Typer):
        app.command(command.name, epilog=_MORE)(entry)
        return
    for each in entry.registered_commands:
        each.epilog = _MORE
    if entry.registered_callback or len(entry.registered_commands) != 1:
        app.add_typer(entry, name=command.name)
    else:
        only = entry.registered_commands[0]
        only.name = command.name
        app.registered_commands.append(only)


def _imported(command: Command) -> Any:
    """Return what a command's entry names."""
    module, _, name = command.entry.partition(":")
    return getattr(import_module(module), name)


def _nothing() -> None:
    """Stand for a command that is not called."""


def _print_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        say(f"mmrs {version('mmrs-core')}")
        raise typer.Exit


def _global_options(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version.", callback=_print_version, is_eager=True)
    ] = False,
    no_plugins: Annotated[bool, typer.Option(NO_PLUGINS, help="Disable plug-ins.")] = False,
    debug: Annotated[bool, typer.Option(DEBUG, help="Print the Python traceback of an error.")] = False,
    quiet_migration: Annotated[
        bool,
        typer.Option(
            QUIET_MIGRATION, help="Do not list the changes made when reading models of another dialect."
        ),
    ] = False,
) -> None:
    """Describe the global options, which `taken_from` has taken off the command line before."""


def _add_plugin_commands(app: typer.Typer, settings: Settings, called: str | None) -> str:
    """Add the commands of plug-ins; return the plug-in whose command is called.

    A conflict of plug-ins is an error for a called command, and a line on standard error beside the help.
    """
    try:
        contributions = settings.plugins().contributions
        commands = contributions.commands
    except PluginError as error:
        if called is not None:
            raise
        tell(f"mmrs: {error}")
        return ""
    _add_commands(app, (each for each in commands if each.name != called), called)
    command = next((each for each in commands if each.name == called), None)
    if command is None:
        return ""
    source = contributions.source_of("commands", command)
    try:
        entry = _imported(command)
    except Exception as error:
        raise PluginError(f"{source}: {command.entry} cannot be imported: {error!r}") from error
    if isinstance(entry, typer.Typer):
        _add(app, command, entry)
        return source
    passed = {"allow_extra_args": True, "ignore_unknown_options": True, "help_option_names": []}
    app.command(command.name, help=command.help, context_settings=passed, add_help_option=False)(
        _with_arguments(entry)
    )
    return source


def _with_arguments(entry: Callable[[list[str]], object]) -> Callable[[typer.Context], object]:
    def run(context: typer.Context) -> object:
        return entry(list(context.args))

    return run
