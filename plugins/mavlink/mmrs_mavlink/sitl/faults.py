"""Faults on demand: what goes wrong with a simulated vehicle, when somebody says so."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from inspect import signature
from math import cos, isfinite, nan, radians, sin

from mmrs_mavlink.sitl.autopilot import Autopilot
from mmrs_mavlink.sitl.body import wind_of
from mmrs_mavlink.sitl.failsafes import breach


class Faults:
    """Makes things go wrong; each method may be called from any thread and has done so on return.

    Attributes:
        link_down: whether nothing comes through, either way. ground_down: the same, to a ground station.
        dumb: whether nothing comes through of what it sends, while it hears everything.
        answer_delay: seconds by which every answer to an upload is late.
    """

    def __init__(
        self, autopilot: Autopilot, lock: AbstractContextManager[object], *, watched: bool = False
    ) -> None:
        """Work on an autopilot whose simulation holds `lock` while it goes on.

        Args:
            autopilot: of the vehicle.
            lock: held for every change.
            watched: whether the vehicle has a radio of its own to a ground station.
        """
        self.link_down = self.ground_down = self.dumb = False
        self._watched = watched
        self.answer_delay = 0.0
        self._autopilot = autopilot
        self._lock = lock

    def lose_position(self) -> None:
        """Have it no longer know where it is: no GPS, and an estimate without a position."""
        with self._lock:
            self._autopilot.located = False

    def find_position(self) -> None:
        """Give it its position back."""
        with self._lock:
            self._autopilot.located = True

    def shift_position(self, metres: float, bearing: float = 0.0) -> None:
        """Have it take itself to be elsewhere from now on, so far off in degrees clockwise from north."""
        with self._lock:
            angle = radians(bearing)
            self._autopilot.body.mistake(metres * cos(angle), metres * sin(angle))

    def restart(self, armed: bool = False) -> None:
        """Reboot it: it is silent for a while, its boot time is zero, and its memory is what is on disk.

        Args:
            armed: whether its motors go on, as after a watchdog's reset; else it falls.
        """
        with self._lock:
            self._autopilot.restart(armed)

    def take_stick(self, mode: str = "loiter") -> None:
        """Have the pilot change the mode, by one of its names.

        Raises:
            ValueError: the vehicle has no such mode.
        """
        with self._lock:
            self._autopilot.take_stick(mode)

    def meet_obstacle(self, distance: float = 3.0, bearing: float = 0.0) -> None:
        """Have it report an obstacle, metres away, in degrees clockwise from where it looks."""
        _refuse_below("metres", distance)
        with self._lock:
            self._autopilot.obstacle = (distance, bearing)

    def clear_obstacle(self) -> None:
        """Take the obstacle away."""
        with self._lock:
            self._autopilot.obstacle = None

    def breach_fence(self) -> None:
        """Have it report that it has left its fence, and do what FENCE_ACTION says."""
        with self._lock:
            self._autopilot.told_out = True
            breach(self._autopilot)

    def mend_fence(self) -> None:
        """Have it be inside its fence again."""
        with self._lock:
            self._autopilot.told_out = False
            self._autopilot.breached = False

    def set_battery(self, level: float) -> None:
        """Have a battery of which so much is left, 0 to 1: an old one, or a fresh one after a change.

        Raises:
            ValueError: it is not from 0 to 1.
        """
        if not 0.0 <= level <= 1.0:
            raise ValueError(f"{level:g} is not from 0 to 1")
        with self._lock:
            self._autopilot.energy = level

    def silence(self, *commands: int) -> None:
        """Have it answer these commands no more; without any, answer all again."""
        with self._lock:
            self._autopilot.silent = frozenset(commands)

    def cut_link(self) -> None:
        """Let nothing through, either way; the vehicle goes on."""
        self.link_down = True

    def mend_link(self) -> None:
        """Let everything through again."""
        self.link_down = False

    def fall_dumb(self) -> None:
        """Let nothing through of what the vehicle sends; it hears everything."""
        self.dumb = True

    def speak(self) -> None:
        """Let through again what it sends."""
        self.dumb = False

    def cut_ground(self) -> None:
        """Let nothing through to and from the ground station that looks on.

        Raises:
            ValueError: there is none.
        """
        if not self._watched:
            raise ValueError("the vehicle has no radio to a ground station")
        self.ground_down = True

    def mend_ground(self) -> None:
        """Let everything through to and from that ground station again."""
        self.ground_down = False

    def jump_clock(self, seconds: float) -> None:
        """Have its time of day jump; the time since it booted goes on as it did."""
        with self._lock:
            self._autopilot.clock_error += seconds

    def refuse_arming(self, reason: str = "Compass not calibrated") -> None:
        """Have its own checks fail for a reason; an empty one lets them pass again."""
        with self._lock:
            self._autopilot.unfit = reason

    def slow_uploads(self, seconds: float = 3.0) -> None:
        """Answer every message of an upload so much later."""
        _refuse_below("seconds", seconds)
        self.answer_delay = seconds

    def break_camera(self) -> None:
        """Have its camera take no more photos, and tell none."""
        with self._lock:
            self._autopilot.camera.works = False

    def mend_camera(self) -> None:
        """Have its camera work again."""
        with self._lock:
            self._autopilot.camera.works = True

    def change_wind(self, speed: float, comes_from: float) -> None:
        """Have the wind blow otherwise: metres per second, and degrees where it comes from."""
        _refuse_below("metres per second", speed)
        with self._lock:
            self._autopilot.body.wind = wind_of(speed, comes_from)

    def begin(self, name: str, *values: str) -> None:
        """Begin a fault by its name in `FAULTS`, with its values as texts.

        Raises:
            ValueError: there is no such fault, or it does not take these values.
        """
        _do(FAULTS, self, name, values)

    def end(self, name: str) -> None:
        """End a fault by its name; those that cannot end are left as they are.

        Raises:
            ValueError: there is no such fault.
        """
        if name not in FAULTS:
            raise ValueError(_unknown(name))
        if name in ENDS:
            ENDS[name](self)


def _finite(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = nan
    if not isfinite(number):
        raise ValueError(f"'{text}' is no finite number")
    return number


def _command(text: str) -> int:
    if not text.isdecimal() or len(text) > 9:
        raise ValueError(f"'{text}' is no number of a command")
    return int(text)


def _armed(how: str) -> bool:
    if how not in ("", "armed"):
        raise ValueError(f"'{how}' is not armed")
    return how == "armed"


def _refuse_below(unit: str, number: float) -> None:
    if number < 0.0:
        raise ValueError(f"{number:g} {unit} are less than none")


Act = Callable[..., None]

FAULTS: Mapping[str, Act] = {
    "gps-lost": Faults.lose_position,
    "position-shift": lambda faults, metres="40", bearing="0": faults.shift_position(
        _finite(metres), _finite(bearing)
    ),
    "restart": lambda faults, armed="": faults.restart(_armed(armed)),
    "stick": Faults.take_stick,
    "obstacle": lambda faults, metres="3", bearing="0": faults.meet_obstacle(
        _finite(metres), _finite(bearing)
    ),
    "breach": Faults.breach_fence,
    "battery": lambda faults, level: faults.set_battery(_finite(level)),
    "silent": lambda faults, *commands: faults.silence(*map(_command, commands)),
    "link-down": Faults.cut_link,
    "dumb": Faults.fall_dumb,
    "ground-down": Faults.cut_ground,
    "clock-jump": lambda faults, seconds="3600": faults.jump_clock(_finite(seconds)),
    "refuse-arming": lambda faults, *words: faults.refuse_arming(" ".join(words) or "Compass not calibrated"),
    "slow-upload": lambda faults, seconds="3": faults.slow_uploads(_finite(seconds)),
    "camera-dead": Faults.break_camera,
    "wind": lambda faults, speed, bearing="0": faults.change_wind(_finite(speed), _finite(bearing)),
}
"""What can go wrong, by name, and how it begins."""

ENDS: Mapping[str, Act] = {
    "gps-lost": Faults.find_position,
    "position-shift": lambda faults: faults.shift_position(0.0),
    "obstacle": Faults.clear_obstacle,
    "breach": Faults.mend_fence,
    "silent": Faults.silence,
    "link-down": Faults.mend_link,
    "dumb": Faults.speak,
    "ground-down": Faults.mend_ground,
    "refuse-arming": lambda faults: faults.refuse_arming(""),
    "slow-upload": lambda faults: faults.slow_uploads(0.0),
    "camera-dead": Faults.mend_camera,
    "wind": lambda faults: faults.change_wind(0.0, 0.0),
}
"""How faults end, by name; the others happen once."""


def _do(acts: Mapping[str, Act], faults: Faults, name: str, values: tuple[str, ...]) -> None:
    if name not in acts:
        raise ValueError(_unknown(name))
    act = acts[name]
    try:
        signature(act).bind(faults, *values)
    except TypeError:
        raise ValueError(f"{' '.join((name, *values))}: {name} takes {_values(act)}") from None
    try:
        act(faults, *values)
    except ValueError as error:
        raise ValueError(f"{' '.join((name, *values))}: {error}") from error


def _values(act: Act) -> str:
    """Return the values that a fault takes, for people."""
    wanted = list(signature(act).parameters.values())[1:]
    shown = [each.name if each.default is each.empty else f"{each.name} (may be left out)" for each in wanted]
    return " and ".join(shown) or "no value"


def _unknown(name: str) -> str:
    return f"{name}: no such fault; there are {', '.join(FAULTS)}"
