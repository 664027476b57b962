"""Reports of flights of generated controllers with simulated vehicles."""

import json
import shutil
import subprocess

import pytest
from ports import free_port
from warm_python import python

from mmrs_core.behaviour.log import read_logs
from mmrs_core.cli import run
from mmrs_core.resources import shipped
from mmrs_mavlink.sitl import Settings, SimulatedVehicle

HOMES = {"left": (42.3502, 13.399379), "right": (42.3502, 13.399621)}
PATIENCE = 90.0
ANSWERS = (
    ("conditions.py", ": undecided,", ": lambda state: True,"),
    ("objects.py", ": not_looked_for,", ": where_expected,"),
)


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    """Return a project whose two drones have flown with the controllers generated for them."""
    folder = tmp_path_factory.mktemp("flown") / "project"
    shutil.copytree(shipped("examples") / "handwritten", folder)
    code = folder / "code"
    wanted = ("--target", "mavlink-python", "-o", str(code))
    assert run(["generate", str(folder / "behaviour.xmi"), *wanted]) == 0
    for name, word, answer in ANSWERS:
        path = code / name
        path.write_text(path.read_text("ascii").replace(word, answer), "ascii")
    vehicles, links = [], []
    for robot, home in HOMES.items():
        port = free_port()
        vehicles.append(SimulatedVehicle(port, Settings("copter", *home), speedup=20.0))
        links += ["--connect", f"{robot}=udpin:127.0.0.1:{port}"]
    for vehicle in vehicles:
        vehicle.start()
    try:
        command = [python(), str(code / "fleet.py"), "--speedup", "20", "--log", str(folder / "logs")]
        done = subprocess.run([*command, *links], capture_output=True, text=True, timeout=PATIENCE)
    finally:
        for vehicle in vehicles:
            vehicle.stop()
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture
def project(flown, tmp_path):
    """Return a copy of the project that flew."""
    return shutil.copytree(flown, tmp_path / "project")


@pytest.fixture
def told(mmrs, project):
    def report():
        code, out, err = mmrs("report", project, project / "logs", "-o", project / "r.html", "--json")
        assert code == 0, err
        return json.loads(out)["report"]

    return report


def test_a_flight_is_told_as_it_went(told):
    report = told()
    assert (report["outcome"], report["complaints"], report["simulated"]) == ("success", [], False)
    assert report["begun"].endswith("Z")
    assert {robot["ending"] for robot in report["robots"]} == {"completed"}
    assert [link["by"] for link in report["links"]] == ["udp", "udp"]


def test_vehicles_that_fly_what_was_planned_are_near_their_ways(told):
    deviations = told()["deviations"]
    assert deviations
    for deviation in deviations:
        assert deviation["fixes"] > 50
        assert deviation["sideways"]["most"] < 1.0
        assert deviation["upwards"]["most"] < 1.5


def test_distances_as_flown_are_near_those_as_planned(told, mmrs, project):
    mmrs("simulate", project, "-o", project / "simulated")
    _, out, _ = mmrs("report", project, project / "simulated", "--json")
    planned = json.loads(out)["report"]["approaches"]
    assert planned
    for one, other in zip(told()["approaches"], planned, strict=True):
        assert (one["robot"], one["area"], one["required"]) == (
            other["robot"],
            other["area"],
            other["required"],
        )
        assert one["kept"] == pytest.approx(other["kept"], abs=0.7)


def test_the_photo_is_confirmed_and_has_its_place(told):
    photos = told()["photos"]
    assert photos
    assert {photo["state"] for photo in photos} == {"taken"}
    assert all(abs(photo["where"]["latitude"] - 42.3503) < 0.001 for photo in photos)


def test_the_page_tells_nothing_of_the_machine(told, project, tmp_path):
    told()
    text = (project / "r.html").read_text("utf-8")
    assert str(tmp_path) not in text
    assert "127.0.0.1" not in text
    assert "udpin" not in text


def test_after_a_power_loss_the_rest_is_used(told, project):
    box, log = project / "logs" / "left.blackbox.ndjson", project / "logs" / "left.jsonl"
    box.write_bytes(box.read_bytes()[: box.stat().st_size * 4 // 5] + b"\0" * 100)
    log.write_bytes(log.read_bytes()[: log.stat().st_size // 2])
    report = told()
    assert report["complaints"] == []
    left = next(robot for robot in report["robots"] if robot["robot"] == "left")
    assert left["ending"] == "log ends before the program"
    assert left["way"] > 1.0
    assert any(each.startswith("left.blackbox.ndjson:") for each in report["unknown"])
    assert any(each.startswith("left.jsonl:") for each in report["unknown"])


def test_a_preview_shows_the_flight(mmrs, project):
    code, _, err = mmrs("preview", project, "--logs", project / "logs", "-o", project / "out")
    assert code == 0, err
    text = (project / "out" / "preview.html").read_text("utf-8")
    assert "tracks are drawn within 0.2 m of the reported positions" in text


def test_a_replay_of_a_flight_knows_where_robots_were(mmrs, project):
    code, out, _ = mmrs("replay", project, project / "logs", "--steps", "--json")
    where = json.loads(out)["where"]
    assert code == 0
    assert len(where) == len(read_logs([project / "logs"]))
    assert sum(step["where"] is None for step in where) <= 2
