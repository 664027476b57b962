"""What a vehicle tells, in words: what it lacks, what threatens it, what it has answered by itself."""

import pytest
from mavlink_peer import PX4, eventually, linked
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink import Geographic, Local
from mmrs_mavlink.vehicles.telemetry import Telemetry

HOME = Geographic(42.37, 13.35, 0.0)
PREARM = mavlink.MAV_SYS_STATUS_PREARM_CHECK
ALL_KNOWN = 1 | 2 | 4 | 8 | 16 | 32
COMPASS, BARO = 4, 8


def status(health: int = PREARM, enabled: int = PREARM, battery: int = 80):
    return mavlink.MAVLink_sys_status_message(
        enabled, enabled, health, 0, 15_000, -1, battery, 0, 0, 0, 0, 0, 0
    )


def ekf(flags: int = ALL_KNOWN):
    return mavlink.MAVLink_ekf_status_report_message(flags, 0, 0, 0, 0, 0)


def gps(fix: int = 3, satellites: int = 12):
    return mavlink.MAVLink_gps_raw_int_message(0, fix, 0, 0, 0, 0, 0, 0, 0, satellites)


def position():
    return mavlink.MAVLink_global_position_int_message(
        0, 423_700_000, 133_500_000, 750_000, 30_000, 300, 400, 0, 9000
    )


def text(words: str, *, id: int = 0, seq: int = 0):
    return mavlink.MAVLink_statustext_message(2, words.encode(), id, seq)


def scan(*metres: float):
    sectors = [round(each * 100) for each in metres] + [65_535] * (72 - len(metres))
    return mavlink.MAVLink_obstacle_distance_message(0, 0, sectors, 5, 20, 4000)


READY = (status(), ekf(), gps(), position())


@pytest.fixture
def told():
    """Return a function that has a vehicle say things, and gives what is known then."""
    contexts = []

    def tell(*messages, home=HOME, autopilot: int = 3, beat=None) -> Telemetry:
        context = linked(autopilot=autopilot)
        link, wire = context.__enter__()
        contexts.append(context)
        telemetry = Telemetry(link, home)
        for message in messages:
            wire.say(message)
        if beat is not None:
            wire.beat(**beat)
        wire.say(mavlink.MAVLink_ping_message(0, 0, 0, 0))
        eventually(lambda: link.latest("PING"))
        return telemetry

    yield tell
    for context in contexts:
        context.__exit__(None, None, None)


def test_a_vehicle_that_knows_all_lacks_nothing(told):
    telemetry = told(*READY)
    assert telemetry.lacks() == ()
    assert telemetry.ready()


def test_all_that_is_lacking_is_told_at_once(told):
    telemetry = told(status(0), ekf(1 | 4 | 32), gps(1, 4))
    assert telemetry.lacks() == (
        "it has not reported its position (GLOBAL_POSITION_INT)",
        "its estimator (EKF) knows no horizontal velocity and no horizontal position",
        "it has no GPS fix (4 satellites)",
        "its own checks fail",
    )


def test_what_the_vehicle_says_about_arming_is_passed_on_once(told):
    said = [text("PreArm: Compass not calibrated"), text("hello"), text("PreArm: Compass not calibrated")]
    assert told(*READY[1:], status(0), *said).lacks() == (
        "its own checks fail: PreArm: Compass not calibrated",
    )


def test_parts_that_are_unhealthy_are_named_where_the_vehicle_says_nothing(told):
    enabled = PREARM | COMPASS | BARO
    assert told(*READY[1:], status(BARO, enabled)).lacks() == ("its own checks fail: unhealthy: compass",)


def test_a_vehicle_that_has_told_nothing_of_itself_lacks_that(told):
    assert told(*READY[1:]).lacks() == ("it has not reported its state (SYS_STATUS)",)


def test_only_an_ardupilot_must_say_that_its_checks_pass(told):
    assert told(*READY[1:], status(0, 0), autopilot=PX4).lacks() == ()
    assert told(*READY[1:], status(0, PREARM), autopilot=PX4).lacks() == ("its own checks fail",)


