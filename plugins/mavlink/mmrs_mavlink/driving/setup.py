"""What comes before a robot's program: its vehicle is met, recognised, and told what it must know."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import inf
from typing import TYPE_CHECKING

from mmrs_runtime.controllers.box_entries import start_of
from mmrs_runtime.faults import FENCE_BREACHED, RefusedError

from ..program import Robot
from ..services.uploads import Uploads
from ..steps.responses import policy_for
from ..steps.watch import Watch
from ..vehicles.vehicle import Vehicle
from .equipment import Equipment
from .lost_link import LostLink
from .way_back import WayBack

if TYPE_CHECKING:
    from ..services.uploads import Uploads


class Setup:
    """Gets a vehicle ready, and again after a restart.

    Attributes:
        is_known: whether it is known to be the robot's, so that it may be commanded.
        is_done: whether it was ready once.
    """

    def __init__(
        self,
        robot: Robot,
        equipment: Equipment,
        uploads: Uploads,
        watch: Watch,
        lost_link: LostLink,
        way: WayBack,
        note: Callable[[str, Mapping[str, object]], None],
    ) -> None:
        """Keep the parts; `note` writes into the black box."""
        self.is_known = self.is_done = self._restarted = False
        self._robot, self._with, self._live = robot, equipment, equipment.live
        self._uploads, self._watch, self._lost_link = uploads, watch, lost_link
        self._way, self._note = way, note

    def meet(self) -> None:
        """Wait for the vehicle.

        Raises:
            FaultError: it does not come in time.
        """
        radio = self._with.radio
        if radio is None:
            self._note("start", start_of(self._robot, None, "pymavlink"))
            return
        self._live.say(f"waits for a vehicle at {radio.url}")
        from ..vehicles.recognition import firmware_of  # needs MAVLink's library

        try:
            radio.radios.meet(radio.link, radio.url, radio.patience)
        finally:
            about = {"firmware": firmware_of(radio.link), "system": radio.link.system}
            self._note("start", start_of(self._robot, radio.url, "pymavlink", **about))

    def set_up(self) -> None:
        """Upload what the vehicle must know, once it is known to be the robot's.

        Raises:
            RefusedError: it is not the robot's, or refuses an upload.
        """
        vehicle = self._with.vehicle
        self._watch.renew()
        self._recognise()
        if self._live.resumed:
            vehicle.hold()
        self._lost_link.tell()
        equip(self._robot, vehicle, self._uploads, self._live.say)
        self._inspect()
        self.is_done = True
        if vehicle.state().energy is None and not self._with.dry:
            self._live.say("does not report its battery: a low battery will go unnoticed")
        self._watch.forewarn()

    def take_up(self) -> None:
        """Obey all events again, and continue the sortie."""
        self._restarted = self._restarted or self._watch.restarted
        self._watch.tighten()
        self.begin_sortie()

    def begin_sortie(self) -> None:
        """Begin or continue a sortie.

        A vehicle that has restarted, as with a new battery, or was not completely set up, is set up first.
        """
        self._restarted = self._restarted or self._watch.restarted
        if self._restarted or not self.is_done:
            self.set_up()
        self._restarted = False
        self._watch.renew()
        self._watch.moving = True

    def _inspect(self) -> None:
        """Inspect the devices and the batteries of a vehicle on the ground.

        Raises:
            RefusedError: it cannot do what its program asks of it.
        """
        if (radio := self._with.radio) is None or radio.vehicle.state().armed:
            return
        from ..vehicles.batteries import inspect_batteries  # needs MAVLink's library
        from ..vehicles.inspection import inspect_devices

        link, vehicle, precautions = radio.link, radio.vehicle, self._with.precautions
        at_start = not (self.is_done or self._live.resumed)
        devices = inspect_devices(link, vehicle, self._robot, precautions.tried)
        batteries = inspect_batteries(link, vehicle.telemetry, self._robot, at_start=at_start)
        refused: list[str] = []
        for found, option, refuses in (
            (devices, "device-check", precautions.devices),
            (batteries, "battery-check", precautions.battery),
        ):
            for line in found.lines:
                self._live.say(line)
            if found.defects and refuses:
                refused += [*found.defects, f"{option}=no takes off all the same"]
            else:
                for defect in found.defects:
                    self._live.say(f"{defect} (warning: {option}=no)")
        if refused:
            raise RefusedError("; ".join(refused))

    def _recognise(self) -> None:
        """Refuse a vehicle that is not the robot's, or under external control, before it is touched."""
        resumed, vehicle = self._live.resumed, self._with.vehicle
        first = resumed and not self.is_done
        if (radio := self._with.radio) is not None:
            from ..vehicles.recognition import other_times, recognise  # needs MAVLink's library

            recognise(
                radio.link,
                radio.vehicle,
                self._robot,
                inf if resumed and vehicle.state().armed else self._with.home_tolerance,
                self._way.starts(self._live.passed, self._live.begun) if first else (vehicle.start,),
                under_way=resumed,
                system=radio.system,
            )
            if not self.is_known and (said := other_times(radio.link, self._robot)):
                self._live.say(said)
        if first:
            self._way.know(self._live.passed, self._live.begun)
        self.is_known = True


def equip(robot: Robot, vehicle: Vehicle, uploads: Uploads, say: Callable[[str], None]) -> None:
    """Upload what a vehicle must know, and its response outside its fence.

    Args:
        robot: whose policies count.
        vehicle: of the robot.
        uploads: of its program.
        say: reports refusals that the program can do without.

    Raises:
        RefusedError: the vehicle does not accept an upload that it needs, or does not become ready.
    """
    vehicle.prepare(uploads)
    if not uploads.fence:
        return
    try:
        vehicle.answer_breach(policy_for(FENCE_BREACHED, robot).response)
    except RefusedError as error:
        say(str(error))
