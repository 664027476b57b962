"""The routes of one robot: from home, between places, and back home, with the seconds they take."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import pairwise
from math import dist, inf

from mmrs_core.errors import InternalError, UnreachableError
from mmrs_core.geometry.ground import ground_height
from mmrs_core.planning.corners import Corners, InMissions, runs_between
from mmrs_core.planning.corridors import CorridorPath, Corridors
from mmrs_core.planning.paths import Space
from mmrs_core.planning.reach import Reach, Reaches
from mmrs_core.planning.strokes import length_of
from mmrs_core.scene import Area, AreaUse, Corridor, Kinematics, Point, Position, Robot, Scene
from mmrs_core.scene.passing import SHORTEST_RUN
from mmrs_core.scene.timing import MoveSeconds, Rates

_SPECK = 0.01
"""Metres: half the side of the square that stands for a home."""

_SQUARE = ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))


@dataclass(frozen=True, slots=True)
class Route:
    """A route that a robot goes.

    Attributes:
        points: ends of straight legs, one position or more.
        seconds: of the whole route, launch or recovery included.
        length: metres, likewise.
        height: to which it launches before, or from which it comes down after; None: neither.
        lead: seconds by which it may be quicker where the robot does not stop at corners.
        longest: seconds of the whole route at most.
    """

    points: tuple[Position, ...]
    seconds: float
    length: float
    height: float | None = None
    lead: float = 0.0
    longest: float = 0.0

    @property
    def bounds(self) -> MoveSeconds:
        """Return how long it takes."""
        return MoveSeconds(self.seconds - self.lead, self.seconds, self.longest)


class Spaces:
    """The spaces of a scene's robots; robots of one clearance, band, speed and surroundings share theirs."""

    def __init__(self, scene: Scene, *, from_homes: float | None = None) -> None:
        """Make none yet.

        Args:
            scene: expanded.
            from_homes: metres that robots keep from the homes of others, but for homes that are nearer to
                their own; None: homes are free space.
        """
        self._scene, self._from_homes, self._reaches = scene, from_homes, Reaches(scene)
        self._spaces: dict[tuple[float, float, float, Rates, float, frozenset[int]], Space] = {}
        self._within: dict[tuple[int, Reach], Space] = {}

    def of(self, robot: Robot) -> Space:
        """Return the space of a robot whose kinematics are known."""
        kinematics = kinematics_of(robot)
        rates = kinematics.rates()
        areas = (*self._scene.kept_from(robot), *self._homes_kept_from(robot))
        alike = frozenset(map(id, areas))
        radius = kinematics.turning_radius
        key = (robot.clearance, kinematics.floor, kinematics.ceiling, rates, radius, alike)
        if key not in self._spaces:
            self._spaces[key] = Space(areas, *key[:3], rates=rates, turning_radius=radius)
        space, reach = self._spaces[key], self._reaches.of(robot)
        if reach is None:
            return space
        if (id(space), reach) not in self._within:
            self._within[id(space), reach] = space.within(reach)
        return self._within[id(space), reach]

    def _homes_kept_from(self, robot: Robot) -> Iterator[Area]:
        if self._from_homes is None:
            return
        safety = max(0.0, self._from_homes - robot.clearance)
        for other in self._scene.robots:
            east, north, up = other.home
            if other is not robot and dist(other.home, robot.home) >= self._from_homes:
                corners = tuple((east + dx * _SPECK, north + dy * _SPECK) for dx, dy in _SQUARE)
                yield Area(f"home of {other.name}", AreaUse.FORBIDDEN, corners, up, up, safety)


def kinematics_of(robot: Robot) -> Kinematics:
    """Return the kinematics of a robot of an expanded scene."""
    if robot.kinematics is None:
        raise InternalError(f"robot '{robot.name}' has no kinematics: its scene was not expanded")
    return robot.kinematics


