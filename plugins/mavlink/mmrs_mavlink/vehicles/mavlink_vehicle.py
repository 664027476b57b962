"""A vehicle at the end of a MAVLink link, in the words of a robot's program.

ArduPilot is stepped in GUIDED and PX4 in OFFBOARD; both run missions in AUTO. What else differs
between them is in ``profiles/``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from math import inf

from mmrs_runtime.controllers.geodesy import at_height
from mmrs_runtime.controllers.state import State
from mmrs_runtime.faults import LINK_LOST, MOTORS_OFF, FaultError, RefusedError, UnansweredError

from ..links.link import Link, Message
from ..links.messages import ANYBODY
from ..profiles import VehicleProfile, modes
from ..program import Geographic, Look, Place, Travel
from ..services.commands import ask, command, name_of
from ..services.telling import tell
from ..services.uploads import Uploads
from . import preparation
from .batteries import renew_battery
from .evidence import LinkEvidence
from .mission import Mission
from .mode_control import ModeControl
from .own_home import keep_home
from .owner_settings import check_listening, enclose, end_exemption, set_up
from .steering import PATIENCE_FACTOR, PATIENCE_SECONDS, Steering
from .telemetry import Telemetry
from .vehicle import Vehicle

FORCE_DISARM = 21_196
IMAGE_SECONDS = 10.0
IMAGES = ("CAMERA_IMAGE_CAPTURED", "CAMERA_FEEDBACK")


class MavlinkVehicle(Vehicle):
    """A vehicle, stepped in GUIDED and run in AUTO.

    Attributes:
        start: where it is to stand before it takes off: home, or where its program has landed it.
        reports: the messages that it sends on request.
    """

    def __init__(
        self,
        link: Link,
        profile: VehicleProfile,
        home: Place,
        *,
        acceptance: float | None = None,
        travel: Travel = Travel(),  # noqa: B008  it is frozen
        home_tolerance: float = 20.0,
        tell: Callable[[str], None] = lambda line: None,
    ) -> None:
        """Drive the vehicle at the end of a link.

        Args:
            link: open.
            profile: of its class of vehicle.
            home: of the robot, as in its program.
            acceptance: acceptance radius in metres; None: as `travel` defines.
            travel: travel mode.
            home_tolerance: metres that the vehicle may be from where it is to stand.
            tell: called with what operators should know, such as the vehicle's failsafes.
        """
        self.start = home
        self._tell = tell
        self._link = link
        link.expect(profile)
        self._telemetry = Telemetry(link, home)
        self.reports = preparation.Reports(link, geographic=isinstance(home, Geographic))
        self._mode_control = ModeControl(link, self._telemetry)
        self._acceptance = travel.acceptance if acceptance is None else acceptance
        self._steering = Steering(
            link,
            self._telemetry,
            self._mode_control,
            self._acceptance,
            travel.turning_radius,
            travel.turn_rate,
        )
        self._travel = travel
        self._home = home
        self._home_tolerance = home_tolerance
        self._mission = Mission(link, self._telemetry, self._mode_control)
        self._alone: frozenset[int] = frozenset()
        self._listens = False

    def prepare(self, uploads: Uploads) -> None:
        """Upload what there is to upload, and wait until the vehicle is ready to move.

        A vehicle that is in the air already may be anywhere.

        Raises:
            RefusedError: something is not accepted or read back differently, the vehicle does not stand where
                it is to, or it does not become ready.
        """
        geographic = isinstance(self._home, Geographic)
        self.reports.request()
        preparation.await_position(self._link, self._telemetry)
        tolerance = inf if self._telemetry.airborne() else self._home_tolerance
        preparation.check_identity(self._link, self._telemetry, tolerance, self._home, self.start)
        fenced = bool(uploads.fence)
        for line in enclose(self._link, self._home, uploads.places, uploads.rally, polygons=fenced):
            self._tell(line)
        for line in uploads.words:
            self._tell(line)
        for line in self._mission.upload(uploads) if geographic else ():
            self._tell(line)
        for line in preparation.report_failsafes(self._link):
            self._tell(line)
        for line in set_up(self._link, self._travel, self._acceptance, uploads.speed):
            self._tell(line)
        preparation.await_ready(self._link, self._telemetry)
        if fenced:
            self._mode_control.guidance.enable_fence()

    def check(self) -> None:
        """Check that the vehicle is not under external control.

        Raises:
            FaultError: it is, or a failsafe has answered an event.
        """
        self._mode_control.check()

    def answer_lost_link(self, response: str, after: float | None = None) -> None:
        """Set the failsafe for a lost ground station.

        Raises:
            RefusedError: it cannot respond so, does not confirm that it will, or does not count this program.
        """
        if response != "CONTINUE" and not self._listens:
            for said in (check_listening(self._link), end_exemption(self._link)):
                if said:
                    self._tell(said)
            self._listens = True
        failsafe = self._link.profile.lost_link
        alone = failsafe.modes_by(failsafe.answers.get(response, {}))
        # Until it confirms, it may do the one or the other.
        self._alone |= alone
        self._mode_control.alone |= alone
        otherwise = preparation.answer_lost_link(self._link, response, after)
        self._alone = alone
        if otherwise:
            self._tell(otherwise)

    def answer_breach(self, response: str) -> None:
        """Set the failsafe for a broken fence.

        Raises:
            RefusedError: it cannot respond so, or does not confirm that it will.
        """
        preparation.answer_breach(self._link, response)

    @property
    def telemetry(self) -> Telemetry:
        """Return what the vehicle tells about itself."""
        return self._telemetry

    def take_off(self, height: float) -> None:
        """Climb to a height above home, or go there straight up or down from where it is in the air.

        Raises:
            RefusedError: the vehicle does not arm or take off, or, away from home, does not keep that
                place for its own.
            FaultError: it does not get there.
        """
        if self._telemetry.airborne():
            self._steering.go_to(at_height(self._telemetry.here(), height), None, None, False)
            return
        if self.start != self._home and isinstance(self._home, Geographic) and not self._telemetry.armed():
            self._tell(keep_home(self._link, self._telemetry, self._home, self.start))
        self._mode_control.leave_ground(height)
        limit = PATIENCE_SECONDS + PATIENCE_FACTOR * height
        self._mode_control.until(lambda: self._is_at(height) or self._has_climbed(), limit, "to take off")
        if not self._is_at(height):
            self._steering.go_to(at_height(self._telemetry.here(), height), None, None, False)

    def _is_at(self, height: float) -> bool:
        return abs(self._telemetry.here().height - height) <= self._acceptance

    def _has_climbed(self) -> bool:
        """Return whether a vehicle's own climb has ended, at whatever height.

        A PX4 takes for home where it leaves the ground, by when its height has drifted, or it has risen.
        """
        holds = bool(self._mode_control.guidance.climbing()) and self._mode_control.mode() == modes.HOLD
        return holds and self._telemetry.airborne() and self._telemetry.speed() <= self._link.profile.still

    def land(self) -> None:
        """Descend and stop the motors.

        Raises:
            FaultError: it does not come to the ground, or crashes.
        """
        self._mode_control.enter(modes.LAND)
        limit = PATIENCE_SECONDS + PATIENCE_FACTOR * 2.0 * max(0.0, self._telemetry.here().height)
        self._mode_control.until(lambda: not self._telemetry.armed(), limit, "to land")
        self._mode_control.let_go()
        if crash := self._telemetry.crash():
            raise FaultError(MOTORS_OFF, crash)

    def go_to(self, place: Place, speed: float | None, look: Look | None, through: bool) -> None:
        """Go straight to a place.

        Raises:
            FaultError: it does not get there.
        """
        self._mission.look()
        self._steering.go_to(place, speed, look, through)

    def turn(self, look: Look) -> None:
        """Turn until a device points at a target; a device with a gimbal turns on its own."""
        self._steering.turn(look)

    def fly(self, first: int, last: int, reached: Callable[[int], None], look: Look | None = None) -> None:
        """Fly items of the uploaded mission; the one after `last` must make the vehicle wait.

        Args:
            first, last: their numbers.
            reached: called with the number of each that is behind.
            look: where the vehicle, or a gimbal on it, looks all along; None: where it goes.

        Raises:
            RefusedError: the vehicle has another mission by now, or does not begin with that item.
            FaultError: no item was reached for too long, or the mission was set ahead or back externally.
        """
        self._mode_control.arm()
        end = self._mission.fly(first, last, reached, look)
        self._mode_control.enter(modes.GUIDED)
        self._steering.stay(end)

    def can_look(self, look: Look | None) -> bool:
        """Return whether it looks at a place all along a mission."""
        return self._mission.can_look(look)

    def rest(self, seconds: float) -> None:
        """Stay for `seconds`."""
        until = self._link.clock.now() + seconds
        self._link.wait(lambda: self._link.clock.now() >= until, seconds)
        self._mode_control.check()

    def operate(self, number: int, params: tuple[float, ...], *, confirmed: bool = False) -> None:
        """Carry out a device action.

        Args:
            number: of the command.
            params: of the command.
            confirmed: whether the vehicle reports the image that it takes.

        Raises:
            UnansweredError: the vehicle does not answer, or reports no image.
            RefusedError: it does not do it.
        """
        with self._link.inbox(*IMAGES, component=ANYBODY) as inbox:
            command(self._link, number, *params)
            if confirmed and not self._link.wait(
                lambda: any(_taken(message) for message in tuple(inbox)),
                self._link.clock.patience(IMAGE_SECONDS),
                while_received=True,
            ):
                raise UnansweredError(
                    f"{name_of(number)}: no image was reported within {IMAGE_SECONDS:.0f} s"
                )

    def ask(self, number: int, *params: float) -> None:
        """Send a command once, without waiting for the answer."""
        ask(self._link, number, *params)

    def measure(self, value: str, seconds: float) -> float:
        """Return the next value published under that name.

        Raises:
            UnansweredError: none comes within `seconds`.
        """
        with self._link.inbox("NAMED_VALUE_FLOAT") as inbox:
            found = self._link.wait(
                lambda: next((m for m in inbox if m.name == value), None),
                self._link.clock.patience(seconds),
                while_received=True,
            )
        if found is None:
            raise UnansweredError(f"{value}: no such value comes from the vehicle within {seconds:g} s")
        return float(found.value)

    def tell_ground(self, text: str) -> None:
        """Send a text to ground stations, without an acknowledgement."""
        tell(self._link, text)

    def renew_battery(self) -> str:
        """Make the vehicle count its batteries as full; return why it does not; empty: it does."""
        return renew_battery(self._link, self._telemetry)

    def hold(self) -> bool:
        """Halt and hold, and return when the vehicle does; on the ground, when it is disarmed.

        Returns:
            Whether it is still armed, so that it must be watched.

        Raises:
            RefusedError: it does not halt.
        """
        if not self._mode_control.motors_may_run():
            return False
        stands = self._telemetry.grounded() and not self._link.profile.dives
        if (stands or not self._telemetry.armed()) and self._mode_control.stops_motors():
            return False
        self._mode_control.enter(modes.HOLD)
        still = partial(self._telemetry.still_since, self._link.clock.now(), self._link.profile.still)
        if not self._link.wait(still, PATIENCE_SECONDS, while_received=True):
            raise RefusedError("the vehicle does not come to a halt")
        return self._telemetry.armed()

    def carry_on(self) -> None:
        """Resume steering after a hold, at the vehicle's position; nothing happens on the ground."""
        if self._telemetry.airborne() or (self._telemetry.armed() and not self._link.profile.flies):
            self._mode_control.arm()
            self._steering.stay()

    @property
    def returns_alone(self) -> bool:
        """Return whether its autopilot brings it home or down, without a command of this program."""
        mode, profile = self.telemetry.mode(), self._link.profile
        names = {each.number: name for name, each in profile.modes.items()} | dict(profile.other_modes)
        back = any(word in names.get(mode, "") for word in ("return", "land", "surface"))
        return back and mode in profile.failsafe_modes | self._alone

    def take_back(self) -> None:
        """Prepare to command the vehicle out of a failsafe's mode."""
        try:
            self._mode_control.check()
        except FaultError:
            self._mode_control.let_go()

    @property
    def modes_alone(self) -> frozenset[int]:
        """Return the numbers of the modes of its failsafe for a lost ground station, as set."""
        return self._alone

    def answers_to(self, event: str, said: Iterable[str]) -> frozenset[int]:
        """Return the numbers of the modes of its failsafe for an event.

        Args:
            event: of policies.
            said: its latest message about that.
        """
        if event == LINK_LOST:
            return self._alone
        return self._link.profile.failsafe_for(event, tuple(said))

    def accept_own_modes(self) -> None:
        """Accept its present state, or the mode of its own failsafe, until the next command."""
        self._mode_control.accept(self._alone)

    def accept_mode(self) -> None:
        """Accept its present mode until the next command."""
        self._mode_control.accept(())

    def regain(self) -> None:
        """Return the vehicle to the mode that it has left without a command, and hold position in GUIDED.

        Raises:
            RefusedError: it does not enter it. FaultError: it is under external control.
        """
        self._mode_control.regain()
        if self._mode_control.mode() == modes.GUIDED:
            self._steering.stay()

    def explain(self, explains: Callable[[FaultError], FaultError]) -> None:
        """Find the cause of another mode during a mode change."""
        self._mode_control.explains = explains

    def insist(self, insists: Callable[[FaultError], bool]) -> None:
        """Find the cause of a mode that was left during a mode change, before commanding it again."""
        self._mode_control.insists = insists

    def surface(self) -> None:
        """Surface.

        Raises:
            RefusedError: it is disarmed, below.
            FaultError: it does not surface.
        """

        def is_up() -> bool:
            return self._telemetry.here().height > -self._acceptance

        if self._telemetry.armed():
            self._mode_control.enter(modes.SURFACE if self._mode_control.has(modes.SURFACE) else modes.HOLD)
            seconds = 10 * PATIENCE_SECONDS
            self._mode_control.until(lambda: is_up() or not self._telemetry.armed(), seconds, "to surface")
        if not is_up():
            raise RefusedError("it is disarmed: it surfaces only if it is buoyant")

    def disarm(self) -> None:
        """Switch off propulsion, whatever happens then."""
        self._mode_control.disarm(FORCE_DISARM)

    def finish(self) -> None:
        """End the mission: a vehicle that does not fly is disarmed, one that does is not."""
        if self._telemetry.armed() and (not self._link.profile.flies or self._telemetry.grounded()):
            self._mode_control.disarm()

    def evidence(self) -> LinkEvidence:
        """Return what shows, from now on, whether the vehicle obeys."""
        geographic = isinstance(self._home, Geographic)
        return LinkEvidence(self._link, self._telemetry, geographic=geographic)

    def state(self) -> State:
        """Return what is known now."""
        mode, armed = self._mode_control.mode(), self._telemetry.armed()
        return replace(self._telemetry.state(), mode=mode, armed=armed)


def _taken(message: Message) -> bool:
    """Return whether a message reports an image that was taken."""
    return message.get_type() == "CAMERA_FEEDBACK" or bool(message.capture_result == 1)
