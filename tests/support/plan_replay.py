"""Carries out plans step by step and complains about whatever does not fit; shares no code with planning."""

from itertools import pairwise
from math import dist, hypot, inf, sqrt

import numpy as np
import shapely

from mmrs_core.pictures.preview.from_plan import footprints
from mmrs_core.scene import Await, Branch, Launch, Recharge, Recover, Serve, Signal, Transit

NEAR = 1e-6


def complaints(scene, plan):
    """Return everything that is wrong with a plan, in words; empty for a sound one."""
    found = []
    robots = {robot.name: robot for robot in scene.robots}
    if [each.robot for each in plan.robots] != list(robots):
        found.append("robots are missing or in another order")
    stops = scene.timed or plan.timed
    for each in plan.robots:
        faults = _robot_faults(scene, robots[each.robot], each, stops=stops)
        found += [f"{each.robot}: {fault}" for fault in faults]
    found += _signal_faults(plan)
    found += _work_faults(scene, plan)
    found += _order_faults(scene, plan)
    last = max((each.steps[-1].end for each in plan.robots if each.steps), default=0.0)
    if abs(last - plan.makespan) > NEAR:
        found.append(f"makespan {plan.makespan} is not the last end {last}")
    if plan.lower_bound > plan.makespan + NEAR:
        found.append(f"makespan {plan.makespan} is below the lower bound {plan.lower_bound}")
    return found


def flat(steps):
    """Yield all steps, those of branches included."""
    for step in steps:
        yield step
        if isinstance(step, Branch):
            for _, arm in step.arms:
                yield from flat(arm)


