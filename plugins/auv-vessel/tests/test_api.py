import threading
from collections.abc import Mapping
from dataclasses import replace

import pytest
from sample_vessels import pool_sheet
from vessel_rig import Rig

from auv_vessel.api import Craft
from auv_vessel.decision.duties import ThrusterNews
from auv_vessel.decision.duty_control import FaultMonitor
from auv_vessel.goals import Goal, goal_frames, goal_of, within_rating
from auv_vessel.wire.codec import Codec, Received


class Listener:
    """Hears what a craft says, and tells it what a vehicle would."""

    def __init__(self) -> None:
        self.sheet = pool_sheet()
        self.craft = Craft(self.sheet, Codec(self.sheet))
        self._codec = Codec(self.sheet)
        self.now = 0.0

    def tell(self, name: str, **values: object) -> None:
        self.craft.hear(self._codec.encode(name, **values), self.now)

    def tick(self) -> list[Received]:
        self.now += self.craft.period
        found = [self._codec.decode(frame) for frame in self.craft.tick(self.now)]
        assert None not in found
        return [each for each in found if each is not None]

    def goal(self) -> Goal:
        said = {each.name: each for each in self.tick()}
        return goal_of(said["GoalPlace"], said["GoalPose"])


def values_of(said: list[Received], name: str) -> list[Mapping[str, object]]:
    return [dict(each.values) for each in said if each.name == name]


def test_thrusters_that_fail_are_told_once_and_are_no_sign_of_life() -> None:
    listener = Listener()
    drives = ThrusterNews(listener.craft, listener.sheet)
    for drive in ("RUNS", "FAULT", "FAULT"):
        listener.tell("Thruster2Status", Thrust=0.0, Power=0.0, Drive=drive)
    assert drives.news() == (("ERROR", f"thruster '{listener.sheet.thrusters[2].id}' has failed"),)
    assert drives.news() == ()
    listener.tell("Thruster2Status", Thrust=0.0, Power=0.0, Drive="RUNS")
    assert drives.news() == (("NOTICE", f"thruster '{listener.sheet.thrusters[2].id}' works again"),)
    assert listener.craft.state().silent == float("inf")


def test_what_is_borne_lasts_by_the_time_in_which_a_vehicle_was_heard() -> None:
    """A stall of this program, in which only clocks on the wall go on, makes nothing last longer."""
    listener = Listener()
    watch = FaultMonitor(listener.craft, 0.1, after=lambda event: 1.0, clearance=3.0)
    found = []
    for _ in range(8):
        listener.tell("Depth", Depth=1.0, Uncertainty=0.1, Trusted=True)
        listener.tell("Health", Leak=False, Charge=0.9, Power=1.0, SonarRange=2.0)
        found.append(watch.failure())
        listener.tick()
    assert [each and each.event for each in found] == [None] * 5 + ["OBSTACLE"] * 3


@pytest.mark.parametrize("mode", ["IDLE", "HOLD", "GO_TO", "TURN", "SURFACE", "SEARCH"])
def test_a_goal_that_is_said_is_the_goal_that_is_heard(mode: str) -> None:
    codec = Codec(pool_sheet())
    goal = Goal(mode, -12.345, 678.9, 12.34, 271.5, 0.5, mode == "GO_TO", 7)
    place, pose = (codec.decode(frame) for frame in goal_frames(codec, goal))
    assert goal_of(place, pose) == goal


def test_a_goal_is_kept_within_what_the_vehicle_bears() -> None:
    sheet = pool_sheet()
    kept = within_rating(Goal("GO_TO", depth=500.0, speed=3.0), sheet)
    assert (kept.depth, kept.speed) == (sheet.max_depth, sheet.speed)


def test_a_goal_is_repeated_until_the_next_one() -> None:
    listener = Listener()
    number = listener.craft.go_to(1.0, 2.0, 3.0, speed=0.4, heading=90.0)
    goals = {listener.goal() for _ in range(5)}
    assert goals == {Goal("GO_TO", 1.0, 2.0, 3.0, 90.0, 0.4, False, number)}
    assert listener.craft.turn(45.0) != number
    assert listener.goal().mode == "TURN"


def test_without_a_heading_it_faces_where_it_goes() -> None:
    listener = Listener()
    listener.craft.go_to(1.0, 2.0, 3.0)
    assert listener.goal().along


def test_it_holds_where_it_is() -> None:
    listener = Listener()
    listener.tell("Position", North=4.0, East=-5.0)
    listener.tell("Depth", Depth=2.5, Uncertainty=0.1, Trusted=True)
    listener.tell("Pose", Roll=0.0, Pitch=0.0, Heading=123.0)
    number = listener.craft.hold()
    assert listener.goal() == Goal("HOLD", 4.0, -5.0, 2.5, 123.0, 0.0, False, number)


