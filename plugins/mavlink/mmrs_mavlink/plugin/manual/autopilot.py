"""An ArduSub: its reports, its set-up, its ascent and its release."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import degrees, inf
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.links.link import Link
from mmrs_mavlink.plugin.manual.steering import Sticks
from mmrs_mavlink.profiles import ARDUSUB
from mmrs_mavlink.profiles.profile import Safeguard
from mmrs_mavlink.services.commands import ask, command
from mmrs_mavlink.vehicles.preparation import hear_out, report_failsafes
from mmrs_mavlink.vehicles.texts import Texts
from mmrs_runtime import faults

DEPTH_HOLD, SURFACE = 2, 9

TOLD = (mavlink.MAVLINK_MSG_ID_ATTITUDE, mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT)
INTERVALS = tuple((float(number), 1e5) for number in TOLD)
"""Messages that are requested, and their intervals in microseconds; a restart makes it forget them."""

NEEDED, STALE = ("ATTITUDE", "GLOBAL_POSITION_INT"), 2.0
"""Messages with heading and depth, and the seconds without them after which these are unknown."""

FIRST_SIGN = 60.0
INSISTING, PATIENCE = 12, 3.0
"""Times that something is asked for until it is done, and seconds between them."""

ASKED_EVERY = 1.0
"""Seconds after which a vehicle that does not surface, or is off, is commanded once more."""

OFF_FOR = 3.0
"""Seconds without motors after which no news of a new start is waited for."""

STALL = 1.0
"""Seconds between two looks after which this program was stalled, which does not count as silence."""

STICKS_LOST = Safeguard(
    "FS_PILOT_INPUT",
    "no sticks any more",
    {0: "nothing", 1: "warn", 2: "disarm"},
    dict.fromkeys((0, 1), "nothing stops its motors when this program, or its link, ends"),
)
"""What it means here, where the program moves the sticks."""

LEAK = "leak detected"
COMES_UP = "SURFACE"
"""An ArduSub's messages about water inside, in lower case, and the response to them."""


