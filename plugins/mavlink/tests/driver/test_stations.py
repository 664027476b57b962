"""Ground stations of people: who hears them, and when they count as lost."""

import pytest
from flight_crew import robot_of
from mavlink_peer import HERE, PX4, THERE, eventually, heartbeat, linked, two_linked
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.links.radio import GROUND_COMPONENT, GROUND_SYSTEM
from mmrs_mavlink.program import Policy
from mmrs_mavlink.steps.ground import ANY_STATION, SAME_SYSTEM, Ground
from mmrs_mavlink.steps.watch import Watch
from mmrs_mavlink.vehicles.mavlink_vehicle import MavlinkVehicle
from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import FaultError

ELSEWHERE = ("10.0.0.3", 14_550)
STATION = heartbeat(kind=mavlink.MAV_TYPE_GCS, autopilot=mavlink.MAV_AUTOPILOT_INVALID)
FIVE = Policy("GROUND_LOST", "RETURN", 5.0)


class HandClock(Clock):
    """A clock that a test sets."""

    seconds = 0.0

    def now(self) -> float:
        return self.seconds


@pytest.fixture
def ears():
    """Return a wire with the links of two vehicles, at different addresses, and their clock."""
    with two_linked(HandClock()) as made:
        made.number = 100
        yield made


def beat(ears, system: int = 254, component: int = 190, sender=HERE) -> None:
    """Have a station's heartbeat come, and wait until it was dealt with."""
    ears.wire.say(STATION, system=system, component=component, sender=sender)
    alive(ears)


def alive(ears) -> None:
    """Have both vehicles be heard now, after all that has come before."""
    ears.number += 1
    for link, sender in ((ears.first, HERE), (ears.second, THERE)):
        ears.wire.beat(system=link.system, sender=sender, mode=ears.number)
        eventually(lambda link=link: link.latest("HEARTBEAT").custom_mode == ears.number)


def pass_seconds(ears, seconds: int) -> None:
    """Let time pass in which the vehicles are heard."""
    for _ in range(seconds):
        ears.clock.seconds += 1.0
        alive(ears)


def test_a_station_is_heard_by_the_vehicle_that_has_handed_it_on(ears):
    beat(ears, sender=THERE)
    assert (ears.first.stations.systems, ears.second.stations.systems) == ((), (254,))


def test_a_station_that_speaks_for_itself_is_heard_by_all(ears):
    beat(ears, sender=ELSEWHERE)
    assert (ears.first.stations.systems, ears.second.stations.systems) == ((254,), (254,))


@pytest.mark.parametrize(
    ("system", "component"), [(GROUND_SYSTEM, GROUND_COMPONENT), (1, 191), (2, 190)], ids=str
)
def test_our_own_programs_and_what_is_on_board_are_no_stations(ears, system, component):
    beat(ears, system, component, ELSEWHERE)
    assert ears.first.stations.systems == ears.second.stations.systems == ()


def test_a_ground_station_with_the_usual_ids_is_none_of_our_programs(ears):
    beat(ears, 255, 190)
    assert ears.first.stations.systems == (255,)


def test_nothing_is_lost_that_was_never_there(ears):
    ground = Ground(ears.first)
    pass_seconds(ears, 60)
    assert ground.silence(FIVE) == ""


@pytest.mark.parametrize(
    ("policy", "seconds"), [(FIVE, 5), (Policy("GROUND_LOST", "RETURN"), 10)], ids=["its own", "none: ten"]
)
def test_a_station_counts_as_lost_after_the_seconds_of_the_policy(ears, policy, seconds):
    ground = Ground(ears.first)
    beat(ears)
    pass_seconds(ears, seconds)
    assert ground.silence(policy) == ""
    pass_seconds(ears, 1)
    assert ground.silence(policy) == f"no messages from ground station 254 for {seconds + 1} s"


def test_a_station_that_comes_back_in_time_is_not_lost(ears):
    ground = Ground(ears.first)
    beat(ears)
    pass_seconds(ears, 4)
    beat(ears)
    pass_seconds(ears, 4)
    assert ground.silence(FIVE) == ""


def test_of_several_stations_the_last_counts(ears):
    ground = Ground(ears.first)
    beat(ears, 253)
    pass_seconds(ears, 4)
    beat(ears, 254)
    pass_seconds(ears, 4)
    assert ground.silence(FIVE) == ""
    pass_seconds(ears, 4)
    assert ground.silence(FIVE) == "no messages from ground stations 253 and 254 for 8 s"