def test_progress_of_another_goal_is_not_that_of_this_one() -> None:
    listener = Listener()
    first = listener.craft.go_to(1.0, 0.0, 1.0)
    second = listener.craft.go_to(2.0, 0.0, 1.0)
    listener.tell("Progress", Goal=first, State="REACHED", Distance=0.0)
    assert listener.craft.state().progress == "NONE"
    listener.tell("Progress", Goal=second, State="ACTIVE", Distance=1.5)
    state = listener.craft.state()
    assert (state.goal, state.progress, state.distance) == (second, "ACTIVE", pytest.approx(1.5))


def test_a_value_that_no_message_holds_is_refused_at_once() -> None:
    listener = Listener()
    before = listener.goal()
    with pytest.raises(ValueError, match=r"GoalPlace\.North"):
        listener.craft.go_to(1e6, 0.0, 1.0)
    assert listener.goal() == before


def test_a_device_is_asked_until_it_answers() -> None:
    listener = Listener()
    request = listener.craft.operate("ctd", 3, 2.5)
    asked = {"Device": 1, "Action": 3, "Parameter": pytest.approx(2.5), "Request": request}
    for _ in range(3):
        assert values_of(listener.tick(), "DeviceCommand") == [asked]
    listener.tell("DeviceStatus", Device=1, Request=request, State="ACTIVE")
    asked_again = [len(values_of(listener.tick(), "DeviceCommand")) for _ in range(10)]
    assert sum(asked_again) == 2
    listener.tell("DeviceStatus", Device=1, Request=request, State="REACHED")
    assert listener.craft.state().devices[request] == "REACHED"
    assert not any(values_of(listener.tick(), "DeviceCommand") for _ in range(10))


def test_a_device_is_not_asked_for_what_it_was_asked_before_the_last() -> None:
    listener = Listener()
    listener.craft.operate("ctd", 1)
    other, later = listener.craft.operate("front-camera", 2), listener.craft.operate("ctd", 3)
    asked = {values["Request"] for values in values_of(listener.tick(), "DeviceCommand")}
    assert asked == {other, later}


def test_a_device_that_is_not_there_is_refused() -> None:
    with pytest.raises(ValueError, match="no device 'torch'"):
        Listener().craft.operate("torch", 0)


def test_an_emergency_is_said_again_and_again() -> None:
    listener = Listener()
    listener.craft.emergency("POLICY", release=False)
    said = [values_of(listener.tick(), "DecisionEmergency") for _ in range(10)]
    assert said == [[{"Reason": "POLICY", "Release": False}]] * 10
    assert listener.craft.state().emergency == "POLICY"


def test_the_place_is_lost_when_it_is_too_uncertain_or_nothing_is_trusted() -> None:
    listener = Listener()
    assert listener.craft.state().position_lost
    listener.tell("Depth", Depth=2.5, Uncertainty=3.0, Trusted=True)
    assert not listener.craft.state().position_lost
    listener.tell("Depth", Depth=2.5, Uncertainty=11.0, Trusted=True)
    assert listener.craft.state().position_lost
    listener.tell("Depth", Depth=2.5, Uncertainty=3.0, Trusted=False)
    assert listener.craft.state().position_lost


def test_a_state_tells_its_age() -> None:
    listener = Listener()
    assert listener.craft.state().age == float("inf")
    listener.tell("Depth", Depth=2.5, Uncertainty=3.0, Trusted=True)
    for _ in range(10):
        listener.tick()
    assert listener.craft.state().age == pytest.approx(2.0)
    assert listener.craft.state().silent == pytest.approx(2.0)


def test_threads_may_command_and_look_while_it_is_served() -> None:
    rig = Rig(replace(pool_sheet(), home=(0.0, 0.0, 2.0)))
    numbers: list[int] = []
    failures: list[BaseException] = []

    def command() -> None:
        try:
            for step in range(50):
                numbers.append(rig.craft.go_to(step / 10.0, 0.0, 2.0))
                assert 0.0 <= rig.craft.state().distance < 10.0
        except BaseException as failure:
            failures.append(failure)

    threads = [threading.Thread(target=command) for _ in range(4)]
    for thread in threads:
        thread.start()
    rig.run(1.0)
    for thread in threads:
        thread.join(20.0)
    assert failures == []
    assert len(numbers) == 200
    assert all(numbers.count(each) >= 12 for each in range(16))
