"""Programs that go on after a break: with another battery, in another process, or in the same one."""

import signal
import time
from dataclasses import replace
from math import hypot
from random import Random

import pytest
from mmrs_multicopter.testing import LAND, MULTICOPTER, go_to, robot_program, take_off
from patience import until

from mmrs_core.behaviour.program import Transition
from mmrs_core.scene import Policy
from mmrs_core.testing.programs import move, notify, photo, program
from mmrs_runtime.orders.ordering import give

pytestmark = pytest.mark.real_time("controllers")

TAKE_OFF = 22
AT_HOME = 0.4
"""Metres from home at which a vehicle may land: ArduCopter landed within 0.3 m (benchmarks/results)."""
TRANSECTS = [(x, y, 12.0) for x in (20.0, 30.0, 40.0) for y in ((0.0, 60.0) if x != 30.0 else (60.0, 0.0))]
"""Both ends of three lines of a coverage, flown up and down."""
PASSED = 2.5
"""Metres from a place of a run at which it counts as passed, and what a vehicle flies in a tick."""


def coverage(*policies: Policy, fluid: bool = False, **robot):
    """Fly a coverage, with a photo at every end."""
    ends = [go_to(f"t{index}", place, task="field") for index, place in enumerate(TRANSECTS)]
    ends = ends if fluid else [replace(end, after=(photo(),)) for end in ends]
    moves = [take_off("up", 12.0), *ends, go_to("home", (0.0, 0.0, 12.0)), LAND]
    chained = {index: Transition(index, index + 1, fluid=True) for index in range(2, 7)} if fluid else {}
    return program(replace(robot_program("alpha", moves, transitions=chained, **robot), policies=policies))


def covered(vehicle) -> list[bool]:
    """Return which ends of the coverage the vehicle's own track has passed."""
    track = [(north, east) for _, north, east, _ in vehicle.autopilot.track]
    return [any(hypot(north - y, east - x) < PASSED for north, east in track) for x, y, _ in TRANSECTS]


def begun(made, name: str) -> int:
    return sum((step["label"], step["move"]) == ("begin", name) for step in made.steps("alpha"))


def resumed(made) -> bool:
    """Order the robot to go on, and return whether it does: not before it has heard of its battery."""
    (told,) = give(made.logs, "resume", ["alpha"])
    return told["confirmed"]


def empty(made, vehicle, links, move: str) -> str:
    """Fly until a move, find the battery low there, and come home; return what was said."""
    with made.start("fleet.py", *links) as process:
        made.await_step(move)
        time.sleep(0.15)
        vehicle.faults.begin("battery", 0.19)
        _, said = process.communicate(timeout=60)
    assert process.returncode == 1, said
    assert "came home for its battery" in said
    assert "fault" not in {step["label"] for step in made.steps("alpha")}
    return said


def killed_at(made, links, move: str) -> None:
    """Kill the process of a robot soon after a move has begun."""
    with made.start("fleet.py", *links) as process:
        made.await_step(move)
        time.sleep(0.3)
        process.send_signal(signal.SIGKILL)
        process.communicate(timeout=60)


def test_a_coverage_is_complete_after_a_change_of_batteries(controllers, hangar):
    made = controllers(coverage(fluid=True))
    vehicles, links = hangar(made.program)
    alpha = vehicles["alpha"]
    empty(made, alpha, links, "t3")
    assert not alpha.autopilot.armed
    assert max(map(abs, alpha.autopilot.body.position)) < AT_HOME
    assert not all(covered(alpha))
    before = len(alpha.autopilot.track)
    alpha.faults.begin("battery", 1.0)
    code, said = made.run("fleet.py", *links, "--resume")
    assert code == 0, said
    assert all(covered(alpha))
    legs = [(round(east / 10), round(north / 10)) for _, north, east, _ in alpha.autopilot.track[before:]]
    assert legs.index((3, 6)) < legs.index((3, 0)), "the interrupted leg is flown from its beginning"
    assert begun(made, "t3") == 1
    assert made.replayed().complaints == ()


