import json
from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, go_to, quad, robot_program, take_off, target_input, two_drones

from mmrs_core.behaviour.program import Heading, MoveTarget, Transition
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.planned_moves import planned_moves
from mmrs_core.generation.render import render
from mmrs_core.geometry.frames import LocalFrame
from mmrs_core.scene import Device, Frame, Policy
from mmrs_core.testing.programs import L_AQUILA, feedback, move, photo, program
from mmrs_mavlink.plugin.plans.qgc import QGC_PLAN
from mmrs_mavlink.plugin.plans.times import sortie_seconds, too_long


def plans(*moves, allow_lossy=False, transitions=None, frame=L_AQUILA, home=(0.0, 0.0, 0.0)):
    robot = robot_program("alpha", moves, transitions=transitions, home=home)
    given = target_input(program(robot, frame=frame))
    files = render(QGC_PLAN, given, allow_lossy=allow_lossy)
    return {file.path: json.loads(file.content) for file in files}


def items(plan):
    return [(item["command"], item["params"]) for item in plan["mission"]["items"]]


def refused(*moves, **options):
    with pytest.raises(UnsupportedError) as error:
        plans(*moves, **options)
    return error.value.elements


def test_a_flight_takes_off_goes_and_lands():
    plan = plans(take_off("up", 20.0), go_to("a", (0.0, 30.0, 25.0)), LAND)["alpha.plan"]
    assert [command for command, _ in items(plan)] == [22, 178, 16, 21]


def test_heights_are_above_the_robots_home():
    plan = plans(take_off("up", 20.0), go_to("a", (0.0, 30.0, 25.0)), LAND, home=(0.0, 0.0, 5.0))[
        "alpha.plan"
    ]
    assert [params[6] for command, params in items(plan) if command != 178] == [20.0, 20.0, 0.0]
    assert plan["mission"]["plannedHomePosition"] == [42.37, 13.35, 725.0]


def test_places_are_degrees_with_seven_decimals():
    plan = plans(take_off("up", 20.0), go_to("a", (40.0, 30.0, 25.0)), LAND)["alpha.plan"]
    _, params = items(plan)[2]
    expected = LocalFrame("EPSG:4326", 42.37, 13.35).to_geographic([(40.0, 30.0)])[0]
    assert params[4:6] == [round(expected[0], 7), round(expected[1], 7)]


def test_every_item_is_traced_to_its_move():
    files = plans(take_off("up", 20.0), go_to("a", (0.0, 30.0, 25.0), task="photos"), LAND)
    trace = files["qgc-plan.manifest.json"]["trace"]
    assert [(t["step"], t["move"], t["task"]) for t in trace] == [
        ("item 1", "up", ""),
        ("item 2", "a", "photos"),
        ("item 3", "a", "photos"),
        ("item 4", "down", ""),
    ]


def test_a_trajectory_in_two_legs_has_two_waypoints():
    goes = go_to("a", (0.0, 30.0, 25.0), trajectory="VERTICAL_FIRST")
    plan = plans(take_off("up", 20.0), goes, LAND)["alpha.plan"]
    assert [params[4:] for command, params in items(plan) if command == 16] == [
        [42.37, 13.35, 25.0],
        [42.3702701, 13.35, 25.0],
    ]


def test_a_distance_from_the_target_is_kept():
    goes = replace(go_to("a", (0.0, 30.0, 20.0)), distance=10.0)
    plan = plans(take_off("up", 20.0), goes, LAND)["alpha.plan"]
    north = (items(plan)[2][1][4] - 42.37) * 111_080
    assert north == pytest.approx(20.0, abs=0.05)


def test_an_action_follows_its_waypoint():
    goes = replace(go_to("a", (0.0, 30.0, 20.0)), after=(photo(),))
    plan = plans(take_off("up", 20.0), goes, LAND)["alpha.plan"]
    assert [command for command, _ in items(plan)] == [22, 178, 16, 2000, 19, 21]


