"""What this plug-in contributes: the importer of FLYAQ's models of 2015, and ``mmrs migrate``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_core.contributions.commands import Command
from mmrs_core.hookspecs import hookimpl

if TYPE_CHECKING:
    from mmrs_core.languages.importers import Importer

FLYAQ_2015 = Path(__file__).parent / "migrations" / "flyaq-2015.toml"


@hookimpl
def mmrs_importers() -> tuple[Importer, ...]:
    """Contribute the models of the platform that the languages come from."""
    from mmrs_flyaq.importing import importer_of

    return (importer_of("FLYAQ 2015", FLYAQ_2015),)


@hookimpl
def mmrs_commands() -> tuple[Command, ...]:
    """Contribute the command that turns models of another dialect into a project."""
    summary = "Migrate models of another dialect to an MMRS project."
    return (Command("migrate", summary, "mmrs_flyaq.command.migrate:app"),)