class _Walk:
    def __init__(self, scene, robot, *, stops):
        self.scene, self.robot, self.kinematics = scene, robot, robot.kinematics
        self.stops = stops
        self.here, self.time, self.faults = robot.home, 0.0, []
        self.away = self.off = not robot.kinematics.launches
        self.used, self.length = 0.0, 0.0
        power = self.kinematics.power
        self.limit = min(self.kinematics.endurance, self.kinematics.energy / power if power else inf)

    def clock(self, step):
        if step.begin < self.time - NEAR:
            self.faults.append(f"{step} begins before {self.time}")
        if step.end < step.begin - NEAR:
            self.faults.append(f"{step} ends before it begins")
        if not isinstance(step, Branch) and (self.away or isinstance(step, Launch)):
            self.used += step.end - self.time
        self.time = step.end

    def move(self, points, speed=None):
        if dist(points[0], self.here) > NEAR:
            self.faults.append(f"begins at {points[0]}, but is at {self.here}")
        keeps_clear(self.scene, self.robot, points, self.faults)
        seconds = sum(self.leg(a, b, speed or self.kinematics.cruise) for a, b in pairwise(points))
        self.length += sum(dist(a, b) for a, b in pairwise(points))
        self.here = points[-1]
        return seconds

    def mission(self, stroke, seconds, speed):
        """Return the seconds of a stroke that is flown as a mission, whose legs end with a stop each."""
        known = self.kinematics.mission
        stops = [] if known is None or self.stops or stroke.look else _with_stops(stroke)
        if len(stops) < 4 or stroke.actions or stroke.hold:
            return seconds
        return sum(self.leg(a, b, speed, known.acceleration) for a, b in pairwise(stops))

    def leg(self, start, end, speed, acceleration=None):
        acceleration = acceleration or self.kinematics.timing.acceleration
        level = hypot(end[0] - start[0], end[1] - start[1]) / speed
        rise = end[2] - start[2]
        rate = self.kinematics.climb if rise > 0 else self.kinematics.descent
        even, length = max(level, abs(rise) / rate), dist(start, end)
        if length == 0.0 or acceleration == inf:
            return even
        ramp = length / even / acceleration
        return even + ramp if ramp <= even else 2.0 * sqrt(length / acceleration)

    def lasts(self, step, seconds, more=0.0):
        if not seconds - NEAR <= step.end - step.begin <= seconds + more + NEAR:
            self.faults.append(f"{step} should last {seconds} s")

    def step(self, step):
        self.clock(step)
        if self.used > self.limit + 1e-6:
            self.faults.append(f"{self.used:.1f} s on one charge of {self.limit:.1f} s at {step}")
        getattr(self, f"_{type(step).__name__}")(step)

    def _Launch(self, step):  # noqa: N802
        if self.away or step.at != self.robot.home:
            self.faults.append(f"launches at {self.here}")
        self.away = True
        climb = self.move((step.at, (step.at[0], step.at[1], step.up)))
        self.lasts(step, self.kinematics.launch + climb)

    def _Transit(self, step):  # noqa: N802
        if not self.away or len(step.route) < 2:
            self.faults.append(f"cannot travel {step}")
        out = self.kinematics.launch if self.off else 0.0
        self.off = False
        self.lasts(step, out + self.move(step.route, step.speed))
        if max(self.route_heights(step.route)) > self.kinematics.ceiling + NEAR:
            self.faults.append(f"{step} is above the ceiling")

    def route_heights(self, route):
        return [point[2] for point in route]

    def _Serve(self, step):  # noqa: N802
        if not self.away:
            self.faults.append(f"works on the ground {step}")
        seconds = self.move(_with_stops(step.stroke), step.speed)
        actions = [self.robot.type.devices["camera"].actions[each.action] for each in step.stroke.actions]
        seconds = self.mission(step.stroke, seconds, step.speed)
        whole = seconds + step.stroke.hold + sum(action.duration for action in actions)
        turning = 180.0 / self.kinematics.turn_rate if step.stroke.look else 0.0
        self.lasts(step, whole, more=turning)

    def _Await(self, step):  # noqa: N802
        if not step.signals and step.until is None:
            self.faults.append("waits for nothing")

    def _Signal(self, step):  # noqa: N802
        if step.end != step.begin or not step.receivers or self.robot.name in step.receivers:
            self.faults.append(f"wrong {step}")

    def _Recover(self, step):  # noqa: N802
        if not self.away:
            self.faults.append("recovers on the ground")
        down = self.move((step.at, (step.at[0], step.at[1], step.up)))
        self.lasts(step, down + self.kinematics.recovery)
        self.away = False

    def _Recharge(self, step):  # noqa: N802
        if dist(self.here, self.robot.home) > NEAR or (self.away and self.kinematics.launches):
            self.faults.append(f"recharges at {self.here}")
        if step.end - step.begin < self.kinematics.recharge - NEAR:
            self.faults.append("recharges too briefly")
        self.used, self.off = 0.0, not self.kinematics.launches

    def _Branch(self, step):  # noqa: N802
        if [condition for condition, _ in step.arms].count(None) != 1 or step.arms[-1][0] is not None:
            self.faults.append("a branch needs one else arm, the last one")
        start, began = (self.here, self.away, self.used, self.length), step.begin
        uses = []
        for _, arm in step.arms:
            self.here, self.away, self.used, self.length = start
            self.time = began
            for inner in arm:
                self.step(inner)
            if dist(self.here, step.exit) > NEAR:
                self.faults.append(f"an arm ends at {self.here}, not at {step.exit}")
            if self.time > step.end + NEAR:
                self.faults.append("an arm is longer than its branch")
            uses.append(self.used)
        self.here, self.time, self.used = step.exit, step.end, max(uses)


def _with_stops(stroke):
    """Return the stroke's points and the places of its actions, in order."""
    if len(stroke.points) == 1:
        return stroke.points
    arcs = np.cumsum([0.0, *(dist(a, b) for a, b in pairwise(stroke.points))])
    whole = sorted({*arcs.tolist(), *(action.at for action in stroke.actions)})
    apart = [at for before, at in pairwise([-1.0, *whole]) if at - before > 1e-5]
    places = np.array(stroke.points)
    return [tuple(float(np.interp(at, arcs, places[:, axis])) for axis in range(3)) for at in apart]


def _robot_faults(scene, robot, plan, *, stops):
    if not plan.steps:
        return []
    walk = _Walk(scene, robot, stops=stops)
    for step in plan.steps:
        walk.step(step)
    if robot.return_home and dist(walk.here, robot.home) > NEAR:
        walk.faults.append(f"ends at {walk.here}, not at home")
    if robot.kinematics.launches and walk.away:
        walk.faults.append("never lands")
    served = {step.task for step in flat(plan.steps) if isinstance(step, Serve | Branch)}
    aside = {step.task for step in flat(plan.steps)} - served - {""}
    walk.faults += [f"has steps for '{task}', which it does not do" for task in sorted(aside)]
    return [*walk.faults, *_corridor_faults(scene, robot, plan.steps)]