def test_an_ardupilot_which_cuts_off_fractions_stays_for_the_next_whole_second():
    holds = [move(f"hold {n}", "HoldPosition", duration=n) for n in (0.5, 2.0, 2.25)]
    plan = plans(take_off("up", 20.0), *holds, LAND)["alpha.plan"]
    assert [params[0] for command, params in items(plan) if command == 19] == [1.0, 2.0, 3.0]


def test_a_heading_is_a_region_of_interest_until_it_ends():
    looks = go_to("a", (0.0, 30.0, 20.0), heading=Heading(MoveTarget((5.0, 5.0, 0.0)), "camera"))
    plan = plans(take_off("up", 20.0), looks, go_to("b", (0.0, 0.0, 20.0)), LAND)["alpha.plan"]
    assert [command for command, _ in items(plan)] == [22, 178, 195, 16, 197, 16, 21]


@pytest.mark.parametrize(("properties", "looks"), [({"mavlink.gimbal": "1"}, [195, 195]), ({}, [])])
def test_a_ground_vehicle_looks_by_its_gimbal_or_not_at_all(properties, looks):
    heading = Heading(MoveTarget((5.0, 5.0, 0.0)), "camera")
    moves = [go_to("a", (0.0, 30.0, 0.0), heading=heading), replace(move("b", "HeadTo"), heading=heading)]
    camera = Device("camera", {}, properties)
    crawler = replace(quad(), metaclasses=(("urn:mmrs:robot:1.0", "Robot"),), devices={"camera": camera})
    given = target_input(program(robot_program("alpha", moves)), [crawler])
    (plan,) = [
        json.loads(file.content)
        for file in render(QGC_PLAN, given, allow_lossy=True)
        if file.path == "alpha.plan"
    ]
    commands = [command for command, _ in items(plan)]
    assert 115 not in commands
    assert [command for command in commands if command == 195] == looks


def test_the_speed_of_the_travel_mode_stands_where_the_move_gives_none():
    plan = plans(take_off("up", 20.0), go_to("a", (0.0, 30.0, 20.0), speed=None), LAND)["alpha.plan"]
    assert items(plan)[1] == (178, [1.0, 6.0, -1.0, 0.0, 0.0, 0.0, 0.0])


def test_a_second_sortie_is_a_second_plan():
    files = plans(
        take_off("up", 20.0),
        LAND,
        move("charge", "Recharge", duration=3600.0),
        take_off("again", 15.0),
        replace(LAND, id="down again"),
    )
    assert [c for c, _ in items(files["alpha.sortie-2.plan"])] == [22, 21]


def test_forbidden_areas_are_exclusion_polygons_and_enlarged():
    plan = plans(take_off("up", 20.0), LAND)["alpha.plan"]
    (polygon,) = plan["geoFence"]["polygons"]
    assert polygon["inclusion"] is False
    latitudes, longitudes = zip(*polygon["polygon"], strict=True)
    corners = LocalFrame("EPSG:4326", 42.37, 13.35).to_local(latitudes, longitudes)
    easts, norths = [corner[0] for corner in corners], [corner[1] for corner in corners]
    assert (min(easts), max(easts)) == pytest.approx((99.5, 140.5), abs=0.02)
    assert (min(norths), max(norths)) == pytest.approx((-0.5, 40.5), abs=0.02)


def test_rally_points_keep_their_clearance_inside_emergency_areas():
    plan = plans(take_off("up", 20.0), LAND)["alpha.plan"]
    ((latitude, longitude, height),) = plan["rallyPoints"]["points"]
    east, north = LocalFrame("EPSG:4326", 42.37, 13.35).to_local([latitude], [longitude])[0]
    assert -39.5 <= east <= -20.5
    assert 0.5 <= north <= 19.5
    assert height == 20.0


def test_a_wait_is_refused_with_its_slots():
    (fault,) = refused(take_off("up", 20.0), LAND, transitions={1: Transition(1, 2, waits=("go",))})
    assert fault == "robot 'alpha', move 'up': waits for go, which only an operator can do in a plan"


