import os
import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest
from ada_centres import judge, write
from dives import dive, diver, swim
from hypothesis import given, settings
from hypothesis import strategies as st
from mmrs_auv.targets.ada import literals, tables
from mmrs_auv.targets.ada.bus import catalogue
from mmrs_auv.targets.ada.refusals import refusals
from mmrs_auv.targets.ada.target import ADA

from mmrs_core.behaviour.program import BEHAVIOUR, Action, Heading, MoveTarget, Transition
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.render import render
from mmrs_core.scene import Policy
from mmrs_core.testing.conformance.missions import run_command
from mmrs_core.testing.programs import feedback, installed, move
from mmrs_core.testing.small_programs import notify

NASTY = ('"; end Build; --', "é\n🦑\x7f\t", "'" * 70_000)
names = st.text(st.characters(exclude_categories=("Cs",)), min_size=1, max_size=60)


@pytest.fixture(scope="module")
def compiler():
    if shutil.which("gnatmake") is None:
        message = "gnatmake is not installed: compiles decision centres in Ada"
        pytest.fail(message) if os.environ.get("MMRS_REQUIRE_PEERS") == "1" else pytest.skip(message)


def input_of(behaviour, type=None):
    kind = type or diver()
    return TargetInput(behaviour, {kind.name: kind}, installed().robot_kinds, installed().move_kinds)


def bound_by(policy):
    """Return a dive with a policy of its mission."""
    made = dive(swim("a", 1.0, 2.0, 1.0))
    return replace(made, robots=(replace(made.robots[0], policies=(policy,)),))


def mission_of(behaviour, type=None, *, allow_lossy=False):
    """Return what is written of the first robot's mission."""
    made = render(ADA, input_of(behaviour, type), allow_lossy=allow_lossy)
    files = {file.path: file.content for file in made}
    return files["robot-naiad/mission.adb"].decode()


def read_back(expression):
    """Return the text that an expression of Ada stands for, read by nothing of ours."""
    data = bytearray()
    for plain, code in re.findall(r'"((?:[^"])*)"|Character\'Val \((\d+)\)', expression):
        data += plain.encode("ascii") if not code else bytes([int(code)])
    return data.decode("utf-8")


@settings(max_examples=50)
@given(st.text(st.characters(exclude_categories=("Cs",))))
def test_a_text_is_written_so_that_it_can_be_read_back_and_lines_stay_short(text):
    made = literals.string(text)
    assert read_back(made) == text
    assert made.isascii()
    assert max(map(len, made.splitlines())) < 250


def test_a_number_that_compilers_warn_of_is_zero():
    assert literals.value(5e-324) == literals.value(-2e-308) == "0.0"


@given(st.floats(allow_nan=False, allow_infinity=False, allow_subnormal=False))
def test_a_number_keeps_its_value(number):
    made = literals.value(number)
    assert re.fullmatch(r"\(?-?\d+\.\d+(E-?\d+)?\)?", made)
    assert float(made.strip("()")) == number


@pytest.mark.parametrize("wrong", [float("nan"), float("inf"), object(), None])
def test_what_ada_has_no_expression_for_is_refused(wrong):
    with pytest.raises(ValueError):
        literals.value(wrong)


def named(words):
    """Return a behaviour in which everything is called so."""
    first, second, third = (f"{word}{number}" for number, word in enumerate(words))
    moves = [
        swim(first, 1.0, 2.0, 1.0, after=(feedback(second), notify(("naiad", third))), task=second),
        swim(second, -1.0, 2.0, 1.0, task=third, rule=first),
    ]
    ways = {1: Transition(1, 2, waits=(third,), condition=words[0], otherwise=3)}
    return dive(*moves, slots=(third,), transitions=ways)


RESERVED = ("abort", "begin", "end", "is", "null", "package", "Move", "Plan", "a", "A")


def test_names_that_mean_something_to_ada_are_names_like_others(tmp_path, compiler):
    moves = [swim(word, 1.0, 2.0, 1.0, after=(notify(("naiad", word)),), task=word) for word in RESERVED]
    many = [swim(str(number), 1.0, 2.0, 1.0) for number in range(200)]
    waits = {len(RESERVED): Transition(len(RESERVED), len(RESERVED) + 1, waits=RESERVED)}
    behaviour = dive(*moves, *many, slots=RESERVED, transitions=waits)
    assert judge(write(behaviour, tmp_path)) == ""


@pytest.mark.parametrize("order", range(3))
def test_names_of_any_kind_compile_without_a_warning(order, tmp_path, compiler):
    words = NASTY[order:] + NASTY[:order]
    assert judge(write(named(words), tmp_path)) == ""


