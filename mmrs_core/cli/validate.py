"""``mmrs validate``: is the mission one that can be planned?"""

from __future__ import annotations

from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.any_model import Metamodels, is_metamodel
from mmrs_core.cli.diagnosing import Subject
from mmrs_core.cli.fixing import agreed, difference, refuse_foreign, repairer_for, show, write
from mmrs_core.cli.metamodel_tree import validate_metamodel
from mmrs_core.cli.output import counted, report, say, say_json, tell
from mmrs_core.cli.parameters import Context, Project, Robots, robot_files, without_mission
from mmrs_core.cli.sarif import STANDARD_OUTPUT, Sarif, refuse_two_outputs, subject_of, write_sarif
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.diagnostics import Diagnostic, Severity, has_errors
from mmrs_core.errors import UnreadableError
from mmrs_core.languages.codes import is_refusal

if TYPE_CHECKING:
    from mmrs_core.analysis.fixes.repair import Diagnosis, Proposal, Repair

_Fix = Annotated[bool, typer.Option("--fix", help="Fix unambiguous problems after showing a diff.")]
_Yes = Annotated[bool, typer.Option("--yes", help="With --fix, skip confirmation.")]
_DryRun = Annotated[bool, typer.Option("--dry-run", help="With --fix, show the diff only.")]


def validate(
    call: typer.Context,
    project: Project,
    context: Context = None,
    robots: Robots = None,
    metamodel: Metamodels = None,
    fix: _Fix = False,
    yes: _Yes = False,
    dry_run: _DryRun = False,
    sarif: Sarif = None,
    json: Json = False,
) -> int:
    """Validate the models of a mission.

    Prints every problem with its file, line and a hint. A mission or a behaviour is checked with its
    context and robot types, any other model alone. A model of a language that is not installed is checked
    against its .ecore file, which --metamodel names, the model refers to or its folder contains. An .ecore
    file is checked as a metamodel.

    Example: mmrs validate field --fix
    """
    if is_metamodel(project):
        return validate_metamodel(call, project, json)
    if (yes or dry_run) and not fix:
        raise typer.BadParameter("--yes and --dry-run go with --fix")
    if metamodel and project.is_dir():
        raise typer.BadParameter(f"--metamodel is for one model: name its file in {project}")
    refuse_two_outputs(sarif, json or fix)
    session = Session(settings_of(call))
    subject = Subject(session, without_mission(project), context, robot_files(robots), tuple(metamodel or ()))
    found, changed = subject.examined(), False
    repairer = repairer_for(session.contributions, subject.diagnose)
    report(found.faults)
    if fix:
        refuse_foreign(found.models)
    repair = repairer.repair(found) if fix else None
    if repair is not None:
        if not json:
            show(repair, session.contributions.fixes)
        changed = agreed(repair, yes=yes, dry_run=dry_run or (json and not yes))
        if changed:
            write(repair)
            found = repair.diagnosis
    proposals = tuple(repairer.proposals(found))
    if sarif is not None:
        named = subject_of("validate", project)
        write_sarif(sarif, found.faults, session.contributions, proposals, subject=named)
    if json:
        say_json(_as_json(found, proposals, repair, changed))
    elif sarif != STANDARD_OUTPUT:
        say(_summary(project, found, repair, changed))
        _tell_of(proposals, project, asked=fix)
    return _exit_code(found)


def _exit_code(found: Diagnosis) -> int:
    if any(map(is_refusal, found.faults)):
        return UnreadableError.exit_code
    return 0 if _is_valid(found) else 1


def _is_valid(found: Diagnosis) -> bool:
    return found.complete and not has_errors(found.faults)


def _summary(project: Path, found: Diagnosis, repair: Repair | None, changed: bool) -> str:
    counts = _counts(found.faults)
    mended = counted(len(repair.applied), "problem") if repair is not None and changed else ""
    known = "incompletely read" if _exit_code(found) == UnreadableError.exit_code else "not valid"
    words = f"{project}: {'valid' if _is_valid(found) else known}" + (f" ({counts})" if counts else "")
    return f"{words}; {mended} fixed" if mended else words


def _counts(faults: tuple[Diagnostic, ...]) -> str:
    counts = [(severity, sum(fault.severity is severity for fault in faults)) for severity in Severity]
    return ", ".join(counted(count, severity.value) for severity, count in counts if count)


def _tell_of(proposals: tuple[Proposal, ...], project: Path, *, asked: bool) -> None:
    if proposals and not asked:
        count = len(proposals)
        command = f"mmrs validate {quote(str(project))} --fix"
        tell(f"{counted(count, 'problem')} can be fixed with {command}")


def _as_json(
    found: Diagnosis, proposals: tuple[Proposal, ...], repair: Repair | None, changed: bool
) -> dict[str, object]:
    reported: dict[str, object] = {
        "valid": _is_valid(found),
        "diagnostics": found.faults,
        "fixable": [
            {"code": each.fault.code, "place": each.fault.place, "fix": each.title} for each in proposals
        ],
    }
    if repair is not None:
        reported["fix"] = {
            "changed": changed,
            "mended": [each.fault for each in repair.applied],
            "refused": [each.fault for each in repair.refused],
            "diff": difference(repair.changes),
        }
    return reported