def test_a_px4_that_holds_must_say_so_too_until_it_is_armed(told):
    holds = {"autopilot": PX4, "mode": 3 << 24 | 4 << 16}
    assert told(*READY[1:], status(0, 0), beat=holds).lacks() == ("its own checks fail",)
    assert told(*READY[1:], status(PREARM, 0), beat=holds).lacks() == ()
    assert told(*READY[1:], status(0, 0), beat={**holds, "armed": True}).lacks() == ()


def test_a_px4_that_stands_still_may_know_its_position(told):
    found = mavlink.MAVLink_estimator_status_message(0, ALL_KNOWN | 128, 0, 0, 0, 0, 0, 0, 0, 0)
    others = [message for message in READY if message.get_type() != "EKF_STATUS_REPORT"]
    assert told(*others, status(PREARM), found, autopilot=PX4).lacks() == ()


def test_a_local_program_needs_no_place_on_the_earth(told):
    local = mavlink.MAVLink_local_position_ned_message(0, 1, 2, -3, 0, 0, 0)
    flags = ALL_KNOWN & ~16
    assert told(status(), ekf(flags), gps(0), local, home=Local(0.0, 0.0, 0.0)).lacks() == ()


@pytest.mark.parametrize(
    ("after", "words"),
    [
        (ekf(ALL_KNOWN & ~16), "its estimator (EKF) knows no horizontal position"),
        (ekf(ALL_KNOWN | 128), "its estimator (EKF) only assumes that it stands still"),
        (gps(1, 3), "it has no GPS fix (3 satellites)"),
        (gps(2, 255), "it has a GPS fix without height"),
    ],
)
def test_a_lost_position_is_told_with_its_cause(told, after, words):
    assert told(*READY).position_trouble() == ""
    assert told(*READY, after).position_trouble() == words


def test_a_position_that_was_never_there_is_not_lost(told):
    assert told(status(), ekf(1)).position_trouble() == ""


def test_a_position_that_comes_no_more_is_lost(told, monkeypatch):
    monkeypatch.setattr("mmrs_mavlink.vehicles.telemetry.STALE_SECONDS", 0.1)
    telemetry = told(*READY)
    link = telemetry._link
    monkeypatch.setattr(link.clock, "patience", lambda seconds, least=0.5: seconds)
    eventually(lambda: link.since("GLOBAL_POSITION_INT") > 0.3)
    assert telemetry.position_trouble() == ""
    link._received = link.clock.now()
    assert "it has not reported its position for" in telemetry.position_trouble()


@pytest.mark.parametrize(
    ("metres", "seen"), [((12.0, 4.0), "something is 4.0 m away"), ((12.0, 6.0), ""), ((), "")]
)
def test_an_obstacle_counts_when_it_is_near(told, metres, seen):
    assert told(*READY, scan(*metres)).obstacle() == seen


@pytest.mark.parametrize(("level", "seen"), [(2, "a collision threatens in 7 s"), (1, ""), (0, "")])
def test_a_collision_counts_when_it_threatens(told, level, seen):
    assert told(*READY, mavlink.MAVLink_collision_message(0, 1, 0, level, 7.0, 0, 0)).obstacle() == seen


def test_a_broken_fence_is_told(told):
    assert told(*READY).breach() == ""
    assert told(*READY, mavlink.MAVLink_fence_status_message(0, 2, 3, 0)).breach() == ""
    assert (
        told(*READY, mavlink.MAVLink_fence_status_message(1, 1, 3, 0)).breach()
        == "it is outside its fence: at its boundary"
    )


def test_wind_is_told_with_where_it_comes_from_by_both_autopilots(told):
    assert told().wind() is None
    assert told(mavlink.MAVLink_wind_message(270.0, 6.5, 0.0)).wind() == (6.5, 270.0)
    speed, origin = told(mavlink.MAVLink_wind_cov_message(0, 0.0, 5.0, 0, 0, 0, 0, 0, 0)).wind()
    assert (speed, origin) == pytest.approx((5.0, 270.0))


