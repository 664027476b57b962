import json
from dataclasses import replace
from itertools import pairwise
from math import degrees, dist, radians

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from imc_reader import FORMS, check_sum, read_packet, smallest
from marine_programs import MANY_PROGRAMS, inputs, rendered
from mmrs_imc.messages import DEFINITIONS, Message, crc16, packet, payload
from mmrs_imc.target import IMC
from mmrs_multicopter.testing import robot_program
from pyproj import Geod

from mmrs_core.behaviour.program import MoveTarget, Transition
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.render import render
from mmrs_core.scene import Frame
from mmrs_core.testing.programs import move

RELAXED = settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
WGS84 = Geod(ellps="WGS84")
SONAR = {
    "imc__entity": "Sidescan",
    "imc__set__Record": "Active=true; Range=50",
    "imc__set__Stop": "Active=false",
}


def plan(input, robot="naiad", lossy=False):
    """Return a robot's plan as it is read back."""
    written = {file.path: file.content for file in render(IMC, input, allow_lossy=lossy)}
    found = read_packet(written[f"{robot}.imc"])
    request = read_packet(written[f"{robot}.load.imc"])
    assert (request["type"], request["op"], request["plan_id"]) == (0, 0, found["plan_id"])
    assert request["arg"] == found
    return found


def maneuvers(found):
    return [each["data"] for each in found["maneuvers"]]


def way(found):
    """Return the manoeuvres' identifiers in the order in which the plan has them, and what ends it."""
    after = {each["source_man"]: each["dest_man"] for each in found["transitions"]}
    assert len(after) == len(found["transitions"])
    assert {each["conditions"] for each in found["transitions"]} == {"ManeuverIsDone"}
    passed = [found["start_man_id"]]
    while after[passed[-1]] != "_done_" and after[passed[-1]] not in passed:
        passed.append(after[passed[-1]])
    return [*passed, after[passed[-1]]]


@pytest.mark.parametrize("number", FORMS)
def test_messages_have_the_sizes_of_their_published_definitions(number):
    name, size, _ = FORMS[number]
    assert smallest(number) == size
    empty = {"plaintext": "", "message": None, "message-list": (), "uint8": 0, "uint16": 0}
    values = {
        field.name: empty.get(field.kind, 1.0 if field.name == "radius" else 0.0)
        for field in DEFINITIONS[name].fields
    }
    assert DEFINITIONS[name].number == number
    assert len(payload(Message(name, values))) == size


@given(st.binary(max_size=64))
def test_the_check_sum_is_that_of_the_polynomial(data):
    assert crc16(data) == check_sum(data)


def test_places_are_in_radians_and_metres_below_the_surface(given, dive):
    (goto,) = maneuvers(plan(given(dive("a", 0.0, 1000.0, 12.5))))
    assert goto[""] == "Goto"
    assert degrees(goto["lat"]) == pytest.approx(41.18 + 1000.0 / 111_066.0, abs=1e-5)
    assert degrees(goto["lon"]) == pytest.approx(-8.7, abs=1e-7)
    assert (goto["z"], goto["z_units"]) == (12.5, 1)
    assert (goto["speed"], goto["speed_units"]) == (1.0, 0)
    assert (goto["roll"], goto["pitch"], goto["yaw"]) == (-1.0, -1.0, -1.0)
    assert goto["timeout"] > 1000.0


def test_moves_follow_each_other_to_the_end_of_the_plan(given, dive):
    found = plan(given(dive("a", 10.0, 0.0, 5.0), dive("b", 10.0, 10.0, 5.0), dive("c", 0.0, 10.0, 5.0)))
    assert way(found) == ["a", "b", "c", "_done_"]
    assert found["plan_id"] == "naiad"


def test_a_hold_keeps_station_at_its_depth_and_pops_up_at_the_surface(given, dive):
    hold = move("h", "HoldPosition", duration=7.2)
    (_, stay) = maneuvers(plan(given(dive("a", 9.0, 0.0, 5.0), hold)))
    assert (stay[""], stay["z"], stay["duration"]) == ("StationKeeping", 5.0, 8)
    (rise, fix) = maneuvers(plan(given(dive("a", 9.0, 0.0, 0.0), hold)))
    assert (rise["z"], fix[""], fix["duration"], fix["flags"]) == (0.0, "PopUp", 8, 7)


def test_a_hold_of_no_duration_makes_no_manoeuvre_that_never_ends(given, dive):
    found = plan(given(dive("a", 9.0, 0.0, 5.0), move("h", "HoldPosition", duration=0.0)))
    assert way(found) == ["a", "_done_"]


def test_a_robot_stops_short_of_a_target(given, dive):
    whole, short = (maneuvers(plan(given(dive("a", 100.0, 0.0, 0.0, distance=d))))[0] for d in (0.0, 25.0))
    home = radians(-8.7)
    assert (short["lon"] - home) / (whole["lon"] - home) == pytest.approx(0.75, abs=1e-4)


