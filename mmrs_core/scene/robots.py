"""Robot types, and what a robot of the team can do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import dist, inf, pi, sqrt, tan
from typing import Any

from mmrs_core.diagnostics import Place
from mmrs_core.scene.attributes import finite
from mmrs_core.scene.headings import turn
from mmrs_core.scene.primitives import Metaclasses, Part, Position, TravelMode
from mmrs_core.scene.timing import MoveSeconds, Push, Rates, bounded, noticing
from mmrs_runtime.policies import Policy
from mmrs_runtime.timing import IDEAL, LegTiming

BACK_SECONDS = 3.5
"""In which a robot that has overshot is back, before or after its movement counts as over: in an autopilot's
own simulation one came to rest 3.3 s after it had turned back."""


@dataclass(frozen=True, slots=True)
class Capability:
    """How a robot type moves with a payload of one weight; None: unknown.

    Attributes:
        payload: kilograms that the figures hold for.
        lifetime: seconds on full batteries.
        speed: (smallest, largest), metres per second.
        acceleration: largest, metres per second squared.
        climb_rate, descent_rate: largest, metres per second.
        turn_rate: largest, degrees per second.
        leg_timings: what the type states of how its autopilot takes legs, by way of being commanded
            (``STEP``, ``MISSION``) and by attribute of `LegTiming`.
        launch, recovery, landing_rate, landing_height: as in `Kinematics`.
    """

    payload: float
    lifetime: float | None
    speed: tuple[float, float]
    acceleration: float | None = None
    climb_rate: float | None = None
    descent_rate: float | None = None
    turn_rate: float | None = None
    part: Part = field(default_factory=lambda: Part((), {}))
    leg_timings: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    launch: float | None = None
    recovery: float | None = None
    landing_rate: float | None = None
    landing_height: float | None = None

    def timing(self, mode: str, autopilot: LegTiming = IDEAL) -> LegTiming:
        """Return how legs are taken: as the type states, else by its autopilot within the type's limits.

        Args:
            mode: ``STEP`` or ``MISSION``.
            autopilot: how its autopilot takes them, in that mode.
        """
        stated: dict[str, Any] = dict(self.leg_timings.get(mode, {}))
        paced = replace(
            autopilot,
            speed=min(autopilot.speed, self.speed[1]),
            climb=min(autopilot.climb, self.climb_rate or self.speed[1]),
            descent=min(autopilot.descent, self.descent_rate or self.speed[1]),
        )
        largest, upright = self.acceleration or inf, autopilot.vertical_acceleration
        limited = replace(
            paced,
            acceleration=min(autopilot.acceleration, largest),
            deceleration=None if autopilot.deceleration is None else min(autopilot.deceleration, largest),
            vertical_acceleration=None if upright is None else min(upright, largest),
        )
        limited, unlimited = replace(limited, **stated), replace(autopilot, **stated)
        if autopilot == IDEAL:
            return limited
        if autopilot.keeps_acceleration:
            return replace(limited, unlimited=unlimited)
        return replace(paced, **stated, unlimited=unlimited, limited=limited)


@dataclass(frozen=True, slots=True)
class Battery:
    """A battery.

    Attributes:
        energy: joules when full.
        recharge_time: seconds; None where it cannot be recharged.
        voltage: nominal; None where unknown.
    """

    energy: float
    recharge_time: float | None
    voltage: float | None = None


@dataclass(frozen=True, slots=True)
class DeviceAction:
    """An action that a device supports: its name, seconds it takes, and its parameters' keys."""

    name: str
    duration: float
    parameters: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Device:
    """A device of a robot type."""

    id: str
    actions: Mapping[str, DeviceAction]
    properties: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class RobotType:
    """A robot type.

    Attributes:
        name: as missions refer to it.
        metaclasses: of the robot type itself, most specific first.
        capability_metaclasses: of its movement capabilities (the first one's), most specific first.
        half_diagonal: half the diagonal of the robot's outer dimensions, metres.
        capabilities: sorted by payload, at least one.
        part: the whole type, with all attributes that plug-ins add.
        policies: where a mission says nothing about an event.
    """

    name: str
    metaclasses: Metaclasses
    capability_metaclasses: Metaclasses
    half_diagonal: float
    max_payload: float | None
    capabilities: tuple[Capability, ...]
    batteries: tuple[Battery, ...]
    devices: Mapping[str, Device]
    part: Part
    policies: tuple[Policy, ...] = ()

    def looks_ahead(self, device: str) -> bool:
        """Return whether a device looks where the front of the robot does; empty: the front itself."""
        known = self.devices.get(device)
        return known is None or finite(known.properties.get("mount.yaw", "0")) == 0.0


