"""`mmrs sitl` as users start it."""

import json
import shlex
import signal
import socket
import subprocess
import sys
import time

import pytest
from ports import free_port
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from real_flights.routes import COPTER, Route, on_px4, routes
from warm_python import python

from mmrs_core.cli import run
from mmrs_core.cli.settings import Settings
from mmrs_core.resources import shipped
from mmrs_mavlink.commands.fleet import members_of

pytestmark = pytest.mark.real_time("faults")


EXAMPLE = str(shipped("examples") / "carbon-dioxide")


def start(*arguments: str) -> subprocess.Popen[str]:
    command = [python(), "-W", "error", "-m", "mmrs_core", "sitl", EXAMPLE, *arguments]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    return subprocess.Popen(command, text=True, **pipes)


def finish(process: subprocess.Popen[str], typed: str | None = None) -> tuple[int, str, str]:
    out, said = process.communicate(typed, timeout=60)
    return process.returncode, out, said


def systems_at(port: int, seconds: float = 20.0) -> set[int]:
    """Return the systems that send to a port."""
    codec, systems = mavlink.MAVLink(None), set()
    codec.robust_parsing = True
    until = time.monotonic() + seconds
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ground:
        ground.bind(("127.0.0.1", port))
        ground.settimeout(0.2)
        while time.monotonic() < until and not systems:
            try:
                data = ground.recv(65_535)
            except TimeoutError:
                continue
            systems |= {message.get_srcSystem() for message in codec.parse_buffer(data) or ()}
    return systems


def test_a_project_gets_a_vehicle_for_each_robot_at_its_home():
    port = free_port()
    process = start("--port", str(port), "--port-step", "1")
    line = process.stdout.readline()
    links = shlex.split(line)[1::2]
    assert links == [
        f"{robot}=udpin:127.0.0.1:{port + number}@{number + 1}"
        for number, robot in enumerate(("Alba", "Brezza", "Cirro"))
    ]
    assert systems_at(port + 1) == {2}
    code, out, said = finish(process, "quit\n")
    assert code == 0, said
    assert out.count("0.0 s in motion") == 3
    assert "'Alba': copter, system 1, at 42.3700000, 13.3500000" in said


def test_vehicles_may_share_a_port():
    port = free_port()
    process = start("--port", str(port), "--port-step", "0")
    assert process.stdout.readline().count(f":{port}@") == 3
    assert systems_at(port)
    assert finish(process, "quit\n")[0] == 0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_ends_it_with_the_summaries(number):
    process = start("--port", str(free_port()))
    process.stdout.readline()
    process.send_signal(number)
    code, out, said = finish(process)
    assert code == 130
    assert "'Alba': 0.0 s in motion" in out
    assert "Traceback" not in said


def test_it_ends_on_time_with_its_result_as_json():
    code, out, said = finish(start("--port", str(free_port()), "--for", "1", "--speedup", "5", "--json"))
    assert code == 0, said
    result = json.loads(out)
    assert result["connect"][-2:] == ["--speedup", "5"]
    assert result["vehicles"]["Alba"]["armed"] is False


def test_typed_lines_inject_faults_and_report_errors():
    process = start("--port", str(free_port()))
    process.stdout.readline()
    code, _, said = finish(process, "Alba gps-lost\nall battery 0.2\nDrone9 gps-lost\nquit\n")
    assert code == 0
    assert "Alba: gps-lost" in said
    assert "Drone9: unknown robot; known are Alba, Brezza, Cirro, and all" in said


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["--fault", "Drone7:gps-lost@3"], "unknown robot 'Drone7'"),
        (["--fault", "battery=half@3"], "half"),
        (["--fault", "list"], "unknown fault; known are gps-lost"),
        (["--fault", "wind=strong"], "'strong' is not a finite number"),
        (["--parameter", "RTL_ALT"], "not NAME=NUMBER"),
        (["--speedup", "0"], "speedup"),
        (["--host", "nowhere.invalid"], "nowhere.invalid: cannot be resolved"),
        (["--fault", "battery=2"], "--fault battery 2: 2 is not from 0 to 1"),
        (["--fault", "obstacle=nan"], "'nan' is not a finite number"),
        (["--count", "2"], "--count"),
    ],
)
def test_a_wrong_command_line_is_a_usage_error(arguments, complaint, capsys):
    assert run(["sitl", EXAMPLE, "--for", "0.1", *arguments]) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert complaint in printed.err


@pytest.mark.parametrize(("of", "firmware"), [(lambda models: models, "ardupilot"), (on_px4, "px4")])
def test_a_vehicle_has_the_autopilot_that_its_robot_type_states(tmp_path, of, firmware):
    of(routes(Route("Alba", COPTER, ((0.0, 30.0, 12.0),), 5.0)))(tmp_path / "models")
    (alba,) = members_of(Settings(), tmp_path / "models" / "behaviour.xmi").values()
    assert alba.firmware == firmware


IN_A_TERMINAL = "import os, pty, sys; sys.exit(os.waitstatus_to_exitcode(pty.spawn(sys.argv[1:])))"


def test_it_runs_in_the_background_of_a_terminal():
    """A background process that reads from its terminal is stopped unless it ignores SIGTTIN."""
    command = f"{sys.executable} -m mmrs_core sitl {EXAMPLE} --port {free_port()} --for 2 & wait %1"
    shell = [sys.executable, "-c", IN_A_TERMINAL, "bash", "--norc", "-i", "-c", command]
    with subprocess.Popen(shell, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        try:
            out, _ = process.communicate(timeout=30.0)
        finally:
            process.kill()
    assert "in motion" in out
    assert process.returncode == 0


def test_a_folder_without_a_mission_is_refused(tmp_path):
    assert run(["sitl", str(tmp_path)]) == 3
