import ast
import json
import subprocess
import sys
from dataclasses import replace

import pytest
from counts import many
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mmrs_multicopter.testing import LAND, go_to, quad, robot_program, take_off, target_input, two_drones
from type_checks import mypy

from mmrs_core.behaviour.program import Heading, MoveTarget, Transition
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.render import render
from mmrs_core.generation.writing import write
from mmrs_core.scene import Device, DeviceAction, Frame, Policy
from mmrs_core.testing.programs import feedback, move, notify, photo, program
from mmrs_mavlink.plugin.controllers import MAVLINK_PYTHON
from mmrs_mavlink.plugin.plans.qgc import QGC_PLAN
from mmrs_mavlink.wiring import DeviceWiring, Wired

HOSTILE = [
    '"; import os; os.mkdir("canary"); "',
    "a\nimport os\nos.mkdir('canary')\n#",
    "*/",
    "${x}",
    "{{ 7*7 }}{% raw %}",
    "\\u000aimport os",
    "\u202eabc",
    "class",
    "json",
    "fleet",
    "'''",
    '"""\nimport os\nos.mkdir("canary")\n"""',
    "\x00\x1b[31m",
    "x" * 10_000,
]
names = st.text(min_size=1, max_size=30)


def generated(made, **options):
    files = render(MAVLINK_PYTHON, target_input(made, options.pop("types", None)), **options)
    return {file.path: file.content for file in files}


def refused(*moves, types=None, **robot):
    with pytest.raises(UnsupportedError) as error:
        generated(program(robot_program("alpha", moves, **robot)), types=types)
    return error.value.elements


def named(robots, tasks="t", moves="m", slots="s", conditions="c", texts="x"):
    """Return a behaviour with these names everywhere that models may hold names."""
    first = robot_program(
        robots[0],
        [
            replace(take_off("up", 5.0), id=f"{moves}1", task=tasks, rule=tasks),
            replace(
                go_to(f"{moves}2", (0.0, 9.0, 5.0), task=tasks),
                before=(feedback(texts, (texts, texts)), photo()),
                after=(notify((robots[1], slots)),),
            ),
            replace(LAND, id=f"{moves}3"),
        ],
        transitions={1: Transition(1, 2, condition=conditions, otherwise=3)},
    )
    second = robot_program(
        robots[1],
        [replace(take_off("up", 5.0), id=f"{moves}1"), replace(LAND, id=f"{moves}2")],
        home=(50.0, 0.0, 0.0),
        slots=(slots,),
        transitions={1: Transition(1, 2, waits=(slots,))},
    )
    return program(first, second, name=tasks)


def shape(source: bytes) -> str:
    """Return the syntax of a module without its texts and module names."""
    tree = ast.parse(source)
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            node.value = ""
    return ast.dump(tree)


def test_every_generated_python_file_compiles():
    for path, content in generated(two_drones()).items():
        if path.endswith(".py"):
            compile(content, path, "exec")


@pytest.mark.parametrize("hostile", HOSTILE, ids=lambda text: ascii(text)[:20])
def test_a_hostile_name_changes_nothing_but_texts(hostile):
    benign = generated(named(("alpha", "beta")))
    files = generated(named((hostile, hostile + "2"), hostile, hostile, hostile, hostile, hostile))
    robots = sorted(path for path in files if path.startswith("robot_"))
    plain = sorted(path for path in benign if path.startswith("robot_"))
    shapes = {shape(files[path]) for path in robots}
    assert shapes == {shape(benign[path]) for path in plain}
    assert shape(files["conditions.py"]) == shape(benign["conditions.py"])
    assert len(ast.parse(files["fleet.py"]).body) == len(ast.parse(benign["fleet.py"]).body)


@given(names)
@settings(max_examples=many(400, fast=8), suppress_health_check=[HealthCheck.too_slow])
def test_no_name_changes_anything_but_texts(text):
    benign = generated(named(("alpha", "beta")))
    files = generated(named((text, text + "!"), text, text, text, text, text))
    robots = [content for path, content in files.items() if path.startswith("robot_")]
    assert {shape(content) for content in robots} == {
        shape(content) for path, content in benign.items() if path.startswith("robot_")
    }


