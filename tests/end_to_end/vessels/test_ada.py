"""Decision centres in Ada, compiled with warnings as errors, on the bus of a simulated vehicle."""

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from math import atan2, degrees, hypot
from pathlib import Path
from random import Random
from types import MappingProxyType

import pytest
from ada_centres import Dive, build, commanded, gateways, run, telling, unused_port, write
from bus_traces import Said, Trace, steps_in
from dives import dive, diver, rehearse, swim
from mmrs_auv.kinds import AUV_KIND
from mmrs_auv.plugin import mmrs_metamodels
from mmrs_auv.targets.can_python.target import CAN_PYTHON
from waiting_pair import waiting_pair
from warm_python import python

from auv_vessel.eyes import Detection
from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.program import BEHAVIOUR, Action, Heading, Move, MoveTarget, Program, Transition
from mmrs_core.behaviour.reading import program_of
from mmrs_core.behaviour.replay import replay
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.render import render
from mmrs_core.generation.writing import write as write_files
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.registry import registry_with
from mmrs_core.simulation.run import asked_by
from mmrs_core.testing.programs import feedback, move
from mmrs_core.testing.small_programs import notify
from mmrs_core.transformation.kinds import MOVE_KINDS
from mmrs_runtime.engine.decisions import standard_conditions
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("vessels")

SLOTS = ("go", "GO")

PHOTO = Action(((BEHAVIOUR, "DeviceAction"), (BEHAVIOUR, "Action")), "TakePicture", "front-camera")


@pytest.fixture(scope="module", autouse=True)
def compiler(need_program):
    return need_program("gnatmake", "compiles decision centres in Ada")


def feedback_move(name: str) -> Move:
    return replace(move(name, "HoldPosition", duration=0.1), before=(feedback(name),))


def everything():
    """Return a behaviour with all kinds of moves and actions, whose choice all decide alike."""
    turn = replace(move('turn "x"\n', "HeadTo"), heading=Heading(MoveTarget((0.0, 10.0, -1.0))))
    there = swim("there", 0.5, 0.5, 0.7, after=(notify(("naiad", "go")), feedback("there")))
    hold = move("hold", "HoldPosition", duration=1.0)
    looking = swim(
        "looking", 0.3, 0.2, 0.9, before=(PHOTO,), heading=Heading(MoveTarget((5.0, 5.0, -1.0)), "", 30.0)
    )
    short = swim("é", -0.5, 0.0, 0.8, after=(PHOTO,), task="home", distance=0.5, speed=0.3)
    return dive(
        there, hold, turn, looking, short, slots=("go",),
        transitions={2: Transition(2, 4, waits=("go",), condition="battery-below:0.3", otherwise=3)},
    )  # fmt: skip


def rehearsed(behaviour, folder: Path) -> tuple[Trace, list]:
    """Return what the interpreter does on the bus, and its steps."""
    traces: list[Trace] = []

    def listen(robot) -> None:
        traces.append(Trace(robot.stage.sheet))
        robot.stage.rehearsal.add(traces[0])

    decided = standard_conditions(asked_by(behaviour))
    assert rehearse(behaviour, folder, listen, decided, noise="no").accepted
    return traces[0], steps_in(folder)


def controlled(behaviour, folder: Path) -> Dive:
    """Return what a controller in Python does."""
    kinds = {kind.metaclass: kind for kind in MOVE_KINDS}
    given = TargetInput(behaviour, {diver().name: diver()}, {AUV_KIND.metaclass: AUV_KIND}, kinds)
    write_files(render(CAN_PYTHON, given), folder / "code")

    def words(port: int) -> list[str]:
        options = ["--can", f"can0@127.0.0.1:{port}", "--log", str(folder / "logs")]
        return [python(), str(folder / "code" / "fleet.py"), *options]

    return commanded(words, behaviour, folder, strange=1.0)


def some_moves(random: Random) -> list[Move]:
    """Return moves of all sorts, before and after which all sorts of things are done."""

    def some_actions() -> tuple[Action, ...]:
        kinds = [PHOTO, feedback(random.choice(["é", 'a "b"', ""])), notify(("naiad", random.choice(SLOTS)))]
        return tuple(random.sample(kinds, random.choice([0, 0, 1, 2])))

    made = []
    for number in range(random.randint(2, 4)):
        north, east = (round(random.uniform(-1.0, 1.0), 3) for _ in range(2))
        depth = round(random.uniform(0.5, 1.2), 3)
        look = Heading(MoveTarget((20.0 * north, 20.0 * east, -1.0)), "", random.choice([0.0, 90.0]))
        name = f"{random.choice(['end', 'é', 'a b'])}{number}"
        kind = random.choice(["goes", "goes", "looks", "short", "holds", "turns"])
        gone = swim(name, east, north, depth, task=random.choice(["", "t", "T"]))
        changes = {
            "goes": gone,
            "looks": replace(gone, heading=look),
            "short": replace(gone, distance=0.2, speed=0.3),
            "holds": move(name, "HoldPosition", duration=0.2),
            "turns": replace(move(name, "HeadTo"), heading=look),
        }
        made.append(replace(changes[kind], before=some_actions(), after=some_actions()))
    return made


