"""On the ground or not, on every way that Choices may go."""

from checking import finding, findings, given, kind, land, recharge, take_off

from mmrs_core.contributions.checks import Status
from mmrs_core.testing.small_programs import go, hold, robot

OVER = go("over", (5.0, 0.0, 10.0))


def flight(*moves, **more):
    return given(robot("a", moves, **more), robot_kind=kind(launches=True))


def test_a_flight_that_takes_off_and_lands_is_safe():
    assert finding("states", flight(take_off("up", 10.0), OVER, land("down"))).status is Status.SAFE


def test_going_before_taking_off_is_violated():
    verdict = finding("states", flight(OVER))
    assert (verdict.status, verdict.move) == (Status.VIOLATED, "over")
    assert verdict.message == (
        "a: GoTo 'over' begins while the robot may be grounded, it needs it to be airborne or moving"
    )


def test_stopping_in_the_air_is_violated():
    verdict = finding("states", flight(take_off("up", 10.0), OVER))
    assert (verdict.status, verdict.move) == (Status.VIOLATED, "stop")


def test_one_arm_that_does_not_land_is_violated():
    moves = (take_off("up", 10.0), land("down"), hold("wait"))
    verdict = finding("states", flight(*moves, choices={"up": ("c", "down", "wait")}))
    assert (verdict.status, verdict.move) == (Status.VIOLATED, "stop")


def test_taking_off_twice_is_violated():
    found = findings("states", flight(take_off("up", 10.0), take_off("again", 10.0), land("down")))
    assert [(verdict.move, verdict.status) for verdict in found] == [("again", Status.VIOLATED)]


def test_recharging_in_the_air_is_violated():
    found = findings("states", flight(take_off("up", 10.0), recharge("charge", 60.0), land("down")))
    assert [verdict.move for verdict in found] == ["charge"]


def test_a_robot_that_does_not_launch_is_under_way_from_the_beginning():
    assert finding("states", given(robot("a", [OVER]))).status is Status.SAFE


def test_a_second_take_off_is_violated_though_nothing_says_whether_the_robot_launches():
    made = robot("a", [take_off("up", 10.0), take_off("again", 10.0), land("down")], home=None)
    violated, unknown = findings("states", given(made))
    assert (violated.status, violated.move) == (Status.VIOLATED, "again")
    assert (unknown.status, unknown.message) == (Status.UNKNOWN, "a: its home is not given")
