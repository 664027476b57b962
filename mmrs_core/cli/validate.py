"""``mmrs validate``: is the mission one that can be planned?"""

from __future__ import annotations

import typer

from mmrs_core.cli.output import counted, report, say, say_json
from mmrs_core.cli.parameters import Context, Project, Robots, robot_files
from mmrs_core.cli.settings import Json, settings_of


def validate(
    call: typer.Context,
    project: Project,
    context: Context = None,
    robots: Robots = None,
    json: Json = False,
) -> int:
    """List everything that is wrong with a mission's models."""
    from mmrs_core.cli.journey import Workshop
    from mmrs_core.diagnostics import Severity, has_errors, in_order
    from mmrs_core.pipeline import check_models, read_models

    workshop = Workshop(settings_of(call))
    models, faults = read_models(project, workshop.contributions, context=context, robots=robot_files(robots))
    if models is not None:
        given = models
        checked = workshop.stage(
            "check", "checking the models", lambda: check_models(given, workshop.contributions)
        )
        faults = in_order((*faults, *checked))
    report(faults)
    valid = models is not None and not has_errors(faults)
    if json:
        say_json({"valid": valid, "diagnostics": faults})
    else:
        counts = [(s, sum(fault.severity is s for fault in faults)) for s in Severity]
        found = ", ".join(counted(count, severity.value) for severity, count in counts if count)
        say(f"{project}: {'valid' if valid else 'not valid'}" + (f" ({found})" if found else ""))
    return 0 if valid else 1
