"""Dives in real time: by the interpreter and by generated code, on the bus of a vehicle that runs."""

import os
import subprocess
from dataclasses import replace
from pathlib import Path

from dives import diver
from mmrs_auv.kinds import AUV_KIND
from mmrs_auv.rehearsal import VehicleProcesses
from mmrs_auv.targets.can_python.target import CAN_PYTHON
from warm_python import python

from mmrs_core.behaviour.program import Program
from mmrs_core.contributions.registry import Contributions
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.render import render
from mmrs_core.generation.writing import write
from mmrs_core.pipeline import BehaviourContext, input_of
from mmrs_core.simulation.live import live_run_for
from mmrs_core.simulation.run import asked_by, inputs_of
from mmrs_core.transformation.kinds import MOVE_KINDS
from mmrs_runtime.engine.clocks import RealClock
from mmrs_runtime.engine.decisions import standard_conditions
from mmrs_runtime.engine.live import LiveRun
from mmrs_runtime.slots import LocalSlots

SPEED = 0.5
"""Slower than real time, so that a computer with other work does not make the vehicle give up its dive."""


def interpreted(
    behaviour: Program, berth: VehicleProcesses, contributions: Contributions, folder: Path, **options: str
) -> LiveRun:
    """Return a dive by the interpreter that keeps its logs in `logs`."""
    given = input_of(behaviour, BehaviourContext({diver().name: diver()}), contributions)
    live_run = live_run_for(
        behaviour,
        inputs_of(given, {"clock": "bus", **options}),
        contributions.vehicles["can"],
        LocalSlots(behaviour.executable),
        standard_conditions(asked_by(behaviour)),
    )
    return replace(live_run, clock=RealClock(SPEED), folder=folder / "logs", links={"naiad": berth.channel})


def dive_by_code(behaviour: Program, berth: VehicleProcesses, folder: Path, *words: str) -> None:
    """Generate code in `code`, run it to its end, and have it keep its logs in `logs`."""
    kinds = {kind.metaclass: kind for kind in MOVE_KINDS}
    given = TargetInput(behaviour, {diver().name: diver()}, {AUV_KIND.metaclass: AUV_KIND}, kinds)
    write(render(CAN_PYTHON, given), folder / "code")
    words = ("--can", berth.channel, "--clock", "bus", "--speedup", str(SPEED), *words)
    done = subprocess.run(
        [python(), "fleet.py", *words, "--log", str(folder / "logs")],
        cwd=folder / "code",
        env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        timeout=240,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