def test_a_battery_that_is_changed_while_others_work_needs_no_second_start(controllers, hangar):
    other = robot_program(
        "beta",
        [take_off("up", 5.0), move("stay", "HoldPosition", duration=150.0), LAND],
        home=(0.0, -50.0, 0.0),
    )
    made = controllers(program(*coverage().robots, other))
    vehicles, links = hangar(made.program)
    with made.start("fleet.py", *links) as process:
        made.await_step("t2")
        time.sleep(0.15)
        vehicles["alpha"].faults.begin("battery", 0.19)
        assert any("came home for its battery" in line for line in process.stderr)
        vehicles["alpha"].faults.begin("battery", 1.0)
        until(lambda: resumed(made))
        _, said = process.communicate(timeout=60)
    assert process.returncode == 0, said
    assert all(covered(vehicles["alpha"]))
    assert made.replayed().complaints == ()


@pytest.mark.thorough
def test_a_restarted_vehicle_with_a_new_battery_is_set_up_again(controllers, hangar):
    made = controllers(coverage())
    vehicles, links = hangar(made.program)
    with made.start("fleet.py", *links, "--battery-patience", "60") as process:
        made.await_step("t1")
        vehicles["alpha"].faults.begin("battery", 0.19)
        assert any("came home for its battery" in line for line in process.stderr)
        vehicles["alpha"].faults.begin("restart")
        vehicles["alpha"].faults.begin("battery", 1.0)
        time.sleep(1.0)
        until(lambda: resumed(made))
        _, said = process.communicate(timeout=60)
    assert process.returncode == 0, said
    assert all(covered(vehicles["alpha"]))


def test_the_point_of_no_return_is_noticed_before_the_reserve_is_touched(controllers, hangar):
    far = [take_off("up", 10.0), go_to("far", (0.0, 400.0, 10.0)), go_to("home", (0.0, 0.0, 10.0)), LAND]
    made = controllers(replace(program(robot_program("alpha", far)), reserve=0.1))
    vehicles, links = hangar(made.program, speedup=5.0, energy=180.0)
    code, said = made.run("fleet.py", *links)
    assert code == 1, said
    assert "BATTERY_LOW: point of no return" in said
    assert not vehicles["alpha"].autopilot.armed
    assert max(map(abs, vehicles["alpha"].autopilot.body.position)) < AT_HOME
    assert vehicles["alpha"].autopilot.battery.level > 0.02


def test_a_killed_process_goes_on_in_the_air_where_its_robot_waits(controllers, hangar):
    made = controllers(coverage(Policy("LINK_LOST", "HOLD", 60.0)))
    vehicles, links = hangar(made.program)
    with made.start("fleet.py", *links) as process:
        made.await_step("t2")
        process.send_signal(signal.SIGKILL)
        process.communicate(timeout=60)
    code, said = made.run("fleet.py", *links, "--resume")
    assert code == 0, said
    assert sum(command == TAKE_OFF for _, command, _ in vehicles["alpha"].autopilot.history) == 1
    assert all(covered(vehicles["alpha"]))
    assert made.replayed().complaints == ()


@pytest.mark.thorough
def test_a_killed_process_goes_on_where_its_robot_is_on_the_corner_of_a_leg(controllers, hangar):
    down = go_to("down to work", (0.0, 60.0, 15.0), trajectory="HORIZONTAL_FIRST")
    alpha = robot_program("alpha", [take_off("up", 40.0), down, LAND])
    made = controllers(program(replace(alpha, policies=(Policy("LINK_LOST", "HOLD", 60.0),))))
    vehicles, links = hangar(made.program, speedup=10.0)
    body = vehicles["alpha"].autopilot.body
    with made.start("fleet.py", *links) as process:
        while body.position[0] < 40.0:
            assert process.poll() is None
            time.sleep(0.01)
        process.send_signal(signal.SIGKILL)
        process.communicate()
    assert body.position[2] > 30.0, "it flies level before it comes down"
    code, said = made.run("fleet.py", *links, "--resume")
    assert code == 0, said
    assert made.replayed().complaints == ()


