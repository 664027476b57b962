"""The picture of a run shows what the log and the track say."""

from dataclasses import replace

import pytest

from mmrs_core.behaviour.program import BEHAVIOUR, Action, Move, MoveTarget, Program, RobotProgram, Transition
from mmrs_core.contributions.execution import Sample
from mmrs_core.contributions.rules import MoveKind
from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.pictures.preview.from_run import picture_of_run
from mmrs_core.pipeline import BehaviourContext
from mmrs_core.scene import Area, AreaUse, Frame, Part, RobotType
from mmrs_core.scene.timing import MoveSeconds
from mmrs_runtime.records.steps import StepRecord

GO, HOLD, START, STOP = ((BEHAVIOUR, name) for name in ("GoTo", "HoldPosition", "Start", "Stop"))
UP = ("urn:test", "Up")
UNICAST = ((BEHAVIOUR, "UnicastNotify"), (BEHAVIOUR, "Notify"), (BEHAVIOUR, "Action"))
QUAD = RobotType("quad", (), (), 0.5, None, (), (), {}, Part((), {}))
TELL = Action(UNICAST, sets=(("b", "go"),))
SNAP = Action(((BEHAVIOUR, "DeviceAction"),), "Snap", "camera")
KINDS = {
    name: MoveKind(name, lambda *a: None, lambda *a: MoveSeconds.exactly(0.0), frozenset(), leaves)
    for name, leaves in ((UP, "airborne"), (GO, None), (HOLD, None))
}


def move(id, kind, **more):
    return Move(id, (kind, (BEHAVIOUR, "Move")), **more)


def robot(id, moves, waits):
    transitions = {i: Transition(i, i + 1, waits.get(i, ())) for i in range(len(moves) - 1)}
    return RobotProgram(
        id, "quad", "NORMAL", 0.0, (0.0, 0.0, 0.0), ("go",), moves, transitions, 0, len(moves) - 1
    )


def log(id, *steps):
    return [StepRecord("run", id, i, i, *step) for i, step in enumerate(steps)]


A = robot(
    "a",
    (
        move("start", START),
        move("up", UP),
        move("there", GO, target=MoveTarget((10.0, 0.0, 5.0)), task="photo", after=(SNAP, TELL)),
        move("stop", STOP),
    ),
    {},
)
B = robot(
    "b",
    (move("start", START), move("stay", HOLD, attributes={"duration": 2.0}), move("stop", STOP)),
    {0: ("go",)},
)
RECORDS = [
    *log(
        "a",
        (0.0, "begin", "start"), (0.0, "end", "start"), (0.0, "take", "start", "up"),
        (0.0, "begin", "up"), (5.0, "end", "up"), (5.0, "take", "up", "there"),
        (5.0, "begin", "there"), (7.0, "end", "there"), (8.0, "act", "there", "post:0"),
        (8.0, "ntf", "there", "post:1", "+b.go"), (8.0, "take", "there", "stop"),
        (8.0, "begin", "stop"), (8.0, "end", "stop"),
    ),
    *log(
        "b",
        (0.0, "begin", "start"), (0.0, "end", "start"), (8.0, "take", "start", "stay"),
        (8.0, "begin", "stay"), (10.0, "end", "stay"), (10.0, "take", "stay", "stop"),
        (10.0, "begin", "stop"), (10.0, "end", "stop"),
    ),
]  # fmt: skip
TRACKS = {
    "a": (
        Sample(0, 0, 0, 0, None),
        Sample(5, 0, 0, 5, None),
        Sample(7, 10, 0, 5, None),
        Sample(8, 10, 0, 5, None),
    ),
    "b": (Sample(0, 0, 0, 0, None), Sample(10, 0, 0, 0, None)),
}


@pytest.fixture
def shown():
    program = Program("relay", Frame("EPSG:4326", None, None), (A, B))
    tree = Area("tree", AreaUse.OBSTACLE, ((20.0, 0.0), (21.0, 0.0), (21.0, 1.0)), 0.0, 9.0, 1.0)
    return picture_of_run(program, RECORDS, TRACKS, KINDS, {}, BehaviourContext({"quad": QUAD}, (tree,)))