def test_hostile_names_run_without_effect(tmp_path):
    hostile = HOSTILE[0]
    made = named((hostile, HOSTILE[1]), HOSTILE[12], hostile, HOSTILE[1], hostile, HOSTILE[4])
    write(render(MAVLINK_PYTHON, target_input(made)), tmp_path)
    conditions = (tmp_path / "conditions.py").read_text("ascii").replace(": undecided,", ": lambda s: True,")
    (tmp_path / "conditions.py").write_text(conditions, "ascii")
    found = subprocess.run(
        [sys.executable, "-W", "error", "fleet.py", "--dry-run"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert found.returncode == 0, found.stderr
    assert not (tmp_path / "canary").exists()
    assert "\x1b" not in found.stderr


def test_two_robots_whose_names_look_alike_get_two_files():
    files = generated(named(("a b", "a_b")))
    assert len([path for path in files if path.startswith("robot_")]) == 2


def test_generated_files_are_formatted_as_people_format_theirs(tmp_path):
    write(render(MAVLINK_PYTHON, target_input(named(("alpha", "beta")))), tmp_path)
    ruff = [sys.executable, "-m", "ruff"]
    style = ["--isolated", "--line-length", "110", "."]
    formatted = subprocess.run([*ruff, "format", "--check", *style], cwd=tmp_path, check=False)
    checked = subprocess.run([*ruff, "check", "--select", "E,F,I", *style], cwd=tmp_path, check=False)
    assert (formatted.returncode, checked.returncode) == (0, 0)


@pytest.mark.thorough
def test_generated_files_pass_a_strict_type_check(tmp_path):
    write(render(MAVLINK_PYTHON, target_input(named(("alpha", "beta")))), tmp_path)
    options = ("--strict", "--ignore-missing-imports", "--python-version", "3.11")
    found = mypy(*options, ".", folder=tmp_path)
    assert found.returncode == 0, found.stdout


def test_every_step_carries_its_move_and_task():
    source = generated(two_drones())["robot_alpha.py"].decode()
    assert "# task photos, by rule by_hand" in source
    assert 'Step(\n            "a1",' in source
    assert source.count('task="photos"') == 4


def test_the_manifest_traces_every_step_to_move_and_task():
    manifest = json.loads(generated(two_drones())["mavlink-python.manifest.json"])
    steps = [t for t in manifest["trace"] if t["robot"] == "alpha" and t["move"]]
    assert [t["move"] for t in steps] == ["start", "up", "a1", "a2", "a3", "a4", "back", "down", "stop"]
    assert {t["task"] for t in steps} == {"", "photos"}


def test_conditions_are_the_users_file_and_only_there_if_there_are_choices():
    assert "conditions.py" not in generated(two_drones())
    files = render(MAVLINK_PYTHON, target_input(named(("a", "b"))))
    assert [file.path for file in files if file.once] == ["conditions.py"]


def test_policies_are_the_waits_then_the_robots_then_the_types():
    robot = robot_program(
        "alpha",
        [take_off("up", 5.0), LAND],
        slots=("go",),
        transitions={1: Transition(1, 2, waits=("go",), policies=(Policy("WAIT_TOO_LONG", "LAND", 9.0),))},
    )
    made = program(replace(robot, policies=(Policy("LINK_LOST", "HOLD"),)))
    kind = replace(quad(), policies=(Policy("LINK_LOST", "LAND"), Policy("BATTERY_LOW", "LAND")))
    source = render(MAVLINK_PYTHON, target_input(made, [kind]))[0].content.decode()
    assert 'Policy("LINK_LOST", "HOLD", 10.0)' in source
    assert 'Policy("BATTERY_LOW", "LAND")' in source
    assert 'Policy("LINK_LOST", "LAND"' not in source
    assert 'policies=(Policy("WAIT_TOO_LONG", "LAND", 9.0),)' in source


def test_a_response_to_a_lost_link_that_the_vehicle_cannot_give_by_itself_is_refused():
    surfaces = (Policy("LINK_LOST", "SURFACE"),)
    robot = robot_program(
        "alpha",
        [take_off("up", 5.0), LAND],
        slots=("go",),
        transitions={1: Transition(1, 2, waits=("go",), policies=surfaces)},
    )
    with pytest.raises(UnsupportedError) as error:
        generated(program(replace(robot, policies=surfaces)))
    assert error.value.elements == (
        "robot 'alpha': policy LINK_LOST: no copter does SURFACE as a failsafe",
        "robot 'alpha', move 'up': policy LINK_LOST: no copter does SURFACE as a failsafe",
    )


def test_an_object_is_looked_for_by_the_users_own_function():
    goes = replace(
        go_to("a", (0.0, 9.0, 5.0)), target=MoveTarget((0.0, 9.0, 5.0), "a buoy", 2.0), distance=3.0
    )
    files = generated(program(robot_program("alpha", [take_off("up", 5.0), goes, LAND])))
    source = files["robot_alpha.py"].decode()
    assert 'GoTo(Object("a buoy", Geographic(42.370081, 13.35, 5.0), 2.0), speed=5.0, distance=3.0)' in source
    assert b'"a buoy": not_looked_for,' in files["objects.py"]


def test_a_device_without_wiring_is_refused():
    bare = replace(quad(), devices={"camera": Device("camera", {}, {})})
    (fault,) = refused(take_off("up", 5.0), replace(LAND, before=(photo(),)), types=[bare])
    assert "no wiring property" in fault


def test_a_robot_without_a_home_is_refused():
    assert refused(take_off("up", 5.0), LAND, home=None) == (
        "robot 'alpha': its home is not known, and heights count from there",
    )


def test_a_speed_that_nobody_knows_is_refused():
    (fault,) = refused(take_off("up", 5.0), go_to("a", (0.0, 9.0, 5.0), speed=None), LAND, types=[])
    assert "its speed is not known" in fault


def test_what_is_lost_is_a_step_without_effect():
    spiral = replace(go_to("a", (0.0, 9.0, 5.0)), metaclasses=(("urn:x:1.0", "Spiral"),))
    made = program(robot_program("alpha", [take_off("up", 5.0), spiral, LAND]))
    source = generated(made, allow_lossy=True)["robot_alpha.py"].decode()
    assert "Skip(" in source


def test_a_device_on_the_robots_side_turns_the_robot():
    looks = go_to("a", (0.0, 9.0, 5.0), heading=Heading(MoveTarget((5.0, 5.0, 0.0)), "side", 90.0))
    side = Device("side", {"look": DeviceAction("look", 1.0)}, {"mount.yaw": "270"})
    made = program(robot_program("alpha", [take_off("up", 5.0), looks, LAND]))
    source = generated(made, types=[replace(quad(), devices={"side": side})])["robot_alpha.py"].decode()
    assert "angle=90.0, mount=270.0" in source


def crawler(**properties):
    """Return a ground vehicle with a camera."""
    camera = Device("camera", {"takePhoto": DeviceAction("takePhoto", 1.0)}, properties)
    robot = (("urn:mmrs:robot:1.0", "Robot"),)
    return replace(quad(), metaclasses=robot, devices={"camera": camera})


LOOK = Heading(MoveTarget((5.0, 5.0, 0.0)), "camera")
DRIVE = go_to("a", (0.0, 9.0, 0.0), heading=LOOK)
TURN = replace(move("b", "HeadTo"), heading=LOOK)


def test_a_ground_vehicle_that_is_to_turn_to_a_heading_is_refused():
    faults = refused(DRIVE, TURN, types=[crawler()])
    assert [fault.split(": ")[1] for fault in faults] == [
        "no ground vehicle turns to a heading on command; give the device a mavlink.gimbal"
    ] * 2


def test_a_turn_of_a_ground_vehicle_that_is_lost_is_a_step_without_effect():
    made = program(robot_program("alpha", [DRIVE, TURN]))
    source = generated(made, types=[crawler()], allow_lossy=True)["robot_alpha.py"].decode()
    assert "Skip(" in source
    assert "Look(" not in source


def test_a_gimbal_on_a_ground_vehicle_looks_where_it_is_to_look():
    made = program(robot_program("alpha", [DRIVE, TURN]))
    source = generated(made, types=[crawler(**{"mavlink.gimbal": "1"})])["robot_alpha.py"].decode()
    assert source.count("gimbal=True") == 2


def test_a_local_behaviour_has_local_places_relative_to_home():
    robot = robot_program(
        "a", [take_off("up", 5.0), go_to("b", (13.0, 24.0, 6.0)), LAND], home=(10.0, 20.0, 1.0)
    )
    files = generated(program(robot, frame=Frame("EPSG:4326", None, None)))
    assert b"GoTo(Local(4.0, 3.0, 5.0), speed=5.0)" in files["robot_a.py"]
    assert b"fence=" not in files["robot_a.py"]


def test_a_wiring_of_a_plugin_reaches_controllers_and_missions():
    wiring = DeviceWiring("kites.reel", "reels", lambda action, device: Wired(183, (9.0,), more=((184, ()),)))
    reel = Device("reel", {"pull": DeviceAction("pull", 2.0)}, {"kites.reel": "9"})
    pulls = replace(go_to("a", (0.0, 9.0, 5.0)), after=(photo("reel", "pull"),))
    made = program(robot_program("alpha", [take_off("up", 5.0), pulls, LAND]))
    given = target_input(made, [replace(quad(), devices={"reel": reel})])
    given = replace(given, extensions={"device_actions": {"kites.reel": wiring}})
    source = render(MAVLINK_PYTHON, given)[0].content.decode()
    operate = (
        'Operate("reel", "pull", MAV_CMD_DO_SET_SERVO, (9.0,), 2.0, more=((MAV_CMD_DO_REPEAT_SERVO, ()),))'
    )
    assert operate in " ".join(source.split()).replace("( ", "(").replace(", )", ")")
    plan = json.loads(render(QGC_PLAN, given)[0].content)
    assert [item["command"] for item in plan["mission"]["items"]] == [22, 178, 16, 183, 184, 19, 21]


@pytest.mark.parametrize(("properties", "said"), [({}, False), ({"mavlink.autopilot": "px4"}, True)])
def test_an_autopilot_that_is_planned_for_is_passed_on_where_it_is_no_ardupilot(properties, said):
    made = program(robot_program("alpha", [take_off("up", 5.0), LAND]))
    source = generated(made, types=[quad(**properties)])["robot_alpha.py"].decode()
    assert ('autopilot="px4"' in source) is said


def test_the_number_of_a_gimbal_is_passed_on():
    made = program(robot_program("alpha", [DRIVE]))
    given = target_input(made, [crawler(**{"mavlink.gimbal": "3"})])
    assert b"gimbal=True, device=3" in render(MAVLINK_PYTHON, given)[0].content
    plan = json.loads(render(QGC_PLAN, given)[0].content)
    assert [item["params"][0] for item in plan["mission"]["items"] if item["command"] == 195] == [3.0]


@pytest.mark.parametrize(
    ("event", "response", "why"),
    [
        ("BATTERY_LOW", "SURFACE", "no copter can answer it by SURFACE"),
        ("OBSTACLE", "STOP_THRUST", "no copter can answer it by STOP_THRUST"),
        ("POSITION_LOST", "RETURN", "without its position, the robot cannot respond with RETURN"),
        (
            "POSITION_LOST",
            "EMERGENCY_AREA",
            "without its position, the robot cannot respond with EMERGENCY_AREA",
        ),
    ],
)
def test_a_response_that_no_vehicle_can_give_is_refused(event, response, why):
    robot = replace(robot_program("alpha", [take_off("up", 5.0), LAND]), policies=(Policy(event, response),))
    with pytest.raises(UnsupportedError) as error:
        generated(program(robot))
    assert error.value.elements == (f"robot 'alpha': policy {event}: {why}",)


def test_a_gimbal_is_not_pointed_at_places_that_are_nowhere_on_the_earth():
    robot = robot_program("a", [DRIVE])
    made = program(robot, frame=Frame("EPSG:4326", None, None))
    with pytest.raises(UnsupportedError, match="places on the Earth, and the behaviour is local"):
        generated(made, types=[crawler(**{"mavlink.gimbal": "1"})])


def test_a_robot_without_a_home_is_refused_whatever_is_allowed():
    robot = robot_program("alpha", [take_off("up", 5.0), LAND], home=None)
    with pytest.raises(UnsupportedError, match="its home is not known"):
        generated(program(robot), allow_lossy=True)


def test_standard_conditions_are_decided_from_the_beginning():
    moves = [take_off("up", 5.0), go_to("a", (0.0, 9.0, 5.0)), LAND]
    choices = {
        1: Transition(1, 2, condition="wind-above:8", otherwise=3),
        2: Transition(2, 3, condition="calm", otherwise=4),
    }
    files = generated(program(robot_program("alpha", moves, transitions=choices)))
    source = files["conditions.py"].decode()
    assert '"wind-above:8": standard("wind-above:8"),' in source
    assert '"calm": undecided,' in source
