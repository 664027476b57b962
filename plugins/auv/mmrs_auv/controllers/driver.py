"""The driver of vehicles on CAN buses, for controllers: it reads its options, and makes vehicles."""

from __future__ import annotations

import argparse
from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Collection, Mapping, Sequence
from math import dist, inf
from pathlib import Path

from auv_vessel.api import Craft
from auv_vessel.api import State as CraftState
from auv_vessel.eyes import Detections
from auv_vessel.goals import Goal
from auv_vessel.sheet import Sheet, Vector, from_json
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.ports import CHANNEL
from mmrs_auv.controllers.connected import ConnectedVehicle, Reach
from mmrs_auv.controllers.orders import Orders
from mmrs_auv.controllers.program_orders import ProgramOrders
from mmrs_auv.controllers.vehicle import CanVehicle
from mmrs_runtime.controllers.box_entries import start_of
from mmrs_runtime.controllers.driver import Driver, DriverInput
from mmrs_runtime.controllers.running import run_controllers
from mmrs_runtime.controllers.state import State
from mmrs_runtime.controllers.user_functions import Condition, Locator, objects_of, where_expected
from mmrs_runtime.controllers.vocabulary import Robot
from mmrs_runtime.engine.connecting import Live
from mmrs_runtime.faults import LINK_LOST, FaultError
from mmrs_runtime.records.blackbox import BlackBox

LEADS = ("GO_TO", "HOLD", "SEARCH")
"""Goals that have a position; the others start at the current one."""


class DryCraft(Craft):
    """Takes the time that a real vehicle needs, and carries out every goal."""

    def __init__(self, sheet: Sheet, now: Callable[[], float]) -> None:
        """Lie at home; `now` returns seconds."""
        super().__init__(sheet, Codec(sheet))
        self._clock, self._at, self._since = now, sheet.home, now()

    def operate(self, device: str, action: int, parameter: float = 0.0) -> int:
        """Complete the action of a device at once."""
        request = super().operate(device, action, parameter)
        self._devices[request] = "REACHED"
        self._requests.pop(request, None)
        return request

    def state(self) -> CraftState:
        """Return where it would be, with a full battery."""
        place = self._move_on()
        there = dist(place, self._target()) < 1e-6
        return (
            super()
            .state()
            ._replace(
                time=self._since,
                north=place[0],
                east=place[1],
                depth=place[2],
                heading=self._goal.heading,
                uncertainty=0.0,
                trusted=True,
                position_lost=False,
                age=0.0,
                silent=0.0,
                charge=1.0,
                goal=self._goal.number,
                progress="REACHED" if there else "ACTIVE",
                distance=dist(place, self._target()),
            )
        )

    def _begin(self, goal: Goal) -> int:
        self._move_on()
        return super()._begin(goal)

    def _move_on(self) -> Vector:
        now = self._clock()
        left, target = now - self._since, self._target()
        self._since = now
        away, pace = dist(self._at, target), self._goal.speed or self._sheet.speed
        part = 1.0 if away <= left * pace else left * pace / away
        north, east, depth = (a + (b - a) * part for a, b in zip(self._at, target, strict=True))
        self._at = (north, east, depth)
        return self._at

    def _target(self) -> Vector:
        goal, (north, east, depth) = self._goal, self._at
        if goal.mode in LEADS:
            return (goal.north, goal.east, goal.depth)
        return (north, east, 0.0 if goal.mode == "SURFACE" else depth)


def main(
    robots: Sequence[Robot],
    sheets: Mapping[str, Path],
    conditions: Mapping[str, Condition] | None = None,
    locators: Mapping[str, Locator] | None = None,
    arguments: Sequence[str] | None = None,
) -> int:
    """Run the programs of robots; return the exit code.

    Args:
        robots: at least one.
        sheets: files of the vehicles' data, by robot.
        conditions: what decides Choices, by identifier.
        locators: what finds objects, by description.
        arguments: as on the command line; None: those of this process.
    """
    return run_controllers(CanDriver(sheets), robots, conditions, locators, arguments)


