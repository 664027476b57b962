"""Cameras that continue on their own get their last command again after a break."""

import pytest

from mmrs_mavlink.driving.cameras import Cameras
from mmrs_mavlink.program import Local, Operate, Robot, Start, Step

BEGIN, END = (Operate("camera", "Trigger", 206, (metres, 0.0, 1.0)) for metres in (8.5, 0.0))
ROBOT = Robot("Alba", "Alba.jsonl", "copter", Local(0.0, 0.0, 0.0), "start", (Step("start", Start()),))
FILM = Operate("film", "Start", 2500, (1.0,))


class Vehicle:
    """Keeps the commands that it is sent."""

    def __init__(self) -> None:
        self.sent: list[tuple[int, tuple[float, ...]]] = []

    def operate(self, command: int, params: tuple[float, ...], *, confirmed: bool = False) -> None:
        self.sent.append((command, params))

    def ask(self, command: int, *params: float) -> None:
        self.sent.append((command, params))


@pytest.mark.parametrize(
    ("noted", "sent"),
    [
        ((BEGIN,), [(206, (8.5, 0.0, 1.0))]),
        ((BEGIN, END), []),
        ((FILM, BEGIN, END, BEGIN), [(2500, (1.0,)), (206, (8.5, 0.0, 1.0))]),
    ],
)
def test_a_trigger_that_has_ended_is_not_begun_again(noted, sent):
    cameras, vehicle = Cameras(ROBOT, ()), Vehicle()
    for each in noted:
        cameras.note(each)
    cameras.restore(vehicle)
    assert vehicle.sent == sent


def test_a_camera_takes_no_photos_while_its_robot_returns_and_goes_on_when_it_resumes():
    cameras, vehicle = Cameras(ROBOT, ()), Vehicle()
    cameras.rest(vehicle)
    for each in (FILM, BEGIN):
        cameras.note(each)
    cameras.rest(vehicle)
    assert vehicle.sent == [(206, (0.0, 0.0, 0.0))]
    cameras.restore(vehicle)
    assert vehicle.sent[1:] == [(2500, (1.0,)), (206, (8.5, 0.0, 1.0))]
