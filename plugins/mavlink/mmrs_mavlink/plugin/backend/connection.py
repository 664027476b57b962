"""Opens what the backend mavlink works with: radios that robots share, links, vehicles, black boxes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import cast

from mmrs_core.behaviour.earth import from_wgs84
from mmrs_core.behaviour.program import Action as Doing
from mmrs_core.behaviour.program import Move, Program
from mmrs_core.contributions.vehicles import Live, VehicleInput
from mmrs_core.errors import LinkLostError, UnsupportedError, UsageError
from mmrs_core.generation.python.moves import action_of
from mmrs_core.generation.python.program import built, objects_in
from mmrs_core.geometry.frames import LocalFrame
from mmrs_core.scene import Frame, Position
from mmrs_mavlink import program as words
from mmrs_mavlink.driving.equipment import Equipment, Guard, Precautions
from mmrs_mavlink.driving.threaded import ThreadedVehicle
from mmrs_mavlink.linked import reached
from mmrs_mavlink.links.link import Link
from mmrs_mavlink.links.ports import address_of, split_system
from mmrs_mavlink.links.radios import Radios
from mmrs_mavlink.links.retries import Retries
from mmrs_mavlink.links.signing import Signer, signer_for
from mmrs_mavlink.options import FIRST_PORT, PORT_STEP
from mmrs_mavlink.plugin.backend.options import LinkOptions, link_options
from mmrs_mavlink.plugin.context import VehicleContext, context_of
from mmrs_mavlink.plugin.controllers import DRIVER, MAVLINK_PYTHON, robot_of
from mmrs_mavlink.program import Action, Geographic, Place, Robot
from mmrs_mavlink.services.satellites import attended
from mmrs_runtime.clock import Clock
from mmrs_runtime.controllers.user_functions import Locator, where_expected
from mmrs_runtime.engine.clocks import FollowingClock
from mmrs_runtime.faults import FaultError
from mmrs_runtime.injection import Rehearsal, injections, noted_in
from mmrs_runtime.ports import Port

SHARED = "mavlink"


@dataclass(frozen=True, slots=True)
class Fleet:
    """What all robots of a run share."""

    clock: Clock
    radios: Radios
    rehearsal: Rehearsal


def connect(given: VehicleInput, live: Live) -> ThreadedVehicle:
    """Return a robot at the end of its link.

    Raises:
        UsageError: an option or a link is unknown or makes no sense.
        UnsupportedError: the robot's program holds what vehicles cannot do; lists all of it.
        LinkLostError: the port cannot be opened.
    """
    options = link_options(given.options)
    _refuse(given, options)
    program = robot_of(given.robot, given)
    fleet = _fleet(live, options, given.program)
    url, system = _url(given, live)
    try:
        link = fleet.radios.open(url, system)
    except FaultError as fault:
        raise LinkLostError(f"robot '{given.robot.id}': {fault}") from fault
    context = context_of(given.robot, given)
    equipment = _equipment(given, live, context, program, fleet, link)
    return BehaviourVehicle(program, equipment, lambda each: built(action_of(each, context, DRIVER), words))


class RobotFrame:
    """The local frame of a behaviour, as one robot sees it."""

    def __init__(self, frame: Frame, home: Position, zero: float) -> None:
        """Lay it.

        Args:
            frame: of the behaviour.
            home: of the robot: east, north, up.
            zero: height above the origin from which the robot's heights count, metres.
        """
        self._frame, self._home, self._zero = frame, home, zero

    def position(self, place: Place) -> Position:
        """Return a place as metres east, north and up of the origin."""
        if not isinstance(place, Geographic):
            return (self._home[0] + place.east, self._home[1] + place.north, self._zero + place.height)
        longitude, latitude = from_wgs84(self._frame.crs).transform(place.longitude, place.latitude)
        east, north = self._plane.to_local([latitude], [longitude])[0]
        return (float(east), float(north), self._zero + place.height)

    @cached_property
    def _plane(self) -> LocalFrame:
        assert self._frame.latitude is not None
        assert self._frame.longitude is not None
        return LocalFrame(self._frame.crs, self._frame.latitude, self._frame.longitude)


class BehaviourVehicle(ThreadedVehicle):
    """Carries out a behaviour's own moves and actions, by the steps that they are in the robot's program."""

    def __init__(self, robot: Robot, equipment: Equipment, action: Callable[[Doing], Action]) -> None:
        """Drive a robot; `action`: returns an action as the robot's program has it."""
        super().__init__(robot, equipment)
        self._action = action

    def do(self, order: object, now: float, *, through: bool = False) -> None:
        """Begin a grounded movement, or an action."""
        known = self._steps[order.id] if isinstance(order, Move) else self._action(cast(Doing, order))
        super().do(known, now, through=through)