def some_behaviour(seed: int) -> Program:
    """Return a small behaviour that comes to its end, whatever the charge."""
    random = Random(seed)
    moves = some_moves(random)
    last = len(moves) + 1
    ways, active = {}, set[str]()
    for number, each in enumerate(moves, start=1):
        active |= {slot for action in (*each.before, *each.after) for _, slot in action.sets}
        waits = tuple(sorted(active)) if random.random() < 0.3 else ()
        if random.random() < 0.4:
            limit = random.choice(["0.3", "2.0"])
            otherwise = random.randint(number + 1, last)
            ways[number] = Transition(
                number, number + 1, waits, condition=f"battery-below:{limit}", otherwise=otherwise
            )
        elif waits:
            ways[number] = Transition(number, number + 1, waits)
    return dive(*moves, slots=SLOTS, transitions=ways)


@pytest.mark.parametrize("seed", [-1, *(pytest.param(each, marks=pytest.mark.thorough) for each in range(6))])
def test_ada_python_and_the_interpreter_do_the_same(tmp_path: Path, seed: int) -> None:
    """Two programs and the interpreter command the same simulated vehicle; this is compared.

    ================  =====================================================================================
    steps in the log  label, move, detail and slots of all, in order
    goals             bytes without counter and check where place and heading are fixed; else mode, number,
                      speed, whether it faces where it goes, place to 0.15 m, heading to 5 degrees
    orders            bytes without counter and check: device, action, parameter, number of the request
    ends              which goals ended, and how
    ================  =====================================================================================
    """
    behaviour = everything() if seed < 0 else some_behaviour(seed)
    program = build(write(behaviour, tmp_path / "out"))
    wanted, steps = rehearsed(behaviour, tmp_path / "sim")
    with ThreadPoolExecutor(2) as pool:
        found = [
            pool.submit(run, program, behaviour, tmp_path / "ada", strange=1.0),
            pool.submit(controlled, behaviour, tmp_path / "python"),
        ]
        for dive in (each.result() for each in found):
            assert dive.status == 0, dive.errors
            trace = dive.world.trace
            assert steps_in(dive.log) == steps
            assert trace.orders == wanted.orders
            assert trace.ends == wanted.ends
            assert [same_goal(*each) for each in zip(trace.told, wanted.told, strict=True)] == [""] * len(
                wanted.told
            )
    if seed < 0:
        assert len(wanted.told) == 4
        assert len(wanted.orders) == 2


def same_goal(goal: Said, wanted: Said) -> str:
    """Return in what a goal differs from another."""
    if wanted.values["Mode"] == "GO_TO" and wanted.values["Speed"] > 0.4:
        return "" if goal.data == wanted.data else f"{goal.values} instead of {wanted.values}"
    for name in ("North", "East", "Depth"):
        if abs(goal.values[name] - wanted.values[name]) > 0.15:
            return f"{name}: {goal.values[name]}, {wanted.values[name]}"
    if abs((goal.values["Heading"] - wanted.values["Heading"] + 180.0) % 360.0 - 180.0) > 5.0:
        return f"heading: {goal.values['Heading']}, {wanted.values['Heading']}"
    for name in ("Mode", "Goal", "Speed", "FaceAlong"):
        if goal.values[name] != wanted.values[name]:
            return f"{name}: {goal.values[name]}, {wanted.values[name]}"
    return ""


def buoy(tolerance: float) -> Move:
    """Return an approach to a buoy, which the vehicle then faces."""
    target = MoveTarget((1.5, 0.0, -1.0), "a buoy", tolerance)
    return swim("near", 0.0, 0.0, 0.0, target=target, heading=Heading(target), distance=0.5)


def sought(behaviour, folder: Path, extra: Mapping[str, float] = MappingProxyType({})) -> Dive:
    """Return what comes of a behaviour whose choices are decided, while a buoy is seen."""
    robot = write(behaviour, folder / "out")
    conditions = robot / "conditions.adb"
    text = conditions.read_text()
    asked = "Undecided.Nobody_Says (Condition, Known);\n      end if;"
    conditions.write_text(text.replace(asked, "Known.Charge > 0.3;\n      end if;"))
    port = unused_port()
    with telling(port, Detection(0.0, "a buoy", 0.9, 0.4, 1.2, 1.2, "front")):
        return run(build(robot), behaviour, folder, detections=port, extra=extra)