@pytest.mark.parametrize(
    ("condition", "undecided"),
    [
        ("\x1f", 1),
        ("battery-below:0.3", 0),
        ('detected:a "b\n', 0),
        ('found:a "b\n', 0),
        ("wind-above:3", 1),
        ("battery-below:low", 1),
    ],
)
def test_conditions_of_any_kind_compile_without_a_warning(condition, undecided, tmp_path, compiler):
    ways = {1: Transition(1, 2, condition=condition, otherwise=3)}
    moves = [swim("a", 1.0, 2.0, 1.0), swim("b", 0.0, 2.0, 1.0)]
    robot = write(dive(*moves, transitions=ways), tmp_path)
    assert judge(robot) == ""
    assert (robot / "conditions.adb").read_text().count("Nobody_Says (") == 1 + undecided


EXAMPLES = Path(__file__).parents[4] / "examples"
LONGER = [pytest.param(name, marks=pytest.mark.thorough) for name in ("pool", "outfall", "two-auv-survey")]


@pytest.mark.parametrize("example", ["pool-course", *LONGER])
def test_examples_lack_nothing_and_compile_without_a_warning(example, tmp_path, compiler):
    project = shutil.copytree(EXAMPLES / example, tmp_path / example)
    run_command("plan", project)
    run_command("generate", project, "--target", "ada", "-o", tmp_path / "out")
    robots = sorted((tmp_path / "out").glob("robot-*"))
    assert robots
    assert [judge(robot) for robot in robots] == [""] * len(robots)


@pytest.mark.thorough
@pytest.mark.skipif(shutil.which("gprbuild") is None, reason="gprbuild is not installed")
def test_the_project_is_built_by_gprbuild(tmp_path):
    robot = write(dive(swim("a", 1.0, 2.0, 1.0)), tmp_path)
    done = subprocess.run(["gprbuild", "-q"], cwd=robot, capture_output=True, text=True, timeout=600)
    assert (done.returncode, done.stdout + done.stderr) == (0, "")
    assert (robot / "decision_centre").exists()


@pytest.mark.parametrize(
    ("policy", "refused"),
    [
        (Policy("BATTERY_LOW", "RETURN", 5.0), False),
        (Policy("OBSTACLE", "HOLD"), False),
        (Policy("DEVICE_SILENT", "CONTINUE"), False),
        (Policy("GROUND_LOST", "EMERGENCY_AREA"), False),
        (Policy("BATTERY_LOW", "EMERGENCY_AREA"), True),
        (Policy("POSITION_LOST", "RETURN"), True),
        (Policy("LOG_FAILED", "CONTINUE"), True),
    ],
)
def test_policies_that_it_does_not_keep_are_refused_and_else_it_comes_up(policy, refused):
    found = [each for each in refusals(input_of(bound_by(policy))) if policy.event in each]
    assert bool(found) == refused


@pytest.mark.parametrize("event", ["BATTERY_LOW", "POSITION_LOST"])
def test_what_cannot_be_done_about_a_fault_is_to_come_up_where_that_is_allowed(event):
    lost = bound_by(Policy(event, "EMERGENCY_AREA"))
    with pytest.raises(UnsupportedError):
        mission_of(lost)
    assert f"Into.Answer ({event}) := Comes_Up;" in mission_of(lost, allow_lossy=True)


def test_a_policy_of_the_type_counts_only_where_the_mission_has_none():
    fearful = replace(diver(), policies=(Policy("BATTERY_LOW", "RETURN"),))
    mission = bound_by(Policy("BATTERY_LOW", "HOLD", 7.0))
    assert "Into.Bears (BATTERY_LOW) := 7.0;" in mission_of(mission, fearful)
    assert "Into.Answer (BATTERY_LOW) := Holds_Place;" in mission_of(mission, fearful)
    assert "Into.Answer (BATTERY_LOW) := Backs_Out;" in mission_of(dive(swim("a", 1.0, 2.0, 1.0)), fearful)


def test_places_and_parameters_that_no_message_holds_are_refused():
    far = swim("far", 9000.0, 0.0, 1.0)
    huge = Action(((BEHAVIOUR, "DeviceAction"),), "Sample", "ctd", (("seconds", "10000"),))
    found = " ".join(refusals(input_of(dive(far, swim("a", 0.0, 0.0, 1.0, after=(huge,))))))
    assert "9000 m to the east" in found
    assert "parameter 10000 of device 'ctd'" in found