class Travel:
    """Ways of one robot; remembered, as plans ask for the same ones again and again."""

    def __init__(
        self,
        robot: Robot,
        space: Space,
        transit_altitude: float | None,
        *,
        fluid: bool = True,
        corridors: Sequence[Corridor] = (),
        areas: Iterable[Area] = (),
        corners: Corners | None = None,
        uploads: bool = False,
    ) -> None:
        """Make it for a robot.

        Args:
            robot: with its kinematics.
            space: its space.
            transit_altitude: height at which it goes between home and tasks, where it may and can.
            fluid: whether it may pass without a stop where nothing is done.
            corridors: that are for it.
            areas: that it keeps away from.
            corners: that it may pass; None: it stops at all of them.
            uploads: whether missions may be uploaded.
        """
        self.robot, self.space, self.fluid = robot, space, fluid
        self.kinematics = kinematics_of(robot)
        self.corners = None if self.kinematics.mission is None else corners
        self.uploading = self.corners if uploads else None
        kept_from = tuple(areas)
        self.entries, self.exits = (
            Corridors(corridors, direction, robot, self.kinematics, space, kept_from)
            for direction in ("in", "out")
        )
        aloft = transit_altitude if self.kinematics.launches else None
        self._altitude = None if aloft is None else self._within(aloft)
        tireless = replace(self.kinematics, endurance=inf, energy=inf, recharge=None)
        key = tireless, self._altitude, fluid, self.uploading is None
        self._between: dict[tuple[Position, Position], Route | str]
        self._hops: dict[tuple[Position, Position], Route]
        self._between, self._hops = space.remembered.setdefault(key, ({}, {}))
        self._leaving: dict[Position, Route | str]
        self._returning: dict[Position, Route | str]
        own = (*key, robot.home, *map(id, corridors))
        self._leaving, self._returning = space.remembered.setdefault(own, ({}, {}))
        self._bounds: dict[float | None, tuple[Rates, Rates, Rates]] = {}
        self._uploaded: dict[float | None, Rates] = {}
        self._at_speeds: dict[tuple[Route, float], Route] = {}

    def _within(self, height: float) -> float:
        lowest = max(self.kinematics.floor, self.robot.home[2])
        return max(lowest, min(height, self.kinematics.ceiling))

    @property
    def straight(self) -> bool:
        """Return whether all its routes are straight: nothing is in the way, and no altitude is wanted."""
        return self.space.empty and self._altitude is None

    def bounds(self, speed: float | None = None) -> tuple[Rates, Rates, Rates]:
        """Return how fast it goes along legs: as quickly as it may, as expected, and as slowly.

        Args:
            speed: commanded, metres per second; None: its cruise.
        """
        if speed not in self._bounds:
            rates = self.kinematics.rates(speed)
            self._bounds[speed] = rates.soonest(), rates, rates.latest()
        return self._bounds[speed]

    def uploaded(self, speed: float | None = None) -> Rates | None:
        """Return how slowly it may go along legs of a mission; None: none is uploaded."""
        if self.uploading is None:
            return None
        if speed not in self._uploaded:
            self._uploaded[speed] = self.kinematics.in_mission().rates(speed).latest()
        return self._uploaded[speed]

    def upload_seconds(self, legs: int) -> float:
        """Return how much longer some legs may take as parts of a mission, whose end is noticed late."""
        uploaded = self.uploaded()
        if uploaded is None:
            return 0.0
        lengths = [(0.0, 0.0, 0.0), *((2.0**each, 0.0, 0.0) for each in range(12))]
        slowest = self.bounds()[2]
        more = (
            uploaded.from_stop_to_stop(lengths[0], each) - slowest.from_stop_to_stop(lengths[0], each)
            for each in lengths[1:]
        )
        return legs * max(0.0, *more) + self.ending

    @property
    def ending(self) -> float:
        """Return the seconds after which the end of a mission is noticed, at most."""
        return (1.0 + self.kinematics.timing.spread) * self.kinematics.noticing

    def leave(self, goal: Position) -> Route:
        """Return the route from home to a place.

        Raises:
            UnreachableError: there is none.
        """
        if goal not in self._leaving:
            self._leaving[goal] = self._outward(goal)
        return _found(self._leaving[goal])

    def go_home(self, start: Position) -> Route:
        """Return the route from a place to home, down to the ground for robots that launch.

        Raises:
            UnreachableError: there is none.
        """
        if start not in self._returning:
            self._returning[start] = self._inward(start)
        return _found(self._returning[start])

    def go(self, start: Position, goal: Position) -> Route:
        """Return the route between two places.

        Raises:
            UnreachableError: there is none.
        """
        if (start, goal) not in self._between:
            self._between[start, goal] = self._across(start, goal)
        return _found(self._between[start, goal])

    def hop(self, start: Position, goal: Position) -> Route:
        """Return the quickest route within one task: from its entry to a stroke, or between two strokes.

        Raises:
            UnreachableError: there is none.
        """
        found = self._hops.get((start, goal))
        if found is None:
            found = self._hops[start, goal] = self._timed(self.space.route(start, goal))
        return found

    def at_speed(self, route: Route, speed: float | None) -> Route:
        """Return the same route, its route gone at a commanded speed; None: at the robot's cruise."""
        if speed is None:
            return route
        if (route, speed) not in self._at_speeds:
            self._at_speeds[route, speed] = self._gone_at(route, speed)
        return self._at_speeds[route, speed]

    def _gone_at(self, route: Route, speed: float) -> Route:
        before, now = self.going(route.points), self.going(route.points, speed)
        shortest, expected, longest = (
            whole - a + b for whole, a, b in zip(route.bounds, before, now, strict=True)
        )
        return replace(route, seconds=expected, lead=expected - shortest, longest=longest)

    def come_down(self, start: Position) -> Route:
        """Return the route down to the ground where the robot is; for robots that need not return.

        Raises:
            UnreachableError: something is below.
        """
        down = self._down(start, self.space)
        if down.height is not None and not self.space.in_range((start, (*start[:2], down.height))):
            raise UnreachableError(f"the ground below ({start[0]:.1f}, {start[1]:.1f}) is out of range")
        return down

    def _down(self, start: Position, space: Space) -> Route:
        if not self.kinematics.launches:
            return Route((start,), 0.0, 0.0)
        ground = ground_height(start, self.robot.home)
        below = space.column_blockers(start, ground)
        if below:
            raise UnreachableError(f"the ground below ({start[0]:.1f}, {start[1]:.1f}) is close to {below}")
        down = self._upright(self.kinematics.landing(start[2] - ground))
        return self._route((start,), down, start[2] - ground, ground)

    def land_at(self, start: Position, place: Point) -> Route:
        """Return the route from a position to another place than home, and there down to the ground.

        Robots that do not launch end at the height of their home. The radio need not be in range.

        Raises:
            UnreachableError: there is none.
        """
        goal, surface = (*place, start[2]), (*place, self.robot.home[2])
        space = self.space.anywhere
        points = space.route(start, goal) if goal != start else (start,)
        if not self.kinematics.launches:
            upright = () if goal == surface else space.route(goal, surface)[1:]
            route = self._timed((*points, *upright))
            told = self.kinematics.setting_out().longest + self.kinematics.timing.reporting
            return replace(route, longest=route.longest + told)
        down = self._down(goal, space)
        seconds = MoveSeconds(*(a + b for a, b in zip(self.going(points), down.bounds, strict=True)))
        return self._route(points, seconds, length_of(points) + down.length, down.height)

    def gates(self, corridors: Corridors, heights: Iterable[float]) -> dict[Position, MoveSeconds]:
        """Return how long it takes from home to where corridors end, or from where exits begin to home.

        Args:
            corridors: its entries or exits.
            heights: of the places that it goes to, or comes from.
        """
        ways = [
            each for height in dict.fromkeys(heights) for each in corridors.passages(self._within(height))
        ]
        found: dict[Position, MoveSeconds] = {}
        for each in ways:
            inner = each.points[-1] if corridors is self.entries else each.points[0]
            with suppress(UnreachableError):
                found[inner] = (self.leave if corridors is self.entries else self.go_home)(inner).bounds
        return found

    def above_home(self, heights: Iterable[float]) -> list[Position]:
        """Return from where the robot may come down at home, by the heights of tasks."""
        if not self.kinematics.launches:
            return [self.robot.home]
        wanted = [each for height in heights for each in self._launch_heights(height)]
        wanted += [self._within(each.height) for level in wanted for each in self.exits.passages(level)]
        levels = dict.fromkeys(wanted)
        return [above for above, reason in map(self._above_home, levels) if not reason]

    def landing_longest(self, start: Position) -> float:
        """Return the seconds straight down to the ground at most; 0 for robots that do not launch."""
        if not self.kinematics.launches:
            return 0.0
        drop = start[2] - ground_height(start, self.robot.home)
        return self._upright(self.kinematics.landing(drop)).longest

    def _timed(self, points: tuple[Position, ...]) -> Route:
        return self._route(points, self.going(points), length_of(points))

    def _route(
        self, points: tuple[Position, ...], seconds: MoveSeconds, length: float, height: float | None = None
    ) -> Route:
        shortest, expected, longest = seconds
        return Route(points, expected, length, height, expected - shortest, longest)

    def going(
        self, points: tuple[Position, ...], speed: float | None = None, flown: InMissions | None = None
    ) -> MoveSeconds:
        """Return how long it takes from the first of some points to the last.

        Args:
            points: of the path.
            speed: commanded, metres per second; None: its cruise.
            flown: which of its legs are part of missions; None: any that may be.
        """
        soonest, rates, latest = self.bounds(speed)
        quickest = soonest.eased if self.fluid else soonest.from_stop_to_stop
        legs = list(pairwise(points))
        longest = [latest.from_stop_to_stop(*leg) for leg in legs]
        flown = self._in_missions(points, speed) if flown is None else flown
        for i in flown.legs:
            longest[i] = max(longest[i], self._in_mission(legs[i], speed))
        return MoveSeconds(
            sum(quickest(*leg) for leg in legs),
            sum(rates.from_stop_to_stop(*leg) for leg in legs),
            flown.ends * self.ending + sum(longest),
        )

    def _in_missions(self, points: tuple[Position, ...], speed: float | None) -> InMissions:
        """Return which legs may be part of missions; one between others counts with those."""
        if self.uploading is None or not (self.kinematics.turning_radius > 0.0 or self.entries or self.exits):
            return InMissions()
        corners = zip(points, points[1:], points[2:], strict=False)
        halts = [False, *(not self.uploading.may_pass(*each, speed) for each in corners), False]
        runs = [run for run, _ in runs_between(halts, (SHORTEST_RUN, SHORTEST_RUN)) if len(run) > 1]
        return InMissions(frozenset(i for run in runs for i in run), len(runs))

    def _in_mission(self, leg: tuple[Position, Position], speed: float | None) -> float:
        uploaded = self.uploaded(speed)
        return 0.0 if uploaded is None else uploaded.from_stop_to_stop(*leg)

    def _upright(self, seconds: float, route: Route | None = None) -> MoveSeconds:
        """Return how long launching or landing takes, and a route before or after that."""
        upright = self.kinematics.upright_bounds(seconds)
        if route is None:
            return upright
        shortest, expected, longest = (a + b for a, b in zip(route.bounds, upright, strict=True))
        return MoveSeconds(shortest, expected, longest)

    def _outward(self, goal: Position) -> Route | str:
        if not self.kinematics.launches:
            route = self._through(self.entries, self.robot.home, goal, goal[2])
            if isinstance(route, str):
                return route
            return self._route(route.points, self._setting_out(route.bounds), route.length)
        return self._upwards(goal, self.entries)

    def _setting_out(self, seconds: MoveSeconds) -> MoveSeconds:
        """Return how long what a robot does from home on takes if it has to set out."""
        out = self.kinematics.setting_out()
        return MoveSeconds(*(a + b for a, b in zip(seconds, out, strict=True)))

    def _inward(self, start: Position) -> Route | str:
        if not self.kinematics.launches:
            return self._through(self.exits, start, self.robot.home, start[2])
        return self._upwards(start, self.exits)

    def _upwards(self, other: Position, corridors: Corridors) -> Route | str:
        """Return the route between the air above home and a place: from there, or back; or why there is none.

        The first of several launch heights will do; where it leads through a corridor, that of the corridor
        as well: the quicker one is taken.
        """
        best: Route | str = ""
        for height in self._launch_heights(other[2]):
            passing = (self._within(each.height) for each in corridors.passages(height))
            routes = [self._from_above(each, other, corridors) for each in dict.fromkeys((height, *passing))]
            found = [route for route in routes if isinstance(route, Route)]
            if found:
                return min(found, key=lambda route: route.seconds)
            best = best or routes[0]
        return best

    def _from_above(self, height: float, other: Position, corridors: Corridors) -> Route | str:
        outwards = corridors is self.entries
        above, reason = self._above_home(height)
        start, goal = (above, other) if outwards else (other, above)
        route = reason or self._through(corridors, start, goal, height)
        if isinstance(route, str):
            return route
        rise = height - self.robot.home[2]
        upright = self.kinematics.launching(rise) if outwards else self.kinematics.landing(rise)
        whole = self._upright(upright, route)
        whole = self._setting_out(whole) if outwards else whole
        return self._route(route.points, whole, route.length + rise, height)

    def _through(self, corridors: Corridors, start: Position, goal: Position, level: float) -> Route | str:
        """Return the quickest route that leads through one of some corridors; or why there is none.

        Args:
            corridors: none: any route will do.
            start, goal: of the route.
            level: at which it leads where the robot may choose, and nearest to which it leads in a corridor.
        """
        raised = level if self.kinematics.launches else None
        if not corridors:
            return self._routed(start, goal, level=raised)
        why = corridors.why_not(level)
        best: Route | None = None
        for each in corridors.passages(level):
            route = self._by(each, start, goal, raised)
            if isinstance(route, str):
                why = f"{why}; {route}" if why else route
            elif best is None or route.seconds < best.seconds:
                best = route
        return best or why

    def _by(self, passage: CorridorPath, start: Position, goal: Position, level: float | None) -> Route | str:
        """Return the route through one corridor."""
        there = self._path(start, passage.points[0], level)
        on = self._path(passage.points[-1], goal, level)
        if isinstance(there, str) or isinstance(on, str):
            return f"{there if isinstance(there, str) else on} (corridor '{passage.corridor}')"
        points = (*there, *passage.points, *on)
        return self._timed(tuple(each for i, each in enumerate(points) if i == 0 or each != points[i - 1]))

    def _launch_heights(self, other: float) -> list[float]:
        """Return the heights above home to try for a route to or from another height, best first."""
        first = self._within(other) if self._altitude is None else self._altitude
        rest = [self._within(height) for height in (other, other / 2, other / 4, -inf, inf)]
        return list(dict.fromkeys(height for height in (first, *rest) if height < inf))

    def _above_home(self, height: float) -> tuple[Position, str]:
        home = self.robot.home
        above = (home[0], home[1], height)
        near, whose = self.space.column_blockers(home, height), f"home of robot '{self.robot.name}'"
        if near:
            return above, f"{whose} is within the clearance of {near}"
        in_range = self.space.in_range((home, above))
        return above, "" if in_range else f"{height:g} m above {whose} it is out of range of its radio"

    def _across(self, start: Position, goal: Position) -> Route | str:
        return self._routed(start, goal, level=self._altitude)

    def above(
        self, start: Position, goal: Position, higher: float, peaks: Iterable[float] = ()
    ) -> Iterator[tuple[Position, ...]]:
        """Yield paths between two places that lead above both; none where they are blocked or not asked for.

        One leads up, along a level and down; the others up to a peak, and down from there, on a slant: these
        only where no transit altitude is asked for.

        Args:
            start, goal: of the paths.
            higher: metres above the higher one of both, and above the transit altitude.
            peaks: shares of the straight line.
        """
        level = max(start[2], goal[2], -inf if self._altitude is None else self._altitude) + higher
        if not self._flies_at(level) or start[:2] == goal[:2]:
            return
        raised = self._raised(start, goal, level)
        if raised is not None:
            yield raised
        for share in peaks if self._altitude is None else ():
            east, north = (a + share * (b - a) for a, b in zip(start[:2], goal[:2], strict=True))
            with suppress(UnreachableError):
                up = self.space.route(start, (east, north, level))
                yield (*up, *self.space.route(up[-1], goal)[1:])

    def from_above(
        self, height: float, other: Position, corridors: Corridors
    ) -> Iterator[tuple[Position, ...]]:
        """Yield paths from a height above home to a place, or back from there: level, and on a slant.

        There is no slant where a transit altitude is asked for.

        Args:
            height: of launch or recovery.
            other: place that is not home.
            corridors: its entries or exits.
        """
        above, reason = self._above_home(height)
        if reason or not self._flies_at(height) or above[:2] == other[:2]:
            return
        start, goal = (above, other) if corridors is self.entries else (other, above)
        if self._altitude is None:
            with suppress(UnreachableError):
                yield self.space.route(start, goal)
        raised = self._raised(start, goal, height)
        if raised is not None:
            yield raised

    def _flies_at(self, height: float) -> bool:
        fits = self.kinematics.launches and self._within(height) == height
        return fits and not self.entries and not self.exits

    def _routed(self, start: Position, goal: Position, level: float | None = None) -> Route | str:
        """Return the route at a level where that is clear, else the quickest; or why there is none."""
        points = self._path(start, goal, level)
        return points if isinstance(points, str) else self._timed(points)

    def _path(self, start: Position, goal: Position, level: float | None) -> tuple[Position, ...] | str:
        """Return the places of that route."""
        try:
            if level is not None and self._altitude is not None and start[:2] != goal[:2]:
                raised = self._raised(start, goal, level)
                if raised is not None:
                    return raised
            return self.space.route(start, goal)
        except UnreachableError as error:
            return str(error)

    def _raised(self, start: Position, goal: Position, level: float) -> tuple[Position, ...] | None:
        """Return a route up to a level, along it, and down to the goal; None where that is blocked."""
        up, over = (start[0], start[1], level), (goal[0], goal[1], level)
        if self.space.column_blockers(start, level) or self.space.column_blockers(goal, level):
            return None
        if not self.space.in_range((start, up)) or not self.space.in_range((over, goal)):
            return None
        try:
            route = (start, *self.space.route(up, over), goal)
        except UnreachableError:
            return None
        return tuple(each for i, each in enumerate(route) if i == 0 or each != route[i - 1])


def _found(route: Route | str) -> Route:
    if isinstance(route, str):
        raise UnreachableError(route)
    return route