def test_policies_of_a_robot_are_refused_by_name():
    robot = replace(robot_program("alpha", []), policies=(Policy("BATTERY_LOW", "LAND"),))
    type = replace(quad(), policies=(Policy("LINK_LOST", "HOLD", 5.0), Policy("BATTERY_LOW", "RETURN")))
    assert tuple(QGC_PLAN.refusals(target_input(program(robot), [type]))) == (
        "robot 'alpha': policy BATTERY_LOW: LAND, which only settings of the vehicle can do",
        "robot 'alpha': policy LINK_LOST after 5 s: HOLD, which only settings of the vehicle can do",
    )


def test_policies_of_a_wait_are_refused_with_it():
    late = (Policy("WAIT_TOO_LONG", "LAND", 9.0),)
    faults = refused(
        take_off("up", 20.0), LAND, transitions={1: Transition(1, 2, waits=("go",), policies=late)}
    )
    assert faults[1:] == (
        "robot 'alpha', move 'up': policy WAIT_TOO_LONG after 9 s: LAND, which only settings of the"
        " vehicle can do",
    )


def test_a_wait_that_is_lost_becomes_a_loiter_that_the_operator_ends():
    waiting = {1: Transition(1, 2, waits=("go",))}
    files = plans(take_off("up", 20.0), LAND, transitions=waiting, allow_lossy=True)
    assert [command for command, _ in items(files["alpha.plan"])] == [22, 17, 21]


STAYS = move("stays", "HoldPosition", duration=20.0)


def first_that_moves(plan):
    """Return the first command that ArduPilot flies to: its numbers are up to 95."""
    return next(command for command, _ in items(plan) if command <= 95)


def test_nothing_that_moves_goes_before_the_take_off():
    shoots = replace(STAYS, before=(photo(),))
    files = plans(shoots, take_off("up", 20.0), LAND, transitions=None, allow_lossy=True)
    assert [command for command, _ in items(files["alpha.plan"])] == [2000, 22, 21]
    assert first_that_moves(files["alpha.plan"]) == 22


def test_a_stay_on_the_ground_is_refused():
    assert refused(STAYS, take_off("up", 20.0), LAND) == (
        "robot 'alpha', move 'stays': no mission stays 20 s on the ground",
    )


def test_the_seconds_of_an_action_on_the_ground_are_refused():
    shoots = replace(move("stays", "HoldPosition"), before=(photo(),))
    assert refused(shoots, take_off("up", 20.0), LAND) == (
        "robot 'alpha', move 'stays': no mission waits 1 s on the ground for its action 'takePhoto'",
    )


def test_a_wait_on_the_ground_is_the_operators_begin():
    waiting = {0: Transition(0, 1, waits=("go",)), 2: Transition(2, 3, waits=("more",))}
    shoots = replace(take_off("up", 20.0), before=(photo(),))
    files = plans(shoots, LAND, transitions=waiting, allow_lossy=True)
    assert first_that_moves(files["alpha.plan"]) == 22
    assert [*files] == ["alpha.plan", "qgc-plan.manifest.json"]


def test_an_action_after_the_last_landing_is_refused_since_no_sortie_has_it():
    shoots = replace(move("stays", "HoldPosition"), before=(photo(),))
    assert "robot 'alpha', move 'stays': what it does there is in no sortie" in refused(
        take_off("up", 20.0), LAND, shoots
    )


def test_going_and_landing_without_a_take_off_are_refused():
    faults = refused(go_to("a", (0.0, 9.0, 20.0)), LAND)
    assert faults == (
        "robot 'alpha', move 'a': goes somewhere without having taken off",
        "robot 'alpha', move 'down': lands without having taken off",
    )


