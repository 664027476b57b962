import os
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest
from dives import POOL, dive, diver, swim
from mmrs_auv.controllers.driver import main
from mmrs_auv.kinds import AUV_KIND
from mmrs_auv.targets.can_python.target import CAN_PYTHON
from mmrs_multicopter.testing import quad, robot_program
from ports import free_endpoint
from warm_python import python

from auv_vessel.sheet import from_json
from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.program import MoveTarget, Program, Transition
from mmrs_core.behaviour.replay import replay
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.render import render
from mmrs_core.generation.writing import write
from mmrs_core.scene import Policy
from mmrs_core.testing.programs import feedback, move, notify, program, use
from mmrs_core.transformation.kinds import MOVE_KINDS
from mmrs_mavlink.plugin.controllers import MAVLINK_PYTHON
from mmrs_mavlink.program import Local, Robot
from mmrs_runtime.semantics import Outcome


def given(behaviour: Program) -> TargetInput:
    kinds = {kind.metaclass: kind for kind in MOVE_KINDS}
    types = {each.name: each for each in (diver(), quad())}
    return TargetInput(behaviour, types, {AUV_KIND.metaclass: AUV_KIND}, kinds)


def pair() -> Program:
    """Return two vehicles: the second waits until the first has sampled."""
    sample = use("ctd", "Sample")
    told = feedback("done", ("by", 'it "is"'))
    first = robot_program(
        "Caßtor '1'",
        [swim("a", 2.0, 1.0, 1.0, after=(sample, told, notify(("Pollux", "go"))))],
        home=(0.0, 0.0, -0.5),
        type_name="Pool AUV",
    )
    stays = move("b", "HoldPosition", duration=1.0)
    second = robot_program(
        "Pollux",
        [stays, swim("c", 3.0, 5.0, 1.0)],
        home=(0.0, 5.0, -0.5),
        slots=("go",),
        transitions={1: Transition(1, 2, waits=("go",))},
        type_name="Pool AUV",
    )
    return program(first, second, name="pair", frame=POOL)


def generated(behaviour: Program, folder: Path) -> Path:
    write(render(CAN_PYTHON, given(behaviour)), folder)
    return folder


def call(folder: Path, *words: str, timeout: float = 120.0) -> subprocess.CompletedProcess[str]:
    """Run controllers."""
    process = begun(folder, "fleet.py", *words)
    said, told = process.communicate(timeout=timeout)
    return subprocess.CompletedProcess(process.args, process.returncode, said, told)


def begun(folder: Path, *words: str) -> subprocess.Popen[str]:
    """Begin controllers."""
    command = [python(), *words]
    return subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


BOOT = f"""
import glob, sys, runpy
sys.path += {[path for path in sys.path if path.endswith("site-packages")]!r}
class Barred:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in ("mmrs_core", "mmrs_mavlink", "pymavlink", "pyecore"):
            raise ImportError(name)
sys.meta_path.insert(0, Barred())
sys.path[:0] = [".", *glob.glob("wheels/*.whl")]
runpy.run_path("fleet.py", run_name="__main__")
"""
"""Runs controllers without this project, or MAVLink's library, in reach."""


def test_controllers_stand_alone_and_their_dry_logs_replay(tmp_path: Path) -> None:
    folder = generated(pair(), tmp_path / "code")
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    command = [sys.executable, "-S", "-c", BOOT, "--dry-run", "--log", str(tmp_path / "logs")]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    judged = replay(pair(), read_logs([tmp_path / "logs"]))
    assert judged.accepted
    assert judged.outcome is Outcome.SUCCESS


def test_a_program_that_was_killed_goes_on_where_its_log_ends(tmp_path: Path) -> None:
    behaviour = dive(*(swim(f"s{number}", 4.0, 4.0 * (number % 2), 1.0) for number in range(6)))
    folder, logs = generated(behaviour, tmp_path / "code"), tmp_path / "logs"
    words = ("--dry-run", "--log", str(logs), "--speedup")
    process = begun(folder, "fleet.py", *words, "10")
    log = logs / f"{behaviour.robots[0].id}.jsonl"
    until = time.monotonic() + 60.0
    while not (log.exists() and '"begin","move":"s3"' in log.read_text(encoding="utf-8")):
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < until
        time.sleep(0.02)
    process.kill()
    process.communicate()
    done = call(folder, *words, "500", "--resume")
    assert done.returncode == 0, done.stderr
    assert "'s1'" not in done.stderr
    judged = replay(behaviour, read_logs([logs]))
    assert (judged.complaints, judged.outcome) == ((), Outcome.SUCCESS)


