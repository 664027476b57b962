"""The set-up of a vehicle before it moves: its messages, its failsafes, its parameters."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.faults import RefusedError

from ..links.link import Link
from ..profiles import GENERIC
from ..profiles.profile import Answers, Delay, Safeguard
from ..program import Place
from ..services import parameters
from ..services.commands import ask, command
from ..services.items import FENCE, MISSION, RALLY, Item
from ..services.missions import upload, verify
from .footing import LANDED, aside, there
from .telemetry import HEARING_SECONDS, Telemetry

READY_SECONDS = 120.0
WORDS_SECONDS = 0.5
"""After which a vehicle that is asked for what fails has said it."""

STREAMED = {
    "GLOBAL_POSITION_INT": 5.0,
    "EXTENDED_SYS_STATE": 2.0,
    "SYS_STATUS": 1.0,
    "BATTERY_STATUS": 0.5,
    "GPS_RAW_INT": 1.0,
    "MISSION_CURRENT": 5.0,
}
"""Messages that the program lives by, and how often they are asked for, hertz."""

STREAMED_LOCAL = {"LOCAL_POSITION_NED": 5.0}
STREAMED_FLYING = {"ATTITUDE": 2.0}


CEASED_SECONDS = 2.0
"""For how long a vehicle that is received may report no position until its messages are requested again."""


class Reports:
    """The messages that a vehicle sends on request; it forgets all requests when it restarts."""

    def __init__(self, link: Link, *, geographic: bool) -> None:
        """Request nothing yet; `geographic`: whether the program's positions are."""
        self._link = link
        self._position = "GLOBAL_POSITION_INT" if geographic else "LOCAL_POSITION_NED"
        self._local = {} if geographic else STREAMED_LOCAL
        self._requested: float | None = None

    def request(self) -> None:
        """Request every message at its rate; a vehicle that refuses sends it as it likes, or does without.

        The position is requested as often as anything: at the rate at which vehicles report it otherwise, a
        poor link makes it look lost.
        """
        for name, interval in self._intervals():
            tries = None if name == self._position else 2
            with suppress(RefusedError):
                command(self._link, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, *interval, tries=tries)
        self._requested = self._link.clock.now()

    def renew(self) -> None:
        """Request them again, without waiting, while heartbeats arrive and positions do not."""
        link = self._link
        limit = link.clock.patience(CEASED_SECONDS)
        if self._requested is None or link.since("HEARTBEAT") > limit:
            return
        if min(link.since(self._position), link.clock.now() - self._requested) > limit:
            self.request_at_once()

    def request_at_once(self) -> None:
        """Request every message at its rate, without waiting for acknowledgements."""
        self._requested = self._link.clock.now()
        for _, interval in self._intervals():
            ask(self._link, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, *interval)

    def _intervals(self) -> Iterator[tuple[str, tuple[float, float]]]:
        """Yield each message with the parameters of its request: its number, and microseconds."""
        profile = self._link.profile
        flying = STREAMED_FLYING if profile.flies else {}
        rates = STREAMED | {**profile.autopilot.streamed} | flying | self._local
        for name, rate in rates.items():
            yield name, (getattr(mavlink, f"MAVLINK_MSG_ID_{name}"), 1e6 / rate)


def replace_all(link: Link, mission: Sequence[Item], fence: Sequence[Item], rally: Sequence[Item]) -> int:
    """Replace mission, fence and rally points, and read back what the vehicle has kept.

    Returns:
        The id that the vehicle gave to the mission; 0 where it gives none.

    Raises:
        RefusedError: something is not accepted, or read back differently.
    """
    marks = []
    for items, kind in ((mission, MISSION), (fence, FENCE), (rally, RALLY)):
        marks.append(upload(link, items, kind))
        verify(link, items, kind)
    return marks[0]


