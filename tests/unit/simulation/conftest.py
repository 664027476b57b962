"""Robots and moves for runs in tests."""

import pytest
from live_runs import Flight

from mmrs_core.behaviour.replay import replay
from mmrs_core.contributions.rules import MoveKind, MoveSpec, RobotKind
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.scene.timing import MoveSeconds
from mmrs_core.simulation.run import simulate
from mmrs_core.simulation.simulation import SIMULATION
from mmrs_core.testing.small_programs import ROBOT_TYPE, robot_type
from mmrs_core.transformation.kinds import MOVE_KINDS, PLAIN_ROBOT, kinematics_for, straight_travel

FLYER = ("urn:test", "Flyer")
RISE = ("urn:test", "Rise")
SINK = ("urn:test", "Sink")


def _nothing(*_: object) -> tuple[MoveSpec, ...]:
    return ()


def _seconds(move, path, kinematics, mode):
    return MoveSeconds.exactly(kinematics.rates().even(path[0], path[-1]))


FLYER_KIND = RobotKind(
    "flyer",
    FLYER,
    lambda robot, scene: kinematics_for(robot, scene, launches=True),
    _nothing,
    _nothing,
    straight_travel,
    position_hold="positionHold",
)
FLYER_MOVES = (
    MoveKind(
        RISE,
        lambda move, here, home: (here, (*here[:2], here[2] + move.attributes["altitude"])),
        _seconds,
        frozenset({"grounded"}),
        "airborne",
    ),
    MoveKind(
        SINK, lambda move, here, home: (here, (*here[:2], 0.0)), _seconds, frozenset({"airborne"}), "grounded"
    ),
)


@pytest.fixture(scope="session")
def kinds():
    """Return robot kinds and move kinds by metaclass."""
    return {
        "robot_kinds": {kind.metaclass: kind for kind in (PLAIN_ROBOT, FLYER_KIND)},
        "move_kinds": {kind.metaclass: kind for kind in (*MOVE_KINDS, *FLYER_MOVES)},
    }


@pytest.fixture
def fly(kinds):
    """Return a function that simulates a behaviour whose log must replay without complaint."""

    def run(program, type=None, **options):
        parts = {name: options.pop(name) for name in ("areas", "elements", "environment") if name in options}
        given = TargetInput(program, {ROBOT_TYPE: type or robot_type()}, **kinds, **parts)
        found = simulate(given, SIMULATION, **options)
        result = replay(program, found.records, partial=True)
        assert result.accepted, result.complaints
        if found.ending.outcome.value != "incomplete":
            assert result.outcome is found.ending.outcome
        return found

    return run


@pytest.fixture
def live(kinds):
    """Return a function that begins a run in real time, and gives what it is steered and judged by."""
    runs = []

    def begin(behaviour, script, **more):
        runs.append(Flight(behaviour, script, kinds, **more))
        return runs[-1]

    yield begin
    for run in runs:
        run.abort()
