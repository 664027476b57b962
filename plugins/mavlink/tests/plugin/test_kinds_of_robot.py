"""Which vehicle carries a robot follows from its kind; a kind that names none is refused by its name."""

from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, go_to, quad, robot_program, take_off, target_input

from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.render import render
from mmrs_core.testing.programs import program
from mmrs_core.transformation.kinds import PLAIN_ROBOT
from mmrs_mavlink.plugin.controllers import MAVLINK_PYTHON
from mmrs_mavlink.plugin.plans.qgc import QGC_PLAN
from mmrs_mavlink.plugin.plans.wpl import WPL
from mmrs_mavlink.plugin.vehicles import profile_of_type
from mmrs_mavlink.profiles import ARDUPILOT, PROFILES

WORDS = {word for profile in PROFILES.values() for word in profile.words}
KITE = ("urn:kites:1.0", "Kite")
KITES = replace(quad(), metaclasses=(KITE, ("urn:mmrs:robot:1.0", "Robot")))

every_target = pytest.mark.parametrize("target", [MAVLINK_PYTHON, QGC_PLAN, WPL], ids=lambda each: each.name)


def kinds(vehicle):
    return {each.metaclass: each for each in (PLAIN_ROBOT, kite(vehicle))}


def kite(vehicle):
    return replace(PLAIN_ROBOT, name="kite", metaclass=KITE, vehicle=vehicle)


def flown(vehicle):
    moves = [take_off("up", 20.0), go_to("a", (0.0, 9.0, 20.0)), LAND]
    return replace(target_input(program(robot_program("alpha", moves)), [KITES]), robot_kinds=kinds(vehicle))


@every_target
@pytest.mark.parametrize("lossy", [False, True])
@pytest.mark.parametrize(("vehicle", "named"), [("", "no vehicle"), ("airship", "vehicle 'airship'")])
def test_a_robot_that_no_vehicle_carries_is_refused_by_the_name_of_its_kind(target, lossy, vehicle, named):
    with pytest.raises(UnsupportedError) as error:
        render(target, flown(vehicle), allow_lossy=lossy)
    said = " ".join((str(error.value), *error.value.elements))
    assert (
        f"robot 'alpha': is of kind 'kite', which names {named}; known are copter, ground, rover, sub" in said
    )


def test_a_robot_is_what_its_kind_says():
    for profile in PROFILES.values():
        found = profile_of_type(KITES, kinds(profile.vehicle), {})
        assert (found.vehicle, found.autopilot) == (profile.vehicle, ARDUPILOT)
    files = {each.path: each.content for each in render(MAVLINK_PYTHON, flown("copter"))}
    assert b'vehicle="copter"' in files["robot_alpha.py"]


def test_every_kind_that_is_installed_names_its_vehicle(contributions):
    installed = contributions.robot_kinds
    assert {each.name: each.vehicle in WORDS for each in installed.values()} == dict.fromkeys(
        (each.name for each in installed.values()), True
    )
