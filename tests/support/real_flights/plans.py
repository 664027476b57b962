"""Flies a plan of QGroundControl by the vehicle alone: uploads what the file says, and starts its mission."""

from __future__ import annotations

import json
import re
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from math import isfinite
from pathlib import Path
from typing import Any

from firmware import Observer
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.limits import Limit

MISSION, FENCE, RALLY = 0, 1, 2
AUTO, GUIDED = 3, 4
"""ArduPilot's numbers of copters and subs; those of rovers are `ROVER_AUTO`, `ROVER_GUIDED`."""

ROVER_AUTO, ROVER_GUIDED = 10, 15
PX4_AUTO, PX4_MISSION = 4, 4
"""PX4's main mode, and the mode within it."""

START_SECONDS = 90.0
Item = tuple[int, int, tuple[float, ...]]
"""Frame, command, seven parameters: the fifth and sixth are degrees where the item has a place."""


class PlanError(Exception):
    """The vehicle refuses a plan, or what starts it."""


def upload(observer: Observer, plan: Path, *, px4: bool = False) -> int:
    """Upload mission, fence and rally points of a plan; return the number of the mission's items.

    ArduPilot's first item is its home; PX4 knows no such item.

    Raises:
        PlanError: the vehicle does not take them.
    """
    said = json.loads(plan.read_text("utf-8"))
    home = [] if px4 else [_home(said["mission"])]
    mission = [*home, *map(_item, said["mission"]["items"])]
    for sort, items in ((MISSION, mission), (FENCE, list(_fence(said))), (RALLY, list(_rally(said)))):
        if items:
            _send(observer, sort, items)
    return len(mission)


def waits_in(plan: Path, *, px4: bool = False) -> set[int]:
    """Return the numbers of the items at which a vehicle waits until its operator lets it go on."""
    items = json.loads(plan.read_text("utf-8"))["mission"]["items"]
    first = 0 if px4 else 1
    return {
        number
        for number, item in enumerate(items, start=first)
        if item["command"] == mavlink.MAV_CMD_NAV_LOITER_UNLIM
    }


def go_on(observer: Observer) -> None:
    """Let a vehicle that waits in its mission go on to the next item, as an operator does."""
    observer.send(mavlink.MAVLink_mission_set_current_message(*_address(observer), observer.item + 1))


def set_up(observer: Observer, file: str, said: str) -> None:
    """Set a vehicle to what its plan asks for, as operators do; what it does not know is another version's.

    Args:
        observer: of the vehicle.
        file: name of the plan.
        said: by what wrote it.

    Raises:
        TimeoutError: it does not take a parameter.
    """
    for name, value, sort in re.findall(rf"{re.escape(file)}: set (\w+) to (\S+) ([^:]+):", said):
        limit = Limit(name, float(value), "", sort)
        found = observer.read(name)
        if found is not None and not limit.holds(found):
            observer.change({name: limit.value})


def start(observer: Observer, *, rover: bool = False, px4: bool = False) -> None:
    """Arm a vehicle and start its mission.

    Raises:
        PlanError: it does not arm, or does not go into AUTO.
    """
    guided, auto = (ROVER_GUIDED, ROVER_AUTO) if rover else (GUIDED, AUTO)
    steps: tuple[tuple[str, Callable[[], bool], tuple[tuple[float, ...], ...]], ...] = (
        ("GUIDED", lambda: observer.mode == guided, ((176, 1, guided),)),
        ("arming", lambda: observer.armed, ((400, 1),)),
        ("AUTO", lambda: observer.mode == auto, ((mavlink.MAV_CMD_MISSION_START,), (176, 1, auto))),
    )
    if px4:
        mission = PX4_AUTO << 16 | PX4_MISSION << 24
        steps = (
            ("mission", lambda: observer.mode == mission, ((176, 1, PX4_AUTO, PX4_MISSION),)),
            ("arming", lambda: observer.armed, ((400, 1),)),
        )
    for what, holds, commands in steps:
        until = time.monotonic() + START_SECONDS
        while not holds():
            if time.monotonic() > until:
                texts = "; ".join(text for _, text in observer.texts[-4:])
                raise PlanError(f"{what}: refused: {texts}")
            for number, *params in commands:
                observer.command(int(number), *params)
            time.sleep(0.5)


def _send(observer: Observer, sort: int, items: Sequence[Item], seconds: float = 60.0) -> None:
    observer.requests.clear()
    observer.mission_acks.clear()
    until, asked, sent = time.monotonic() + seconds, 0.0, 0
    while time.monotonic() < until:
        refused = [result for kind, result in observer.mission_acks if kind == sort]
        if refused and refused[-1] == mavlink.MAV_MISSION_ACCEPTED:
            return
        if refused and refused[-1] != mavlink.MAV_MISSION_NO_SPACE and sent:
            raise PlanError(f"upload {sort}: MISSION_ACK {refused[-1]} after {sent} items")
        if not sent and time.monotonic() - asked > 1.0:
            asked = time.monotonic()
            observer.mission_acks.clear()
            observer.send(mavlink.MAVLink_mission_count_message(*_address(observer), len(items), sort))
        while observer.requests:
            kind, number = observer.requests.pop(0)
            if kind == sort and number < len(items):
                observer.send(_message(observer, sort, number, items[number]))
                sent = max(sent, number + 1)
        time.sleep(0.002)
    raise PlanError(f"upload {sort}: no answer after {sent} of {len(items)} items")


def _address(observer: Observer) -> tuple[int, int]:
    return observer.system, 1


def _message(observer: Observer, sort: int, number: int, item: Item) -> mavlink.MAVLink_message:
    frame, command, params = item
    placed = frame != mavlink.MAV_FRAME_MISSION
    x, y = (round(value * 1e7) if placed else round(value) for value in params[4:6])
    return mavlink.MAVLink_mission_item_int_message(
        *_address(observer), number, frame, command, 0, 1, *params[:4], x, y, params[6], sort
    )


def _home(mission: Mapping[str, Any]) -> Item:
    latitude, longitude, altitude = mission["plannedHomePosition"]
    return (0, 16, (0.0, 0.0, 0.0, 0.0, latitude, longitude, altitude))


def _item(item: Mapping[str, Any]) -> Item:
    params = tuple(0.0 if value is None or not isfinite(value) else float(value) for value in item["params"])
    return (item["frame"], item["command"], params)


def _fence(said: Mapping[str, Any]) -> Iterator[Item]:
    for polygon in said["geoFence"]["polygons"]:
        kind, corners = (5001 if polygon["inclusion"] else 5002), polygon["polygon"]
        for latitude, longitude in corners:
            yield (0, kind, (float(len(corners)), 0.0, 0.0, 0.0, latitude, longitude, 0.0))
    for circle in said["geoFence"]["circles"]:
        kind, place = (5003 if circle["inclusion"] else 5004), circle["circle"]
        yield (0, kind, (place["radius"], 0.0, 0.0, 0.0, *place["center"], 0.0))


def _rally(said: Mapping[str, Any]) -> Iterator[Item]:
    for latitude, longitude, altitude in said["rallyPoints"]["points"]:
        yield (3, 5100, (0.0, 0.0, 0.0, 0.0, latitude, longitude, altitude))
