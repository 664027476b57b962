"""A response under the interpreter that fails itself, with a simulated vehicle."""

from math import nan

import pytest
from flight_crew import manned, robot_of
from patience import until

from mmrs_mavlink.driving.moves import Moves
from mmrs_mavlink.driving.response import Response
from mmrs_mavlink.program import Geographic, Policy
from mmrs_runtime.faults import FaultError

pytestmark = pytest.mark.real_time("parts of flights")

NOWHERE = tuple((move, (Geographic(nan, nan, nan),)) for move in ("up", "out"))


@pytest.fixture
def made():
    """Return a robot 22 metres north of its home whose emergency area the program cannot make out."""
    with manned(robot_of(escapes=NOWHERE)) as made:
        made.fly_out()
        yield made


def response_of(made) -> tuple[Response, list[BaseException]]:
    moves, failed = Moves(made.robot, made.vehicle, made.clock, {}, lambda kind, name, content: None), []
    moves.track = made.track
    response = Response(made.robot, made.vehicle, made.watch, moves, made.said.append, 20.0)
    response.failed = failed.append
    return response, failed


def test_a_response_that_fails_itself_halts_the_vehicle_and_is_told_as_not_done(made):
    response, failed = response_of(made)
    job = response.begin("EMERGENCY_AREA", None, lambda what, why, does: None, restored=True)
    job.run()
    assert made.mode == "hold"
    assert response.holds
    assert response.undone.startswith("the program itself fails: ValueError")
    assert response.undone.endswith(": it does HOLD")
    assert len(failed) == 1


def test_what_is_told_next_is_done_as_ever(made):
    response, _ = response_of(made)
    response.begin("EMERGENCY_AREA", None, lambda what, why, does: None, restored=True).run()
    response.begin("LAND", None, lambda what, why, does: None, restored=True).run()
    assert not made.simulated.autopilot.armed
    assert (response.holds, response.undone) == (False, "")


@pytest.mark.parametrize("mode", ["return", "altitude_hold"])
def test_a_vehicle_that_a_pilot_has_just_taken_is_left_to_him_whatever_is_ordered(made, mode):
    response, _ = response_of(made)
    made.simulated.faults.begin("stick", mode)
    until(lambda: made.vehicle.telemetry.mode() == made.simulated.autopilot.mode)
    with pytest.raises(FaultError, match="it is under external control"):
        response.begin("LAND", None, lambda what, why, does: None, restored=True).run()
    assert made.mode == mode


@pytest.mark.parametrize(
    ("answer", "stays"), [("CONTINUE", True), pytest.param("LAND", False, marks=pytest.mark.thorough)]
)
def test_a_vehicle_that_obeys_nothing_is_watched_where_it_would_not_come_down_by_itself(answer, stays):
    with manned(robot_of(Policy("LINK_LOST", answer))) as made:
        made.fly_out()
        made.vehicle.hold()
        made.simulated.faults.begin("silent", 176)
        response, _ = response_of(made)
        job = response.begin("RETURN", None, lambda what, why, does: None, restored=True)
        if not stays:
            with pytest.raises(FaultError, match="DO_SET_MODE"):
                job.run()
            return
        job.run()
        assert response.holds
        assert response.undone.startswith("HOLD cannot be carried out")


def test_a_return_that_cannot_be_steered_is_a_landing_and_told_as_that():
    with manned(robot_of(Policy("POSITION_LOST", "CONTINUE"))) as made:
        made.fly_out()
        made.vehicle.hold()
        made.simulated.autopilot.parameters["FS_EKF_ACTION"] = 0.0
        made.simulated.faults.begin("gps-lost")
        response, _ = response_of(made)
        decided = []
        response.begin("RETURN", None, lambda *words: decided.append(words[2]), restored=True).run()
        assert decided == ["HOLD", "LAND"]
        assert not made.simulated.autopilot.armed
        assert response.undone.endswith(": it does LAND")
