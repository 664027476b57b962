"""What one autopilot does with one class of vehicle, as a value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from mmrs_runtime.controllers.geodesy import at_height
from mmrs_runtime.controllers.vocabulary import Place
from mmrs_runtime.timing import AutopilotTiming

from .autopilot import Autopilot
from .modes import HOLD, Mode
from .pacing import UNKNOWN

Answers: TypeAlias = Mapping[str, Mapping[str, int]]
"""Parameters and their values, by response of a policy."""


@dataclass(frozen=True, slots=True)
class Delay:
    """A parameter for the seconds until a failsafe acts; `usual` is set where no policy says them."""

    parameter: str
    least: float
    largest: float
    usual: float | None = None


@dataclass(frozen=True, slots=True)
class Exemption:
    """Bits of a parameter by which a failsafe for a lost link does not act, and where that is, as printed."""

    parameter: str
    bits: int
    where: str


@dataclass(frozen=True, slots=True)
class LostLinkFailsafe:
    """The failsafe for a lost ground station.

    Attributes:
        answers: parameters by response, in the order in which they are set.
        modes: numbers of its modes, by parameter and value, with those where the first is not possible; in
            others the vehicle stays as it is, or disarms.
        enabled_by: parameter that is 0 where there is no failsafe; empty: the others say so.
        delay: until it acts.
        set_point_delay: until it acts where set-points are missing, which happens before.
        exemption: where it does not act.
    """

    answers: Answers
    modes: Mapping[str, Mapping[int, frozenset[int]]]
    enabled_by: str = ""
    delay: Delay | None = None
    set_point_delay: Delay | None = None
    exemption: Exemption | None = None

    @property
    def parameters(self) -> tuple[str, ...]:
        """Return the parameters that decide what the vehicle does."""
        return tuple(dict.fromkeys(filter(None, (self.enabled_by, *self.modes))))

    def modes_by(self, values: Mapping[str, float]) -> frozenset[int]:
        """Return the numbers of its modes with these values of parameters; unknown ones add no modes."""
        if self.enabled_by and not values.get(self.enabled_by):
            return frozenset()
        known = (by_value.get(round(values.get(name, 0.0))) for name, by_value in self.modes.items())
        return frozenset().union(*filter(None, known))


@dataclass(frozen=True, slots=True)
class Timing:
    """How long a vehicle may take, seconds of the run.

    Attributes:
        mode: until it shows a mode that was requested, or that it has disarmed.
        arming: until it shows that it is armed, or has left the ground.
        resend: after which a target is sent again, unless the vehicle approaches it.
        restart: until its time since its start tells that it has restarted.
        cause: until it tells why it has left its mode as its failsafe would.
    """

    mode: float = 5.0
    arming: float = 3.0
    resend: float = 1.0
    restart: float = 5.0
    cause: float = 1.5


@dataclass(frozen=True, slots=True)
class Safeguard:
    """A parameter of a failsafe that is checked and listed.

    Attributes:
        name: of the parameter.
        what: its failsafe's trigger.
        words: its actions, by value; others are listed as numbers, in `unit`.
        doubtful: by value, warnings.
        below: warning about values below a limit: (limit, why).
    """

    name: str
    what: str
    words: Mapping[int, str] = field(default_factory=dict)
    doubtful: Mapping[int, str] = field(default_factory=dict)
    below: tuple[float, str] | None = None
    unit: str = ""

    def line(self, value: float) -> str:
        """Return what the value means, with a warning where there is cause for one."""
        whole = round(value)
        shown = self.words.get(whole, f"{value:g}{self.unit}")
        why = self.doubtful.get(whole)
        if self.below is not None and value < self.below[0]:
            why = self.below[1]
        line = f"{self.name} = {value:g}: {self.what}: {shown}"
        return f"{line} (warning: {why})" if why else line


@dataclass(frozen=True, slots=True)
class VehicleProfile:
    """What one autopilot does with one class of vehicle: all that the driver does differently for it.

    Attributes:
        name: unique, such as ``arducopter``.
        vehicle: class of vehicle, as `RobotKind.vehicle` names it; one word.
        autopilot: what carries it.
        mav_types: numbers of MAV_TYPE that the vehicle may report; the first is written into plans.
        modes: modes of programs, by their names; those that the vehicle has.
        other_modes: names of further modes, by number.
        failsafe_modes: numbers of the modes of its failsafes.
        own_modes: further modes that it enters without a pilot, such as the one that it starts in.
        lost_link: its failsafe for a lost ground station.
        responses: responses of policies that it carries out on command.
        event_modes: modes of its failsafes, by the event that they answer; None: any, for any event.
        named_modes: modes that its texts about failsafes name, by letters in lower case.
        breach: parameters of its failsafe for a broken fence, by response.
        safeguards: parameters of its failsafes that are checked and listed.
        carries: further words of `RobotKind.vehicle` whose robots it carries.
        source: ``module:name`` from which programs import a profile of a plug-in; it needs no core.
        rehearsed_as: class of vehicle that `mmrs sitl` simulates instead; empty: none.
        rehearsed_with: firmware of that: ``ardupilot`` or ``px4``.
        flies: whether the vehicle takes off and lands.
        dives: whether its heights count from the water surface.
        turns: whether it turns to a heading on command.
        turns_as_places: whether it takes the bytes of a CONDITION_YAW in a mission for a place, and refuses
            it unless these say "above home".
        heads_apart: whether it ignores the heading of a target, so that it is commanded separately.
        in_plane: whether it is judged in the plane: it is as high as the ground takes it, and its reported
            height is wrong where it has set its home before it knew its own.
        still: metres per second up to which it stands still.
        timing: how long it may take.
        pacing: how long it takes.
        speed_repeats: number of targets in a row with which a new speed is sent: any may be lost.
        stops_early: whether it stops as soon as it is within the radius of its target.
        radii: parameters for the radius of waypoints, with their units in a metre.
        fastest: parameters for its level speed, with their units in a metre per second: it goes no faster,
            whatever is commanded.
        climbs, descents: parameters for its vertical speeds, with their units in a metre per second.
        yaw_rates: parameters for its turn rate, with their units in a degree per second.
        pivots: parameters for the angle beyond which it turns on the spot before it goes, if it can, with
            what they are set to where they are 0, which is never.
        corridor: metres that it is beside its legs at most, in corners and gusts.
        highest_item: metres above home, of items of its missions; None: unlimited.
        watches_jumps: whether a position that leaps is a fault.
        down: response that is left where nothing else can be carried out.
        rests: modes in which it comes to rest, by response: ``LAND`` and ``SURFACE``.
        without_position: response that replaces those that need a position, where that is lost.
        usual_responses: responses to events where no policy declares one, if other than the usual.
        starts_in: number of the mode that it starts in, by default: it may have restarted.
    """

    name: str
    vehicle: str
    autopilot: Autopilot
    mav_types: tuple[int, ...]
    modes: Mapping[str, Mode]
    other_modes: Mapping[int, str]
    failsafe_modes: frozenset[int]
    lost_link: LostLinkFailsafe
    responses: frozenset[str]
    own_modes: frozenset[int] = frozenset()
    event_modes: Mapping[str, frozenset[int]] | None = None
    named_modes: Mapping[str, int] = field(default_factory=dict)
    breach: Answers = field(default_factory=dict)
    safeguards: tuple[Safeguard, ...] = ()
    carries: tuple[str, ...] = ()
    source: str = ""
    rehearsed_as: str = ""
    rehearsed_with: str = "ardupilot"
    flies: bool = False
    dives: bool = False
    turns: bool = True
    turns_as_places: bool = False
    heads_apart: bool = False
    in_plane: bool = False
    still: float = 0.3
    timing: Timing = Timing()
    pacing: AutopilotTiming = UNKNOWN
    speed_repeats: int = 3
    stops_early: bool = False
    radii: Mapping[str, float] = field(default_factory=dict)
    fastest: Mapping[str, float] = field(default_factory=dict)
    climbs: Mapping[str, float] = field(default_factory=dict)
    descents: Mapping[str, float] = field(default_factory=dict)
    yaw_rates: Mapping[str, float] = field(default_factory=dict)
    pivots: Mapping[str, float] = field(default_factory=dict)
    corridor: float = 20.0
    highest_item: float | None = None
    watches_jumps: bool = True
    down: str = "HOLD"
    rests: Mapping[str, str] = field(default_factory=lambda: {"LAND": HOLD, "SURFACE": HOLD})
    without_position: str = ""
    usual_responses: Mapping[str, str] = field(default_factory=dict)
    starts_in: int = 0

    @property
    def alone(self) -> frozenset[str]:
        """Return the responses that the vehicle carries out by its own failsafe when the link is lost."""
        return self.responses & self.lost_link.answers.keys()

    @property
    def words(self) -> tuple[str, ...]:
        """Return the words of `RobotKind.vehicle` whose robots it carries."""
        return (self.vehicle, *self.carries)

    @property
    def drives(self) -> bool:
        """Return whether it moves on the ground: it neither flies nor dives."""
        return not (self.flies or self.dives)

    def level(self, place: Place) -> Place:
        """Return a place as the vehicle is judged by it: at the height of home where heights do not count."""
        return at_height(place, 0.0) if self.in_plane else place

    def item_height(self, height: float) -> float:
        """Return the height of an item of a mission, metres above home, that leads to a height."""
        return height if self.highest_item is None else min(height, self.highest_item)

    def mode_name(self, number: int) -> str:
        """Return the name of a mode, or its number where it has no name."""
        known = {mode.number: name for name, mode in self.modes.items()}
        return known.get(number) or self.other_modes.get(number, str(number))

    def is_pilots(self, number: int) -> bool:
        """Return whether only a pilot puts the vehicle into the mode of a number."""
        own = {mode.number for mode in self.modes.values()} | self.failsafe_modes | self.own_modes
        return number not in own

    def failsafe_for(self, event: str, said: tuple[str, ...] = ()) -> frozenset[int]:
        """Return the numbers of the modes of its failsafe for an event.

        Args:
            event: of policies.
            said: the vehicle's latest texts about the event.
        """
        if self.event_modes is None:
            return self.failsafe_modes
        letters = ["".join(filter(str.isalpha, text.lower())) for text in said]
        named = {
            number
            for name, number in self.named_modes.items()
            if any(f"changedto{name}" in each for each in letters)
        }
        return self.event_modes.get(event, frozenset()) | named


Profiles: TypeAlias = Mapping[str, VehicleProfile]
"""Profiles by name."""
