"""Turns: a robot leaves home only when all others are back at theirs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from mmrs_core.planning.materials import Material
from mmrs_core.planning.runs import PortionRun
from mmrs_core.planning.sorties import Pilot
from mmrs_core.planning.states import Bounds, Ready, State

_BETWEEN = 1.0
"""Seconds from one robot's coming home to the next one's leaving: times follow from rounded places."""

States = Mapping[str, State]
"""The state of each robot, by name."""


@dataclass(frozen=True, slots=True)
class TurnShare:
    """A run of portions for one robot, begin to end, and what it waits for."""

    pilot: Pilot
    material: Material
    begin: int
    end: int
    ready: Ready


@dataclass(frozen=True, slots=True)
class JobResult:
    """What has become of a job.

    Attributes:
        states: after it, of the robots that it moves at least.
        begin: seconds at which it began; ends: by robot that has a share, when that ended; bounds: of that.
        back: when the last of these is back, seconds.
    """

    states: States
    begin: float
    ends: Mapping[str, float]
    bounds: Mapping[str, Bounds]
    back: float


def turn_of(name: str, states: States, pilots: Mapping[str, Pilot], task: str) -> States | None:
    """Return the states in which only that robot is or may go away; None if another cannot come home.

    At most one robot is away before.

    Args:
        name: of the robot.
        states: before.
        pilots: by name of robot.
        task: for which it leaves.
    """
    found = dict(states)
    for other, state in states.items():
        if other != name and state.away:
            if not pilots[other].affords_home(state, 0.0, state.at):
                return None
            found[other] = pilots[other].home(state)
    others = [state.time for other, state in found.items() if other != name and state.sorties]
    if not found[name].away and others:
        pilot = pilots[name]
        found[name] = pilot.stay_until(found[name], max(others) + _BETWEEN, task)
    return found


def in_turns(
    parts: Sequence[TurnShare], states: States, pilots: Mapping[str, Pilot], *, record: bool
) -> JobResult | None:
    """Return what has become of parts of a job done one after the other; None if one cannot be done."""
    begins, ends, bounds, back = [], {}, {}, 0.0
    for part in parts:
        name, pilot = part.pilot.robot.name, part.pilot
        turn = turn_of(name, states, pilots, part.material.task)
        if turn is None:
            return None
        run = PortionRun(pilot, part.material, turn[name], part.begin, part.ready, record=record)
        if not run.can_do(part.end):
            return None
        end = run.state(part.end)
        states = {**turn, name: end}
        begins.append(run.started())
        ends[name], bounds[name] = end.time, end.bounds
        back = max(back, run.back(part.end))
    return JobResult(states, min(begins), ends, bounds, back)