def test_a_plan_ends_at_a_choice():
    choosing = {2: Transition(2, 3, condition="windy", otherwise=4)}
    moves = (take_off("up", 20.0), go_to("a", (0.0, 9.0, 20.0)), go_to("b", (9.0, 9.0, 20.0)), LAND)
    chooses, *beyond = refused(*moves, transitions=choosing)
    assert chooses.startswith("robot 'alpha', move 'a': chooses by 'windy', so the plan ends here")
    behind = "comes after the end of the plan, so it is in none"
    assert beyond == [f"robot 'alpha', move '{move}': {behind}" for move in ("b", "down")]
    files = plans(*moves, transitions=choosing, allow_lossy=True)
    assert [command for command, _ in items(files["alpha.plan"])] == [22, 178, 16, 17]


def test_everything_that_a_plan_cannot_say_is_listed():
    refusals = tuple(QGC_PLAN.refusals(target_input(two_drones())))
    assert [refusal.split(": ", 1)[0] for refusal in refusals] == [
        "robot 'alpha', move 'a4'",
        "robot 'beta', move 'b1'",
    ]


def test_a_take_off_to_no_height_is_refused():
    (fault,) = refused(take_off("up", 0.0), LAND)
    assert "takes off to 0 m" in fault


def test_a_home_of_unknown_height_above_the_sea_is_refused():
    ellipsoid = Frame("EPSG:4326", 42.37, 13.35, 770.0, "ELLIPSOID")
    (fault,) = refused(take_off("up", 20.0), LAND, frame=ellipsoid)
    assert "height of its home above mean sea level is not known" in fault


def test_the_geoid_separation_makes_the_height_above_the_sea_known():
    ellipsoid = Frame("EPSG:4326", 42.37, 13.35, 770.0, "ELLIPSOID", 47.5)
    plan = plans(take_off("up", 20.0), LAND, frame=ellipsoid)["alpha.plan"]
    assert plan["mission"]["plannedHomePosition"][2] == 722.5


def test_a_local_behaviour_is_refused_whatever_is_allowed():
    local = Frame("EPSG:4326", None, None)
    assert any("is local" in fault for fault in refused(take_off("up", 20.0), LAND, frame=local))
    with pytest.raises(UnsupportedError, match="is local"):
        plans(take_off("up", 20.0), LAND, frame=local, allow_lossy=True)


def test_an_object_target_is_refused():
    goes = replace(go_to("a", (0.0, 9.0, 20.0)), target=MoveTarget((0.0, 9.0, 20.0), "a buoy", 2.0))
    (fault,) = refused(take_off("up", 20.0), goes, LAND)
    assert "object 'a buoy'" in fault


AHEAD = Heading(MoveTarget((0.0, 90.0, 0.0)), "camera")


def looking(*moves, **properties):
    """Return the commands of a plan, with their first parameters, and the refusals."""
    named = {name.replace("__", "."): value for name, value in properties.items()}
    kind = replace(quad(), devices={"camera": Device("camera", {}, named)})
    given = target_input(program(robot_program("alpha", [take_off("up", 20.0), *moves, LAND])), [kind])
    plan = json.loads(render(QGC_PLAN, given, allow_lossy=True)[0].content)
    return [(command, params[0]) for command, params in items(plan)], tuple(QGC_PLAN.refusals(given))


def test_a_device_that_looks_aside_is_turned_on_the_spot():
    turn = replace(move("turn", "HeadTo"), heading=AHEAD)
    commands, refusals = looking(turn, mount__yaw="90")
    assert (115, 270.0) in commands
    assert refusals == ()


def test_a_device_that_looks_aside_cannot_be_turned_on_the_way():
    _, refusals = looking(go_to("a", (0.0, 30.0, 20.0), heading=AHEAD), mount__yaw="90")
    assert refusals == ("robot 'alpha', move 'a': device 'camera' does not look ahead (mount.yaw)",)


def test_a_gimbal_turns_by_itself_while_the_vehicle_stays_as_it_is():
    turn = replace(move("turn", "HeadTo"), heading=AHEAD)
    commands, refusals = looking(turn, mavlink__gimbal="2")
    assert [command for command, _ in commands] == [22, 195, 21]
    assert (195, 2.0) in commands
    assert refusals == ()


