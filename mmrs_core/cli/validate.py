"""``mmrs validate``: is the mission one that can be planned?"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import typer

from mmrs_core.cli.output import counted, report, say, say_json
from mmrs_core.cli.parameters import Context, Project, Robots, robot_files
from mmrs_core.cli.settings import Json, settings_of

if TYPE_CHECKING:
    from mmrs_core.cli.journey import Workshop
    from mmrs_core.diagnostics import Diagnostic


def validate(
    call: typer.Context,
    project: Project,
    context: Context = None,
    robots: Robots = None,
    json: Json = False,
) -> int:
    """List everything that is wrong with a mission's models.

    Robot types and context are checked with the mission. A behaviour is checked by itself.
    """
    from mmrs_core.cli.behaviours import is_behaviour
    from mmrs_core.cli.journey import Workshop
    from mmrs_core.diagnostics import Severity, has_errors

    workshop = Workshop(settings_of(call))
    types = robot_files(robots)
    if is_behaviour(workshop, project):
        complete, faults = _faults_of_behaviour(workshop, project, context, types)
    else:
        complete, faults = _faults_of_mission(workshop, project, context, types)
    report(faults)
    valid = complete and not has_errors(faults)
    if json:
        say_json({"valid": valid, "diagnostics": faults})
    else:
        counts = [(s, sum(fault.severity is s for fault in faults)) for s in Severity]
        found = ", ".join(counted(count, severity.value) for severity, count in counts if count)
        say(f"{project}: {'valid' if valid else 'not valid'}" + (f" ({found})" if found else ""))
    return 0 if valid else 1


_Found = tuple[bool, tuple["Diagnostic", ...]]
"""Whether there is a whole model to judge, and all faults."""


def _faults_of_mission(
    workshop: Workshop, project: Path, context: Path | None, robots: tuple[Path, ...]
) -> _Found:
    from mmrs_core.diagnostics import in_order
    from mmrs_core.pipeline import check_models, read_models

    models, faults = read_models(project, workshop.contributions, context=context, robots=robots)
    if models is None:
        return False, in_order(faults)
    given = models
    workshop.have_read(given.models, given.context)
    checked = workshop.stage(
        "check", "checking the models", lambda: check_models(given, workshop.contributions)
    )
    return True, in_order((*faults, *checked))


def _faults_of_behaviour(
    workshop: Workshop, file: Path, context: Path | None, robots: tuple[Path, ...]
) -> _Found:
    from mmrs_core.cli.behaviours import faults_of, read_behaviour_files

    files = read_behaviour_files(workshop, file, context=context, robots=robots)
    return True, workshop.stage("check", "checking the behaviour", lambda: faults_of(workshop, files))
