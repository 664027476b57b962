"""From what a run says to a robot that is driven by hand, at the end of its link."""

from __future__ import annotations

from mmrs_core.contributions.vehicles import Live, VehicleInput
from mmrs_core.errors import LinkLostError, UnsupportedError
from mmrs_mavlink.links.link import Link
from mmrs_mavlink.links.ports import split_system
from mmrs_mavlink.links.radios import Radios
from mmrs_mavlink.options import FIRST_PORT, PORT_STEP
from mmrs_mavlink.plugin.context import context_of
from mmrs_mavlink.plugin.manual.goals import refusals
from mmrs_mavlink.plugin.manual.robot import ManualRobot
from mmrs_runtime import faults
from mmrs_runtime.engine.clocks import FollowingClock

FULL_SPEED, RADIOS = "full-speed", "radios of ardusub-manual"


def connect(given: VehicleInput) -> ManualRobot:
    """Return a robot at the end of its link.

    Raises:
        UnsupportedError: an option is unknown, the robot is not an underwater vehicle, or not all of its
            program can be driven manually; lists all of it.
        LinkLostError: the port cannot be opened.
    """
    unknown = sorted(set(given.options) - {FULL_SPEED})
    if unknown:
        raise UnsupportedError(f"option '{unknown[0]}': the backend has {FULL_SPEED}, metres per second")
    speed = _full_speed(given)
    if given.live is None:
        raise UnsupportedError("backend 'ardusub-manual': drives robots in real time; 'mmrs run' does that")
    context = context_of(given.robot, given)
    found = list(refusals(context))
    if found:
        raise UnsupportedError(f"robot '{given.robot.id}': cannot be driven to do all of it by hand", found)
    return ManualRobot(given, context, _link(given, given.live), given.live, speed)


def _full_speed(given: VehicleInput) -> float:
    said = given.options.get(FULL_SPEED)
    try:
        speed = given.type.capabilities[0].speed[1] if said is None else float(said)
    except ValueError as error:
        raise UnsupportedError(f"option '{FULL_SPEED}': '{said}' is not a number") from error
    if not 0.05 <= speed <= 20.0:
        raise UnsupportedError(
            f"option '{FULL_SPEED}': {speed:g} m/s is not a speed of an underwater vehicle"
        )
    return speed


def _radios(live: Live) -> Radios:
    """Return the radios of all robots of the run that are driven by hand: some may share a port."""
    found = live.shared.setdefault(RADIOS, Radios(FollowingClock(live.clock)))
    assert isinstance(found, Radios)
    return found


def _link(given: VehicleInput, live: Live) -> Link:
    number = [robot.id for robot in given.program.robots].index(given.robot.id)
    usual = f"udpin:127.0.0.1:{FIRST_PORT + PORT_STEP * number}"
    try:
        url, system = split_system(live.links.get(given.robot.id, usual))
        return _radios(live).open(url, system)
    except ValueError as error:
        raise UnsupportedError(f"link {error}") from error
    except faults.FaultError as fault:
        raise LinkLostError(f"robot '{given.robot.id}': {fault}") from fault
