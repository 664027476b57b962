"""What cameras tell the decision centre: detections, one JSON object in each UDP datagram."""

from __future__ import annotations

import json
import logging
import socket
import threading
import time
from collections import Counter, deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, fields
from math import hypot
from statistics import median
from types import TracebackType

from auv_vessel.sheet import Vector

FRONT, BOTTOM = "front", "bottom"
CAMERAS = (FRONT, BOTTOM)

LONGEST, LONGEST_NAME, FARTHEST, DEEPEST = 4096, 80, 8388.0, 11000.0
"""Bytes of a datagram, characters of a name, metres from the origin and of depth that are taken at most."""

LATEST = 1e12
"""Seconds of the latest time that is taken."""

CONFIDENCE, LASTING, LEAST, SPREAD = 0.5, 10.0, 2, 1.0
"""What a detection has at least, seconds for which it counts; how many must agree, within how many metres."""

KEPT, NAMES = 9, 256
"""Detections that are kept of each object, and objects of which any are kept."""

REPEATED = 60.0
"""Seconds: a sender whose times lie farther back may have another clock, and is accepted again."""

_LOG = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class Detection:
    """An object that a camera saw.

    Attributes:
        time: when the picture was taken, seconds of the vehicle's clock.
        name: of the object, as behaviours call it.
        confidence: from 0 to 1: how often such a detection is right.
        north, east, depth: of the object's middle, metres.
        camera: one of `CAMERAS`.
        robot: whose cameras detected it, the beginning of a long name; empty: not stated.
    """

    time: float
    name: str
    confidence: float
    north: float
    east: float
    depth: float
    camera: str
    robot: str = ""


def to_datagram(detection: Detection) -> bytes:
    """Return a detection as it goes through UDP."""
    reported = {key: value for key, value in asdict(detection).items() if key != "robot" or value}
    return json.dumps(reported, allow_nan=False).encode() + b"\n"


def from_datagram(data: bytes) -> Detection:
    """Return what a datagram tells.

    Raises:
        ValueError: it is not a detection; the message states why.
    """
    if len(data) > LONGEST:
        raise ValueError("too long")
    try:
        found = json.loads(data)
    except (ValueError, RecursionError):
        raise ValueError("no JSON") from None
    if not isinstance(found, dict) or {*found, "robot"} != {each.name for each in fields(Detection)}:
        raise ValueError("other keys")
    name = found["name"]
    if not isinstance(name, str) or not 0 < len(name) <= LONGEST_NAME or not name.isprintable():
        raise ValueError("no name")
    if found["camera"] not in CAMERAS:
        raise ValueError("no camera")
    robot = found.get("robot", "")
    if not isinstance(robot, str) or len(robot) > LONGEST_NAME:
        raise ValueError("no robot")
    return Detection(
        _number(found, "time", 0.0, LATEST),
        name,
        _number(found, "confidence", 0.0, 1.0),
        _number(found, "north", -FARTHEST, FARTHEST),
        _number(found, "east", -FARTHEST, FARTHEST),
        _number(found, "depth", -FARTHEST, DEEPEST),
        str(found["camera"]),
        robot,
    )


def owner_of(robot: str) -> str:
    """Return how detections name a robot."""
    return robot[:LONGEST_NAME]


def _number(found: Mapping[str, object], key: str, low: float, high: float) -> float:
    value = found[key]
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError(f"{key} is not a number")
    if not low <= value <= high:
        raise ValueError(f"{key} out of range")
    return float(value)


