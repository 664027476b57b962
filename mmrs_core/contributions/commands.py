"""Commands of the command line: the core's, and those that plug-ins add."""

from __future__ import annotations

from dataclasses import dataclass


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


CORE_COMMANDS = (
    Command("demo", "Run an example end to end.", "mmrs_core.cli.demo:demo"),
    Command("new", "Make a new mission that is ready to plan.", "mmrs_core.cli.new:new"),
    Command(
        "import", "Import drawings of map programs into a project.", "mmrs_core.cli.importing:import_drawings"
    ),
    Command("validate", "Validate the models of a mission.", "mmrs_core.cli.validate:validate"),
    Command("plan", "Plan a mission and write the robots' behaviour.", "mmrs_core.cli.plan:plan"),
    Command("check", "Verify the safety of a behaviour.", "mmrs_core.cli.check:check"),
    Command("generate", "Generate controller code for every robot.", "mmrs_core.cli.generate:generate"),
    Command("explain", "Trace a generated line to its move.", "mmrs_core.cli.explain:explain"),
    Command("simulate", "Simulate a behaviour faster than real time.", "mmrs_core.cli.simulate:simulate"),
    Command("run", "Run a behaviour on real or simulated vehicles.", "mmrs_core.cli.live:run"),
    Command("control", "Send a command to running robots.", "mmrs_core.cli.control:control"),
    Command("replay", "Check the logs of a run against its behaviour.", "mmrs_core.cli.replay:replay"),
    Command("report", "Write a flight report as HTML.", "mmrs_core.cli.report:report"),
    Command(
        "preview", "Draw a mission's map, timeline and altitude profile.", "mmrs_core.cli.preview:preview"
    ),
    Command("export", "Export to QGIS, Google Earth and other map programs.", "mmrs_core.cli.export:export"),
    Command("show", "Print a model, or one element, as a tree.", "mmrs_core.cli.show:show"),
    Command("convert", "Convert models between XMI and JSON.", "mmrs_core.cli.convert:convert"),
    Command("diff", "Compare two models.", "mmrs_core.cli.diff:diff"),
)
"""The help of all together imports none of them: each line is the first of the command's own help."""
CORE_GROUPS = (
    Command("plugin", "List and create plug-ins.", "mmrs_core.cli.plugin:app"),
    Command("metamodel", "Inspect and export the metamodels.", "mmrs_core.cli.metamodel:app"),
    Command("bus", "Synchronise slots between machines.", "mmrs_core.cli.bus:app"),
)
CORE_NAMES = frozenset(each.name for each in (*CORE_COMMANDS, *CORE_GROUPS))
"""Names that plug-ins cannot have."""
