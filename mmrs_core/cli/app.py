"""The commands by name: the core's own, and those that plug-ins add."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib import import_module
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli import (
    bus,
    check,
    control,
    convert,
    demo,
    diff,
    explain,
    generate,
    live,
    metamodel,
    migrate,
    plan,
    plugin,
    replay,
    show,
    simulate,
    sitl,
    validate,
)
from mmrs_core.cli.output import say, tell
from mmrs_core.cli.preview import command as preview
from mmrs_core.cli.report import command as report
from mmrs_core.cli.settings import DEBUG, NO_PLUGINS, Settings
from mmrs_core.errors import MmrsError, PluginError

if TYPE_CHECKING:
    from mmrs_core.contributions.commands import Command

_HELP = "Missions of mobile multi-robot systems: from a mission model to robots that carry it out."
_EPILOG = (
    "Exit codes: 0 done, 1 model invalid or mission failed, 2 wrong usage, 3 file not readable or writable, "
    "4 no feasible plan, 5 link or robot lost, 130 interrupted."
)
_COMMANDS: tuple[tuple[str, Callable[..., int]], ...] = (
    ("demo", demo.demo),
    ("validate", validate.validate),
    ("plan", plan.plan),
    ("check", check.check),
    ("generate", generate.generate),
    ("explain", explain.explain),
    ("simulate", simulate.simulate),
    ("sitl", sitl.sitl),
    ("run", live.run),
    ("control", control.control),
    ("replay", replay.replay),
    ("report", report.report),
    ("preview", preview.preview),
    ("show", show.show),
    ("convert", convert.convert),
    ("diff", diff.diff),
    ("migrate", migrate.migrate),
)


def app_for(arguments: Sequence[str], settings: Settings) -> typer.Typer:
    """Return the application for a command line.

    Plug-ins are asked for their commands only if no command of the core is called: for the help,
    or for a command that the core does not know.
    """
    app = _core_app()
    called = next((argument for argument in arguments if not argument.startswith("-")), None)
    if called not in {*(name for name, _ in _COMMANDS), "plugin", "metamodel", "bus"}:
        _add_plugin_commands(app, settings, called)
    return app


def generate_app(command: Callable[..., int]) -> typer.Typer:
    """Return the application ``mmrs-gen``, or ``mmrs-gen explain``, which has one command."""
    app = typer.Typer(rich_markup_mode=None, add_completion=False)
    app.command()(command)
    return app


def app_of(program: str, arguments: Sequence[str], settings: Settings) -> tuple[str, typer.Typer, list[str]]:
    """Return what a program's help calls it, its application, and the arguments for that."""
    if program != "mmrs-gen":
        return program, app_for(arguments, settings), list(arguments)
    if next(iter(arguments), None) == "explain":
        return f"{program} explain", generate_app(explain.explain), list(arguments[1:])
    return program, generate_app(generate.generate), list(arguments)


def _core_app() -> typer.Typer:
    app = typer.Typer(rich_markup_mode=None, help=_HELP, epilog=_EPILOG, no_args_is_help=True)
    app.callback()(_global_options)
    for name, command in _COMMANDS:
        app.command(name)(command)
    app.add_typer(plugin.app, name="plugin")
    app.add_typer(metamodel.app, name="metamodel")
    app.add_typer(bus.app, name="bus")
    return app


def _print_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        say(f"mmrs {version('mmrs-core')}")
        raise typer.Exit


def _global_options(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version.", callback=_print_version, is_eager=True)
    ] = False,
    no_plugins: Annotated[bool, typer.Option(NO_PLUGINS, help="Load nothing but the core.")] = False,
    debug: Annotated[bool, typer.Option(DEBUG, help="Show where errors come from.")] = False,
) -> None:
    """Describe the global options, which `taken_from` has taken off the command line before."""


def _add_plugin_commands(app: typer.Typer, settings: Settings, called: str | None) -> None:
    """Add the commands of plug-ins; what is wrong with them is only told where help was asked for."""
    try:
        contributions = settings.plugins().contributions
        commands = contributions.commands
    except PluginError as error:
        if called is not None:
            raise
        tell(f"mmrs: {error}")
        return
    for command in commands:
        passed = {"allow_extra_args": True, "ignore_unknown_options": True, "help_option_names": []}
        app.command(command.name, help=command.help, context_settings=passed, add_help_option=False)(
            _runner(command, contributions.blamed("commands", command))
        )


def _runner(command: Command, blamed: str) -> Callable[[typer.Context], int]:
    def run(context: typer.Context) -> int:
        module, _, function = command.entry.partition(":")
        try:
            entry = getattr(import_module(module), function)
        except Exception as error:
            raise PluginError(f"{blamed}: {command.entry} cannot be imported: {error!r}") from error
        try:
            result = entry(list(context.args))
        except (MmrsError, OSError, typer.TyperException, typer.Exit, typer.Abort):
            raise  # about what the user gave, in the words of all commands
        except Exception as error:
            raise PluginError(f"{blamed} fails: {error!r}") from error
        return result if isinstance(result, int) else 0

    return run
