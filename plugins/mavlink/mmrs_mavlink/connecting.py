"""Makes the vehicles of a process: at the ends of their links, made up, or of other drivers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import inf
from typing import TYPE_CHECKING

from mmrs_runtime.engine.connecting import Live
from mmrs_runtime.faults import Fault
from mmrs_runtime.injection import Rehearsal
from mmrs_runtime.policies import NOTHING
from mmrs_runtime.records.blackbox import BlackBox, black_box_path
from mmrs_runtime.vehicle import Position

from .driving.equipment import Equipment, Guard, Radio
from .driving.threaded import ThreadedVehicle
from .objects import Locator
from .options import Options
from .places import offset
from .program import Place, Robot
from .records.start import start_of
from .vehicles.dry import DryVehicle
from .vehicles.vehicle import Vehicle

if TYPE_CHECKING:
    from .links.radios import Radios

Vehicles = Callable[[Robot, Options, Callable[[], None], BlackBox], Vehicle]
"""What makes the vehicle of a robot that is reached otherwise than by MAVLink.

It calls the guard in every wait, and writes where it is into the black box.
"""


@dataclass(frozen=True, slots=True)
class Garage:
    """Makes the vehicles of a process.

    Attributes:
        radios: None: no robot speaks MAVLink.
        others: what makes vehicles that do not; None: those that do, unless there is none.
        locators: what finds objects, by description.
        vehicles: by robot, once they are there.
    """

    options: Options
    radios: Radios | None
    rehearsal: Rehearsal
    locators: Mapping[str, Locator]
    others: Vehicles | None
    vehicles: dict[str, ThreadedVehicle] = field(default_factory=dict)

    def connect(self, robot: Robot, live: Live) -> ThreadedVehicle:
        """Return a robot's vehicle, which need not have been heard yet.

        Raises:
            Fault: it cannot be reached.
        """
        box = self._box(robot, live)
        self.rehearsal.record(robot.id, lambda fault, content: box.write("injected", fault=fault, **content))
        try:
            self.vehicles[robot.id] = ThreadedVehicle(robot, self._equipment(robot, live, box))
        except Fault as fault:
            box.write("start", **start_of(robot, self.options.reach.urls.get(robot.id, ""), None))
            box.write("decision", what=fault.event, why=str(fault), response=NOTHING, move=robot.start)
            box.close()
            live.say(str(fault))
            raise
        return self.vehicles[robot.id]

    def reported(self, robot: str) -> Mapping[str, object]:
        """Return what a robot has reported last, as people are told who ask; empty before it has."""
        vehicle = self.vehicles.get(robot)
        return {"reported": vehicle.reported} if vehicle is not None and vehicle.reported else {}

    def _equipment(self, robot: Robot, live: Live, box: BlackBox) -> Equipment:
        options, guard = self.options, Guard()
        radio = self._radio(robot, live, guard, box) if self.radios is not None else None
        vehicle: Vehicle
        if radio is not None:
            vehicle = radio.vehicle
        elif self.others is not None and not options.dry:
            vehicle = self.others(robot, options, guard, box)
        else:
            vehicle = DryVehicle(options.clock, robot.home, guard)
        return Equipment(
            vehicle,
            guard,
            options.clock,
            _from(robot.home),
            live.say,
            live.wake,
            radio=radio,
            locators=self.locators,
            box=box,
            home_tolerance=options.tolerances.home,
            fence=options.fence,
            dry=options.dry,
            records=live.records,
            let_go=lambda: self.rehearsal.forget(robot.id),
        )

    def _radio(self, robot: Robot, live: Live, guard: Guard, box: BlackBox) -> Radio:
        from .linked import at_end_of  # MAVLink's library need not be there where no robot speaks it
        from .services.satellites import attended
        from .vehicles.recognition import system_of

        assert self.radios is not None
        options, reach = self.options, self.options.reach
        url, near = reach.urls[robot.id], options.tolerances
        link = self.radios.open(url, reach.systems[robot.id])
        link.guard = guard
        home_tolerance = inf if live.resumed else near.home
        linked = at_end_of(link, robot, near.place, home_tolerance, live.say)
        linked.record(box, robot, options.clock)
        self.rehearsal.attend(robot.id, attended(link))
        system = system_of(black_box_path(options.log / robot.log)) if options.resume else 0
        patience = reach.patience * options.clock.speedup
        return Radio(url, link, linked.vehicle, self.radios, patience, system)

    def _box(self, robot: Robot, live: Live) -> BlackBox:
        path, mark = black_box_path(self.options.log / robot.log), {"dry_run": True}
        now = self.options.clock.now
        return BlackBox(path, live.run, robot.id, now, mark=mark if self.options.dry else {}, say=live.say)


def _from(home: Place) -> Callable[[Place], Position]:
    """Return what tells where a place is from home: metres east and north of it, and its height."""

    def position(place: Place) -> Position:
        north, east, _ = offset(home, place)
        return (east, north, place.height)

    return position
