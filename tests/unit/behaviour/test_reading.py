"""From behaviour models to programs."""

from itertools import pairwise

import pytest

from mmrs_core.behaviour.program import Transition
from mmrs_core.behaviour.reading import program_of
from mmrs_core.errors import InvalidModelError
from mmrs_core.languages import behaviour as bl
from mmrs_core.languages import robot as rl
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.registry import core_registry
from mmrs_core.scene import Policy

REGISTRY = core_registry()


def robot(id="r", moves=(), *, transitions=None, slots=(), **more):
    """Return a robot that makes the moves in a row between Start and Stop."""
    every = [bl.Start(), *moves, bl.Stop()]
    if transitions is None:
        transitions = [bl.MoveTransition(from_=a, to=b) for a, b in pairwise(every)]
    return bl.Robot(id=id, typeName="t", moves=every, moveTransitions=transitions, slots=slots, **more)


def read(*robots, **more):
    return program_of(bl.Behaviour(robots=robots, **more), registry=REGISTRY)


def faults(*robots, code="BL000", **more):
    with pytest.raises(InvalidModelError) as caught:
        read(*robots, **more)
    assert {fault.code for fault in caught.value.diagnostics} == {code}
    return [(fault.place.path, fault.message) for fault in caught.value.diagnostics]


def test_moves_keep_their_names_or_get_their_number():
    moves = (
        read(robot(moves=[bl.HoldPosition(name="rest", duration=1), bl.HoldPosition(duration=2)]))
        .robots[0]
        .moves
    )
    assert [move.id for move in moves] == ["moves.0", "rest", "moves.2", "moves.3"]


def test_start_stop_and_transitions_are_indices():
    each = read(robot(moves=[bl.HoldPosition(duration=1)])).robots[0]
    assert (each.start, each.stop) == (0, 2)
    assert {source: t.to for source, t in each.transitions.items()} == {0: 1, 1: 2}


def test_a_choice_a_wait_and_a_policy_are_read():
    slot, a, b = bl.Slot(name="s"), bl.HoldPosition(duration=1), bl.HoldPosition(duration=1)
    start, stop = bl.Start(), bl.Stop()
    policy = rl.Policy(event="WAIT_TOO_LONG", response="LAND", after=9.0)
    choice = bl.Choice(
        from_=start, to=a, falseBranch=b, conditionIdentifier="c", waitFor=[slot, slot], policies=[policy]
    )
    rest = [bl.MoveTransition(from_=a, to=stop, fluid=True), bl.MoveTransition(from_=b, to=stop)]
    each = read(
        bl.Robot(
            id="r", typeName="t", moves=[start, a, b, stop], moveTransitions=[choice, *rest], slots=[slot]
        )
    ).robots[0]
    assert each.slots == ("s",)
    first = each.transitions[0]
    assert (first.condition, first.to, first.otherwise, first.waits) == ("c", 1, 2, ("s",))
    assert first.policies == (Policy("WAIT_TOO_LONG", "LAND", 9.0),)
    assert each.transitions[1].fluid
    assert isinstance(each.transitions[2], Transition)
    assert not each.transitions[2].fluid


def notified(notify, *slots):
    robots = [robot("a", [bl.HoldPosition(duration=1, postActions=[notify])], slots=slots[:2])]
    robots += [robot("b", slots=slots[2:])]
    return read(*robots).robots[0].moves[1].after[0]


def three_slots():
    return bl.Slot(name="go"), bl.Slot(name="other"), bl.Slot(name="go")


def test_a_unicast_sets_the_slot_of_its_owner():
    slots = three_slots()
    assert notified(bl.UnicastNotify(slot=slots[2]), *slots).sets == (("b", "go"),)


def test_a_multicast_sets_each_of_its_slots_once():
    slots = three_slots()
    action = notified(bl.MulticastNotify(slots=[slots[2], slots[1]], active=False), *slots)
    assert action.sets == (("b", "go"), ("a", "other"))
    assert action.active is False


