"""Steering a PX4. Written from its documents and source, and flown on 1.16.0-beta1 in its own simulation.

OFFBOARD takes only a stream of set-points, which must have begun a second before the mode is
requested, and ends the mode when it stops (https://docs.px4.io, "Offboard Mode"). So a thread of its
own sends them, at 10 Hz, until another mode has been entered. A set-point moves along the leg at the
commanded speed: OFFBOARD ignores DO_CHANGE_SPEED. So does its heading at the turn rate: only its own modes
obey MPC_YAWRAUTO_MAX, and a heading that is set at once is turned to at up to MC_YAWRATE_MAX, 200 degrees per
second.

Heights of set-points are above sea level: with MAV_FRAME_GLOBAL_RELATIVE_ALT_INT, PX4 1.13 to 1.15 put
the set-point on the wrong side of home wherever home is not where the estimator began
(``mavlink_receiver.cpp``, ``handle_message_set_position_target_global_int``).

It may settle beside its target, and report that it moves: in its own simulation, whose accelerometers are
noisy, it estimates speeds of 0.3 to 0.85 m/s for ten seconds and more while its position hardly changes. Its
controller answers an error of its speed by one of its place (MPC_XY_P): 0.5 to 1.4 m. So its speed, which is
slow at times by chance, says nothing: two of five legs ended 2 s earlier where that counted.
"""

from __future__ import annotations

import threading
from math import copysign, inf, isnan, nan, pi, radians, remainder

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.controllers.geodesy import between, distance
from mmrs_runtime.faults import RefusedError

from ..links.link import Link
from ..profiles import modes
from ..profiles.px4 import HOLDS, TAKES_OFF
from ..program import Place
from .guidance import target
from .telemetry import Telemetry

STREAM_SECONDS = 0.1
LEAST_PAUSE = 0.01
"""Real seconds between two set-points at least."""

AHEAD_SECONDS = 1.5
"""For how long set-points are sent before the mode is asked for: PX4 wants more than a second."""

WANDER, WANDERING = 1.5, 4.0
"""Metres from the target, and seconds within these, in all, from which it has settled whatever speed it
estimates. It may be a bit farther away in between: were it to stay, a leg would take 4 s longer whose
overshoot is 0.02 m more."""

FRESH_SECONDS = 1.0
"""In which a position comes from a vehicle that tells five a second."""


class Stream:
    """Sends set-points that move towards a target, as long as it runs."""

    def __init__(self, link: Link, telemetry: Telemetry) -> None:
        """Send nothing yet."""
        self._link = link
        self._telemetry = telemetry
        self._lock = threading.Lock()
        self._running: threading.Event | None = None
        self._at: Place | None = None
        self._target: Place | None = None
        self._yaw = self._turns_to = 0.0
        self._speed: float | None = None
        self._turn_rate = inf
        self._moved = 0.0

    @property
    def runs(self) -> bool:
        """Return whether set-points are being sent."""
        return self._running is not None

    def begin(self) -> None:
        """Send the vehicle's position again and again, if nothing is being sent."""
        with self._lock:
            if self._running is not None:
                return
            self._at = self._target = self._telemetry.here()
            self._yaw = self._turns_to = radians(self._telemetry.heading() or 0.0)
            self._moved = self._link.clock.now()
            self._running = threading.Event()
            threading.Thread(target=self._send, args=(self._running,), name="set-points", daemon=True).start()

    def end(self) -> None:
        """Send no more."""
        with self._lock:
            if self._running is not None:
                self._running.set()
            self._running = None

    @property
    def is_there(self) -> bool:
        """Return whether the set-point has come to its target."""
        with self._lock:
            return self._at is not None and self._at == self._target

    def aim(self, place: Place, yaw: float, speed: float | None, turn_rate: float) -> None:
        """Move to a place, and turn, from now on; None for the speed: as fast as the vehicle can."""
        with self._lock:
            self._target, self._speed = place, speed
            self._turns_to, self._turn_rate = yaw, turn_rate

    def _send(self, ended: threading.Event) -> None:
        clock = self._link.clock
        while not ended.is_set() and self._link.listening:
            with self._lock:
                place, yaw = self._move(clock.now()), self._yaw
            level = self._telemetry.sea_level() or 0.0
            self._link.send(target(self._link, place, yaw, mavlink.MAV_FRAME_GLOBAL_INT, level))
            ended.wait(max(LEAST_PAUSE, clock.real(STREAM_SECONDS)))

    def _move(self, now: float) -> Place:
        assert self._at is not None
        assert self._target is not None
        passed, self._moved = now - self._moved, now
        left = distance(self._at, self._target)
        aside, most = remainder(self._turns_to - self._yaw, 2.0 * pi), self._turn_rate * passed
        self._yaw = self._yaw + copysign(most, aside) if abs(aside) > most else self._turns_to
        if self._speed is None or left <= self._speed * passed:
            self._at = self._target
        else:
            self._at = between(self._at, self._target, self._speed * passed / left)
        return self._at


