"""What the sensor controller says at the ends of what it can say, and after long times."""

from collections.abc import Callable
from dataclasses import replace

import pytest
from sample_vessels import pool_sheet, torpedo_sheet

from auv_vessel.api import Craft
from auv_vessel.control.actuators import Actuators
from auv_vessel.control.sensors import Sensors
from auv_vessel.movement.movement import Movement
from auv_vessel.node import Node
from auv_vessel.sheet import Sheet
from auv_vessel.wire.catalogue import MOST_UPTIME
from auv_vessel.wire.codec import Codec, Received

AIR, PER_METRE = 101_325.0, 1025.0 * 9.80665


def said(node: Node, listener: Codec, now: float) -> dict[str, Received]:
    heard = [listener.decode(frame) for frame in node.tick(now)]
    return {each.name: each for each in heard if each is not None}


@pytest.mark.parametrize("depth", [999.0, 1500.0, 6000.0])
def test_depth_is_told_as_deep_as_vehicles_go(depth: float) -> None:
    sheet = replace(pool_sheet(), max_depth=7000.0, home=(0.0, 0.0, depth))
    sensors, body = Sensors(sheet, Codec(sheet)), Codec(sheet)
    sensors.hear(body.encode("Pressure", Pressure=AIR + PER_METRE * depth, Temperature=4.0), 0.0)
    told = said(sensors, Codec(sheet), 0.0)["Depth"]
    assert told.values["Depth"] == pytest.approx(depth, abs=0.01)


def test_a_drive_that_fell_silent_is_not_taken_to_push_for_ever() -> None:
    sheet = torpedo_sheet()
    sensors, listener = Sensors(sheet, Codec(sheet)), Codec(sheet)
    for number in (0, 1):
        frame = listener.encode(f"Thruster{number}Status", Thrust=18.0, Power=90.0, Drive="RUNS")
        sensors.hear(frame, 0.0)
    surges = []
    for tick in range(300):
        told = said(sensors, listener, 0.05 * tick)
        surges.append(float(told["Velocity"].values["Surge"]))
    assert max(surges) > 0.05
    assert surges[-1] < 0.8 * max(surges)


@pytest.mark.parametrize("kind", [Sensors, Actuators, Movement, Craft])
def test_a_node_that_runs_for_days_goes_on(kind: Callable[[Sheet, Codec], Node]) -> None:
    sheet = pool_sheet()
    node, listener = kind(sheet, Codec(sheet)), Codec(sheet)
    said(node, listener, 0.0)
    beat = said(node, listener, MOST_UPTIME + 100.0)[f"{node.name}Beat"]
    assert beat.values["Uptime"] == pytest.approx(MOST_UPTIME)
