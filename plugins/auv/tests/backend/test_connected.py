"""Robots at the end of a bus, in real time."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from mmrs_auv.backend.connected import ConnectedRobot
from mmrs_auv.vessel.wire.ports import PortError


@pytest.mark.parametrize(("failure", "stays"), [(None, True), (PortError("has ended"), False)])
def test_nobody_stays_with_a_vehicle_whose_bus_itself_is_gone(
    failure: PortError | None, stays: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot = ConnectedRobot.__new__(ConnectedRobot)
    monkeypatch.setattr(robot, "_connection", SimpleNamespace(failure=failure), raising=False)
    monkeypatch.setattr(robot, "_response", "HOLD", raising=False)
    monkeypatch.setattr(robot, "_is_up", lambda: False)
    assert robot.watched(0.0) is stays