def _corridor_faults(scene, robot, steps):
    """Yield each sortie that does not lead in and out through a corridor, where there are some."""
    mine = scene.corridors_of(robot)
    into = [each for each in mine if each.use != "EXIT"]
    out = [each for each in mine if each.use != "ENTRY"]
    path, working = [robot.home], False
    for step in steps:
        match step:
            case Launch():
                path = [step.at, (*step.at[:2], step.up)]
                working = False
            case Transit() | Recover():
                path += step.route if isinstance(step, Transit) else ((*step.at[:2], step.up),)
            case Serve() | Branch():
                if not working and into and not any(leads_through(path, each, robot) for each in into):
                    yield f"comes to '{step.task}' through no corridor"
                working, path = True, [step.exit if isinstance(step, Branch) else step.stroke.points[-1]]
        at_home = dist(path[-1], robot.home) <= NEAR and not isinstance(step, Serve | Branch | Launch)
        if working and at_home:
            if out and not any(leads_through(path, each, robot, out=True) for each in out):
                yield "goes home through no corridor"
            path, working = [robot.home], False


def leads_through(path, corridor, robot, *, out=False):
    """Return whether a path, sampled every half metre, goes along a corridor within its sides, end to end."""
    line = shapely.LineString(corridor.line[::-1] if out else corridor.line)
    spare = corridor.width / 2.0 - robot.clearance + 1e-6
    samples = np.concatenate([np.linspace(a, b, int(2 * dist(a, b)) + 2) for a, b in pairwise(path)])
    points = shapely.points(samples[:, :2])
    low, high = corridor.low + robot.clearance - 1e-6, corridor.high - robot.clearance + 1e-6
    inside = (shapely.distance(points, line) <= spare) & (low <= samples[:, 2]) & (samples[:, 2] <= high)
    along = shapely.line_locate_point(line, points)
    began = False
    first, last = (
        shapely.distance(points, shapely.Point(line.coords[end])) <= spare + 0.5 for end in (0, -1)
    )
    for within, begins, ends, place in zip(inside, first, last, along, strict=True):
        began = within and (began or begins)
        if began and ends and place >= line.length - spare - 0.5:
            return True
    return False


def keeps_clear(scene, robot, points, faults, step=0.5):
    """Add a fault for each area that a polyline, sampled every half metre, comes too near to."""
    line = list(points) if len(points) > 1 else [points[0], points[0]]
    for area in scene.kept_from(robot):
        shape, needed = shapely.Polygon(area.shell), area.safety_distance + robot.clearance
        for one, two in pairwise(line):
            places = np.linspace(one, two, int(dist(one, two) / step) + 2)
            sideways = shapely.distance(shapely.points(places[:, :2]), shape)
            upright = np.abs(places[:, 2] - np.clip(places[:, 2], area.low, area.high))
            kept = float(np.hypot(sideways, upright).min())
            if kept < needed - 1e-9:
                faults.append(
                    f"keeps {kept:.3f} m from {area.name}, {needed:.3f} m are required: {one} {two}"
                )


def _signal_faults(plan):
    """Run all robots at once: whoever awaits goes on when all its signals were given."""
    faults, given, at = [], {}, {each.robot: 0 for each in plan.robots}
    steps = {each.robot: each.steps for each in plan.robots}
    progress = True
    while progress:
        progress = False
        for name, mine in steps.items():
            while at[name] < len(mine):
                step = mine[at[name]]
                if isinstance(step, Await) and not set(step.signals) <= set(given):
                    break
                if isinstance(step, Await):
                    late = [s for s in step.signals if given[s].end > step.end + NEAR]
                    faults += [f"{name} goes on before {signal} is given" for signal in late]
                    faults += [
                        f"{s} is not for {name}" for s in step.signals if name not in given[s].receivers
                    ]
                    if step.until is not None and step.end < step.until - NEAR:
                        faults.append(f"{name} goes on before {step.until} s")
                if isinstance(step, Signal):
                    if step.signal in given:
                        faults.append(f"{step.signal} is given twice")
                    given[step.signal] = step
                at[name] += 1
                progress = True
    faults += [f"{name} waits for ever at {steps[name][i]}" for name, i in at.items() if i < len(steps[name])]
    return faults


