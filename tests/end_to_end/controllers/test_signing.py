"""Signed links: who has no key commands nobody, and is not believed."""

import pytest
from mmrs_multicopter.testing import LAND, robot_program, take_off

from mmrs_core.testing.programs import program

pytestmark = pytest.mark.real_time("controllers")

KEY = bytes(range(32))
UP_AND_DOWN = program(robot_program("alpha", [take_off("up", 5.0), LAND]))


def key_file(folder, content=KEY, mode=0o600):
    path = folder / "key"
    path.write_bytes(content)
    path.chmod(mode)
    return str(path)


def test_with_the_right_key_a_robot_flies(controllers, hangar, tmp_path):
    made = controllers(UP_AND_DOWN)
    _, links = hangar(UP_AND_DOWN, key=KEY)
    code, said = made.run("fleet.py", *links, "--signing-key", key_file(tmp_path))
    assert code == 0, said
    assert made.replayed().complaints == ()


@pytest.mark.parametrize("theirs", [b"", bytes(32)], ids=["unsigned", "other key"])
def test_a_vehicle_without_the_key_is_not_heard(controllers, hangar, tmp_path, theirs):
    made = controllers(UP_AND_DOWN)
    vehicles, links = hangar(UP_AND_DOWN, key=theirs)
    code, said = made.run("fleet.py", *links, "--signing-key", key_file(tmp_path), "--patience", "2")
    assert code == 5
    assert "no vehicle at" in said
    assert "frames from there could not be read, or are not signed with the key" in said
    assert not vehicles["alpha"].autopilot.history


def test_a_ground_station_without_the_key_commands_nothing(controllers, hangar, tmp_path):
    made = controllers(UP_AND_DOWN)
    vehicles, links = hangar(UP_AND_DOWN, key=KEY)
    code, _ = made.run("fleet.py", *links, "--patience", "2", "--answer-seconds", "0.1")
    assert code != 0
    assert not vehicles["alpha"].autopilot.armed
    assert not vehicles["alpha"].autopilot.history


@pytest.mark.parametrize(
    ("content", "mode", "complaint"),
    [(b"short", 0o600, "holds 5 bytes instead of 32"), (KEY, 0o644, "others may read it")],
)
def test_a_bad_key_is_a_usage_error(controllers, tmp_path, content, mode, complaint):
    made = controllers(UP_AND_DOWN)
    code, said = made.run("fleet.py", "--dry-run", "--signing-key", key_file(tmp_path, content, mode))
    assert code == 2
    assert complaint in said