def test_nothing_of_the_core_is_imported(tmp_path: Path) -> None:
    folder = generated(dive(swim("a", 1.0, 0.0, 1.0)), tmp_path)
    for file in folder.rglob("*.py"):
        assert "import mmrs_core" not in file.read_text(encoding="utf-8"), file
        assert "from mmrs_core" not in file.read_text(encoding="utf-8"), file


def test_each_robot_has_its_sheet(tmp_path: Path) -> None:
    folder = generated(pair(), tmp_path)
    sheet = from_json((folder / "robot_Pollux.json").read_text(encoding="utf-8"))
    assert (sheet.robot, sheet.home) == ("Pollux", (5.0, 0.0, 0.5))
    assert "command=" not in (folder / "robot_Pollux.py").read_text(encoding="utf-8")


def mixed() -> Program:
    """Return a drone, and a vehicle that waits for it."""
    stays = replace(move("stay", "HoldPosition", duration=1.0), after=(notify(("naiad", "go")),))
    waits = {0: Transition(0, 1, waits=("go",))}
    naiad = dive(swim("a", 1.0, 0.0, 1.0), slots=("go",), transitions=waits).robots[0]
    return program(robot_program("Kite", [stays]), naiad, name="mixed", frame=POOL)


def test_controllers_of_a_mixed_team_meet_by_zenoh(tmp_path: Path) -> None:
    for target, name in ((CAN_PYTHON, "can"), (MAVLINK_PYTHON, "mavlink")):
        write(render(target, given(mixed()), allow_lossy=True), tmp_path / name)
    common = ("--dry-run", "--log", str(tmp_path / "logs"), "--speedup", "10")
    endpoint = free_endpoint()
    naiad = begun(tmp_path / "can", "robot_naiad.py", *common, "--bus-listen", endpoint)
    kite = begun(tmp_path / "mavlink", "robot_Kite.py", *common, "--bus-connect", endpoint)
    said = [each.communicate(timeout=60)[1] for each in (naiad, kite)]
    assert (naiad.returncode, kite.returncode) == (0, 0), said
    judged = replay(mixed(), read_logs([tmp_path / "logs"]))
    assert (judged.accepted, judged.outcome) == (True, Outcome.SUCCESS)


def test_robots_of_other_kinds_are_left_out_where_that_is_allowed(tmp_path: Path) -> None:
    with pytest.raises(UnsupportedError, match="Kite"):
        render(CAN_PYTHON, given(mixed()))
    write(render(CAN_PYTHON, given(mixed()), allow_lossy=True), tmp_path / "code")
    assert sorted(path.name for path in (tmp_path / "code").glob("robot_*.py")) == ["robot_naiad.py"]
    alone = call(tmp_path / "code", "--dry-run", "--log", str(tmp_path / "logs"))
    assert alone.returncode == 2
    assert "needs 'Kite'" in alone.stderr


def test_actions_say_how_long_their_devices_take_for_them(tmp_path: Path) -> None:
    folder = generated(dive(swim("a", 1.0, 0.0, 1.0, after=(use("ctd", "Sample"),))), tmp_path)
    seconds = diver().devices["ctd"].actions["Sample"].duration
    assert seconds > 0.0
    said = f'Operate("ctd", "Sample", 0, 0.0, {seconds!r})'
    assert said in (folder / "robot_naiad.py").read_text(encoding="utf-8")


def test_a_vehicle_that_meets_others_has_what_it_meets_them_by(tmp_path: Path) -> None:
    write(render(CAN_PYTHON, given(mixed()), allow_lossy=True), tmp_path)
    assert "eclipse-zenoh==" in (tmp_path / "requirements.txt").read_text(encoding="utf-8")


def test_its_plan_is_that_of_all_other_controllers_of_the_mission(tmp_path: Path) -> None:
    folder = generated(pair(), tmp_path)
    assert repr(pair().fingerprint)[1:-1] in (folder / "robot_Pollux.py").read_text(encoding="utf-8")


