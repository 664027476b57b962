from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, go_to, quad, robot_program, take_off, two_drones
from ports import free_endpoint

from mmrs_core.behaviour.program import MoveTarget, Transition
from mmrs_core.scene import Device, DeviceAction, Frame
from mmrs_core.testing.programs import photo, program
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("controllers")

PHOTO = 2000
AT_HOME = 0.4
"""Metres from home at which a vehicle may land: ArduCopter landed within 0.3 m (benchmarks/results)."""


def commands(vehicle, number):
    return [params for _, command, params in vehicle.autopilot.history if command == number]


def test_a_dry_run_replays(controllers):
    made = controllers(two_drones())
    code, said = made.run("fleet.py", "--dry-run")
    assert code == 0, said
    assert made.replayed().outcome is Outcome.SUCCESS
    assert made.replayed().complaints == ()


@pytest.fixture(scope="module")
def flown(tmp_path_factory, new_hangar, new_controllers):
    """Return two drones that have flown: their controllers, the vehicles, exit code and what was said."""
    made = new_controllers(tmp_path_factory.mktemp("flown"), two_drones())
    with new_hangar() as hangar:
        vehicles, links = hangar(made.program)
        code, said = made.run("fleet.py", *links)
    return made, vehicles, code, said


def test_two_drones_fly_and_their_logs_replay(flown):
    made, vehicles, code, said = flown
    assert code == 0, said
    result = made.replayed()
    assert (result.outcome, result.complaints) == (Outcome.SUCCESS, ())
    for vehicle in vehicles.values():
        assert not vehicle.autopilot.armed
        assert max(map(abs, vehicle.autopilot.body.position)) < AT_HOME


def test_a_run_without_stops_is_flown_as_a_mission(flown):
    _, vehicles, _, _ = flown
    alpha, beta = vehicles["alpha"], vehicles["beta"]
    assert [item for _, item in alpha.autopilot.visited] == [1, 2, 3, 4, 5]
    assert beta.autopilot.visited == []
    assert len(commands(alpha, PHOTO)) == 1


def test_fence_and_rally_points_are_uploaded(flown):
    _, vehicles, _, _ = flown
    stores = vehicles["alpha"].autopilot.stores
    assert [item.command for item in stores[1]] == [5002] * 8
    assert [item.command for item in stores[2]] == [5100]
    assert vehicles["alpha"].autopilot.parameters["FENCE_ENABLE"] == 1.0


def test_a_lossy_link_changes_nothing(controllers, hangar):
    made = controllers(two_drones())
    _, links = hangar(made.program, speedup=20.0)
    patience = ("--tries", "20", "--answer-seconds", "0.2")
    code, said = made.run("fleet.py", *patience, "--inject", "loss=0.15,seed=7", *links)
    assert code == 0, said
    assert made.replayed().complaints == ()


def test_a_local_behaviour_is_stepped_in_local_coordinates(controllers, hangar):
    robot = robot_program(
        "alpha",
        [take_off("up", 5.0), go_to("a", (14.0, 26.0, 8.0)), go_to("b", (10.0, 20.0, 5.0)), LAND],
        home=(10.0, 20.0, 0.0),
        transitions={2: Transition(2, 3, fluid=True)},
    )
    made = controllers(program(robot, frame=Frame("EPSG:4326", None, None)))
    vehicles, links = hangar(made.program)
    code, said = made.run("fleet.py", *links)
    assert code == 0, said
    assert made.replayed().complaints == ()
    assert max(map(abs, vehicles["alpha"].autopilot.body.position)) < AT_HOME


def test_a_value_that_is_measured_is_recorded_with_its_place(controllers, hangar):
    sensor = Device("gas", {"sample": DeviceAction("sample", 1.0)}, {"mavlink.value": "CO2"})
    samples = replace(go_to("a", (0.0, 10.0, 10.0)), after=(photo("gas", "sample"),))
    flown = program(robot_program("alpha", [take_off("up", 10.0), samples, LAND]))
    made = controllers(flown, types=[replace(quad(), devices={"gas": sensor})])
    _, links = hangar(flown, values={"CO2": lambda seconds: 412.5})
    code, said = made.run("fleet.py", *links)
    assert code == 0, said
    (record,) = made.box("alpha", "measured")
    assert record["content"] == {"device": "gas", "result": 412.5}
    assert record["place"]["latitude"] == pytest.approx(42.37009, abs=1e-5)


def test_robots_that_begin_together_know_how_well_they_did(controllers):
    made = controllers(two_drones())
    endpoint = free_endpoint()
    code, said = made.run("fleet.py", "--dry-run", "--sync", "--speedup", "50", "--bus-listen", endpoint)
    assert code == 0, said
    for robot in ("alpha", "beta"):
        (begun,) = made.box(robot, "decision")
        assert (begun["what"], begun["response"]) == ("TOGETHER", "begins")
        assert "ms apart, known to" in begun["why"]
    assert made.replayed().complaints == ()


