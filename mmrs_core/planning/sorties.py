"""A robot's progress through its plan: a state that grows step by step, within what its batteries allow.

Time on one charge counts as the verifier counts it: for a robot that launches, from launch to recovery,
waits aloft included; for all others from the mission's start or the last recharge on. Each leg, action and
stay counts with the most that it may take, a wait from the earliest time at which the robot may begin it
until the latest at which it may be over. Energy is power against the wind or current times time.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import inf

from mmrs_core.errors import UnreachableError
from mmrs_core.planning.diversions import Diversions
from mmrs_core.planning.flown_legs import flown_legs
from mmrs_core.planning.states import ApproachRoute, Ready, State
from mmrs_core.planning.strokes import approach_speed, commanded_speed, length_of, serve_seconds
from mmrs_core.planning.travel import Route, Travel
from mmrs_core.scene import Await, Launch, Position, Recharge, Recover, Serve, Stroke, Transit
from mmrs_core.scene.timing import MoveSeconds, noticing

_SAME = 1e-9


class Pilot:
    """Moves one robot's state on; each action is a short function of the state.

    Attributes:
        paces: by parts in one go, legs beside them and bound: when each begins and ends, see `paced`.
        charge: seconds that a charge allows.
        spare: seconds of a charge that are kept for flying higher, beside those.
        stuck: whether it cannot set out, for no charge suffices for a diversion from above home.
        fresh: seconds that starting takes of a charge at most; stopping: likewise, at the end.
    """

    def __init__(
        self,
        travel: Travel,
        *,
        homebound: bool = True,
        diversions: Diversions | None = None,
        spare: float = 0.0,
    ) -> None:
        """Make it.

        Args:
            travel: routes of the robot.
            homebound: whether it always keeps enough to go home, even if it may stay where it ends.
            diversions: to emergency areas, for which its charge must always suffice; None: it need not.
            spare: part of each charge that is kept for flying higher.
        """
        self.travel = travel
        self.robot, self.kinematics = travel.robot, travel.kinematics
        self.homebound = homebound or self.robot.return_home
        power = self.kinematics.power * self.kinematics.draw
        by_energy = self.kinematics.energy / power if power > 0 else inf
        whole = min(self.kinematics.endurance, by_energy)
        self.spare = spare * whole if whole < inf else 0.0
        self.charge = whole - self.spare
        self.diversions = diversions if self.charge < inf else None
        self.stuck = self.diversions is not None and self.diversions.from_home >= self.charge
        self._noticing = noticing(self.kinematics.timing)
        launches = self.kinematics.launches
        self.fresh = 0.0 if launches else self._noticing
        self.stopping = 0.0 if launches else self.kinematics.timing.reporting
        self.paces: dict[
            tuple[tuple[Stroke, ...], tuple[int, int]], dict[int, list[tuple[float, float]]]
        ] = {}
        self._served: dict[Stroke, float] = {}
        self._ends: dict[Position, float] = {}
        self._exits: dict[Position, Route | None] = {}
        self._descents: dict[Position, Route | None] = {}
        self._homes: dict[Position, Route | None] = {}

    def start(self, delay: float = 0.0) -> State:
        """Return the state in which the mission begins, after a delay at home."""
        since = None if self.kinematics.launches else 0.0
        start = State(0.0, self.robot.home, used=self.fresh, since=since, late=self._noticing)
        return self.stay_until(start, delay, "")

    def stay_until(self, state: State, time: float, task: str) -> State:
        """Return the state after staying where the robot is until a time, if that is still to come."""
        return self._wait(state, Ready(earliest=time), task)

    def exit_seconds(self, position: Position) -> float:
        """Return the seconds that ending the last sortie from a place takes; inf where it cannot end."""
        return _seconds(_remembered(self._exits, position, self.exit_route))

    def exit_longest(self, position: Position) -> float:
        """Return how long that takes at most, or a diversion that it must be able to make; inf: it cannot."""
        return self._ending_longest(_remembered(self._exits, position, self.exit_route))

    def slower_out(self, state: State, approach: ApproachRoute) -> float:
        """Return by how much a route to work takes longer than its length at even speed; 0: none is."""
        goal, travel = approach.via[0], self.travel
        if state.away and state.at == goal:
            return 0.0
        try:
            route = travel.go(state.at, goal) if state.away else travel.leave(goal)
        except UnreachableError:
            return 0.0
        even = route.length / travel.bounds(approach.speed)[1].cruise
        return max(0.0, travel.at_speed(route, approach.speed).seconds - even)

    def slower_home(self, position: Position) -> float:
        """Return likewise of the route on which the last sortie ends from a place."""
        route = _remembered(self._exits, position, self.exit_route)
        return 0.0 if route is None else max(0.0, route.seconds - route.length / self.kinematics.cruise)

    def end_seconds(self, position: Position) -> float:
        """Return the seconds from a place to the robot's end: down where it is, if it need not return."""
        if position not in self._ends:
            self._ends[position] = self._end_seconds(position)
        return self._ends[position]

    def _end_seconds(self, position: Position) -> float:
        if not self.homebound or self.robot.return_home:
            return self.exit_seconds(position)
        descent = _remembered(self._descents, position, self.travel.come_down)
        return min(self.exit_seconds(position), _seconds(descent))

    def home_longest(self, position: Position) -> float:
        """Return how long going home takes at most, or a diversion from above it; inf: there is no route."""
        return self._ending_longest(_remembered(self._homes, position, self.travel.go_home), stopping=0.0)

    def _ending_longest(self, route: Route | None, stopping: float | None = None) -> float:
        """Return how long a sortie's last route takes at most, or a diversion from where it comes down."""
        if route is None:
            return inf
        stopping = self.stopping if stopping is None else stopping
        return route.longest + max(stopping, self.diversion_more(route.points[-1]))

    def diversion_more(self, end: Position) -> float:
        """Return the seconds by which a diversion takes longer than to come down at the end of a path."""
        return 0.0 if self.diversions is None else self.diversions.more_than_landing(end)

    def exit_route(self, position: Position) -> Route:
        """Return the route on which the last sortie ends from a place: home, or down where that is allowed.

        Raises:
            UnreachableError: there is neither.
        """
        if self.homebound:
            return self.travel.go_home(position)
        try:
            return self.travel.come_down(position)
        except UnreachableError:
            return self.travel.go_home(position)

    def affords(self, state: State, seconds: float, end: Position) -> bool:
        """Return whether `seconds` at most that end at a place leave enough to end the last sortie there."""
        used = state.used + seconds
        return used <= self.charge + _SAME and used + self.exit_longest(end) <= self.charge + _SAME

    def affords_home(self, state: State, seconds: float, end: Position) -> bool:
        """Return whether `seconds` at most that end at a place leave enough to return home."""
        return state.used + seconds + self.home_longest(end) <= self.charge + _SAME

    def reach(
        self, state: State, approach: ApproachRoute, need: float, ready: Ready, task: str
    ) -> State | None:
        """Return the state in which the robot begins work, as early as can be; None if it cannot.

        It goes there and waits, or first goes home for full batteries where it would have too little
        left, or would wait so long that this is as early.

        Args:
            state: where it is.
            approach: how it comes there.
            need: seconds it must then have left, the end of the sortie included, at most.
            ready: what the work waits for.
            task: that it is for.
        """
        now = self._with_enough(self._reach_now(state, approach, ready, task), need)
        if now is not None and now.time - state.time < (self.kinematics.recharge or inf):
            return now
        rested = self.rested(state, task)
        later = None if rested is None else self._reach_now(rested, approach, ready, task)
        found = [each for each in (now, self._with_enough(later, need)) if each is not None]
        return min(found, key=lambda each: (each.time, each.used), default=None)

    def _with_enough(self, state: State | None, need: float) -> State | None:
        return state if state is not None and state.used + need <= self.charge + _SAME else None

    def rested(self, state: State, task: str) -> State | None:
        """Return the state at home with full batteries; None if the robot is fresh or cannot."""
        if self.kinematics.recharge is None or state.used <= self.fresh:
            return None
        try:
            home = self.home(state, task)
        except UnreachableError:
            return None
        ending = self.home_longest(state.at) if state.away else 0.0
        return self._recharged(home, task) if state.used + ending <= self.charge + _SAME else None

    def _reach_now(self, state: State, approach: ApproachRoute, ready: Ready, task: str) -> State | None:
        try:
            if not state.away:
                return self._from_home(state, approach, ready, task)
            return self._wait(self._along(state, approach, task), ready, task)
        except UnreachableError:
            return None

    def _from_home(self, state: State, approach: ApproachRoute, ready: Ready, task: str) -> State:
        """Wait at home for signals and clock, then go; wait for the rest of the clock where work begins."""
        there = self._along(self._wait(state, replace(ready, earliest=None), task), approach, task)
        if ready.earliest is None or there.early >= ready.earliest:
            return there
        travel = there.time - max(state.time, ready.time)
        later = max(0.0, ready.earliest - travel)
        start = self._wait(state, replace(ready, earliest=later), task)
        return self._wait(self._along(start, approach, task), Ready(earliest=ready.earliest), task)

    def _wait(self, state: State, ready: Ready, task: str) -> State:
        """Wait until a clock says, for certain, that it is time, and until all signals are given.

        By the clock a robot waits for a certain time, so that it must wait longer if it may be early.
        """
        late = ready.earliest is not None and ready.earliest > state.early + _SAME
        clock = (ready.earliest or 0.0) + state.time - state.early if late else None
        if not ready.signals and clock is None:
            return state
        end = max(state.time, ready.time, clock or 0.0)
        step = Await(state.time, end, task, ready.signals, clock)
        held = MoveSeconds.exactly(0.0)
        if clock is not None:
            stay = max(0.0, clock - state.time)
            held = MoveSeconds(stay, stay, stay + self._noticing)
        early = state.early + held.shortest
        used = state.used
        if state.since is not None:
            used = waited(used + held.longest, state.before, state.since, early, ready.bounds.late)
        return state._replace(
            time=end,
            used=used,
            early=max(early, ready.bounds.early),
            late=max(state.late + held.longest, ready.bounds.late),
            busy=state.busy + (end - state.time if state.away else 0.0),
            trail=(state.trail, step),
        )

    def _along(self, state: State, approach: ApproachRoute, task: str) -> State:
        first, *rest = approach.via
        if not state.away:
            state = self._leave(state, first, task, approach.speed)
        elif state.at != first:
            state = self._follow(state, self.travel.go(state.at, first), task, approach.speed)
        for goal in rest:
            state = self._follow(state, self.travel.hop(state.at, goal), task, approach.speed)
        return state

    def _leave(self, state: State, goal: Position, task: str, speed: float | None) -> State:
        route = self.travel.at_speed(self.travel.leave(goal), speed)
        trail, time = state.trail, state.time
        if state.since is None:
            state = state._replace(before=state.used, since=state.early)
        if route.height is not None:
            climb = route.height - self.robot.home[2]
            up = time + self.kinematics.launching(climb)
            trail = (trail, Launch(time, up, task, self.robot.home, route.height))
            time = up
        end = state.time + route.seconds
        if any(point != route.points[0] for point in route.points):
            trail = (trail, Transit(time, end, task, route.points, speed))
        return state.after(route, goal, trail)._replace(sorties=state.sorties + 1)

    def _follow(self, state: State, route: Route, task: str, speed: float | None) -> State:
        route = self.travel.at_speed(route, speed)
        step = Transit(state.time, state.time + route.seconds, task, route.points, speed)
        return state.after(route, route.points[-1], (state.trail, step))

    def hop(self, state: State, stroke: Stroke, task: str) -> State:
        """Return the state after the quickest route to the next stroke of a task."""
        goal = stroke.points[0]
        if state.at == goal:
            return state
        return self._follow(state, self.travel.hop(state.at, goal), task, self._approach_speed(stroke))

    def hop_seconds(self, here: Position, stroke: Stroke) -> MoveSeconds:
        """Return how long that takes."""
        goal = stroke.points[0]
        if here == goal:
            return MoveSeconds.exactly(0.0)
        return self.travel.at_speed(self.travel.hop(here, goal), self._approach_speed(stroke)).bounds

    def _approach_speed(self, stroke: Stroke) -> float | None:
        return approach_speed(stroke, self.kinematics)

    def serve_seconds(self, stroke: Stroke) -> float:
        """Return how long the robot takes for a stroke; remembered, as rests of works are laid out again."""
        if stroke not in self._served:
            stepped = serve_seconds(stroke, self.robot, self.kinematics)
            self._served[stroke] = stepped - flown_legs(stroke, self.travel).gained
        return self._served[stroke]

    def serve(self, state: State, stroke: Stroke, task: str, rule: str, first: bool, last: bool) -> State:
        """Return the state after a stroke, whose first point the robot is at."""
        seconds = self.serve_seconds(stroke)
        speed = commanded_speed(stroke, self.kinematics)
        end = state.time + seconds
        step = Serve(state.time, end, task, stroke, speed, rule, first, last)
        done = state.later(MoveSeconds.exactly(seconds), length_of(stroke.points), stroke.points[-1])
        return done._replace(trail=(state.trail, step))

    def home(self, state: State, task: str = "") -> State:
        """Return the state at home, after recovery.

        Raises:
            UnreachableError: there is no route home.
        """
        return self._ended(state, self.travel.go_home(state.at), task) if state.away else state

    def finish(self, state: State) -> State:
        """Return the state at the end of the plan: at home, or on the ground where the robot may stay.

        Raises:
            UnreachableError: there is no route home.
        """
        if not state.away:
            return state
        route = self.exit_route(state.at)
        if self.homebound and not self.robot.return_home:
            down = self._descent(state)
            route = route if down is None else down
        return self._ended(state, route, "")

    def _descent(self, state: State) -> Route | None:
        """Return the route down to the ground where the robot is; None if it is shut, or takes too long."""
        try:
            route = self.travel.come_down(state.at)
        except UnreachableError:
            return None
        return route if state.used + self._ending_longest(route) <= self.charge + _SAME else None

    def _ended(self, state: State, route: Route, task: str) -> State:
        end, trail = state.time + route.seconds, state.trail
        down = 0.0
        last = route.points[-1]
        at = last
        if self.kinematics.launches and route.height is not None:
            ground = self.robot.home[2] if len(route.points) > 1 else route.height
            down = self.kinematics.landing(last[2] - ground)
            at = (last[0], last[1], ground)
        if any(point != last for point in route.points):
            trail = (trail, Transit(state.time, end - down, task, route.points))
        if self.kinematics.launches:
            trail = (trail, Recover(end - down, end, task, last, at[2]))
        ended = state.after(route, at, trail)._replace(away=False)
        return ended._replace(since=None) if self.kinematics.launches else ended

    def _recharged(self, state: State, task: str) -> State:
        seconds = self.kinematics.charging_time(self.kinematics.recharge or 0.0)
        end, early = state.time + seconds.expected, state.early + seconds.shortest
        return state._replace(
            time=end,
            used=0.0,
            before=0.0,
            since=None if self.kinematics.launches else early,
            early=early,
            late=state.late + seconds.longest,
            trail=(state.trail, Recharge(state.time, end, task)),
        )


def waited(used: float, before: float, since: float, early: float, release: float) -> float:
    """Return the seconds used of a charge at most after a wait: the smaller of two bounds.

    The robot waits no longer than from when it may begin to until the release; and what it is in since its
    launch, or since it was charged, takes no longer than from the begin of that to the release.

    Args:
        used: by the begin of the wait, at most. before: by the launch.
        since: seconds of the launch, at the earliest. early: of the wait. release: at the latest.
    """
    whole = max(used, before + max(0.0, release - since))
    return min(used + max(0.0, release - early), whole)


def _remembered(
    known: dict[Position, Route | None], position: Position, route_from: Callable[[Position], Route]
) -> Route | None:
    """Return the route from a place; None where there is none."""
    if position not in known:
        try:
            known[position] = route_from(position)
        except UnreachableError:
            known[position] = None
    return known[position]


def _seconds(route: Route | None) -> float:
    return inf if route is None else route.seconds