def _refuse(given: VehicleInput, options: LinkOptions) -> None:
    alone = replace(given, program=replace(given.program, robots=(given.robot,)))
    found = list(MAVLINK_PYTHON.refusals(alone))
    if not options.objects:
        found += [
            f"robot '{given.robot.id}': object '{each}': it is not located; objects=expected flies"
            " to its expected position"
            for each in objects_in(given.robot)
        ]
    if found:
        raise UnsupportedError(f"robot '{given.robot.id}': its vehicle cannot do all of it", found)


def _fleet(live: Live, options: LinkOptions, program: Program) -> Fleet:
    found = live.shared.get(SHARED)
    if isinstance(found, Fleet):
        return found
    clock = FollowingClock(live.clock)
    urls = _urls(live, program)
    try:
        faults = injections([options.inject] if options.inject else [], urls)
    except ValueError as error:
        raise UsageError(f"option 'inject': {error}") from error
    rehearsal = Rehearsal(faults, clock, live.announce)
    retries = Retries(options.tries, options.answer_seconds, options.item_seconds)
    sharers: dict[str, list[str]] = {}
    for robot, url in urls.items():
        sharers.setdefault(_split(url)[0], []).append(robot)

    def wrap(port: Port, url: str) -> Port:
        return rehearsal.wrap(port, sharers.get(url, []))

    fleet = Fleet(clock, Radios(clock, _signer(options.signing_key), retries, wrap), rehearsal)
    live.shared[SHARED] = fleet
    return fleet


def _signer(path: Path | None) -> Signer | None:
    if path is None:
        return None
    try:
        return signer_for(path)
    except (OSError, ValueError) as error:
        raise UsageError(f"option 'signing-key': {error}") from error


def _urls(live: Live, program: Program) -> Mapping[str, str]:
    usual = {
        robot.id: f"udpin:127.0.0.1:{FIRST_PORT + PORT_STEP * number}"
        for number, robot in enumerate(program.robots)
    }
    return {robot: live.links.get(robot, url) for robot, url in usual.items()}


def _url(given: VehicleInput, live: Live) -> tuple[str, int]:
    return _split(_urls(live, given.program)[given.robot.id])


def _split(text: str) -> tuple[str, int]:
    try:
        url, system = split_system(text)
        address_of(url)
    except ValueError as error:
        raise UsageError(f"link {error}") from error
    return url, system


def _equipment(
    given: VehicleInput, live: Live, context: VehicleContext, program: Robot, fleet: Fleet, link: Link
) -> Equipment:
    options, box = link_options(given.options), live.black_box(given.robot.id)
    radio = reached(
        _url(given, live)[0],
        link,
        program,
        fleet.radios,
        live,
        box,
        fleet.clock,
        acceptance=options.acceptance,
        home_tolerance=options.home_tolerance,
        patience=options.patience,
    )
    home = given.robot.home or (0.0, 0.0, 0.0)
    fleet.rehearsal.record(given.robot.id, noted_in(box))
    fleet.rehearsal.attend(given.robot.id, attended(link))
    locators: dict[str, Locator] = {each: where_expected for each in objects_in(given.robot)}
    guard = link.guard = Guard()
    return Equipment(
        radio.vehicle,
        guard,
        fleet.clock,
        RobotFrame(given.program.frame, home, context.zero).position,
        live,
        radio=radio,
        joules=sum(battery.energy for battery in given.type.batteries) or None,
        locators=locators,
        box=box,
        home_tolerance=options.home_tolerance,
        fence=options.fence,
        precautions=Precautions(options.device_check, options.battery_check, options.try_devices),
        start=_once(fleet.rehearsal.start, live.shared),
        let_go=lambda: fleet.rehearsal.forget(given.robot.id),
    )


def _once(begin: Callable[[], None], shared: dict[str, object]) -> Callable[[], None]:
    def start() -> None:
        if shared.setdefault(f"{SHARED} faults", begin) is begin:
            shared[f"{SHARED} faults"] = "begun"
            begin()

    return start