def test_every_move_that_moves_is_a_leg(shown):
    legs = shown.robots[0].legs
    assert [(leg.kind, leg.begin, leg.end, leg.moves) for leg in legs] == [
        ("launch", 0.0, 5.0, "move up"),
        ("work", 5.0, 7.0, "move there"),
    ]
    assert legs[1].points == ((0.0, 0.0, 5.0), (10.0, 0.0, 5.0))


def test_a_hold_is_a_place_at_which_the_robot_stays(shown):
    (leg,) = shown.robots[1].legs
    assert (leg.kind, leg.points, leg.begin, leg.end, leg.moves) == (
        "hold", ((0.0, 0.0, 0.0),), 8.0, 10.0, "move stay",
    )  # fmt: skip


def test_robots_and_things_have_their_symbols():
    drone = MapSymbol(("urn:test", "Quad"), "drone", "#1f6fb2", "D")
    quad = replace(QUAD, metaclasses=(drone.metaclass,))
    tree = Part((("urn:test", "OldTree"),), {"name": "oak", "position": (1.0, 2.0, 0.0)})
    program = Program("relay", Frame("EPSG:4326", None, None), (A, B))
    symbols = {drone.metaclass: drone}
    shown = picture_of_run(
        program, RECORDS, TRACKS, KINDS, symbols, BehaviourContext({"quad": quad}, elements=(tree,))
    )
    assert shown.robots[0].symbol == drone
    assert [(thing.name, thing.symbol.label) for thing in shown.elements] == [("oak", "old tree")]


def test_actions_are_where_the_robot_was(shown):
    assert shown.robots[0].legs[1].actions == ((10.0, 0.0, 5.0),)


def test_time_is_told_by_what_it_was_spent_on(shown):
    assert [(bar.kind, bar.begin, bar.end) for bar in shown.robots[0].bars] == [
        ("launch", 0.0, 5.0),
        ("work", 5.0, 7.0),
        ("work", 7.0, 8.0),
    ]
    assert [(bar.kind, bar.begin, bar.end) for bar in shown.robots[1].bars] == [
        ("wait", 0.0, 8.0),
        ("hold", 8.0, 10.0),
    ]


def test_a_notify_that_ended_a_wait_is_a_handover(shown):
    assert [(h.sender, h.sent, h.receiver, h.since, h.released, h.note) for h in shown.handovers] == [
        ("a", 8.0, "b", 0.0, 8.0, "photo")
    ]


def test_areas_are_grown_by_clearance_and_safety_distance(shown):
    assert shown.zones[0].clearance == 1.5


def test_where_types_or_the_context_are_unknown_the_picture_says_so():
    program = Program("relay", Frame("EPSG:4326", None, None), (A, replace(B, type_name="sub")))
    tree = Area("tree", AreaUse.OBSTACLE, ((20.0, 0.0), (21.0, 0.0), (21.0, 1.0)), 0.0, 9.0, 1.0)

    def gaps(types, areas):
        shown = picture_of_run(program, RECORDS, TRACKS, KINDS, {}, BehaviourContext(types, areas))
        return [bool(zone.kept) for zone in shown.zones], [(gap.what, gap.reason) for gap in shown.gaps]

    some, none = "unknown; only that of other robots is drawn", "unknown; none is drawn"
    assert gaps({"quad": QUAD}, (tree,)) == ([True], [("clearance of b", some)])
    assert gaps({}, (tree,)) == ([False], [("clearance of a, b", none)])
    assert gaps({"quad": QUAD}, None)[1][0][0] == "context"


def test_the_run_ends_with_its_last_step(shown):
    assert shown.makespan == 10.0


def test_a_robot_without_track_still_has_its_times():
    program = Program("relay", Frame("EPSG:4326", None, None), (A, B))
    shown = picture_of_run(program, RECORDS, {}, KINDS, {}, BehaviourContext({}))
    assert shown.robots[0].legs == ()
    assert len(shown.robots[0].bars) == 3