class Detections:
    """Receives the detections of cameras, and returns positions of objects.

    One detection alone moves nothing: an object counts as seen when `LEAST` of its latest detections, each
    with a `CONFIDENCE` at least, lie within `SPREAD` of their median. Every sender at the port can tell
    anything, so that it is opened on this computer only.

    Attributes:
        port: that is listened to.
        bad: how many datagrams were refused, by why; the first of each kind is logged.
    """

    def __init__(
        self,
        port: int = 0,
        *,
        lasting: float = LASTING,
        clock: Callable[[], float] = time.monotonic,
        robot: str = "",
    ) -> None:
        """Open the port; 0: any that is free.

        Args:
            robot: whose cameras count, and those that do not say whose they are; empty: all.
            lasting: seconds after its arrival, by the clock, that a detection counts.

        Raises:
            OSError: the port is taken.
        """
        self.bad: Counter[str] = Counter()
        self._lasting, self._clock, self._owner = lasting, clock, owner_of(robot)
        self._lock = threading.Lock()
        self._kept: dict[str, deque[tuple[float, Detection]]] = {}
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.bind(("127.0.0.1", port))
        except OSError:
            self._socket.close()
            raise
        self._socket.settimeout(0.2)
        self.port: int = self._socket.getsockname()[1]
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._listen, name="detections", daemon=True)
        self._thread.start()

    def __enter__(self) -> Detections:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Listen no more; idempotent."""
        self._stop.set()
        self._thread.join()
        self._socket.close()

    def place(self, name: str) -> Vector | None:
        """Return where an object is seen: metres north, east and below the surface; None: it is not."""
        found = self._lately(name)
        for _ in range(len(found)):
            if len(found) < LEAST:
                return None
            middle = (
                median(each.north for each in found),
                median(each.east for each in found),
                median(each.depth for each in found),
            )
            agreeing = [each for each in found if _away(each, middle) <= SPREAD]
            if len(agreeing) == len(found):
                return middle
            found = agreeing
        return None

    def newest(self, name: str) -> Detection | None:
        """Return the latest detection of an object that counts."""
        found = self._lately(name)
        return found[-1] if found else None

    def seen(self) -> frozenset[str]:
        """Return the names of the objects that are seen."""
        return frozenset(self.places())

    def places(self) -> dict[str, Vector]:
        """Return where the objects are that are seen: metres north, east and below the surface."""
        with self._lock:
            names = list(self._kept)
        found = ((name, self.place(name)) for name in names)
        return {name: place for name, place in found if place is not None}

    def take(self, data: bytes) -> None:
        """Take a datagram; one that is not a detection is counted in `bad`."""
        try:
            detection = from_datagram(data)
        except ValueError as error:
            self._refuse(str(error))
            return
        if self._owner and detection.robot not in ("", self._owner):
            self._refuse("of another robot")
            return
        if detection.confidence < CONFIDENCE:
            return
        now = self._clock()
        with self._lock:
            self._keep(detection, now)

    def _keep(self, detection: Detection, now: float) -> None:
        kept = self._kept.get(detection.name)
        if kept is None:
            if len(self._kept) >= NAMES:
                self._forget(now)
            if len(self._kept) >= NAMES:
                self._refuse("too many names")
                return
            kept = self._kept[detection.name] = deque(maxlen=KEPT)
        if self._is_late(detection, kept, now):
            self._refuse("late")
            return
        kept.append((now, detection))

    def _is_late(self, detection: Detection, kept: Iterable[tuple[float, Detection]], now: float) -> bool:
        """Return whether a detection repeats one that is kept, or is older than most of its camera's.

        A few that pretend to be of the future do not make all others late. Those of a camera whose clock
        restarts counts again once its earlier detections have been forgotten.
        """
        others = [each for each in kept if each[1].camera == detection.camera]
        ahead = [(arrived, other.time - detection.time) for arrived, other in others]
        newer = [
            by for arrived, by in ahead if by > 0.0 and (by < REPEATED or now - arrived <= self._lasting)
        ]
        return any(by == 0.0 for _, by in ahead) or len(newer) > max(1, len(others) // 2)

    def _refuse(self, why: str) -> None:
        self.bad[why] += 1
        if self.bad[why] == 1:
            _LOG.warning("a detection at port %d is refused: %s", self.port, why)

    def _forget(self, now: float) -> None:
        for name in [name for name, kept in self._kept.items() if now - kept[-1][0] > self._lasting]:
            del self._kept[name]

    def _lately(self, name: str) -> list[Detection]:
        now = self._clock()
        with self._lock:
            kept = self._kept.get(name, ())
            return [each for arrived, each in kept if now - arrived <= self._lasting]

    def _listen(self) -> None:
        while not self._stop.is_set():
            try:
                data = self._socket.recv(LONGEST + 1)
            except TimeoutError:
                continue
            except OSError:
                self.bad["socket"] += 1
                self._stop.wait(0.2)
                continue
            self.take(data)


def _away(one: Detection, middle: Vector) -> float:
    return hypot(one.north - middle[0], one.east - middle[1], one.depth - middle[2])
