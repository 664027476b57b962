"""The functions by which a decision centre commands a vehicle and asks for its state; none of them waits."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any, NamedTuple

from auv_vessel.goals import GOAL_PERIOD, GOALS, Goal, check_goal, goal_frames
from auv_vessel.hosting import FramePort, Pace, serve
from auv_vessel.sheet import Sheet
from auv_vessel.wire.catalogue import BEAT_PERIOD, DECISION, EMERGENCIES, MOST_UPTIME, STATUS_BASE, by_id
from auv_vessel.wire.codec import Codec, Received
from auv_vessel.wire.frame import Frame

FIRST_SIGN = 30.0
"""Real seconds to wait for a vehicle's first sign, and until it knows where it is."""

POSITION_LOST = 10.0
"""Metres of uncertainty above which the position counts as lost (`Sheet.extra`: ``position.lost``)."""

FARTHEST_SEEN = 655.3
"""Metres from which on a range of the sonar says that it sees nothing."""

SELDOM = 5
"""Ticks from one repetition of a device's command to the next, once the device has answered."""

OFTEN = 25
"""Emergency messages that are sent for one order, one at each tick."""

REQUESTS = 256
"""Numbers that requests of devices have, from 1 on, again and again."""


class State(NamedTuple):
    """What is known of a vehicle: metres, metres per second, degrees, degrees per second.

    Attributes:
        time: seconds, by a clock of the receiver that leaves out its own stalls.
        uncertainty: of the position, one sigma.
        trusted: whether depth, attitude and heading may be relied on.
        age: seconds since the sensor controller said it; infinite: it never did.
        charge: remaining fraction of the battery; None: unknown. sonar: range ahead; None: nothing detected.
        goal: number of the goal of which `progress` tells (one of `catalogue.PROGRESS`).
        distance: left to it.
        emergency: why the dive was given up; None: it was not.
        devices: progress of each request.
        silent: seconds since the last frame of any node of the vehicle.
        failed: numbers on the bus of the thrusters whose drives say that they have failed.
    """

    time: float = 0.0
    north: float = 0.0
    east: float = 0.0
    depth: float = 0.0
    roll: float = 0.0
    pitch: float = 0.0
    heading: float = 0.0
    surge: float = 0.0
    sway: float = 0.0
    heave: float = 0.0
    current_north: float = 0.0
    current_east: float = 0.0
    uncertainty: float = float("inf")
    trusted: bool = False
    position_lost: bool = True
    age: float = float("inf")
    silent: float = float("inf")
    charge: float | None = None
    leak: bool = False
    sonar: float | None = None
    goal: int | None = None
    progress: str = "NONE"
    distance: float = 0.0
    emergency: str | None = None
    devices: Mapping[int, str] = MappingProxyType({})
    failed: frozenset[int] = frozenset()