def test_energy_is_none_where_nobody_tells_it(told):
    assert told(status(battery=-1)).energy() is None
    assert told(status(battery=43)).energy() == 0.43


def battery(id: int, left: int, state: int, function: int = 0):
    return mavlink.MAVLink_battery_status_message(
        id, function, 0, 2000, [3800] + [65_535] * 9, 500, 100, -1, left, 0, state
    )


def test_a_battery_of_several_that_is_low_is_not_hidden_by_the_others(told):
    telemetry = told(status(battery=-1), battery(0, 20, 2), battery(1, 90, 1), battery(2, 30, 7))
    assert (telemetry.energy(), telemetry.battery_trouble()) == (0.2, "it says that its battery is low")


def test_a_battery_of_the_payload_is_not_that_of_the_vehicle(told):
    payload = battery(1, 5, 3, mavlink.MAV_BATTERY_FUNCTION_PAYLOAD)
    telemetry = told(status(battery=-1), battery(0, 80, 1), payload)
    assert (telemetry.energy(), telemetry.battery_trouble()) == (0.8, "")


def test_place_and_speed_are_those_of_the_last_position(told):
    telemetry = told(*READY)
    assert telemetry.here() == Geographic(pytest.approx(42.37), pytest.approx(13.35), pytest.approx(30.0))
    assert telemetry.speed() == pytest.approx(5.0)
    assert telemetry.sea_level() == pytest.approx(720.0)


@pytest.mark.parametrize(
    ("words", "event"),
    [
        ("EKF Failsafe: changed to LAND Mode", "POSITION_LOST"),
        ("Polygon fence breached", "FENCE_BREACHED"),
        ("Battery 1 is low 14.20V used 900 mAh", "BATTERY_LOW"),
        ("GCS Failsafe", "LINK_LOST"),
        ("Mission: 3 WP", None),
    ],
)
def test_what_the_vehicle_answers_by_itself_is_known_from_what_it_says(told, words, event):
    assert told(*READY, text(words)).failsafe() == event


def test_long_texts_are_put_together_from_their_pieces(told):
    pieces = [text("x" * 50, id=7), text("and the end", id=7, seq=1)]
    (found,) = told(*pieces).texts.since(0.0)
    assert found.text == "x" * 50 + "and the end"


def nowhere():
    return mavlink.MAVLink_global_position_int_message(0, 0, 0, 720_000, 100, 0, 0, 0, 9000)


def test_zero_degrees_of_both_are_no_place_but_what_ardupilots_tell_before_they_know_one(told):
    telemetry = told(*READY[:3], nowhere())
    assert not telemetry.placed()
    assert telemetry.here() == HOME
    assert telemetry.lacks() == ("it has not reported its position (GLOBAL_POSITION_INT)",)


def test_a_vehicle_that_does_not_know_its_place_any_more_is_where_it_was_last():
    with linked() as (link, wire):
        telemetry = Telemetry(link, HOME)
        wire.say(position())
        eventually(telemetry.placed)
        assert telemetry.here() == Geographic(42.37, 13.35, 30.0)
        wire.say(nowhere())
        eventually(lambda: not telemetry.placed())
        assert telemetry.here() == Geographic(42.37, 13.35, 30.0)


AT_3 = mavlink.MAVLink_mission_current_message(3)


@pytest.mark.parametrize(
    ("said", "item"),
    [
        ((), -1),
        ((AT_3,), 3),
        ((AT_3, mavlink.MAVLink_mission_item_reached_message(3)), 4),
        ((AT_3, mavlink.MAVLink_mission_item_reached_message(2)), 3),
        ((mavlink.MAVLink_mission_item_reached_message(3), AT_3), 3),
        ((mavlink.MAVLink_mission_item_reached_message(3),), -1),
    ],
    ids=["nothing", "an item", "it reached", "an earlier one reached", "set back to it", "only reached"],
)
def test_an_item_that_was_reached_is_behind_a_vehicle_that_says_so_last(told, said, item):
    """A PX4 says over all links at once what it has reached, and up to a second later where it goes."""
    assert told(*said, autopilot=PX4).item() == item