def test_a_broadcast_reaches_the_slot_of_that_name_in_every_robot_the_sender_included():
    slots = three_slots()
    assert notified(bl.BroadcastNotify(slot=slots[2]), *slots).sets == (("a", "go"), ("b", "go"))
    slots = three_slots()
    assert notified(bl.BroadcastNotify(slot=slots[1]), *slots).sets == (("a", "other"),)


def test_actions_keep_their_parameters():
    pairs = [bl.Pair(key="zoom", value="2")]
    device = bl.DeviceAction(actionName="shoot", deviceId="cam", parameters=pairs)
    feedback = bl.Feedback(payload=[bl.Pair(key="k", value="v")])
    move = read(robot(moves=[bl.HoldPosition(duration=1, preActions=[device], postActions=[feedback])]))
    move = move.robots[0].moves[1]
    assert (move.before[0].name, move.before[0].device, move.before[0].parameters) == (
        "shoot",
        "cam",
        (("zoom", "2"),),
    )
    assert move.after[0].parameters == (("k", "v"),)
    assert move.before[0].place.path == "/robots[0]/moves[1]/preActions[0]"


def position(target, *others, **more):
    each = read(robot(moves=[bl.GoTo(target=target)]), targets=[target, *others], **more)
    return each.robots[0].moves[1].target.position


def test_relative_coordinates_add_up_along_their_references():
    first = bl.RelativeCoordinate(x=1, y=2, z=3)
    second = bl.RelativeCoordinate(x=10, y=0, z=0, reference=first)
    third = bl.RelativeCoordinate(x=0, y=0, z=-1, reference=second)
    assert position(third, second, first) == (11, 2, 2)


def test_geographic_coordinates_lie_in_metres_from_the_origin():
    origin = bl.GeoCoordinate(latitude=42.37, longitude=13.35, altitude=700.0)
    target = bl.GeoCoordinate(latitude=42.371, longitude=13.35, altitude=730.0)
    east, north, up = position(target, origin, origin=origin)
    assert east == pytest.approx(0.0, abs=1e-3)
    assert north == pytest.approx(111.08, abs=0.05)
    assert up == pytest.approx(30.0)


def test_the_first_home_is_the_origin_where_none_is_given():
    home = bl.GeoCoordinate(latitude=42.37, longitude=13.35)
    target = bl.GeoCoordinate(latitude=42.37, longitude=13.36, altitude=5.0)
    behaviour = bl.Behaviour(
        altitudeReference="ORIGIN",
        robots=[robot("a"), robot("b", [bl.GoTo(target=target)], home=home)],
        targets=[home, target],
    )
    program = program_of(behaviour, registry=REGISTRY)
    assert program.robots[0].home is None
    assert program.robots[1].home == pytest.approx((0.0, 0.0, 0.0))
    assert program.robots[1].moves[1].target.position[2] == 5.0


def test_depth_counts_down_from_the_surface():
    origin = bl.GeoCoordinate(latitude=42.37, longitude=13.35)
    target = bl.GeoCoordinate(latitude=42.37, longitude=13.35, depth=4.0)
    assert position(target, origin, origin=origin, surfaceHeight=-1.5)[2] == -5.5


def test_a_relative_coordinate_may_count_from_a_geographic_one():
    origin = bl.GeoCoordinate(latitude=42.37, longitude=13.35)
    near = bl.RelativeCoordinate(x=3, y=4, z=5, reference=origin)
    assert position(near, origin, origin=origin) == pytest.approx((3, 4, 5))


def test_an_object_keeps_its_description_and_where_it_is_expected():
    place = bl.RelativeCoordinate(x=1, y=2, z=3)
    known = bl.ObjectTarget(description="wreck", expectedAt=place, tolerance=2.0, name="w")
    unknown = bl.ObjectTarget(description="fish")
    moves = [bl.GoTo(target=known, distance=1.5, speed=0.5), bl.GoTo(target=unknown)]
    _, to_known, to_unknown, _ = read(robot(moves=moves), targets=[place, known, unknown]).robots[0].moves
    assert to_known.target.position == (1, 2, 3)
    assert (to_known.target.description, to_known.target.tolerance) == ("wreck", 2.0)
    assert (to_known.distance, to_known.speed) == (1.5, 0.5)
    assert (to_unknown.target.position, to_unknown.target.tolerance) == (None, None)