def _pieces(stroke):
    """Yield the stroke's straight pieces as shapely lines, with heights."""
    points = stroke.points if len(stroke.points) > 1 else stroke.points * 2
    for one, two in pairwise(points):
        yield (min(one, two), max(one, two))


def _work_faults(scene, plan):
    """Every stroke of every task is done once: its length, its actions and its holds."""
    faults = []
    for name in {task for task, _ in scene.works}:
        serves = [
            (each.robot, step)
            for each in plan.robots
            for step in flat(each.steps)
            if isinstance(step, Serve) and step.task == name
        ]
        if not serves:
            faults.append(f"task {name} is not done")
            continue
        work = scene.works[name, serves[0][0]]
        sorts = [scene.works[name, who] for who in dict.fromkeys(who for who, _ in serves)]
        if any(other != work for other in sorts):
            faults += _mixed_faults(scene, name, sorts, serves)
        elif _sums(work.strokes) != _sums([step.stroke for _, step in serves]):
            faults.append(
                f"task {name}: {_sums([s.stroke for _, s in serves])} of {_sums(work.strokes)} done"
            )
        for robot in {who for who, _ in serves}:
            flags = [(step.first, step.last) for who, step in serves if who == robot]
            if [f for f, _ in flags] != [True] + [False] * (len(flags) - 1):
                faults.append(f"task {name}: {robot} has wrong first flags")
            if [e for _, e in flags] != [False] * (len(flags) - 1) + [True]:
                faults.append(f"task {name}: {robot} has wrong last flags")
    return faults


def _mixed_faults(scene, name, sorts, serves):
    """Robots with works of their own cover all together what the one covers that leaves out least."""
    if any(work.coverage is None for work in sorts):
        return []
    targets = [
        shapely.union_all([shapely.Polygon(*rings) for rings in work.coverage.target], grid_size=1e-6)
        for work in sorts
    ]
    whole = max(targets, key=lambda each: each.area)
    rings = [
        ring for who, step in serves for ring in footprints(step.stroke, scene.works[name, who].coverage)
    ]
    union = shapely.union_all([shapely.Polygon(ring) for ring in rings], grid_size=1e-6)
    share = shapely.difference(whole, union, grid_size=1e-6).area / whole.area
    return [f"task {name}: {share:.6f} of its area is left out"] if share > 1e-4 else []


def _sums(strokes):
    length = sum(dist(a, b) for stroke in strokes for a, b in pairwise(stroke.points))
    spread = sum(
        dist(a, b) * sum(c + d for c, d in zip(a, b, strict=True))
        for stroke in strokes
        for a, b in pairwise(stroke.points)
    )
    actions = sum(len(stroke.actions) for stroke in strokes)
    return round(length, 3), round(spread, 1), actions, round(sum(stroke.hold for stroke in strokes), 6)


def _order_faults(scene, plan):
    faults = []
    inside = {
        step.task
        for each in plan.robots
        for branch in each.steps
        if isinstance(branch, Branch)
        for step in flat((branch,))
        if isinstance(step, Serve)
    }
    for way in scene.dependencies:
        if way.before in inside or way.after in inside:
            continue
        if plan.begins[way.after] < plan.ends[way.before] - NEAR:
            faults.append(f"{way.after} begins before {way.before} ends")
    for task in scene.tasks:
        if task.earliest is not None and plan.begins[task.name] < task.earliest - NEAR:
            faults.append(f"{task.name} begins too early")
        if task.deadline is not None and plan.ends[task.name] > task.deadline + NEAR:
            faults.append(f"{task.name} ends too late")
        if task.wanted is not None:
            who = {
                each.robot
                for each in plan.robots
                for step in flat(each.steps)
                if isinstance(step, Serve) and step.task == task.name
            }
            if len(who) != task.wanted:
                faults.append(f"{task.name} is done by {len(who)} robots")
    return faults


__all__ = ["Recharge", "Recover", "Transit", "complaints", "flat", "keeps_clear", "leads_through"]
