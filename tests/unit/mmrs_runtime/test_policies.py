"""Which response a fault gets."""

from math import inf

from mmrs_runtime.policies import Policy, in_precedence, patience, response_to, seconds_of


def test_the_policy_of_a_wait_goes_before_all_others():
    found = in_precedence(
        transition=[Policy("WAIT_TOO_LONG", "LAND")],
        mission=[Policy("WAIT_TOO_LONG", "RETURN"), Policy("LINK_LOST", "RETURN")],
        robot_type=[Policy("LINK_LOST", "HOLD"), Policy("PEER_LOST", "LAND")],
        kind={"PEER_LOST": "HOLD", "BATTERY_LOW": "RETURN"},
    )
    events = ("WAIT_TOO_LONG", "LINK_LOST", "PEER_LOST", "BATTERY_LOW")
    assert [response_to(event, found) for event in events] == ["LAND", "RETURN", "LAND", "RETURN"]


def test_a_fault_that_nobody_provided_for_has_the_robot_hold():
    assert response_to("BATTERY_EMPTY", ()) == "HOLD"


def test_a_declared_delay_goes_before_the_platforms():
    assert patience("WAIT_TOO_LONG", [Policy("WAIT_TOO_LONG", "LAND", 7.0)]) == 7.0
    assert patience("PEER_LOST", [Policy("PEER_LOST", "LAND")]) == 30.0


def test_a_wait_is_too_long_only_where_somebody_said_how_long_that_is():
    assert patience("WAIT_TOO_LONG", [Policy("WAIT_TOO_LONG", "LAND")]) == inf


def test_a_wait_without_a_policy_is_borne_for_ever():
    assert patience("WAIT_TOO_LONG", ()) is None


def test_a_robot_that_nobody_looks_on_any_more_finishes_unless_somebody_said_otherwise():
    assert response_to("GROUND_LOST", ()) == "CONTINUE"
    assert response_to("GROUND_LOST", [Policy("GROUND_LOST", "RETURN")]) == "RETURN"


def test_real_robots_bear_an_event_that_no_model_names_for_as_long_as_the_platform_says():
    seconds = {event: seconds_of(Policy(event, "HOLD")) for event in ("LINK_LOST", "PEER_LOST", "OBSTACLE")}
    assert seconds == {"LINK_LOST": 5.0, "PEER_LOST": 30.0, "OBSTACLE": 0.0}
    assert seconds_of(Policy("PEER_LOST", "HOLD", 7.0)) == 7.0