class Craft:
    """A vehicle as its decision centre sees it: a node that sends goals and commands, and receives states.

    All functions may be called from any thread and return at once. A goal is in force, and repeated, until
    the next one.
    """

    name = DECISION
    period = GOAL_PERIOD

    def __init__(self, sheet: Sheet, codec: Codec) -> None:
        self._sheet, self._codec = sheet, codec
        self._lost = sheet.extra.get("position.lost", POSITION_LOST)
        self._lock = threading.Lock()
        self._hearers = by_id({
            **dict.fromkeys(("Position", "Pose", "Velocity"), self._hear_state),
            "Depth": self._hear_depth, "Current": self._hear_current, "Health": self._hear_health,
            "Progress": self._hear_progress, "DeviceStatus": self._hear_device,
            **dict.fromkeys(EMERGENCIES, self._hear_emergency),
        })  # fmt: skip
        self._drives = {STATUS_BASE + number: number for number in range(len(sheet.thrusters))}
        self._goal = Goal()
        self._aimless = True
        self._state = State()
        self._devices: dict[int, str] = {}
        self._requests: dict[int, dict[str, float]] = {}
        self._request = 0
        self._ticks = 0
        self._state_at = self._heard_at = float("-inf")
        self._now = 0.0
        self._emergency: tuple[str, bool] | None = None
        self._emergencies = 0
        self._began: float | None = None
        self._beat_due = 0.0

    @property
    def goal(self) -> Goal:
        """Return the goal in force."""
        return self._goal

    def go_to(
        self, north: float, east: float, depth: float, *, speed: float = 0.0, heading: float | None = None
    ) -> int:
        """Go to a place, metres; return the goal's number.

        Args:
            speed: metres per second at most; 0: as the vehicle likes.
            heading: degrees; None: facing where it goes, and any at the goal.

        Raises:
            ValueError: a value is beyond what messages hold.
        """
        return self._begin(Goal("GO_TO", north, east, depth, heading or 0.0, speed, heading is None))

    def hold(
        self,
        north: float | None = None,
        east: float | None = None,
        depth: float | None = None,
        heading: float | None = None,
    ) -> int:
        """Hold a place, depth and heading, by default those where the vehicle is; return the goal's number.

        Raises:
            ValueError: a value is beyond what messages hold.
        """
        with self._lock:
            here = self._state
        return self._begin(
            Goal(
                "HOLD",
                here.north if north is None else north,
                here.east if east is None else east,
                max(0.0, here.depth) if depth is None else depth,
                here.heading if heading is None else heading,
            )
        )

    def stay(self) -> None:
        """Hold where the vehicle is unless it was given a goal before, which is in force then."""
        if self._aimless:
            self.hold()

    def turn(self, heading: float) -> int:
        """Turn to a heading on the spot, degrees; return the goal's number."""
        return self._begin(Goal("TURN", heading=heading))

    def surface(self) -> int:
        """Come up by thrust; return the goal's number."""
        return self._begin(Goal("SURFACE"))

    def search(
        self, north: float, east: float, depth: float, *, speed: float = 0.0, heading: float | None = None
    ) -> int:
        """Search around a place; return the goal's number.

        Args:
            heading: None: along a spiral outwards, facing ahead; otherwise a full turn on the spot.
        """
        return self._begin(Goal("SEARCH", north, east, depth, heading or 0.0, speed, heading is None))

    def idle(self) -> int:
        """Ask for no thrust; return the goal's number."""
        return self._begin(Goal("IDLE"))

    def operate(self, device: str, action: int, parameter: float = 0.0) -> int:
        """Command a device; return the number of the request, under which its progress is reported.

        It is asked again until it says that it is done, or is asked for something else.

        Args:
            device: identifier. action: its number at the device.

        Raises:
            ValueError: the vehicle has no such device, or a value is beyond what messages hold.
        """
        if device not in self._sheet.devices:
            raise ValueError(f"{self._sheet.robot} has no device {device!r}")
        with self._lock:
            request = (self._request + 1) % REQUESTS
            values = {
                "Device": float(self._sheet.devices.index(device)),
                "Action": float(action),
                "Parameter": parameter,
                "Request": float(request),
            }
            self._codec.check("DeviceCommand", **values)
            for earlier in [
                number for number, each in self._requests.items() if each["Device"] == values["Device"]
            ]:
                del self._requests[earlier]
            self._request = request
            self._devices[request] = "NONE"
            self._requests[request] = values
        return request

    def emergency(self, reason: str = "ORDERED", *, release: bool = True) -> None:
        """Stop all thrust for good, and let go of the drop weight if it is to.

        Args:
            reason: one of `catalogue.REASONS`.

        Raises:
            ValueError: there is no such reason.
        """
        with self._lock:
            self._codec.check("DecisionEmergency", Reason=reason, Release=release)
            self._emergency, self._emergencies = (reason, release), OFTEN
            self._state = self._state._replace(emergency=self._state.emergency or reason)

    def state(self) -> State:
        """Return what is known now."""
        with self._lock:
            known, age = self._state, self._now - self._state_at
            return known._replace(
                time=self._now,
                age=age,
                silent=self._now - self._heard_at,
                position_lost=not known.trusted or known.uncertainty > self._lost,
                devices=MappingProxyType(dict(self._devices)),
            )

    def hear(self, frame: Frame, now: float) -> None:
        """Take what the vehicle says."""
        if frame.id in self._drives:
            self._hear_drive(self._drives[frame.id], frame)
            return
        hearer = self._hearers.get(frame.id)
        if hearer is None:
            return
        with self._lock:
            self._now = max(self._now, now)
            if (found := self._codec.decode(frame)) is not None:
                self._heard_at = now
                hearer(found, now)

    def tick(self, now: float) -> list[Frame]:
        """Repeat the goal, and what devices and an emergency need."""
        with self._lock:
            self._now = now
            self._began = now if self._began is None else self._began
            said = []
            if self._emergency is not None and self._emergencies > 0:
                self._emergencies -= 1
                said.append(
                    self._codec.encode(
                        "DecisionEmergency", Reason=self._emergency[0], Release=self._emergency[1]
                    )
                )
            said += goal_frames(self._codec, self._goal)
            self._ticks += 1
            said += [
                self._codec.encode("DeviceCommand", **values)
                for request, values in self._requests.items()
                if self._devices[request] == "NONE" or self._ticks % SELDOM == 0
            ]
            if now + 1e-6 >= self._beat_due:
                self._beat_due = now + BEAT_PERIOD
                uptime = min(now - self._began, MOST_UPTIME)
                said.append(self._codec.encode("DecisionBeat", State="RUNS", Uptime=uptime, Reason="NONE"))
            return said

    def _begin(self, goal: Goal) -> int:
        with self._lock:
            goal = replace(goal, number=(self._goal.number + 1) % GOALS)
            check_goal(self._codec, goal)
            self._goal, self._aimless = goal, False
            self._state = self._state._replace(goal=goal.number, progress="NONE", distance=0.0)
            return goal.number

    def _hear_drive(self, number: int, frame: Frame) -> None:
        """Record whether a drive works; messages of drives do not show that the vehicle is steered."""
        with self._lock:
            found = self._codec.decode(frame)
            if found is not None and (found.values["Drive"] == "FAULT") is not (number in self._state.failed):
                self._state = self._state._replace(failed=self._state.failed ^ {number})

    def _hear_state(self, found: Received, now: float) -> None:
        values: dict[str, Any] = {name.lower(): float(value) for name, value in found.values.items()}
        self._state = self._state._replace(**values)

    def _hear_depth(self, found: Received, now: float) -> None:
        values = found.values
        depth, uncertainty = float(values["Depth"]), float(values["Uncertainty"])
        self._state = self._state._replace(
            depth=depth, uncertainty=uncertainty, trusted=bool(values["Trusted"])
        )
        self._state_at = now

    def _hear_current(self, found: Received, now: float) -> None:
        north, east = float(found.values["North"]), float(found.values["East"])
        self._state = self._state._replace(current_north=north, current_east=east)

    def _hear_health(self, found: Received, now: float) -> None:
        seen = float(found.values["SonarRange"])
        sonar = seen if seen < FARTHEST_SEEN else None
        charge, leak = float(found.values["Charge"]), bool(found.values["Leak"])
        self._state = self._state._replace(charge=charge, leak=leak, sonar=sonar)

    def _hear_progress(self, found: Received, now: float) -> None:
        values = found.values
        if int(values["Goal"]) == self._goal.number:
            progress, distance = str(values["State"]), float(values["Distance"])
            self._state = self._state._replace(goal=self._goal.number, progress=progress, distance=distance)

    def _hear_emergency(self, found: Received, now: float) -> None:
        self._state = self._state._replace(emergency=self._state.emergency or str(found.values["Reason"]))

    def _hear_device(self, found: Received, now: float) -> None:
        request, state = int(found.values["Request"]), str(found.values["State"])
        if request in self._requests:
            self._devices[request] = state
            if state in ("REACHED", "FAILED"):
                self._requests.pop(request, None)


class Connection:
    """A craft that a thread of its own serves on a bus.

    Attributes:
        craft: to be commanded.
        failure: what ended the thread; None: nothing did.
    """

    def __init__(self, sheet: Sheet, port: FramePort, clock: Pace = "real") -> None:
        self.craft = Craft(sheet, Codec(sheet))
        self.failure: Exception | None = None
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._serve, args=(port, clock), name="decision", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Fall silent; the vehicle then holds, and surfaces."""
        self._stop.set()
        self._thread.join(5.0)

    def _serve(self, port: FramePort, clock: Pace) -> None:
        try:
            serve(self.craft, port, clock, self._stop)
        except Exception as error:
            self.failure = error