class Px4Guidance:
    """PX4: set-points as a stream, heights above sea level."""

    climbs_in = modes.HOLD

    def __init__(self, link: Link, telemetry: Telemetry) -> None:
        """Steer the vehicle at a link."""
        self._link = link
        self._telemetry = telemetry
        self._stream = Stream(link, telemetry)
        self._near_for, self._near_at = 0.0, nan
        self._aimed_at: Place | None = None

    def begin_guiding(self) -> None:
        """Send set-points for long enough that OFFBOARD is granted."""
        if not self._stream.runs:
            self._stream.begin()
            self._link.wait(lambda: None, AHEAD_SECONDS)

    def end_guiding(self) -> None:
        """End the stream."""
        self._stream.end()

    def aim(self, place: Place, yaw: float, speed: float | None, turn_rate: float = inf) -> None:
        """Move the set-point towards a place, and turn its heading no faster than its own modes do."""
        turns_at = min(turn_rate, radians(self._link.profile.pacing.turn_rate))
        self._stream.aim(place, yaw, speed, turns_at)
        if place != self._aimed_at:
            self._aimed_at, self._near_for, self._near_at = place, 0.0, nan

    def has_settled(self, place: Place) -> bool:
        """Return whether it is near to a place, and has been for some time since its set-point came there."""
        now, before = self._telemetry.time(), self._near_at
        if not self._stream.is_there or distance(self._telemetry.here(), place) > WANDER:
            self._near_at = nan
            return False
        self._near_for += 0.0 if isnan(before) else now - before
        self._near_at = now
        return self._near_for >= WANDERING

    def take_off(self, height: float) -> tuple[float, ...]:
        """Return the parameters of NAV_TAKEOFF, straight up from here.

        Home is where and as high as the vehicle was armed: earlier reports do not count.

        Raises:
            RefusedError: the vehicle has not reported its home's height.
        """
        begun, clock = self._link.clock.now(), self._link.clock
        self._link.wait(
            lambda: clock.now() - self._link.since("GLOBAL_POSITION_INT") > begun,
            clock.patience(FRESH_SECONDS),
        )
        return (-1.0, 0.0, 0.0, nan, nan, nan, self._above(height))

    def climbing(self) -> tuple[int, ...]:
        """Return take-off, and loitering when it is high enough."""
        return (TAKES_OFF, HOLDS)

    def level(self, height: float) -> tuple[int, float]:
        """Return the frame of heights above sea level, and the height there.

        Raises:
            RefusedError: the vehicle has not reported its home's height.
        """
        return mavlink.MAV_FRAME_GLOBAL, self._above(height)

    def _above(self, height: float) -> float:
        level = self._telemetry.sea_level()
        if level is None:
            raise RefusedError("the vehicle has not reported its home's height above sea level")
        return level + height

    def select(self, seq: int) -> None:
        """Send MISSION_SET_CURRENT, which every PX4 knows; MISSION_CURRENT shows whether it came."""
        for _ in self._link.attempts():
            self._link.send(
                mavlink.MAVLink_mission_set_current_message(self._link.system, self._link.component, seq)
            )
            if self._link.wait(lambda: self._telemetry.item() == seq, self._link.patience):
                return

    def enable_fence(self) -> None:
        """Return at once: a PX4 obeys its own fence (GF_ACTION)."""
