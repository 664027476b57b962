"""The commands by name: the core's own, and those that plug-ins add."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from importlib import import_module
from typing import Annotated, Any

import typer

from mmrs_core.cli.as_typed import take_as_typed
from mmrs_core.cli.completion import COMPLETING, completed_words
from mmrs_core.cli.output import say, tell
from mmrs_core.cli.settings import DEBUG, NO_PLUGINS, QUIET_MIGRATION, Settings
from mmrs_core.contributions.commands import Command
from mmrs_core.errors import MmrsError, PluginError

_HELP = "Plan, verify and run missions of multi-robot teams."
_EPILOG = (
    "Exit codes: 0 success, 1 invalid model or failed mission, 2 usage error, 3 file not readable or "
    "writable, "
    "4 no feasible plan, 5 link or robot lost, 130 interrupted."
)
_COMMANDS = (
    Command("demo", "Run an example end to end.", "mmrs_core.cli.demo:demo"),
    Command(
        "validate",
        "Validate the models of a mission.",
        "mmrs_core.cli.validate:validate",
    ),
    Command("plan", "Plan a mission and write the robots' behaviour.", "mmrs_core.cli.plan:plan"),
    Command("check", "Verify the safety of a behaviour.", "mmrs_core.cli.check:check"),
    Command("generate", "Generate controller code for every robot.", "mmrs_core.cli.generate:generate"),
    Command("explain", "Trace a generated line to its move.", "mmrs_core.cli.explain:explain"),
    Command(
        "simulate",
        "Simulate a behaviour faster than real time.",
        "mmrs_core.cli.simulate:simulate",
    ),
    Command("run", "Run a behaviour on real or simulated vehicles.", "mmrs_core.cli.live:run"),
    Command("control", "Send a command to running robots.", "mmrs_core.cli.control:control"),
    Command(
        "replay",
        "Check the logs of a run against its behaviour.",
        "mmrs_core.cli.replay:replay",
    ),
    Command("report", "Write a flight report as HTML.", "mmrs_core.cli.report:report"),
    Command(
        "preview",
        "Draw a mission's map, timeline and altitude profile.",
        "mmrs_core.cli.preview:preview",
    ),
    Command("show", "Print a model, or one element, as a tree.", "mmrs_core.cli.show:show"),
    Command(
        "convert",
        "Convert models between XMI and JSON.",
        "mmrs_core.cli.convert:convert",
    ),
    Command("diff", "Compare two models.", "mmrs_core.cli.diff:diff"),
)
"""The help of all together imports none of them: each line is the first of the command's own help."""
_GROUPS = (
    Command("plugin", "List and create plug-ins.", "mmrs_core.cli.plugin:app"),
    Command("metamodel", "Inspect and export the metamodels.", "mmrs_core.cli.metamodel:app"),
    Command("bus", "Synchronise slots between machines.", "mmrs_core.cli.bus:app"),
)


def app_for(arguments: Sequence[str], settings: Settings) -> typer.Typer:
    """Return the application for a command line.

    Of the core's commands, only the called one is imported; the others are there by name and help.
    Plug-ins are asked for their commands only if no command of the core is called: for the help,
    or for a command that the core does not know.
    """
    app = typer.Typer(rich_markup_mode=None, help=_HELP, epilog=_EPILOG, no_args_is_help=True)
    app.callback()(_global_options)
    words = completed_words() if COMPLETING in os.environ else arguments
    called = next((word for word in words if not word.startswith("-")), None)
    for command in _COMMANDS:
        if command.name == called:
            app.command(command.name)(_imported(command))
        else:
            app.command(command.name, help=command.help)(_nothing)
    if called not in {command.name for command in (*_COMMANDS, *_GROUPS)}:
        _add_plugin_commands(app, settings, called)
    for group in _GROUPS:
        if group.name == called:
            app.add_typer(_imported(group), name=group.name)
        else:
            app.command(group.name, help=group.help)(_nothing)
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
        from mmrs_core.cli import explain

        return f"{program} explain", generate_app(explain.explain), list(arguments[1:])
    from mmrs_core.cli import generate

    return program, generate_app(generate.generate), list(arguments)


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
            QUIET_MIGRATION,
            help="Do not list the changes made when reading models of another dialect.",
        ),
    ] = False,
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
            _runner(command, contributions.source_of("commands", command), settings)
        )


def _runner(command: Command, source: str, settings: Settings) -> Callable[[typer.Context], int]:
    def run(context: typer.Context) -> int:
        try:
            entry = _imported(command)
        except Exception as error:
            raise PluginError(f"{source}: {command.entry} cannot be imported: {error!r}") from error
        try:
            if isinstance(entry, typer.Typer):
                result = _result_of(entry, command.name, context.args, settings)
            else:
                result = entry(list(context.args))
        except (MmrsError, OSError, typer.TyperException, typer.Exit, typer.Abort):
            raise  # about what the user gave, in the words of all commands
        except Exception as error:
            raise PluginError(f"{source} fails: {error!r}") from error
        return result if isinstance(result, int) else 0

    return run


def _result_of(app: typer.Typer, name: str, arguments: list[str], settings: Settings) -> object:
    command = typer.main.get_command(app)
    take_as_typed(command, arguments)
    return command.main(arguments, prog_name=f"mmrs {name}", standalone_mode=False, obj=settings)