@pytest.mark.thorough
def test_an_object_is_approached_and_choices_are_made_by_what_cameras_see(tmp_path: Path) -> None:
    ways = {
        1: Transition(1, 2, condition="detected:a buoy", otherwise=4),
        2: Transition(2, 3, condition="charged", otherwise=4),
    }
    behaviour = dive(buoy(1.0), feedback_move("seen"), feedback_move("charged"), transitions=ways)
    found = sought(behaviour, tmp_path)
    assert found.status == 0, found.errors
    assert found.replayed.accepted, found.replayed.complaints
    assert [each.detail for each in read_logs([found.log]) if each.label == "choose"] == ["true", "true"]
    goal = found.world.trace.told[-1].values
    place = (0.4, 1.2, 1.2)
    away = [place[each] - goal[name] for each, name in enumerate(("North", "East", "Depth"))]
    assert hypot(*away) == pytest.approx(0.5, abs=0.02)
    assert goal["Heading"] == pytest.approx(degrees(atan2(away[1], away[0])), abs=2.0)


@pytest.mark.thorough
def test_an_object_is_looked_for_on_the_spot_and_along_a_spiral_not_far_away(tmp_path: Path) -> None:
    behaviour = dive(buoy(0.2))
    found = sought(behaviour, tmp_path, {"search.radius": 0.8})
    assert found.replayed.faults == {"naiad": "OBJECT_NOT_FOUND"}
    assert found.replayed.accepted, found.replayed.complaints
    ways = [(goal.values["Mode"], goal.values["FaceAlong"]) for goal in found.world.trace.told]
    assert ways == [("GO_TO", False), ("SEARCH", False), ("SEARCH", True), ("SURFACE", False)]


def test_the_vehicle_is_given_up_when_its_mission_stands_still(tmp_path: Path) -> None:
    hold = move("h", "HoldPosition", duration=0.5)
    behaviour = dive(hold, transitions={1: Transition(1, 2, condition="charged", otherwise=2)})
    robot = write(behaviour, tmp_path / "out")
    conditions = robot / "conditions.adb"
    asked = "return Undecided.Nobody_Says (Condition, Known);\n      end if;"
    slow = "delay (if Known.Charge < 0.0 then 0.0 else 6.0);\n         return True;\n      end if;"
    conditions.write_text(conditions.read_text().replace(asked, slow))
    found = run(build(robot), behaviour, tmp_path)
    assert found.status == 1
    reasons = [each.values["Reason"] for each in found.world.said("DecisionEmergency")]
    assert reasons[0] == "COMMANDS_SILENT"
    assert found.replayed.faults
    assert found.replayed.accepted, found.replayed.complaints


@pytest.mark.thorough
def test_a_lost_bus_is_a_fault_of_the_move_that_was_under_way(tmp_path: Path) -> None:
    behaviour = dive(swim("far", 30.0, 0.0, 1.0))
    found = run(build(write(behaviour, tmp_path / "out")), behaviour, tmp_path, cut=2.5)
    assert found.status == 1
    assert found.replayed.faults == {"naiad": "LINK_LOST"}
    assert found.replayed.accepted, found.replayed.complaints


@pytest.mark.thorough
def test_two_decision_centres_wait_for_each_other_over_the_bus_between_robots(tmp_path: Path) -> None:
    file = tmp_path / "pair.xmi"
    file.write_text(waiting_pair("Pool AUV"))
    registry = registry_with(mmrs_metamodels())
    root = read_model(file, registry).roots[0]
    behaviour = program_of(root, registry=registry)  # type: ignore[arg-type]
    out = write(behaviour, tmp_path / "out").parent
    programs = {name: build(out / f"robot-{name}") for name in ("a", "b")}
    with gateways(file, tmp_path, ("a", "b")) as files, ThreadPoolExecutor(2) as pool:
        begun = [
            pool.submit(run, programs[name], behaviour, tmp_path, robot=number, gateway=files[name])
            for number, name in enumerate(("a", "b"))
        ]
        dives = [each.result() for each in begun]
    assert [dive.status for dive in dives] == [0, 0], [dive.errors for dive in dives]
    result = replay(behaviour, read_logs([tmp_path / "logs"]))
    assert result.accepted, result.complaints
    assert result.outcome is Outcome.SUCCESS