def test_actions_set_parameters_of_entities_around_their_move(given, dive, does, swimmer):
    moved = dive("a", 9.0, 0.0, 5.0, before=(does(),), after=(does("Stop"),))
    (found,) = plan(given(moved, type=swimmer(**SONAR)))["maneuvers"]
    (begin,), (end,) = found["start_actions"], found["end_actions"]
    assert begin["name"] == "Sidescan"
    assert [(each["name"], each["value"]) for each in begin["params"]] == [
        ("Active", "true"),
        ("Range", "50"),
    ]
    assert [(each["name"], each["value"]) for each in end["params"]] == [("Active", "false")]


def test_an_action_that_takes_time_is_waited_for(given, dive, does, swimmer):
    moved = dive("a", 9.0, 0.0, 5.0, after=(does(),))
    found = plan(given(moved, type=swimmer(3.5, **SONAR)))
    assert [each[""] for each in maneuvers(found)] == ["Goto", "StationKeeping"]
    assert maneuvers(found)[1]["duration"] == 4
    assert len(found["maneuvers"][1]["start_actions"]) == 1


def test_what_stands_between_two_holds_of_nothing_is_still_set(given, dive, does, swimmer):
    still = replace(move("h", "HoldPosition", duration=0.0), before=(does(),))
    found = plan(given(still, dive("a", 9.0, 0.0, 5.0), type=swimmer(**SONAR)))
    first = found["maneuvers"][0]
    assert (first["data"][""], first["data"]["duration"], len(first["start_actions"])) == ("PopUp", 1, 1)


def test_moves_that_come_round_again_make_a_ring(given, dive):
    moves = [dive("a", 9.0, 0.0, 5.0), dive("b", 9.0, 9.0, 5.0)]
    found = plan(given(*moves, transitions={2: Transition(2, 1)}))
    assert way(found) == ["a", "b", "a"]


def test_with_losses_a_wait_holds_without_end_and_a_choice_ends_the_plan(given, dive):
    moves = [dive("a", 9.0, 0.0, 5.0), dive("b", 9.0, 9.0, 5.0), dive("c", 0.0, 9.0, 5.0)]
    waits = Transition(1, 2, waits=("go",))
    chooses = Transition(2, 3, condition="calm", otherwise=4)
    input = given(*moves, slots=("go",), transitions={1: waits, 2: chooses})
    with pytest.raises(UnsupportedError) as refusal:
        render(IMC, input)
    assert [each.partition(": ")[2] for each in refusal.value.elements] == [
        "waits for go, which only an operator can do in a plan",
        "chooses by 'calm', of which vehicles know nothing",
    ]
    found = plan(input, lossy=True)
    assert [each[""] for each in maneuvers(found)] == ["Goto", "StationKeeping", "Goto"]
    assert maneuvers(found)[1]["duration"] == 0
    assert way(found)[-1] == "_done_"


@pytest.mark.parametrize("name", ["a,b", ".", "_done_", "bucht\n", "Ufer ü", "'; drop", "x" * 300])
def test_names_that_would_mean_something_else_are_written_as_others(given, dive, name):
    found = plan(given(dive(name, 9.0, 0.0, 5.0), dive("a_b", 9.0, 9.0, 5.0)))
    ids = [each["maneuver_id"] for each in found["maneuvers"]]
    assert way(found) == [*ids, "_done_"]
    assert not {",", "."} & set("".join(ids))
    assert "_done_" not in ids


@RELAXED
@given(data=st.data())
def test_any_journey_is_read_back_as_it_was_written(data, given, dive):
    places = data.draw(
        st.lists(
            st.tuples(st.floats(-5e3, 5e3), st.floats(-5e3, 5e3), st.floats(0.0, 300.0)),
            min_size=1,
            max_size=8,
        )
    )
    found = plan(given(*(dive(f"m{i}", *place) for i, place in enumerate(places))))
    assert way(found) == [*(f"m{i}" for i in range(len(places))), "_done_"]
    depths = [each["z"] for each in maneuvers(found)]
    assert depths == pytest.approx([place[2] for place in places], abs=1e-3)


def test_every_robot_has_a_plan_of_its_own(given, dive):
    more = {"home": (0.0, 0.0, -2.0), "type_name": "Diver"}
    robots = [robot_program(name, [dive("a", 9.0, 0.0, 5.0)], **more) for name in ("one", "two")]
    assert plan(given(*robots), "one")["plan_id"] == "one"
    assert plan(given(*robots), "two")["plan_id"] == "two"


def test_the_plan_for_people_says_the_same(given, dive):
    written = {file.path: file.content for file in render(IMC, given(dive("a", 9.0, 0.0, 5.0)))}
    shown = json.loads(written["naiad.json"])
    read = read_packet(written["naiad.imc"])
    assert shown["maneuvers"][0]["data"]["lat"] == read["maneuvers"][0]["data"]["lat"]
    assert shown["transitions"][0]["dest_man"] == "_done_"


