import pytest
from mmrs_solar.irradiance import IRRADIANCE_CHECK

from mmrs_core.behaviour.program import BEHAVIOUR, Action, Move, Program, RobotProgram
from mmrs_core.contributions.checks import CheckInput, Status
from mmrs_core.scene import Frame

DEVICE_ACTION = ((BEHAVIOUR, "DeviceAction"), (BEHAVIOUR, "Action"))


def judged(*needs, **environment):
    actions = tuple(
        Action(DEVICE_ACTION, "StartCapture", "thermal", (("minimumIrradiance", need),)) for need in needs
    )
    moves = tuple(
        Move(f"m{index}", ((BEHAVIOUR, "GoTo"),), after=(each,)) for index, each in enumerate(actions)
    )
    robot = RobotProgram("Swift", "drone", "NORMAL", 0.0, None, (), moves, {}, 0, 0)
    program = Program("p", Frame("EPSG:4326", None, None), (robot,))
    return list(IRRADIANCE_CHECK.run(CheckInput(program, {}, {}, {}, environment=environment)))


def test_sunlight_that_is_enough_is_safe_with_what_is_left():
    (verdict,) = judged("600", "700", irradiance=780.0)
    assert (verdict.status, verdict.margin, verdict.unit, verdict.move) == (Status.SAFE, 80.0, "W/m²", "m1")


def test_too_little_sunlight_is_violated_by_the_move_that_needs_most():
    (verdict,) = judged("600", "700", irradiance=650.0)
    assert (verdict.status, verdict.margin, verdict.move) == (Status.VIOLATED, -50.0, "m1")
    assert verdict.message == "Swift: images need 700 W/m², the irradiance is 650 W/m²"


def test_sunlight_that_nobody_states_is_unknown():
    (verdict,) = judged("600", windSpeed=3.0)
    assert verdict.status is Status.UNKNOWN
    assert "the environment states no irradiance" in verdict.message


def test_a_need_that_is_no_number_is_unknown():
    (verdict,) = judged("bright", irradiance=900.0)
    assert verdict.status is Status.UNKNOWN


def test_behaviours_that_record_no_panels_are_not_asked():
    assert judged(irradiance=100.0) == []


@pytest.mark.parametrize("needed", ["nan", "inf"])
def test_a_need_that_is_not_finite_is_unknown(needed):
    (verdict,) = judged(needed, irradiance=900.0)
    assert (verdict.status, verdict.margin) == (Status.UNKNOWN, None)