def check_identity(
    link: Link, telemetry: Telemetry, tolerance: float, home: Place, start: Place, *, resumed: bool = False
) -> None:
    """Make sure that the vehicle is the robot's: the only one with its id, of its kind, where it is to stand.

    Args:
        link: to the vehicle.
        telemetry: of the vehicle.
        tolerance: metres that it may be from where it is to stand.
        home: of its program.
        start: where it is to stand.
        resumed: whether a run is resumed, so that the vehicle may be known already, and be elsewhere.

    Raises:
        RefusedError: it is not.
    """
    beat, profile = link.latest("HEARTBEAT"), link.profile
    if beat is not None and beat.type not in (*profile.mav_types, mavlink.MAV_TYPE_GENERIC):
        entry = mavlink.enums["MAV_TYPE"].get(beat.type)
        shown = entry.name.removeprefix("MAV_TYPE_").lower().replace("_", " ") if entry else beat.type
        raise RefusedError(
            f"the vehicle reports the type '{shown}'; the program is for vehicle '{profile.vehicle}'"
        )
    if beat is not None and profile.autopilot.number not in (beat.autopilot, GENERIC.number):
        wanted = f"a {profile.vehicle} with {profile.autopilot.title}"
        raise RefusedError(
            f"the vehicle has autopilot {beat.autopilot} (MAV_AUTOPILOT); the program is for {wanted}"
        )
    if link.doubt():
        raise RefusedError(link.doubt())
    away = aside(start, telemetry.here())
    if away > tolerance:
        place = "the home of its program" if start == home else LANDED
        carry = f": carry it {there(start, home)}" if resumed or start != home else ""
        raise RefusedError(f"the vehicle is {away:.0f} m from {place}{carry}")


def hear_out(link: Link) -> None:
    """Receive on a link without a named vehicle until every vehicle there has had time to send."""
    if not link.named:
        link.wait(link.doubt, link.clock.patience(HEARING_SECONDS))


def await_position(link: Link, telemetry: Telemetry) -> None:
    """Wait until the vehicle has told where it is, before anything is uploaded that may be another's.

    Raises:
        RefusedError: it does not tell.
    """
    if not link.wait(telemetry.placed, READY_SECONDS, while_received=True):
        raise RefusedError(f"the vehicle does not become ready: {'; '.join(telemetry.lacks())}")


def await_ready(link: Link, telemetry: Telemetry) -> None:
    """Wait until the vehicle knows where it is and its own checks pass.

    Raises:
        RefusedError: it does not get ready.
    """
    if not link.wait(telemetry.ready, READY_SECONDS, while_received=True):
        # A PX4 has said why once only, and perhaps before anybody listened.
        ask(link, mavlink.MAV_CMD_RUN_PREARM_CHECKS)
        link.wait(lambda: None, WORDS_SECONDS)
        raise RefusedError(f"the vehicle does not become ready: {'; '.join(telemetry.lacks())}")


def answer_lost_link(link: Link, response: str, after: float | None = None) -> str:
    """Set the failsafe for a lost ground station.

    Args:
        link: to the vehicle.
        response: of a policy.
        after: seconds of silence until then; None: unchanged.

    Returns:
        What the vehicle does otherwise than wanted; empty if nothing.

    Raises:
        RefusedError: it cannot respond so, or does not confirm that it will.
    """
    failsafe = link.profile.lost_link
    _answer(link, "a lost link", failsafe.answers, response)
    reported = (_wait_for(link, delay, after) for delay in (failsafe.set_point_delay, failsafe.delay))
    return "; ".join(dict.fromkeys(filter(None, reported)))


def _wait_for(link: Link, known: Delay | None, wanted: float | None) -> str:
    """Set the seconds until a failsafe acts; return what the vehicle does otherwise; empty: nothing."""
    given = wanted if known is None or wanted is not None else known.usual
    if known is None or given is None:
        return ""
    name, seconds = known.parameter, min(max(given, known.least), known.largest)
    if not parameters.write(link, name, seconds):
        return f"the vehicle does not confirm {name} = {seconds:g}: it may respond sooner or later than that"
    if wanted is None or seconds == wanted:
        return ""
    return f"the vehicle responds to a lost link after {seconds:g} s, not {wanted:g} s"


def answer_breach(link: Link, response: str) -> None:
    """Set the failsafe for a broken fence.

    Raises:
        RefusedError: it cannot respond so, or does not confirm that it will.
    """
    _answer(link, "a broken fence", link.profile.breach, response)


def _answer(link: Link, event: str, answers: Answers, response: str) -> None:
    values = answers.get(response)
    if values is None:
        raise RefusedError(
            f"response to {event}: a {link.profile.vehicle} cannot do {response} as a failsafe"
        )
    for name, value in values.items():
        if not parameters.write(link, name, value):
            raise RefusedError(f"response to {event}: the vehicle does not confirm {name} = {value}")


def report_failsafes(link: Link, instead: Sequence[Safeguard] = ()) -> Iterator[str]:
    """Yield a line for each failsafe parameter that the vehicle tells, and one if it tells none.

    Args:
        link: to the vehicle.
        instead: told in place of those of the same name.
    """
    safeguards = {each.name: each for each in (*link.profile.safeguards, *instead)}
    values = parameters.read(link, list(safeguards))
    if not values:
        yield "the vehicle reports none of its failsafe parameters: check its failsafes yourself"
    for name, safeguard in safeguards.items():
        if name in values:
            yield safeguard.line(values[name])