@pytest.mark.parametrize(
    ("values", "wrong"),
    [
        ({"lat": 41.0}, "lat"),
        ({"timeout": 70_000}, "timeout"),
        ({"timeout": 1.5}, "timeout"),
        ({"speed": float("nan")}, "speed"),
        ({"custom": "ü"}, "custom"),
        ({"z_units": 4}, "z_units"),
    ],
)
def test_values_that_a_field_does_not_hold_are_refused(values, wrong):
    good = {"timeout": 1, "lat": 0.1, "lon": 0.1, "z": 1.0, "z_units": 1, "speed": 1.0, "speed_units": 0}
    whole = {**good, "roll": -1.0, "pitch": -1.0, "yaw": -1.0, "custom": ""}
    assert packet(Message("Goto", whole))
    with pytest.raises(ValueError, match=rf"Goto\.{wrong}"):
        packet(Message("Goto", {**whole, **values}))


def test_a_plan_that_no_packet_holds_is_refused(given, dive):
    moves = [dive(f"m{index}", float(index), 0.0, 5.0) for index in range(800)]
    with pytest.raises(UnsupportedError, match=r"takes [\d,]+ bytes, a message of IMC holds 65,535"):
        render(IMC, given(*moves))


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"target": MoveTarget((9.0, 0.0, 5.0))}, "leads 7 m above the surface"),
        (
            {"target": MoveTarget((9.0, 0.0, -5.0), "a buoy", 1.0)},
            "object 'a buoy', which a plan cannot have",
        ),
        ({"target": MoveTarget((9.0, 0.0, -12_000.0))}, "leads 11998 m below the surface, and no sea is"),
        ({"target": MoveTarget((9.0, 0.0, -1e39))}, "leads 1e[+]39 m below the surface, and no sea is"),
        ({"speed": 0.0}, "its speed of 0 m/s is not from 0.01 to 100"),
        ({"speed": 4e-4}, "its speed of 0 m/s is not from 0.01 to 100"),
        ({"speed": 1e39}, "its speed of 1e[+]39 m/s is not from 0.01 to 100"),
        ({"target": MoveTarget((70_000.0, 0.0, -7.0))}, "takes 70,000 s, of 65,475 at most"),
    ],
)
def test_what_plans_cannot_express_is_told_with_its_move(given, dive, changes, why):
    with pytest.raises(UnsupportedError, match=why):
        render(IMC, given(dive("a", 9.0, 0.0, 5.0, **changes)))


def test_an_action_that_takes_longer_than_manoeuvres_may_is_refused(given, dive, does, swimmer):
    moved = dive("a", 9.0, 0.0, 5.0, after=(does(),))
    with pytest.raises(UnsupportedError, match="action 'Record' takes 70,000 s, of 65,535 at most"):
        render(IMC, given(moved, type=swimmer(70_000.0, **SONAR)))


@pytest.mark.parametrize(
    "changes", [{"speed": 1e39}, {"speed": 0.0}, {"target": MoveTarget((9.0, 0.0, -1e39))}]
)
def test_with_losses_what_no_plan_holds_is_as_near_to_it_as_a_plan_can(given, dive, changes):
    (goto,) = maneuvers(plan(given(dive("a", 9.0, 0.0, 5.0, **changes)), lossy=True))
    assert 0.0 < goto["speed"] <= 100.0
    assert goto["z"] <= 11_000.0


@pytest.mark.parametrize(
    "origin", [(0.0, 180.0), (12.0, -180.0), (-60.0, 179.9999), (88.9, 0.0), (-89.9, 77.0)]
)
def test_places_are_as_far_apart_as_they_were_meant_wherever_on_the_earth_that_is(given, dive, origin):
    places = [(800.0, 0.0), (800.0, 600.0), (-800.0, -600.0)]
    frame = Frame("EPSG:4326", *origin, 0.0, "MSL", surface=-2.0)
    found = maneuvers(plan(given(*(dive(f"m{i}", *p, 5.0) for i, p in enumerate(places)), frame=frame)))
    here = [(0.0, 0.0), *places]
    on_earth = [origin, *((degrees(each["lat"]), degrees(each["lon"])) for each in found)]
    for (a, b), (one, other) in zip(pairwise(here), pairwise(on_earth), strict=True):
        _, _, metres = WGS84.inv(one[1], one[0], other[1], other[0])
        assert metres == pytest.approx(dist(a, b), rel=2e-3)


def test_a_local_behaviour_has_no_plan(given, dive):
    with pytest.raises(UnsupportedError, match="is local"):
        render(IMC, given(dive("a", 9.0, 0.0, 5.0), frame=Frame("EPSG:4326", None, None)), allow_lossy=True)


@MANY_PROGRAMS
@given(data=st.data())
def test_every_manoeuvre_leads_to_one_that_is_there_or_to_the_end(data, given):
    files = rendered(IMC, data.draw(inputs(given)))
    if files is None:
        return
    plan = read_packet(files["naiad.imc"])
    ids = [each["maneuver_id"] for each in plan["maneuvers"]]
    assert len(set(ids)) == len(ids)
    assert plan["start_man_id"] == ids[0]
    assert [each["source_man"] for each in plan["transitions"]] == ids
    assert {each["dest_man"] for each in plan["transitions"]} <= {*ids, "_done_"}