@pytest.mark.thorough
@pytest.mark.parametrize("stays", ["Recharge", "HoldPosition"])
def test_a_killed_process_goes_on_on_the_ground_where_its_robot_has_landed(controllers, hangar, stays):
    ways = [take_off("up", 6.0), go_to("out", (0.0, 30.0, 6.0)), go_to("home", (0.0, 0.0, 6.0)), LAND]
    made = controllers(program(robot_program("alpha", [*ways, move("stay", stays, duration=30.0)])))
    vehicles, links = hangar(made.program, speedup=20.0, recharge=20.0)
    alpha = vehicles["alpha"].autopilot
    killed_at(made, links, "stay")
    code, said = made.run("fleet.py", *links, "--resume")
    assert code == 0, said
    assert sum(command == TAKE_OFF for _, command, _ in alpha.history) == 1
    assert not alpha.armed
    assert made.replayed().complaints == ()


def delivery():
    """Fly to a place, land there, take off again, and come home by another way."""
    there = [take_off("up", 6.0), go_to("out", (0.0, 40.0, 6.0)), move("there", "Land", uri=MULTICOPTER)]
    onward = [take_off("again", 8.0), go_to("on", (60.0, 40.0, 8.0)), go_to("home", (0.0, 0.0, 8.0)), LAND]
    robot = robot_program("alpha", [*there, *onward])
    return program(replace(robot, policies=(Policy("LINK_LOST", "HOLD", 60.0),)))


@pytest.mark.thorough
def test_a_killed_process_goes_on_in_the_air_after_it_has_landed_elsewhere(controllers, hangar):
    made = controllers(delivery())
    vehicles, links = hangar(made.program, speedup=20.0)
    killed_at(made, links, "on")
    code, said = made.run("fleet.py", *links, "--resume")
    assert code == 0, said
    assert not vehicles["alpha"].autopilot.armed
    assert made.replayed().complaints == ()


def test_a_robot_that_was_carried_home_does_not_go_on_where_nobody_has_checked_a_way(controllers, hangar):
    made = controllers(delivery())
    vehicles, links = hangar(made.program, speedup=20.0)
    alpha = vehicles["alpha"]
    killed_at(made, links, "again")
    with alpha.lock:
        alpha.autopilot.disarm()
        alpha.autopilot.body.position = alpha.autopilot.body.velocity = (0.0, 0.0, 0.0)
    before = len(alpha.autopilot.history)
    code, said = made.run("fleet.py", *links, "--resume")
    assert code == 1, said
    assert "the vehicle is 40 m from where its program has landed it: carry it to 42.370360, 13.35" in said
    assert TAKE_OFF not in [command for _, command, _ in alpha.autopilot.history[before:]]


def test_a_process_that_is_killed_as_its_robot_comes_home_for_its_battery_brings_it_home(controllers, hangar):
    made = controllers(coverage(Policy("BATTERY_LOW", "RETURN"), Policy("LINK_LOST", "HOLD", 60.0)))
    vehicles, links = hangar(made.program, speedup=20.0)
    alpha = vehicles["alpha"]
    with made.start("fleet.py", *links) as process:
        made.await_step("t1")
        time.sleep(0.3)
        alpha.faults.begin("battery", 0.15)
        assert any("response: RETURN" in line for line in process.stderr)
        time.sleep(0.3)
        process.send_signal(signal.SIGKILL)
        process.communicate(timeout=60)
    assert alpha.autopilot.body.position[2] > 5.0
    code, said = made.run("fleet.py", *links, "--resume")
    assert code == 1, said
    assert "came home for its battery" in said
    assert not alpha.autopilot.armed
    assert max(map(abs, alpha.autopilot.body.position)) < AT_HOME
    alpha.faults.begin("battery", 1.0)
    code, said = made.run("fleet.py", *links, "--resume")
    assert code == 0, said
    assert all(covered(alpha))


