"""Robots of a scene, and their types."""

import pytest
from grounded import faults, geo, quad, scene, simple

from mmrs_core.errors import InvalidModelError
from mmrs_core.grounding.scenes import robot_type_of
from mmrs_core.languages import robot
from mmrs_core.scene import Policy


def test_clearance_is_half_the_diagonal_and_the_position_error(registry):
    found = scene(simple(registry, geo(), positionError=0.5)).robots[0]
    assert found.type.half_diagonal == 1.5
    assert found.clearance == 2.0


def test_robot_carries_what_the_mission_says_of_it(registry):
    made = simple(registry, geo())
    made.team.robots[0].payload = 0.3
    made.team.robots[0].returnHome = False
    made.team.robots[0].travelMode = "SAFE"
    found = scene(made).robots[0]
    assert (found.payload, found.return_home, found.travel_mode, found.kind) == (0.3, False, "SAFE", "")
    assert found.kinematics is None


def test_unknown_robot_type_is_refused_with_the_known_ones(registry):
    made = simple(registry, geo())
    made.team.robots[0].type = "Quad"
    with pytest.raises(InvalidModelError) as caught:
        scene(made)
    assert caught.value.diagnostics[0].hint == "known are: quad"


def test_literal_that_does_not_exist_is_refused(registry):
    made = simple(registry, geo())
    made.team.robots[0].travelMode = "RECKLESS"
    assert faults(made) == [
        "Robot 'r0' has the travelMode 'RECKLESS', which is none of SAFE, NORMAL, AGGRESSIVE"
    ]


def test_robot_type_sorts_capabilities_and_converts_batteries():
    made = quad(
        maxPayload=1.0,
        batteries=[robot.Battery(capacity=5000.0, voltage=22.2, rechargeTime=600.0)],
        movementCapabilities=[
            robot.MovementCapability(payloadWeight=kg, lifetime=900.0, speed=robot.Interval(min=0.0, max=8.0))
            for kg in (1.0, 0.5)
        ],
        devices=[
            robot.Device(
                id="cam",
                properties=[robot.Property(name="focal.length", value="8.8")],
                supportedActions=[
                    robot.SupportedAction(
                        name="TakePicture", duration=1.5, parameters=[robot.Parameter(key="zoom")]
                    )
                ],
            )
        ],
    )
    found = robot_type_of(made)
    assert [each.payload for each in found.capabilities] == [0.5, 1.0]
    assert found.batteries[0].energy == pytest.approx(5.0 * 22.2 * 3600)
    action = found.devices["cam"].actions["TakePicture"]
    assert (action.duration, action.parameters) == (1.5, ("zoom",))
    assert found.devices["cam"].properties == {"focal.length": "8.8"}


def test_robot_type_says_how_it_answers_faults():
    made = quad(policies=[robot.Policy(event="LINK_LOST", response="RETURN", after=5.0)])
    assert robot_type_of(made).policies == (Policy("LINK_LOST", "RETURN", 5.0),)


@pytest.mark.parametrize("feature", ["size", "movementCapabilities"])
def test_robot_type_without_what_planning_needs_is_refused(feature):
    made = quad()
    setattr(made, feature, None)
    with pytest.raises(InvalidModelError, match=feature):
        robot_type_of(made)