@pytest.mark.parametrize(
    ("moved", "wrong"),
    [
        (swim("a", 1.0, 2.0, 1.0, speed=float("nan")), "speed is nan"),
        (swim("a", 1.0, float("inf"), 1.0), "target is inf"),
        (
            swim("a", 1.0, 2.0, 1.0, heading=Heading(MoveTarget((1.0, 2.0, 3.0)), "", float("nan"))),
            "angle is nan",
        ),
        (move("a", "HoldPosition", duration=float("inf")), "duration is inf"),
    ],
)
def test_what_is_no_number_is_refused_and_its_move_left_out_where_that_is_allowed(moved, wrong):
    assert any(f"move 'a': its {wrong}" in each for each in refusals(input_of(dive(moved))))
    assert "Made := (Kind => Holds, Way => Takes" in mission_of(dive(moved), allow_lossy=True)


@pytest.mark.parametrize(("speed", "said"), [(0.001, "0.02"), (0.3, "0.3"), (9.0, "0.8"), (None, "0.6")])
def test_speeds_are_those_that_the_vehicle_can_and_its_bus_can_say(speed, said):
    assert f"Made.Speed := {said}" in mission_of(dive(swim("a", 1.0, 2.0, 1.0, speed=speed)))


def test_how_deep_a_vehicle_lies_at_the_surface_is_what_its_height_says():
    kind = diver()
    size = kind.part.attributes["size"]
    high = replace(size, attributes={**size.attributes, "height": 1.2})
    tall = replace(kind, part=replace(kind.part, attributes={**kind.part.attributes, "size": high}))
    assert "Into.Afloat := 0.7;" in mission_of(dive(), tall)
    bare = {name: value for name, value in kind.part.attributes.items() if name != "size"}
    assert "Into.Afloat := 0.0;" in mission_of(
        dive(), replace(kind, part=replace(kind.part, attributes=bare))
    )


def test_what_a_readme_says_of_responses_is_what_decision_centres_do():
    files = {each.path: each.content.decode() for each in render(ADA, input_of(dive()))}
    assert "| CONDITION\\_FAILED | Holds\\_Place |" in files["README.md"]
    assert "CONDITION_FAILED => Holds_Place" in files["common/tables.ads"]


def test_batteries_are_charged_at_the_surface():
    behaviour = dive(move("r", "Recharge", duration=9.0))
    assert list(refusals(input_of(behaviour))) == []
    assert re.search(r"Kind => Charges.*\n.*\n.*\n\s+Made.Seconds := 9.0;", mission_of(behaviour))


def test_a_device_that_looks_aside_is_pointed_by_turning_the_vehicle():
    type = diver()
    camera = replace(type.devices["front-camera"], properties={"mount.yaw": "90"})
    type = replace(type, devices={**type.devices, "front-camera": camera})
    aside = swim("a", 1.0, 2.0, 1.0, heading=Heading(MoveTarget((1.0, 9.0, -1.0)), "front-camera", 10.0))
    assert "Made.Angle := 100.0;" in mission_of(dive(aside), type)


def test_a_wait_takes_as_long_as_its_own_policy_says():
    own = Transition(1, 2, waits=("go",), policies=(Policy("WAIT_TOO_LONG", "HOLD", 9.0),))
    behaviour = dive(swim("a", 1.0, 2.0, 1.0), slots=("go",), transitions={1: own})
    mission = mission_of(behaviour)
    assert "Made.Bears (WAIT_TOO_LONG) := 9.0;" in mission
    assert "Made.Answer (WAIT_TOO_LONG) := Holds_Place;" in mission
    assert "Into.Bears (WAIT_TOO_LONG)" not in mission


@pytest.mark.thorough
@settings(max_examples=40, deadline=None)
@given(st.tuples(names, names, names))
def test_random_names_compile_without_a_warning(tmp_path_factory, compiler, words):
    assert judge(write(named(words), tmp_path_factory.mktemp("ada"))) == ""


def test_the_catalogue_holds_what_a_decision_centre_says_and_hears():
    messages = {each["name"]: each for each in catalogue()["messages"]}
    assert messages["GoalPose"]["id"] == 0x401
    assert {field["name"] for field in messages["Progress"]["fields"]} == {
        "Goal", "State", "Distance", "Sequence", "Check",
    }  # fmt: skip


def test_a_decision_centre_goes_by_the_figures_of_the_interpreter(monkeypatch):
    monkeypatch.setitem(tables.METRES, "POSITION_LOST", 7.25)
    files = {each.path: each.content.decode() for each in render(ADA, input_of(dive()))}
    assert "LIMIT_POSITION_LOST : constant := 7.25;" in files["common/tables.ads"]
    assert "less well than to 7.25 m" in files["README.md"]