def test_a_heading_is_read_with_its_device_and_angle():
    look = bl.RelativeCoordinate(x=1, y=2, z=3)
    turn = bl.HeadTo(heading=bl.Heading(target=look, deviceId="cam", angle=90.0))
    heading = read(robot(moves=[turn]), targets=[look]).robots[0].moves[1].heading
    assert (heading.device, heading.angle_degrees, heading.target.position) == ("cam", 90.0, (1, 2, 3))


def test_the_behaviours_own_figures_are_kept():
    program = read(
        robot(policies=[rl.Policy(event="LINK_LOST", response="RETURN")], payload=1.5, travelMode="SAFE"),
        name="b",
        positionError=0.5,
        minimumSeparation=4.0,
        reserve=0.3,
        acceptedUnknowns=["range"],
    )
    assert (program.name, program.position_error, program.minimum_separation) == ("b", 0.5, 4.0)
    assert (program.reserve, program.accepted_unknowns) == (0.3, ("range",))
    each = program.robots[0]
    assert (each.payload, each.travel_mode, each.policies[0].response) == (1.5, "SAFE", "RETURN")


XMI = b"""<?xml version="1.0" encoding="UTF-8"?>
<behaviour:Behaviour xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:behaviour="urn:mmrs:behaviour:1.0">
  <robots id="r" typeName="t">
    <moves xsi:type="behaviour:Start"/>
    <moves xsi:type="behaviour:HoldPosition" duration="2.5"/>
    <moves xsi:type="behaviour:Stop"/>
    <moveTransitions from="//@robots.0/@moves.0" to="//@robots.0/@moves.1"/>
    <moveTransitions from="//@robots.0/@moves.1" to="//@robots.0/@moves.2"/>
  </robots>
</behaviour:Behaviour>
"""


def test_everything_knows_the_line_that_it_was_read_from():
    model = read_text(XMI, "b.xmi", REGISTRY)
    each = program_of(model.roots[0], registry=REGISTRY).robots[0]
    assert each.moves[1].attributes == {"duration": 2.5}
    assert (str(each.place), str(each.moves[1].place), str(each.transitions[1].place)) == (
        "b.xmi:4",
        "b.xmi:6",
        "b.xmi:9",
    )


def test_a_behaviour_without_robots_is_refused():
    assert faults() == [("/", "Behaviour has no robots")]


@pytest.mark.parametrize(
    ("moves", "wrong"),
    [
        ([bl.Stop], "has 0 moves of kind Start"),
        ([bl.Start], "has 0 moves of kind Stop"),
        ([bl.Start, bl.Start, bl.Stop], "has 2 moves of kind Start"),
    ],
)
def test_a_robot_has_one_start_and_one_stop(moves, wrong):
    made = [kind() for kind in moves]
    found = faults(bl.Robot(id="r", typeName="t", moves=made))
    assert any(wrong in message for _, message in found)


def test_every_move_but_stop_has_one_way_on():
    rest = bl.HoldPosition(duration=1)
    start, stop = bl.Start(), bl.Stop()
    two = [bl.MoveTransition(from_=start, to=rest), bl.MoveTransition(from_=start, to=stop)]
    each = bl.Robot(id="r", typeName="t", moves=[start, rest, stop], moveTransitions=two)
    assert faults(each) == [
        (
            "/robots[0]/moveTransitions[1]",
            "MoveTransition robots[0]/moveTransitions[1]"
            " leaves a move that another transition leaves already",
        ),
        ("/robots[0]/moves[1]", "HoldPosition robots[0]/moves[1] is followed by no move, and is not a Stop"),
    ]


def test_nothing_leaves_a_stop_or_leads_into_a_start():
    start, stop = bl.Start(), bl.Stop()
    back = [bl.MoveTransition(from_=start, to=stop), bl.MoveTransition(from_=stop, to=start)]
    each = bl.Robot(id="r", typeName="t", moves=[start, stop], moveTransitions=back)
    assert [message for _, message in faults(each)] == [
        "MoveTransition robots[0]/moveTransitions[1] leaves a Stop or leads into a Start"
    ]


