"""A database is written for what a bus can carry, and for nothing else; models say where it is wrong."""

from pathlib import Path
from shutil import copytree

import cantools
import pytest

from mmrs_core.cli import run
from mmrs_core.resources import shipped

pytestmark = pytest.mark.real_time("vessels")

POOL = shipped("examples") / "pool"
FIGURES = 'operatingThrust="18.0" maxThrust="35.0"'


def written(folder: Path, old: str, new: str) -> Path:
    """Return the folder of a project in whose vehicle something was replaced once."""
    project = copytree(POOL, folder / "pool")
    file = project / "robots" / "pool-auv.xmi"
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new, 1), encoding="utf-8")
    return project


@pytest.mark.parametrize(
    ("old", "new", "place", "said"),
    [
        ('maxThrust="35.0"', 'maxThrust="NaN"', "pool-auv.xmi:34", "maxThrust is NaN"),
        ('maxThrust="35.0"', 'maxThrust="INF"', "pool-auv.xmi:34", "maxThrust: 'INF': not a number"),
        (FIGURES, 'operatingThrust="0" maxThrust="0"', "pool-auv.xmi:34", "maxThrust of Thruster 'T1' is 0"),
        (FIGURES, 'operatingThrust="-18" maxThrust="35"', "pool-auv.xmi:34", "of Thruster 'T1' is -18"),
        ('maxThrust="35.0"', 'maxThrust="1e9"', "type 'Pool AUV'", "thruster 0 ('T1'): max_thrust: "),
        ('maxPower="230.0"', 'maxPower="9999"', "robot 'Naiad'", "max_power: 9999.0 is more than 6553.5"),
        ('id="T2"', 'id="T1"', "pool-auv.xmi:40", "'T1' has the identifier of another"),
        ('id="T2"', 'id="T&quot;2"', "robot 'Naiad'", "thruster 1 ('T\"2'): id: 'T\"2' has '\"'"),
        ('id="T2"', 'id="T&#10;CM_ 2"', "pool-auv.xmi:40", "Thruster 'T\\nCM_ 2': "),
    ],
)  # fmt: skip
def test_what_no_bus_can_be_made_of(
    old: str, new: str, place: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "auv.dbc"
    assert run(["can", "dbc", str(written(tmp_path, old, new)), "-o", str(output)]) == 1
    told = capsys.readouterr()
    assert place in told.out + told.err
    assert said in told.out + told.err
    assert not output.exists()


def test_thirty_three_thrusters(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    one = POOL.joinpath("robots", "pool-auv.xmi").read_text(encoding="utf-8")
    block = one[one.index('<thrusters id="T1"') : one.index("</thrusters>")] + "</thrusters>"
    more = "".join(block.replace('id="T1"', f'id="M{number}"') for number in range(27))
    project = written(tmp_path, '<thrusters id="T1"', more + '<thrusters id="T1"')
    file = project / "robots" / "pool-auv.xmi"
    used = " ".join(f"//@thrusters.{number}" for number in range(6, 33))
    file.write_text(file.read_text("utf-8").replace('thrusters="', f'thrusters="{used} '), "utf-8")
    assert run(["can", "dbc", str(project)]) == 1
    assert "thrusters: 33, there are identifiers for 32" in capsys.readouterr().err


def test_the_example_has_a_bus(tmp_path: Path) -> None:
    output = tmp_path / "auv.dbc"
    assert run(["can", "dbc", str(POOL), "--robot", "Naiad", "-o", str(output)]) == 0
    database = cantools.database.load_file(output)
    assert database.version == "Naiad"
    thrust = database.get_message_by_name("Thruster5Command").get_signal_by_name("Thrust")
    assert thrust.maximum == pytest.approx(35.0, abs=0.002)
    assert run(["can", "dbc", str(POOL), "--robot", "Nobody"]) == 2