def test_a_log_that_was_cut_off_is_gone_on_with_after_its_last_whole_line(controllers):
    made = controllers(coverage())
    with made.start("fleet.py", "--dry-run", "--speedup", "20") as process:
        made.await_step("t1")
        process.send_signal(signal.SIGKILL)
        process.communicate(timeout=60)
    log = made.logs / "alpha.jsonl"
    log.write_text(log.read_text("ascii") + '{"run": "run-0", "rob', "ascii")
    code, said = made.run("fleet.py", "--dry-run", "--resume")
    assert code == 0, said
    assert made.replayed().complaints == ()


def test_slots_that_were_set_before_the_break_are_set_after_it(controllers):
    giver = robot_program("alpha", [take_off("up", 5.0), LAND])
    told = replace(giver.moves[1], after=(notify(("beta", "go")),))
    giver = replace(giver, moves=(giver.moves[0], told, *giver.moves[2:]))
    taker = robot_program(
        "beta",
        [take_off("up", 5.0), move("stay", "HoldPosition", duration=60.0), LAND],
        slots=("go",),
        transitions={2: Transition(2, 3, waits=("go",))},
    )
    made = controllers(program(giver, taker))
    with made.start("fleet.py", "--dry-run", "--speedup", "20") as process:
        assert any("'alpha': done" in line for line in process.stderr)
        process.send_signal(signal.SIGKILL)
        process.communicate(timeout=60)
    code, said = made.run("fleet.py", "--dry-run", "--resume")
    assert code == 0, said
    assert "'alpha': it has come to its end" in said
    assert made.replayed().complaints == ()


def test_a_program_that_has_ended_by_a_fault_does_not_go_on(controllers):
    made = controllers(coverage())
    with made.start("fleet.py", "--dry-run", "--speedup", "20") as process:
        made.await_step("t1")
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
    code, said = made.run("fleet.py", "--dry-run", "--resume")
    assert code == 1
    assert "cannot be resumed: it has ended by STOPPED" in said


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [(("--resume",), "no log of these robots"), (("--resume", "--run", "other"), "no log of these robots")],
)
def test_nothing_can_be_gone_on_with_where_nothing_was_begun(controllers, arguments, complaint):
    code, said = controllers(coverage()).run("fleet.py", "--dry-run", *arguments)
    assert code == 2
    assert complaint in said


def relay(laps: int):
    """Have two robots wait for each other, lap by lap."""
    slots = tuple(f"lap{lap}" for lap in range(laps))

    def robot(name: str, other: str, east: float):
        moves, transitions = [take_off("up", 10.0)], {}
        for lap in range(laps):
            there = go_to(f"lap{lap}", (east, 10.0 * (lap % 2), 10.0))
            moves.append(replace(there, after=(notify((other, f"lap{lap}")),)))
            transitions[lap + 2] = Transition(lap + 2, lap + 3, waits=(f"lap{lap}",))
        return robot_program(
            name, [*moves, LAND], home=(east, 0.0, 0.0), slots=slots, transitions=transitions
        )

    return program(robot("alpha", "beta", 0.0), robot("beta", "alpha", 30.0))


@pytest.mark.parametrize("kills", [10, pytest.param(100, marks=pytest.mark.thorough)])
def test_nothing_is_lost_however_often_a_process_is_killed(controllers, kills):
    made, chance = controllers(relay(8 * kills)), Random(11)
    for kill in range(kills):
        again = ("--resume",) if (made.logs / "alpha.jsonl").exists() else ()
        with made.start("fleet.py", "--dry-run", "--speedup", "100", *again) as process:
            time.sleep(chance.uniform(0.3, 1.3))
            assert process.poll() is None, f"it has ended before it is killed for the {kill + 1}th time"
            process.kill()
            process.communicate()
        if (made.logs / "alpha.jsonl").exists():
            assert made.replayed(partial=True).complaints == ()
    code, said = made.run("fleet.py", "--dry-run", "--speedup", "20000", "--resume")
    assert code == 0, said
    assert made.replayed().complaints == ()