def test_nothing_begins_where_the_others_do_not_come_and_it_can_be_tried_again(controllers):
    made = controllers(two_drones())
    endpoint = free_endpoint()
    alone = ("--dry-run", "--sync", "--sync-patience", "1", "--speedup", "50", "--bus-listen", endpoint)
    code, said = made.run("robot_alpha.py", *alone)
    assert code == 5, said
    assert "after 1 s 'beta' is not ready; never seen on the bus: 'beta'" in said
    assert not (made.logs / "alpha.jsonl").exists()
    code, said = made.run("fleet.py", "--dry-run", "--sync", "--resume", "--speedup", "50")
    assert code == 0, said


def test_logs_are_never_overwritten(controllers):
    made = controllers(two_drones())
    assert made.run("fleet.py", "--dry-run")[0] == 0
    code, said = made.run("fleet.py", "--dry-run")
    assert code == 2
    assert "alpha.jsonl" in said


def test_a_choice_is_decided_by_the_users_own_conditions(controllers):
    robot = robot_program(
        "alpha",
        [take_off("up", 5.0), go_to("a", (4.0, 6.0, 5.0)), LAND],
        transitions={1: Transition(1, 2, condition='it is "windy"', otherwise=3)},
    )
    made = controllers(program(robot))
    code, said = made.run("fleet.py", "--dry-run")
    assert code == 2
    assert "condition 'it is \"windy\"' is not implemented yet" in said
    assert not made.logs.exists()

    conditions = made.folder / "conditions.py"
    decided = conditions.read_text("ascii").replace(": undecided,", ": lambda state: False,")
    conditions.write_text(decided, "ascii")
    code, said = made.run("fleet.py", "--dry-run", "--log", str(made.folder / "again"))
    assert code == 0, said
    assert "'choose'" not in said
    assert '"detail":"false"' in (made.folder / "again/alpha.jsonl").read_text("ascii")


def test_one_of_several_robots_does_not_start_alone(controllers):
    made = controllers(two_drones())
    code, said = made.run("robot_beta.py", "--dry-run")
    assert code == 2
    assert "needs 'alpha'" in said


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["--connect", "gamma=udpin:127.0.0.1:1"], "unknown robot 'gamma'"),
        (["--connect", "udpin:127.0.0.1:1"], "several robots"),
        (["--speedup", "-1"], "must be a positive number"),
        (["--home-tolerance", "nan"], "must be a positive number"),
    ],
)
def test_a_wrong_command_line_is_a_usage_error(controllers, arguments, complaint):
    code, said = controllers(two_drones()).run("fleet.py", *arguments)
    assert code == 2
    assert complaint in said


def buoy(tolerance: float):
    goes = replace(
        go_to("a", (0.0, 20.0, 10.0)), target=MoveTarget((0.0, 20.0, 10.0), "a buoy", tolerance), distance=4.0
    )
    return program(robot_program("alpha", [take_off("up", 10.0), goes, LAND]))


def find_buoy(made, place: str) -> None:
    path = made.folder / "objects.py"
    found = f": lambda state, expected: {place},"
    path.write_text(path.read_text("ascii").replace(": not_looked_for,", found), "ascii")


def test_an_object_that_nobody_looks_for_is_refused_before_anything_moves(controllers):
    made = controllers(buoy(2.0))
    code, said = made.run("fleet.py", "--dry-run")
    assert code == 2
    assert "finding 'a buoy' is not implemented yet" in said
    assert not made.logs.exists()


def test_an_object_that_nobody_finds_is_a_fault(controllers):
    made = controllers(buoy(2.0))
    find_buoy(made, "1 / 0")
    code, said = made.run("fleet.py", "--dry-run")
    assert code == 1
    assert "object 'a buoy': ZeroDivisionError" in said
    assert made.replayed(partial=True).faults == {"alpha": "OBJECT_NOT_FOUND"}


def test_an_object_is_approached_where_it_was_found(controllers, hangar):
    made = controllers(buoy(2.0))
    find_buoy(made, "where_expected(state, expected)")
    vehicles, links = hangar(made.program)
    code, said = made.run("fleet.py", *links)
    assert code == 0, said
    assert made.replayed().complaints == ()
    assert vehicles["alpha"].autopilot.body.position[0] == pytest.approx(16.0, abs=0.6)


def test_an_object_is_not_followed_to_where_it_may_not_be(controllers):
    made = controllers(buoy(2.0))
    find_buoy(made, "type(expected)(expected.latitude + 0.001, expected.longitude, expected.height)")
    code, said = made.run("fleet.py", "--dry-run")
    assert code == 1
    assert "111.1 m from where it should be" in said