def test_a_gimbal_cannot_look_past_its_target():
    _, refusals = looking(
        replace(move("turn", "HeadTo"), heading=replace(AHEAD, angle_degrees=30.0)), mavlink__gimbal="0"
    )
    assert refusals == (
        "robot 'alpha', move 'turn': a gimbal points straight at its target, not at an angle to it",
    )


def test_a_mount_that_is_no_number_is_refused():
    _, refusals = looking(go_to("a", (0.0, 30.0, 20.0), heading=AHEAD), mount__yaw="left")
    assert refusals == ("robot 'alpha', move 'a': device 'camera': mount.yaw is not a number",)


def test_moves_that_come_round_again_are_refused():
    moves = (take_off("up", 20.0), go_to("a", (0.0, 9.0, 20.0)), LAND)
    fault, *beyond = refused(*moves, transitions={2: Transition(2, 2)})
    assert len(beyond) == 1
    assert fault == "robot 'alpha', move 'a': 'a' comes round again, so the plan ends here"


def flight(*moves):
    """Return a robot of a type that states how high it flies, and what a target gets of it."""
    robot = robot_program("alpha", [take_off("up", 20.0), *moves, LAND])
    kind = quad()
    known = replace(kind, part=replace(kind.part, attributes={"maxAltitude": 120.0}))
    return robot, target_input(program(robot, frame=L_AQUILA), (known,))


def test_a_mission_that_takes_longer_than_the_batteries_last_is_refused():
    far = [go_to(f"far{index}", (0.0, 4_000.0 * (index % 2), 25.0)) for index in range(1, 8)]
    (refusal,) = too_long(*flight(*far))
    assert refusal.startswith("robot 'alpha': takes ")
    assert "for sortie 1 as a mission; its batteries last" in refusal
    assert list(too_long(*flight(*far[:1]))) == []


def test_a_mission_takes_longer_than_its_moves_one_by_one():
    robot, given = flight(*(go_to(f"g{index}", (0.0, 10.0 * (index % 2), 20.0)) for index in range(1, 8)))
    stepped = [each.seconds for each in planned_moves(robot, given)]
    assert None not in stepped
    assert sortie_seconds(robot, given) >= (sum(each.expected for each in stepped),)


def test_what_no_mission_sets_on_its_vehicle_is_asked_for():
    _, given = flight(go_to("far", (0.0, 400.0, 25.0)))
    (type,) = given.types.values()
    slow = replace(
        type, capabilities=tuple(replace(c, climb_rate=1.5, turn_rate=30.0) for c in type.capabilities)
    )
    (file,) = QGC_PLAN.files(replace(given, types={type.name: slow}))
    assert "set WPNAV_SPEED_UP to 150 at most: it climbs at 1.5 m/s, as its type states" in file.asks
    assert "set ATC_SLEW_YAW to 3000 at most: it turns at 30°/s, as its type states" in file.asks


def test_a_file_is_noted_with_the_seconds_of_its_mission():
    robot, given = flight(go_to("far", (0.0, 400.0, 25.0)))
    (seconds,) = sortie_seconds(robot, given)
    assert [each.note for each in QGC_PLAN.files(given)] == [f"{seconds:.0f} s as a mission, waits aside"]


def test_feedback_is_left_out_of_a_plan_and_its_file_is_noted_for_that():
    """Nothing waits for it, and a ground station shows by itself how far a vehicle is."""
    moves = (take_off("up", 20.0), go_to("a", (0.0, 30.0, 25.0)), LAND)
    told = (moves[0], replace(moves[1], after=(feedback("done", ("task", "field")),)), LAND)
    assert items(plans(*told)["alpha.plan"]) == items(plans(*moves)["alpha.plan"])
    _, given = flight(*told[1:-1])
    (file,) = QGC_PLAN.files(given)
    assert file.note.endswith(" s as a mission, waits aside; sends no feedback")