class StickAutopilot:
    """An ArduSub at the end of its link, in depth hold unless it is to surface.

    Attributes:
        rising: whether it is to surface in a mode of its own.
    """

    def __init__(
        self, link: Link, given_up: Callable[[], bool], reserve: float, *, under_way: bool = False
    ) -> None:
        """Receive; no command is sent before it is to get ready.

        Args:
            link: to the vehicle.
            given_up: whether it is no longer awaited.
            reserve: fraction of the battery below which it counts as low.
            under_way: whether it may be armed at first, as where a run is resumed.
        """
        self.rising = self._rose = False
        self._link, self._given_up, self._reserve, self._under_way = link, given_up, reserve, under_way
        link.expect(ARDUSUB)
        self._texts, self._stale_after = Texts(link.clock), link.clock.patience(STALE)
        link.observe(self._texts)
        self._starts, self._ready_at, self._asked = 0, -inf, -inf
        self._off_since, self._silent_at = inf, -inf
        self._looked = self._stalled = -inf

    def get_ready(self, say: Callable[[str], None]) -> None:
        """Enter depth hold and arm.

        Args:
            say: called with its failsafes.

        Raises:
            faults.StrangeAnswerError: it is not the robot's, or may be under external control.
            faults.FaultError: it is silent, reports too little, does not do it, or is no longer awaited.
        """
        if not self._wait(lambda: bool(self._link.component), FIRST_SIGN):
            raise faults.FaultError(faults.LINK_LOST, "no vehicle is received")
        hear_out(self._link)
        if why := self._strange():
            raise faults.StrangeAnswerError(why)
        for line in self.safeguards():
            say(line)
        for interval in INTERVALS:
            command(self._link, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, *interval)
        if not self._wait(lambda: None not in (self.heading(), self.depth()), FIRST_SIGN):
            raise faults.FaultError("SENSORS_SILENT", "the vehicle tells no heading and no depth")
        self._insist(lambda: self.mode == DEPTH_HOLD, mavlink.MAV_CMD_DO_SET_MODE, 1.0, float(DEPTH_HOLD))
        self.move(Sticks())
        self._insist(lambda: self.armed, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1.0)
        self._starts, self._ready_at = self._link.starts, self._link.clock.now()

    def safeguards(self) -> Iterator[str]:
        """Yield its failsafes, from its parameters."""
        yield from report_failsafes(self._link, [STICKS_LOST])

    def trouble(self, patience: float) -> faults.FaultError | None:
        """Return what is wrong; what leaves the vehicle to itself, or to others, goes first.

        Args:
            patience: seconds of silence after which the link counts as lost.
        """
        now = self._link.clock.now()
        self._stalled = now if now - self._looked > self._link.clock.patience(STALL) else self._stalled
        self._looked = now
        if self.is_silent(patience):
            self._silent_at = now
            return faults.FaultError(faults.LINK_LOST, f"no messages for {self._link.silent_for():.0f} s")
        if self._link.starts != self._starts:
            return faults.FaultError(faults.VEHICLE_RESTARTED, "it has restarted, and is disarmed")
        if not self.armed:
            return self._disarmed()
        self._off_since = inf
        return self._risen() or self._taken() or self._stale() or self._low()

    @property
    def knows(self) -> bool:
        """Return whether heading and depth were reported just now."""
        return max(map(self._link.since, NEEDED)) <= self._stale_after

    @property
    def knows_depth(self) -> bool:
        """Return whether its depth was reported just now."""
        return self._link.since(NEEDED[1]) <= self._stale_after

    def heading(self) -> float | None:
        """Return degrees clockwise from north, as told last."""
        reported = self._link.latest("ATTITUDE")
        return None if reported is None else degrees(reported.yaw) % 360.0

    def depth(self) -> float | None:
        """Return metres below the surface, as told last."""
        reported = self._link.latest("GLOBAL_POSITION_INT")
        return None if reported is None else max(0.0, -reported.relative_alt * 1e-3)

    def charge(self) -> float | None:
        """Return which part of the battery is left, as told last."""
        reported = self._link.latest("SYS_STATUS")
        left = reported.battery_remaining if reported is not None else -1
        return left / 100.0 if left >= 0 else None

    @property
    def armed(self) -> bool:
        """Return whether its motors may run, as its last heartbeat says."""
        beat = self._link.latest("HEARTBEAT")
        return beat is not None and bool(beat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)

    @property
    def mode(self) -> int | None:
        """Return the number of its mode, as its last heartbeat says."""
        beat = self._link.latest("HEARTBEAT")
        return None if beat is None else int(beat.custom_mode)

    @property
    def silent(self) -> float:
        """Return for how many seconds it has been silent, since this program was last stalled."""
        return min(self._link.silent_for(), self._link.clock.now() - self._stalled)

    def is_silent(self, seconds: float) -> bool:
        """Return whether it has been silent for that long, and for a real second."""
        return self.silent > self._link.clock.patience(seconds, 1.0)

    def word(self) -> str:
        """Return its mode in words."""
        return "" if self.mode is None else self._link.profile.mode_name(self.mode)

    def move(self, sticks: Sticks) -> None:
        """Set the sticks."""
        self._link.send(manual_control(self._link.system, sticks))

    def rise(self) -> None:
        """Let it surface in its own mode; by the stick as long as it does not. To be called repeatedly."""
        self.rising = self._rose = True
        self.move(Sticks(up=0.0 if self.mode == SURFACE else 1.0))
        self._ask(SURFACE)

    def stay(self) -> None:
        """Let it hold its depth after it was to surface. To be called until it is in depth hold."""
        self.move(Sticks())
        self._ask(DEPTH_HOLD)

    def let_go(self, *, at_once: bool) -> None:
        """Let the sticks go, and disarm where it is in depth hold still, or `at_once`, while it comes up.

        Raises:
            faults.FaultError: it does not disarm.
        """
        if self.mode == DEPTH_HOLD or (at_once and self._rose and self.mode == SURFACE):
            self.move(Sticks())
            command(self._link, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0.0, tries=2)

    def do(self, number: int, *params: float) -> None:
        """Send a command, and return when it is carried out.

        Raises:
            faults.FaultError: it is not, or there is no answer.
        """
        command(self._link, number, *params)

    def _ask(self, mode: int) -> None:
        now = self._link.clock.now()
        if self.mode != mode and now - self._asked >= ASKED_EVERY:
            self._asked = now
            ask(self._link, mavlink.MAV_CMD_DO_SET_MODE, 1.0, float(mode))

    def _strange(self) -> str:
        """Return why this vehicle must not be commanded; empty where it may."""
        beat = self._link.latest("HEARTBEAT")
        if beat is None or beat.type not in ARDUSUB.mav_types or beat.autopilot != ARDUSUB.autopilot.number:
            return "the vehicle is not an ArduSub"
        if self.armed and not self._under_way:
            return "the vehicle is armed already: it is under external control"
        return self._link.doubt()

    def _disarmed(self) -> faults.FaultError | None:
        """Return that it is disarmed, unless it may have restarted and is about to report it on request."""
        now = self._link.clock.now()
        self._off_since = min(self._off_since, now)
        if now - self._off_since >= self._link.clock.patience(OFF_FOR):
            return faults.FaultError(faults.MOTORS_OFF, "it was disarmed externally, or by a failsafe")
        if now - self._asked >= ASKED_EVERY:
            self._asked = now
            for interval in INTERVALS:
                ask(self._link, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, *interval)
        return None

    def _risen(self) -> faults.FaultError | None:
        """Return why the vehicle surfaces on its own, or should."""
        if self._rose:
            return None
        if said := self._said(LEAK):
            return faults.FaultError(faults.CRASHED, f"the vehicle says '{said}'", COMES_UP)
        if self.mode == SURFACE and self._is_low():
            return faults.FaultError(faults.BATTERY_LOW, "the vehicle surfaces on its own", COMES_UP)
        return None

    def _taken(self) -> faults.FaultError | None:
        if self.mode == DEPTH_HOLD or (self._rose and self.mode == SURFACE):
            return None
        return faults.FaultError(
            "TAKEN_OVER", f"its mode is '{self.word()}' now: a pilot, or itself, has changed it"
        )

    def _stale(self) -> faults.FaultError | None:
        now, silent, age = self._link.clock.now(), self._link.silent_for(), max(map(self._link.since, NEEDED))
        if silent >= self._stale_after:
            self._silent_at = now
        # What was told last before all fell silent is no older than that: then the link is lost.
        if age - silent <= self._stale_after or now - self._silent_at < self._stale_after:
            return None
        return faults.FaultError(faults.POSITION_LOST, f"heading or depth was not reported for {age:.1f} s")

    def _low(self) -> faults.FaultError | None:
        return (
            faults.FaultError(faults.BATTERY_LOW, f"{self.charge():.0%} are left") if self._is_low() else None
        )

    def _is_low(self) -> bool:
        charge = self.charge()
        return charge is not None and charge < self._reserve

    def _said(self, words: str) -> str:
        reported = (each.text for each in self._texts.since(self._ready_at))
        return next((text for text in reported if words in text.lower()), "")

    def _insist(self, test: Callable[[], bool], number: int, *params: float) -> None:
        """Command a vehicle that needs some time after its start, and check that it obeys."""
        for left in reversed(range(INSISTING)):
            try:
                command(self._link, number, *params)
            except faults.RefusedError:
                if not left:
                    raise
            if self._wait(test, PATIENCE):
                return
        raise faults.RefusedError(f"the vehicle does not do what command {number} asks for")

    def _wait(self, test: Callable[[], bool], seconds: float) -> bool:
        found = self._link.wait(lambda: test() or self._given_up(), seconds)
        if self._given_up():
            raise faults.StoppedError
        return bool(found)


def manual_control(system: int, sticks: Sticks) -> Any:
    """Return the message of the sticks as ArduSub takes it: z is from 0 to 1000, and rests at 500."""
    x, z, r = round(1000 * sticks.forward), round(500 + 500 * sticks.up), round(1000 * sticks.turn)
    return mavlink.MAVLink_manual_control_message(system, x, 0, z, r, 0)
