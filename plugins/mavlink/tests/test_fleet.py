"""Which vehicles a mission gets."""

from __future__ import annotations

import pytest
import typer

from mmrs_core.cli.settings import Settings
from mmrs_core.resources import shipped
from mmrs_mavlink.commands.fleet import Fleet, members_of, plain_members


def members(example: str):
    return {each.robot: each for each in members_of(Settings(), shipped("examples") / example)}


def common(**given) -> Fleet:
    usual = {"port": 14_550, "step": 10, "host": "127.0.0.1", "speedup": 1.0, "loss": 0.0, "delay": 0.0}
    more = {
        "seed": 0,
        "ground": "",
        "firmware": "ardupilot",
        "wind": "0,0",
        "gusts": "0",
        "energy": None,
        "recharge": None,
    }
    return Fleet(**{**usual, **more, "parameters": (), **given})


def settings_of(member, **given):
    ((_, vehicle),) = common(**given).vehicles([member])
    vehicle.stop()
    return vehicle.autopilot.settings


def test_each_robot_is_the_kind_of_vehicle_that_its_type_is():
    kinds = {each.kind for each in members("mixed-team").values()}
    assert {"copter", "sub"} <= kinds


def test_a_battery_lasts_as_the_type_says_and_more_in_hover():
    member = members("carbon-dioxide")["Alba"]
    assert member.energy > 1200.0
    assert settings_of(member).energy == member.energy
    assert settings_of(member, energy=600.0).energy == 600.0


def test_a_battery_is_charged_if_its_type_can_be():
    assert any(each.recharge > 0.0 for each in members("carbon-dioxide").values())
    assert settings_of(members("carbon-dioxide")["Alba"], recharge=0.0).recharge == 0.0


def test_vehicles_without_a_model_stand_side_by_side():
    first, second = plain_members(2, "42.37,13.35", "rover")
    assert first.home == (42.37, 13.35)
    assert second.home[1] > first.home[1]
    assert (second.robot, second.kind) == ("Vehicle2", "rover")


@pytest.mark.parametrize(("speedup", "end"), [(1.0, "=udpin:127.0.0.1:14560@2"), (5.0, "--speedup 5")])
def test_the_arguments_are_those_of_controllers_and_of_mmrs_run(speedup, end):
    given = plain_members(2, "42.37,13.35", "copter")
    assert " ".join(common(speedup=speedup).arguments(given)).endswith(end)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"wind": "nan,0"}, "two numbers"),
        ({"parameters": ("WPNAV_SPEED=nan",)}, "NAME=NUMBER"),
        ({"parameters": ("NOSUCH=1",)}, "NOSUCH"),
        ({"port": 65_535}, "65545"),
    ],
)
def test_what_makes_no_sense_is_refused(given, told):
    with pytest.raises(typer.BadParameter, match=told):
        common(**given).vehicles(plain_members(2, "42.37,13.35", "copter"))


def test_a_ground_station_that_looks_on_is_reached_by_a_radio_of_its_own():
    ((_, vehicle),) = common(ground="14650").vehicles(plain_members(1, "42.37,13.35", "copter"))
    assert len(vehicle.radios) == 2
    vehicle.stop()


@pytest.mark.parametrize("text", ["station", "127.0.0.1:", "0", "127.0.0.1:70000"])
def test_a_ground_station_without_a_port_is_refused(text):
    with pytest.raises(typer.BadParameter, match=r"not \[HOST:\]PORT"):
        common(ground=text).vehicles(plain_members(1, "42.37,13.35", "copter"))
