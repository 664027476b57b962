"""``mmrs replay``: did a run do what its behaviour says?"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mmrs_core.cli.output import say, say_json
from mmrs_core.cli.parameters import Behaviour, behaviour_file
from mmrs_core.cli.settings import Json, settings_of


def replay(
    call: typer.Context,
    behaviour: Behaviour,
    logs: Annotated[list[Path], typer.Argument(metavar="LOG...", help="Logs, or folders of logs.")],
    partial: Annotated[
        bool, typer.Option("--partial", help="Accept logs that end before the run does.")
    ] = False,
    json: Json = False,
) -> int:
    """Replay the logs of a run through the rules of its behaviour."""
    from mmrs_core.behaviour.log import read_logs
    from mmrs_core.behaviour.replay import Outcome
    from mmrs_core.behaviour.replay import replay as replayed
    from mmrs_core.cli.behaviours import load_program
    from mmrs_core.cli.figures import clock
    from mmrs_core.cli.journey import Workshop

    workshop = Workshop(settings_of(call))
    program = load_program(workshop, behaviour_file(behaviour))
    result = replayed(program, read_logs(logs, partial=partial), partial=partial)
    if json:
        say_json(result)
    else:
        verdict = "accepted" if result.accepted else "not what the behaviour says"
        say(f"{verdict}: {result.outcome.value} after {result.steps} steps and {clock(result.duration)}")
        for complaint in result.complaints:
            say(f"  - {complaint}")
        for robot, fault in result.faults.items():
            say(f"  fault of '{robot}': {fault}")
        for waiting in result.waiting:
            say(f"  {waiting}")
    cut = partial and result.outcome is Outcome.INCOMPLETE
    return 0 if result.accepted and (cut or result.outcome is Outcome.SUCCESS) else 1