@dataclass(frozen=True, slots=True)
class Kinematics:
    """What a robot can do on this mission, after payload and travel mode; made by its robot kind.

    Attributes:
        cruise: metres per second by travel mode, within the capability's limits.
        slowest, fastest: limits of commanded speed over ground, metres per second.
        climb, descent: metres per second, vertical.
        timing: of legs that are commanded one by one.
        turn_rate: degrees per second.
        floor, ceiling: heights above the origin between which the robot may move, metres.
        launch: seconds that launching takes beside the climb, and setting out where the robot does not
            launch; recovery: likewise for landing.
        noticing: seconds of each of these, and of a run's last leg, until a program notices its end.
        guiding: seconds by which the first leg after launching begins later that is commanded alone.
        landing_rate: metres per second of the descent below `landing_height`, metres above the ground.
        endurance: usable seconds of one sortie, reserve taken off; inf for wired robots.
        energy: usable joules of one sortie, reserve taken off; inf for wired robots.
        power: mean power in watts; 0 where nothing is known of energy.
        draw: by how much the power may exceed the mean for long, as a factor of one or more: what it
            takes to travel against the wind or current all the time.
        recharge: seconds from empty to full at home; None where impossible.
        charging: how many times as long as declared charging may take.
        launches: whether the robot climbs from its home before it travels and descends onto it
            at the end.
        own_speed: largest speed through the air or the water that it moves in, metres per second;
            `fastest` is what is left of it against the wind or the current. None: nothing is lost.
        turning_radius: of its narrowest curve, metres; 0: it turns on the spot. Else it shunts where it
            stops: it keeps within so far of that place, and takes up to 180° / `turn_rate`.
        halt: seconds that each arc of shunting takes beside its length.
        accepts: metres from a target at which it counts as reached.
        rounds: whether it drives round instead of shunting, if there is room.
        mission: timing of the legs of a mission that is uploaded; None: as that of single ones.
        upright: timing of launch and landing; None: as that of legs.
        facing: degrees clockwise from north in which it looks before a move; None: not known.
        push: with which it begins a move; None: not known.
        entering: metres per second of the move before, at most, where it passes the end of that.
        sets_out: whether its motors may be off before a move, or it has just launched.
    """

    cruise: float
    slowest: float
    fastest: float
    climb: float
    descent: float
    timing: LegTiming = IDEAL
    turn_rate: float = 90.0
    floor: float = -inf
    ceiling: float = inf
    launch: float = 0.0
    recovery: float = 0.0
    noticing: float = 0.0
    guiding: float = 0.0
    landing_rate: float = inf
    landing_height: float = 0.0
    endurance: float = inf
    energy: float = inf
    power: float = 0.0
    draw: float = 1.0
    recharge: float | None = None
    charging: float = 1.0
    launches: bool = False
    own_speed: float | None = None
    turning_radius: float = 0.0
    halt: float = 0.0
    accepts: float = 0.0
    rounds: bool = False
    mission: LegTiming | None = None
    upright: LegTiming | None = None
    facing: float | None = None
    push: Push | None = None
    entering: float = 0.0
    sets_out: bool = False

    def fits_curve(self, turn: float, leg: float) -> bool:
        """Return whether the robot can pass a corner in its narrowest curve without leaving the legs before.

        Args:
            turn: at the corner, radians, less than pi.
            leg: metres of the shorter of its two legs, of which half belongs to the next corner.
        """
        return self.turning_radius * tan(turn / 2.0) <= leg / 2.0 + 1e-9

    def beyond(self, start: Position, end: Position, speed: float) -> Position:
        """Return where a robot turns back that sets out from a standstill, and stops at the end of a leg.

        It may speed up as its autopilot does by its own parameters, whatever its type states.

        Args:
            start: of the leg.
            end: of the leg.
            speed: commanded, metres per second; a short leg does not get it so fast.
        """
        east, north, length = end[0] - start[0], end[1] - start[1], dist(start, end)
        if length <= 0.0 or self.timing.overshoot <= 0.0:
            return end
        acceleration = (self.timing.unlimited or self.timing).acceleration
        share = self.timing.overshoot * min(speed, sqrt(acceleration * length)) / length
        return end[0] + share * east, end[1] + share * north, end[2]

    def room(self, *speeds: float) -> float:
        """Return the metres by which its paths keep more than its clearance: to turn, and to stop late.

        Args:
            speeds: that are commanded beside its cruise, metres per second.
        """
        return self.turning_radius + self.timing.overshoot * min(max((self.cruise, *speeds)), self.fastest)

    @property
    def shunting(self) -> float:
        """Return the longest time to turn before a leg, seconds; 0 where that is while the robot sets out."""
        turns = self.turning_radius > 0.0 or self.timing.pivots < 180.0
        return 180.0 / self.turn_rate if turns else 0.0

    def turning(self, goal: float | None = None) -> MoveSeconds:
        """Return how long a turn on the spot takes: half a circle at most.

        Args:
            goal: degrees clockwise from north in which it is to look; where that, or where it looks before,
                is not known, half of the most is expected.
        """
        half = bounded(180.0 / self.turn_rate, self.timing)
        angle = 90.0 if goal is None or self.facing is None else abs(turn(self.facing, goal))
        return MoveSeconds(0.0, angle / self.turn_rate, half.longest + noticing(self.timing))

    def setting_out(self) -> MoveSeconds:
        """Return how long it takes until a robot sets out: one that does not launch, once it is armed.

        Vehicles tell that from time to time, and two messages may be lost.
        """
        if self.launches:
            return MoveSeconds(0.0, self.guiding, self.guiding)
        return MoveSeconds(0.0, self.launch, 3.0 * self.launch)

    def charging_time(self, seconds: float) -> MoveSeconds:
        """Return how long charging takes that is to take so long: until the batteries are full.

        An operator who confirms new batteries ends it at once.
        """
        return MoveSeconds(0.0, seconds, self.charging * seconds + self.timing.reporting)

    def rates(self, speed: float | None = None) -> Rates:
        """Return how fast it goes along legs at a commanded speed, metres per second; None: at its cruise."""
        wanted = self.cruise if speed is None else min(max(speed, self.slowest), self.fastest)
        curves, seconds = self.timing.shunts_within * self.turning_radius, self.timing.shunts_for
        within = max(curves, seconds * wanted) if self.turning_radius > 0.0 else inf
        circling = 2.0 * pi * self.turning_radius / wanted if wanted > 0.0 else inf
        return Rates(
            wanted,
            self.climb,
            self.descent,
            self.timing,
            self.shunting,
            self.halt,
            self.rounds,
            within,
            circling,
            self.accepts,
        )

    def flown_by(self, timing: LegTiming) -> Kinematics:
        """Return what it can do where its autopilot takes legs in this way."""
        return replace(
            self,
            timing=timing,
            cruise=min(self.cruise, timing.speed),
            fastest=min(self.fastest, timing.speed),
            climb=min(self.climb, timing.climb),
            descent=min(self.descent, timing.descent),
        )

    def in_mission(self) -> Kinematics:
        """Return what it can do on a mission that is uploaded: it launches and lands as without one."""
        if self.mission is None:
            return self
        return replace(self.flown_by(self.mission), upright=self.upright or self.timing)

    def launching(self, height: float) -> float:
        """Return the seconds of launching to a height, metres above the ground."""
        return self.launch + self._upright().rise(height)

    def landing(self, height: float) -> float:
        """Return the seconds of coming down to the ground from a height, metres, until it stands still."""
        slow = min(max(0.0, height), self.landing_height)
        later = slow / self.landing_rate if self.landing_rate < inf else 0.0
        return self._upright().rise(slow - height) + later + self.recovery

    def upright_bounds(self, seconds: float) -> MoveSeconds:
        """Return how long a launch or a landing takes, by the seconds that are expected of it."""
        return bounded(seconds, self.upright or self.timing)

    def _upright(self) -> Rates:
        """Return how fast it launches and lands."""
        return (self if self.upright is None else self.flown_by(self.upright)).rates()


@dataclass(frozen=True, slots=True)
class Robot:
    """A robot of the team.

    Attributes:
        name: unique in the team.
        kind: name of its robot kind; empty until the scene is expanded.
        clearance: half the robot's diagonal plus the mission's position error, metres, and once it is
            expanded the room that its kinematics want; the safety distance of each area comes on top.
        kinematics: None until the scene is expanded.
        policies: of its robot kind, where mission and robot type say nothing about an event; none until the
            scene is expanded.
    """

    name: str
    type: RobotType
    home: Position
    return_home: bool
    payload: float
    travel_mode: TravelMode
    clearance: float
    kind: str = ""
    kinematics: Kinematics | None = None
    policies: tuple[Policy, ...] = ()
    place: Place = Place()