class CanDriver(Driver):
    """Reaches vehicles on CAN buses, or makes them up for a dry run."""

    _outfit: DriverInput
    _given: Namespace

    def __init__(self, sheets: Mapping[str, Path]) -> None:
        """Take the files of the vehicles' data, by robot."""
        self._sheets = sheets
        self._channels: Mapping[str, str] = {}
        self._ports: Mapping[str, int] = {}

    def add_options(self, parser: ArgumentParser) -> None:
        """Add those of buses, cameras and sonar."""
        add = parser.add_argument
        add(
            "--can",
            action="append",
            default=[],
            metavar="[ROBOT=]CHANNEL",
            help=f"CAN channel of a robot's vehicle. Repeatable. Default: {CHANNEL}",
        )
        add(
            "--interface",
            default="socketcand",
            metavar="NAME",
            help="python-can interface. Default: socketcand",
        )
        add("--bit-rate", type=int, metavar="BITS", help="bit rate per second, for adapters that need it")
        add("--detections", action="append", default=[], metavar="[ROBOT=]PORT", help=_DETECTIONS)
        add(
            "--clearance",
            type=_metres,
            default=0.0,
            metavar="METRES",
            help="distance ahead, in metres, in which the sonar must detect nothing. Default: 0",
        )
        add("--clock", choices=("real", "bus"), help="clock; bus: the time that a simulated vehicle sends")

    def settle(self, parser: ArgumentParser, robots: Sequence[Robot], given: Namespace) -> Mapping[str, str]:
        """Keep which robot is on which bus, and which receives its cameras' detections."""
        ids = [robot.id for robot in robots]
        self._given = given
        self._channels = {**dict.fromkeys(ids, CHANNEL), **_by_robot(parser, "--can", ids, given.can)}
        self._ports = _ports(parser, ids, given.detections)
        return {robot: robot for robot in ids}

    def sees(self, robot: Robot) -> Collection[str]:
        """Return the objects that its cameras look for."""
        if robot.id not in self._ports:
            return ()
        return {found for step in robot.steps for found in objects_of(step.movement)}

    def open(self, outfit: DriverInput) -> None:
        """Open nothing: each vehicle has a bus of its own."""
        self._outfit = outfit

    def connect(self, robot: Robot, live: Live, box: BlackBox) -> CanVehicle:
        """Return a robot's vehicle, which need not have sent a message yet.

        Raises:
            FaultError: there is no such bus, or its cameras' port is taken.
        """
        options, given = self._outfit.options, self._given
        sheet = from_json(self._sheets[robot.id].read_text(encoding="utf-8"))
        made: list[CanVehicle] = []

        def state() -> State:
            reported = made[0].state(options.clock.now()).own
            assert reported is not None
            return reported

        if options.dry:
            locators = {**self._outfit.locators, **dict.fromkeys(self.sees(robot), where_expected)}
            craft = DryCraft(sheet, options.clock.now)
            made.append(
                _DryVehicle(robot, sheet, craft, ProgramOrders(robot, sheet, locators, state), live, box)
            )
            return made[0]
        eyes = self._eyes(robot.id)
        orders = ProgramOrders(
            robot, sheet, self._outfit.locators, state, None if eyes is None else eyes.place
        )
        channel = self._channels[robot.id]
        reach = Reach(
            given.interface,
            channel,
            given.bit_rate or 0,
            given.clock or "",
            options.patience,
            options.home_tolerance,
            given.clearance,
        )
        start = start_of(robot, "can", "python-can", confirms=True)
        try:
            made.append(
                ConnectedVehicle(
                    robot.id,
                    sheet,
                    orders,
                    reach,
                    options.clock,
                    live,
                    start,
                    box=box,
                    eyes=eyes,
                    rehearsal=self._outfit.rehearsal,
                    let_go=lambda: self._outfit.rehearsal.forget(robot.id),
                )
            )
        except (OSError, ValueError) as error:
            raise FaultError(LINK_LOST, f"{channel}: {error}") from error
        return made[0]

    def _eyes(self, robot: str) -> Detections | None:
        if (port := self._ports.get(robot)) is None:
            return None
        try:
            return self._outfit.stack.enter_context(Detections(port=port, robot=robot))
        except OSError as error:
            raise FaultError(LINK_LOST, f"--detections {port}: {error.strerror or error}") from error


class _DryVehicle(CanVehicle):
    """A vehicle that is not there; its black box says so."""

    def __init__(
        self, robot: Robot, sheet: Sheet, craft: Craft, orders: Orders, live: Live, box: BlackBox
    ) -> None:
        super().__init__(robot.id, sheet, craft, orders, box=box, say=live.say)
        self._start = start_of(robot, None, "python-can")

    def prepare(self, now: float) -> bool:
        """Get ready."""
        self.note("start", self._start)
        return False

    def close(self) -> None:
        """Close the box."""
        if self._box is not None:
            self._box.close()


_DETECTIONS = "UDP port for positions of objects from cameras; overrides objects.py"


def _metres(text: str) -> float:
    try:
        found = float(text)
    except ValueError:
        found = -1.0
    if not 0.0 <= found < inf:
        raise argparse.ArgumentTypeError(f"{text}: is not a number from 0 on")
    return found


def _by_robot(
    parser: ArgumentParser, option: str, robots: Sequence[str], texts: Sequence[str]
) -> dict[str, str]:
    found = {}
    for text in texts:
        robot, sign, value = text.rpartition("=")
        if sign and robot not in robots:
            parser.error(f"{option} {text}: unknown robot {robot!r}; the robots are {', '.join(robots)}")
        if not sign and len(robots) > 1:
            parser.error(f"{option} {text}: several robots; name one: {option} {robots[0]}={text}")
        found[robot or robots[0]] = value
    return found


def _ports(parser: ArgumentParser, robots: Sequence[str], texts: Sequence[str]) -> Mapping[str, int]:
    found = _by_robot(parser, "--detections", robots, texts)
    for text in found.values():
        if not (text.isascii() and text.isdecimal() and len(text) < 6 and 0 < int(text) < 65_536):
            parser.error(f"--detections {text}: not a port (1 to 65535)")
    if len(set(found.values())) < len(found):
        parser.error("--detections: each vehicle's cameras need a port of their own")
    return {robot: int(text) for robot, text in found.items()}
