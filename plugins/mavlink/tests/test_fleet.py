"""The simulated fleet of a mission."""

import re
from shutil import copytree

import pytest
import typer

from mmrs_core.cli.settings import Settings
from mmrs_core.resources import shipped
from mmrs_mavlink.commands.fleet import PLACE, connected, equipped, members_of, parameter, station
from mmrs_mavlink.sitl import Settings as SimulatedSettings

TWO = {name: SimulatedSettings() for name in ("first", "second")}


@pytest.fixture(scope="module")
def members():
    """Return the robots of an example, by name."""
    return lambda example: members_of(Settings(), shipped("examples") / example)


def settings_of(member, **options):
    return equipped({"a": member}, options)["a"]


def test_each_vehicle_is_of_the_kind_of_its_robot_type(members):
    assert {"copter", "sub"} <= {each.kind for each in members("mixed-team").values()}


def test_batteries_are_those_of_the_robot_type_unless_options_replace_them(members):
    alba = members("carbon-dioxide")["Alba"]
    assert (alba.energy > 1200.0, alba.recharge > 0.0) == (True, True)
    own, given = settings_of(alba), settings_of(alba, energy=600.0, recharge=0.0)
    assert (own.energy, own.recharge) == (alba.energy, alba.recharge)
    assert (given.energy, given.recharge) == (600.0, 0.0)


def test_vehicles_of_a_mission_without_a_place_on_the_earth_stand_anywhere(tmp_path):
    project = tmp_path / "local"
    copytree(shipped("examples") / "handwritten", project)
    (project / "context.xmi").unlink()
    model = project / "behaviour.xmi"
    local = 'xsi:type="behaviour:RelativeCoordinate" name="middle of the square" x="0.0" y="0.0"/>'
    model.write_text(re.sub(r'xsi:type="behaviour:Geo[^>]*/>', local, model.read_text("utf-8")), "utf-8")
    left, right = members_of(Settings(), project).values()
    assert (left.latitude, left.longitude) == (right.latitude, right.longitude) == PLACE


@pytest.fixture
def connect():
    """Return a function that makes the two vehicles, and returns the arguments that connect to them."""
    made = {}

    def connect(port=14_550, speedup=1.0):
        vehicles, arguments = connected(equipped(TWO, {}), port, 10, "127.0.0.1", speedup)
        made.update(vehicles)
        return arguments

    yield connect
    for vehicle in made.values():
        vehicle.close()


@pytest.mark.parametrize(("speedup", "end"), [(1.0, "=udpin:127.0.0.1:14560@2"), (5.0, "--speedup 5")])
def test_the_arguments_are_those_of_controllers_and_of_mmrs_run(connect, speedup, end):
    assert " ".join(connect(speedup=speedup)).endswith(end)


def test_a_port_beyond_the_last_is_refused(connect):
    with pytest.raises(typer.BadParameter, match="65545"):
        connect(port=65_535)


@pytest.mark.parametrize(
    ("member", "options", "complaint"),
    [
        (SimulatedSettings(), {"parameters": {"NOSUCH": 1.0}}, "NOSUCH"),
        (SimulatedSettings("rover"), {"firmware": "px4"}, "px4"),
    ],
)
def test_what_a_vehicle_cannot_have_is_refused(member, options, complaint):
    with pytest.raises(typer.BadParameter, match=complaint):
        settings_of(member, **options)


@pytest.mark.parametrize("text", ["WPNAV_SPEED=nan", "WPNAV_SPEED", "WPNAV_SPEED=fast"])
def test_a_parameter_without_a_number_is_refused(text):
    with pytest.raises(typer.BadParameter, match="NAME=NUMBER"):
        parameter(text)


@pytest.mark.parametrize(
    ("text", "found"), [("14650", ("127.0.0.1", 14_650)), ("10.0.0.9:14550", ("10.0.0.9", 14_550))]
)
def test_a_ground_station_has_an_address(text, found):
    assert station(text) == found


@pytest.mark.parametrize("text", ["station", "127.0.0.1:", "0", "h:70000"])
def test_a_ground_station_without_a_port_is_refused(text):
    with pytest.raises(typer.BadParameter, match=r"not \[HOST:\]PORT"):
        station(text)