def test_seconds_in_which_the_vehicle_itself_is_silent_do_not_count(ears):
    ground = Ground(ears.first)
    beat(ears)
    pass_seconds(ears, 2)
    ears.clock.seconds += 30.0
    assert ground.silence(FIVE) == ""
    alive(ears)
    assert ground.silence(FIVE) == ""
    pass_seconds(ears, 4)
    assert ground.silence(FIVE) == "no messages from ground station 254 for 6 s"


def test_what_is_cut_for_a_rehearsal_is_not_heard(ears):
    ground = Ground(ears.first)
    beat(ears)
    ears.first.stations.deaf = True
    for _ in range(6):
        pass_seconds(ears, 1)
        beat(ears)
    assert ground.silence(FIVE)
    ears.first.stations.deaf = False
    beat(ears)
    assert ground.silence(FIVE) == ""


def test_every_station_is_news_once(ears):
    ground = Ground(ears.first)
    assert ground.news() == []
    beat(ears, 254)
    assert [ground.news(), ground.news()] == [["hears ground station 254"], []]
    beat(ears, 253)
    assert ground.news() == ["hears ground stations 253 and 254"]


def test_a_station_with_our_system_id_is_told_to_hide_our_silence_from_the_vehicle(ears):
    ground = Ground(ears.first)
    beat(ears, 255)
    assert ground.news() == ["hears ground station 255", SAME_SYSTEM]


def test_any_station_hides_our_silence_from_a_px4():
    with linked(autopilot=PX4) as (link, wire):
        ground = Ground(link)
        wire.say(STATION, system=254, component=190)
        eventually(lambda: link.stations.systems)
        assert ground.news() == ["hears ground station 254", ANY_STATION.format("PX4")]


@pytest.mark.parametrize(
    ("policy", "heard", "said"),
    [
        (FIVE, (), "no ground station received yet: policy GROUND_LOST (RETURN) waits for the first"),
        (FIVE, (254,), ""),
        (Policy("GROUND_LOST", "CONTINUE"), (), ""),
    ],
)
def test_people_are_told_at_the_start_what_their_policy_waits_for(ears, policy, heard, said):
    for system in heard:
        beat(ears, system)
    assert Ground(ears.first).missing(robot_of(policy)) == said


def watching(ears, *policies):
    robot = robot_of(*policies)
    watch, decided = Watch(robot, ears.clock), []
    watch.begin(ears.first, MavlinkVehicle(ears.first, robot.profile, robot.home))
    watch.decide = lambda *decision: decided.append(decision)
    return watch, decided


HEARD = ("GROUND_LOST", "hears ground station 254", "watched from now on")


def test_a_watch_ends_the_program_when_the_last_station_is_lost(ears):
    watch, decided = watching(ears, FIVE)
    beat(ears)
    watch.check()
    pass_seconds(ears, 6)
    with pytest.raises(FaultError, match="no messages from ground station 254 for 6 s") as fault:
        watch.check()
    assert (fault.value.event, decided) == ("GROUND_LOST", [HEARD])


@pytest.mark.parametrize("policies", [(), (Policy("GROUND_LOST", "CONTINUE", 5.0),)])
def test_a_robot_that_carries_on_alone_has_that_recorded_each_time(ears, policies):
    watch, decided = watching(ears, *policies)
    beat(ears)
    for _ in range(2):
        pass_seconds(ears, 12)
        watch.check()
        watch.check()
        beat(ears)
        watch.check()
    borne = ("GROUND_LOST", "no messages from ground station 254 for 12 s", "CONTINUE")
    assert decided == [HEARD, borne, borne]


@pytest.mark.parametrize(("response", "heeded"), [("HOLD", True), ("RETURN", False), ("LAND", False)])
def test_a_robot_that_holds_for_another_reason_still_heeds_it(ears, response, heeded):
    watch, _ = watching(ears, FIVE)
    beat(ears)
    watch.relax({"OBSTACLE"}, response)
    pass_seconds(ears, 6)
    if not heeded:
        watch.check()
        return
    with pytest.raises(FaultError, match="ground station 254"):
        watch.check()
