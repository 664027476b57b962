"""``mmrs check``: is this behaviour safe?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import typer

from mmrs_core.cli.behaviours import load_behaviour, tasks_beside
from mmrs_core.cli.output import say, say_json, say_lines
from mmrs_core.cli.parameters import Behaviour, Context, Robots, behaviour_file, robot_files
from mmrs_core.cli.sarif import (
    STANDARD_OUTPUT,
    Sarif,
    as_faults,
    refusals_in,
    refuse_two_outputs,
    subject_of,
    write_sarif,
)
from mmrs_core.cli.session import Session, verdicts_of
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.cli.verdict_words import hint_of, verdict_line, verdict_table
from mmrs_core.pipeline import refusals

if TYPE_CHECKING:
    from mmrs_core.contributions.checks import Verdict


def check(
    call: typer.Context,
    behaviour: Behaviour,
    context: Context = None,
    robots: Robots = None,
    sarif: Sarif = None,
    json: Json = False,
) -> int:
    """Verify the safety of a behaviour.

    Checks clearance, separation, energy, synchronisation and more, independently of the planner. Behaviours
    written by hand are checked in the same way; photos are, against the mission in the same folder.

    Example: mmrs check field/behaviour.xmi --sarif check.sarif
    """
    session = Session(settings_of(call))
    file = behaviour_file(behaviour)
    refuse_two_outputs(sarif, json)
    subject = subject_of("check", file)
    with refusals_in(sarif, session, subject):
        loaded = load_behaviour(session, file, context=context, robots=robot_files(robots))
        place = replace(loaded.place, tasks=tasks_beside(session, file, loaded))
    verdicts = verdicts_of(session, loaded.program, place)
    against = refusals(verdicts, loaded.program)
    if sarif is not None:
        write_sarif(
            sarif,
            as_faults(verdicts, against, session.contributions.checks),
            session.contributions,
            subject=subject,
        )
    if json:
        say_json({"safe": not against, "verdicts": verdicts, "against": against})
    elif sarif != STANDARD_OUTPUT:
        say_lines(verdict_table(verdicts))
        say(f"{file}: {_in_all(verdicts, against)}")
        hinted: set[str] = set()
        for verdict in against:
            say(f"  - {verdict_line(verdict)}")
            hint = hint_of(verdict, session.contributions.checks)
            if hint and (verdict.property + hint) not in hinted:
                say(f"    hint: {hint}")
            hinted.add(verdict.property + hint)
    return 1 if against else 0


def _in_all(verdicts: Sequence[Verdict], against: Sequence[Verdict]) -> str:
    if against:
        return "not safe"
    found: dict[str, set[str]] = {}
    for verdict in verdicts:
        found.setdefault(verdict.property, set()).add(verdict.status.value)
    reported = {
        "unknown, and accepted": [name for name, statuses in found.items() if "unknown" in statuses],
        "not checked": [name for name, statuses in found.items() if statuses == {"not checked"}],
    }
    return "; ".join(
        ["safe", *(f"{words}: {', '.join(names)}" for words, names in reported.items() if names)]
    )
