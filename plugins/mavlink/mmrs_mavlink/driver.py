"""The driver of vehicles that speak MAVLink, for controllers: it reads its options, and makes vehicles."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from mmrs_runtime.controllers import vocabulary as words
from mmrs_runtime.controllers.driver import Driver, DriverInput
from mmrs_runtime.controllers.geodesy import offset
from mmrs_runtime.controllers.running import run_controllers
from mmrs_runtime.controllers.user_functions import Condition, Locator
from mmrs_runtime.engine.connecting import Live
from mmrs_runtime.injection.spec import OF_STATIONS, OF_VEHICLE
from mmrs_runtime.records.blackbox import BlackBox
from mmrs_runtime.vehicle import Position

from .driving.equipment import Equipment, Guard, Precautions
from .driving.threaded import ThreadedVehicle
from .options import Reach, add_reach, reach_of
from .program import Place, Robot
from .vehicles.dry import DryVehicle

if TYPE_CHECKING:
    from mmrs_runtime.ports import Port

    from .linked import RadioLink
    from .links.radios import Radios


def main(
    robots: Sequence[Robot],
    conditions: Mapping[str, Condition] | None = None,
    locators: Mapping[str, Locator] | None = None,
    arguments: Sequence[str] | None = None,
) -> int:
    """Run the programs of robots whose vehicles speak MAVLink; return the exit code.

    Args:
        robots: at least one.
        conditions: what decides Choices, by identifier.
        locators: what finds objects, by description.
        arguments: as on the command line; None: those of this process.
    """
    return run_controllers(MavlinkDriver(), robots, conditions, locators, arguments)


class MavlinkDriver(Driver):
    """Reaches vehicles by MAVLink, or makes them up for a dry run."""

    rehearses = (*OF_VEHICLE, *OF_STATIONS)
    _reach: Reach
    _outfit: DriverInput

    def __init__(self) -> None:
        """Create without connections."""
        self._radios: Radios | None = None

    def add_options(self, parser: ArgumentParser) -> None:
        """Add the options of links and of commands to vehicles."""
        add_reach(parser)

    def settle(
        self, parser: ArgumentParser, robots: Sequence[words.Robot], given: Namespace
    ) -> Mapping[str, str]:
        """Keep how robots are reached; return the urls of their links."""
        for robot in robots:
            assert isinstance(robot, Robot)
            try:
                robot.profile  # noqa: B018  it is imported now, before anything moves
            except ValueError as error:
                parser.error(f"robot '{robot.id}': {error}")
        self._reach = reach_of(parser, robots, given)
        return self._reach.urls

    def open(self, outfit: DriverInput) -> None:
        """Open nothing yet: ports are opened with the first vehicle on them."""
        self._outfit = outfit
        if outfit.options.dry:
            return
        from .links.radios import Radios  # MAVLink's library need not be there for a dry run

        reach = self._reach

        def wrap(port: Port, url: str) -> Port:
            return outfit.rehearsal.wrap(port, reach.sharers(url))

        self._radios = Radios(outfit.options.clock, reach.signer, reach.retries, wrap)

    def connect(self, robot: words.Robot, live: Live, box: BlackBox) -> ThreadedVehicle:
        """Return a robot's vehicle, possibly before its first message.

        Raises:
            FaultError: its port cannot be opened.
        """
        assert isinstance(robot, Robot)
        outfit, guard = self._outfit, Guard()
        options, radio = outfit.options, None
        if self._radios is not None:
            radio = self._radio(robot, live, box, self._radios)
            radio.link.guard = guard
        equipment = Equipment(
            radio.vehicle if radio is not None else DryVehicle(options.clock, robot.home, guard),
            guard,
            options.clock,
            _from(robot.home),
            live,
            radio=radio,
            locators=outfit.locators,
            box=box,
            home_tolerance=options.home_tolerance,
            fence=self._reach.fence,
            precautions=Precautions(self._reach.device_check, self._reach.battery_check, self._reach.tried),
            dry=options.dry,
            let_go=lambda: outfit.rehearsal.forget(robot.id),
        )
        return ThreadedVehicle(robot, equipment)

    def _radio(self, robot: Robot, live: Live, box: BlackBox, radios: Radios) -> RadioLink:
        from .linked import reached  # MAVLink's library need not be there for a dry run
        from .services.satellites import attended

        options, reach = self._outfit.options, self._reach
        url = reach.urls[robot.id]
        link = radios.open(url, reach.systems[robot.id])
        self._outfit.rehearsal.attend(robot.id, attended(link))
        return reached(
            url,
            link,
            robot,
            radios,
            live,
            box,
            options.clock,
            acceptance=reach.acceptance,
            home_tolerance=options.home_tolerance,
            patience=options.patience,
        )


def _from(home: Place) -> Callable[[Place], Position]:
    """Return the function from a position to metres east and north of home, and its height."""

    def position(place: Place) -> Position:
        north, east, _ = offset(home, place)
        return (east, north, place.height)

    return position