def test_a_vehicle_that_is_not_there_ends_the_program(tmp_path: Path) -> None:
    folder = generated(dive(swim("a", 1.0, 0.0, 1.0)), tmp_path / "code")
    done = call(folder, "--can", "can0@127.0.0.1:9", "--log", str(tmp_path / "logs"))
    assert done.returncode == 5, done.stdout + done.stderr
    assert "127.0.0.1:9" in done.stdout + done.stderr


def test_what_controllers_cannot_do_is_refused() -> None:
    flees = replace(dive().robots[0], policies=(Policy("BATTERY_LOW", "EMERGENCY_AREA"),))
    flies = robot_program("Kite", [move("stay", "HoldPosition", duration=1.0)])
    bakes = swim("a", 1.0, 0.0, 1.0, after=(use("ctd", "Bake"),))
    much = replace(use("ctd", "Sample"), parameters=(("seconds", "1e5"),))
    for behaviour, said in (
        (replace(dive(), robots=(flees,)), "emergency area"),
        (program(flies, frame=POOL), "not an underwater vehicle"),
        (dive(bakes), "Bake"),
        (dive(home=None), "home"),
        (dive(swim("a", 1.0, 0.0, 80.0)), "leads 80 m deep, where its vehicle may go 49.6 m deep"),
        (dive(swim("a", 1.0, 0.0, 1.0, after=(much,))), "parameter 100000 of device 'ctd'"),
    ):
        with pytest.raises(UnsupportedError) as refused:
            render(CAN_PYTHON, given(behaviour))
        assert said in f"{refused.value} {refused.value.elements}"


def test_robots_in_separate_programs_meet_by_zenoh(tmp_path: Path) -> None:
    folder = generated(pair(), tmp_path / "code")
    endpoint = free_endpoint()
    common = ("--dry-run", "--log", str(tmp_path / "logs"), "--speedup", "50")
    modules = sorted(path.name for path in folder.glob("robot_*.py"))
    ways = (("--bus-listen", endpoint), ("--bus-connect", endpoint))
    programs = [begun(folder, module, *common, *way) for module, way in zip(modules, ways, strict=True)]
    said = [each.communicate(timeout=60)[1] for each in programs]
    assert [each.returncode for each in programs] == [0, 0], said
    judged = replay(pair(), read_logs([tmp_path / "logs"]))
    assert (judged.accepted, judged.outcome) == (True, Outcome.SUCCESS)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--detections", "4000"), "several robots"),
        (("--detections", "Nobody=4000"), "unknown robot 'Nobody'"),
        (("--detections", "Pollux=0"), "--detections 0: not a port"),
        (("--detections", "Pollux=4000", "--detections", "Caßtor '1'=4000"), "a port of their own"),
    ],
)
def test_ports_of_cameras_that_make_no_sense_are_refused(words, said, tmp_path, capsys) -> None:
    with pytest.raises(SystemExit) as ended:
        main([robot_called("Caßtor '1'"), robot_called("Pollux")], {}, arguments=[*words, "--dry-run"])
    assert ended.value.code == 2
    assert said in capsys.readouterr().err


def robot_called(id: str) -> Robot:
    return Robot(id, f"{id}.ndjson", "sub", Local(0.0, 0.0, 0.0), "a", ())


def test_objects_that_no_camera_looks_for_are_asked_for(tmp_path: Path) -> None:
    folder = generated(to_buoy(), tmp_path / "code")
    done = call(folder, "--dry-run", "--log", str(tmp_path / "logs"))
    assert done.returncode == 2
    assert "objects.py: finding 'red buoy' is not implemented yet" in done.stderr
    done = call(folder, "--dry-run", "--log", str(tmp_path / "logs"), "--detections", "4000")
    assert done.returncode == 0, done.stderr


def to_buoy() -> Program:
    seeks = replace(swim("a", 1.0, 2.0, 1.0), target=MoveTarget((1.0, 2.0, -1.0), "red buoy", 3.0))
    return dive(seeks)


def test_faults_that_no_vehicle_on_a_bus_can_make_are_refused(tmp_path: Path) -> None:
    folder = generated(dive(swim("a", 1.0, 0.0, 1.0)), tmp_path / "code")
    done = call(folder, "--log", str(tmp_path / "logs"), "--inject", "gps-lost@60")
    assert done.returncode == 2
    assert "--inject gps-lost@60: not supported by these vehicles" in done.stderr