def test_transitions_stay_inside_their_robot():
    first, second = robot("a"), robot("b")
    first.moveTransitions[0].to = second.moves[1]
    assert any("has no move of robot 'a' at 'to'" in message for _, message in faults(first, second))


def test_robots_wait_for_own_slots_only():
    first, second = robot("a"), robot("b", slots=[bl.Slot(name="s")])
    first.moveTransitions[0].waitFor = [second.slots[0]]
    assert any("waits for slot 's', which robot 'a' does not have" in m for _, m in faults(first, second))


def test_a_notify_leads_to_a_slot():
    lost = bl.UnicastNotify(slot=bl.Slot(name="nowhere"))
    found = faults(robot(moves=[bl.HoldPosition(duration=1, preActions=[lost, bl.MulticastNotify()])]))
    assert [message.split(" ", 2)[2] for _, message in found] == [
        "notifies a slot that no robot has",
        "notifies no slot",
    ]


@pytest.mark.parametrize(
    "robots",
    [
        lambda: [robot("a"), robot("a")],
        lambda: [robot("a", [bl.HoldPosition(name="h", duration=1), bl.HoldPosition(name="h", duration=1)])],
        lambda: [robot("a", slots=[bl.Slot(name="h"), bl.Slot(name="h")])],
    ],
)
def test_names_that_tell_apart_are_unique(robots):
    assert len([m for _, m in faults(*robots()) if "must be unique" in m]) == 2


def test_coordinates_that_count_from_each_other_in_a_circle_are_refused():
    a = bl.RelativeCoordinate(x=1, y=0, z=0)
    b = bl.RelativeCoordinate(x=1, y=0, z=0, reference=a)
    a.reference = b
    c = bl.RelativeCoordinate(x=1, y=0, z=0, reference=b)
    found = faults(robot(), code="GND001", targets=[a, b, c])
    assert {path for path, _ in found} == {"/targets[0]", "/targets[1]", "/targets[2]"}
    assert any("counts from itself in a cycle" in message for _, message in found)


@pytest.mark.parametrize(
    ("target", "wrong"),
    [
        ({"latitude": 91.0, "longitude": 0.0}, "has no latitude"),
        (
            {"latitude": 42.0, "longitude": 13.0, "altitude": 1.0, "depth": 1.0},
            "both an altitude and a depth",
        ),
        ({"latitude": 42.0, "longitude": 13.0, "altitude": 5.0}, "the origin has none to compare it with"),
    ],
)
def test_geographic_coordinates_that_have_no_place_are_refused(target, wrong):
    origin = bl.GeoCoordinate(latitude=42.0, longitude=13.0)
    ((path, message),) = faults(
        robot(), code="GND001", targets=[origin, bl.GeoCoordinate(**target)], origin=origin
    )
    assert path == "/targets[1]"
    assert wrong in message


def test_geographic_targets_of_a_local_behaviour_are_refused():
    origin = bl.RelativeCoordinate(x=0, y=0, z=0)
    target = bl.GeoCoordinate(latitude=42.0, longitude=13.0)
    ((_, message),) = faults(robot(), code="GND001", targets=[origin, target], origin=origin)
    assert "is geographic" in message


def test_an_unknown_crs_is_refused():
    origin = bl.GeoCoordinate(latitude=42.0, longitude=13.0)
    ((_, message),) = faults(robot(), code="GND001", targets=[origin], origin=origin, crs="EPSG:moon")
    assert "crs 'EPSG:moon' is not known" in message


def test_a_target_of_another_behaviour_is_refused_not_taken_for_an_unknown_place():
    foreign = bl.RelativeCoordinate(x=0, y=0, z=0)
    ((_, message),) = faults(robot(moves=[bl.GoTo(target=foreign)]))
    assert "is not a target of this behaviour" in message


def test_a_goto_without_a_target_and_a_turn_without_a_heading_are_refused():
    found = faults(robot(moves=[bl.GoTo(), bl.HeadTo()]))
    assert ["goes to no target" in found[0][1], "has no heading" in found[1][1]] == [True, True]
