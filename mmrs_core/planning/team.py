"""The robots of a scene and what each of them can do, laid out for planning."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from copy import copy
from dataclasses import replace
from functools import partial

from mmrs_core.errors import UnreachableError
from mmrs_core.planning.charges import Charges
from mmrs_core.planning.corners import Corners
from mmrs_core.planning.diversions import diversions_of
from mmrs_core.planning.jobs import is_control
from mmrs_core.planning.materials import (
    Layout,
    Material,
    charge_faults,
    faults,
    lay_out,
    layout_of,
    shortages,
)
from mmrs_core.planning.mixing import Mixture, WorkGroup
from mmrs_core.planning.patches import in_rows
from mmrs_core.planning.remainders import comparable
from mmrs_core.planning.sharing import ShareCandidate
from mmrs_core.planning.sorties import Pilot
from mmrs_core.planning.states import State
from mmrs_core.planning.strokes import length_of
from mmrs_core.planning.timeline import Timelines
from mmrs_core.planning.travel import Spaces, Travel, kinematics_of
from mmrs_core.planning.turns import JobResult
from mmrs_core.scene import Robot, Scene, SharedWorks, Task, Work
from mmrs_runtime.policies import RETURN

_PORTIONS_PER_ROBOT = 120
"""Portions of a robot's part of the whole mission that are small enough to balance it."""

_LOW = "BATTERY_LOW"

Direction = bool
"""Whether a material is laid out backwards."""

ByRows = bool
"""Whether it is laid out row by row."""


class Team:
    """Pilots by robot and materials by task and robot, made once for a scene.

    Attributes:
        scene: expanded.
        fine: whether works are divided as finely as can be.
        homebound: names of the robots that always keep enough to go home.
        spaces: of its robots.
        pilots: by name of robot, in the scene's order.
        groups: by name of task: robots that can do it, by sort of work, which cameras with different
            footprints or different clearances make.
        mixtures: by name of task: the sorts that can share it, where there are several.
        tasks: by name.
        asked: by name of task: the robots that the mission asks for, whatever numbers are tried.
        charges: what they suffice for in its plans.
        kinds: by robot: the first of those that do alike what they can do.
        starts: by (robot, delay): the states in which schedules have begun.
        candidates: for shares of tasks, by all that matters to them; see `schedule`.
        done: what has become of jobs in earlier schedules, and where nothing has: by when; see `schedule`.
    """

    def __init__(
        self,
        scene: Scene,
        *,
        fine: bool = False,
        homebound: frozenset[str] | None = None,
        altitudes: Mapping[str, float] | None = None,
        from_homes: float | None = None,
        spaces: Spaces | None = None,
        spare: float = 0.0,
        asked: Mapping[str, int | None] | None = None,
    ) -> None:
        """Lay everything out.

        Args:
            scene: expanded.
            fine: whether works are divided as finely as can be, for missions that barely fit.
            homebound: names of the robots that always keep enough to go home; None: see `homebound_of`.
            altitudes: of transit, by robot; None: the scene's for all.
            from_homes: metres that robots keep from the homes of others; None: see `Spaces`.
            spaces: of another team of the same robots; None: new ones.
            spare: see `Pilot`.
            asked: see `Team`; None: what the scene says.
        """
        self.asked = {task.name: task.wanted for task in scene.tasks} if asked is None else asked
        self.scene, self.fine = scene, fine
        self._altitudes, self._from_homes, self._spare = altitudes, from_homes, spare
        self.spaces = spaces or Spaces(scene, from_homes=from_homes)
        self.homebound = homebound_of(scene) if homebound is None else homebound
        aloft = altitudes or {}
        fluid = not scene.timed
        uploads = fluid and not scene.frame.is_local
        travels = {
            robot.name: Travel(
                robot,
                self.spaces.of(robot),
                aloft.get(robot.name, scene.transit_altitude),
                fluid=fluid,
                corridors=scene.corridors_of(robot),
                areas=scene.kept_from(robot),
                corners=Corners(robot, scene.kept_from(robot), scene.corridors_of(robot)) if fluid else None,
                uploads=uploads,
            )
            for robot in scene.robots
        }
        diversions = diversions_of(scene, travels)
        self.pilots: Mapping[str, Pilot] = {
            name: Pilot(
                travel, homebound=name in self.homebound, diversions=diversions.get(name), spare=spare
            )
            for name, travel in travels.items()
        }
        self.kinds = _kinds_of(scene, self.pilots)
        self.starts = dict[tuple[str, float], State]()
        self.done = dict[tuple[object, ...], tuple[tuple[State, ...], JobResult | None, float]]()
        self.candidates = dict[tuple[object, ...], ShareCandidate]()
        self.charges = Charges(self.pilots)
        self._timelines = dict[bool, Timelines]()
        self._others: dict[tuple[object, ...], Team] = {}
        self._coarsest = _seconds_of_all(scene) / (_PORTIONS_PER_ROBOT * max(1, len(scene.robots)))
        self._refusals = dict[tuple[str, str], str]()
        self._members = dict[tuple[str, ...], dict[str, tuple[str, ...]]]()
        self._whole = dict[str, bool]()
        self._fewest = dict[str, float]()
        self.tasks = {task.name: task for task in scene.tasks}
        self._crews: dict[tuple[str, ...], tuple[tuple[str, ...], dict[str, str]]] = {}
        self._able_robots: dict[str, tuple[tuple[str, ...], dict[str, str]]] = {}
        self._laid: dict[tuple[str, str, ByRows], tuple[Work, Layout] | None] = {}
        self._materials: dict[tuple[str, str, ByRows, Direction], Material | None] = {}
        self.groups: dict[str, tuple[tuple[str, ...], ...]] = {}
        self.mixtures: dict[str, tuple[Mixture, ...]] = {}
        for task in scene.tasks:
            if not is_control(task):
                self._gather(task)

    def _gather(self, task: Task) -> None:
        """Find out who can do a task, and who can share it."""
        groups, mixtures = list[tuple[str, ...]](), list[Mixture]()
        for family in _families(self._sorts(task)):
            robots = sum(len(group) for _, group in family)
            sorts = [self._able(task.name, work, group, robots) for work, group in family]
            groups += [each.robots for each in sorts]
            if len(able := [each for each in sorts if each.robots]) > 1:
                divide = partial(self._layout, robots=robots)
                mixtures.append(Mixture(task.name, able, self.pilots, self.kinds, divide))
        self.groups[task.name], self.mixtures[task.name] = tuple(groups), tuple(mixtures)
        found = groups[0] if len(groups) == 1 else self._in_order(groups)
        if found not in self._crews:
            self._crews[found] = found, {kind: names[0] for kind, names in self._of_kinds(found).items()}
        self._able_robots[task.name] = self._crews[found]
        if len(groups) == 1:
            self.groups[task.name] = self._crews[found][:1]

    def _in_order(self, groups: Iterable[Sequence[str]]) -> tuple[str, ...]:
        found = {name for group in groups for name in group}
        return tuple(name for name in self.pilots if name in found)

    def _sorts(self, task: Task) -> list[tuple[Work, tuple[str, ...]]]:
        """Return the robots whose work of a task is sound, by work; keep why others cannot do it."""
        works, name = self.scene.works, task.name
        if isinstance(works, SharedWorks):
            able = works.able(name)
        else:
            able = tuple(robot for robot in self.pilots if (name, robot) in works)
        sorts: list[tuple[Work, tuple[str, ...]]] = []
        for robots in self._of_kinds(able).values():
            work = works[name, robots[0]]
            if fault := "; ".join(faults(work, self.pilots[robots[0]])):
                self._refusals |= {(name, robot): fault for robot in robots}
                continue
            known = [i for i, (other, _) in enumerate(sorts) if other is work or other == work]
            if known:
                sorts[known[0]] = (work, self._in_order((sorts[known[0]][1], robots)))
            else:
                sorts.append((work, robots))
        return sorts

    def _of_kinds(self, robots: tuple[str, ...]) -> Mapping[str, tuple[str, ...]]:
        """Return some robots by kind; the same ones for tasks that the same robots can do."""
        if robots not in self._members:
            members = dict[str, list[str]]()
            for name in robots:
                members.setdefault(self.kinds[name], []).append(name)
            self._members[robots] = {kind: tuple(names) for kind, names in members.items()}
        return self._members[robots]

    def _layout(self, work: Work, group: Sequence[str], robots: int) -> Layout:
        return layout_of(work, self.pilots[group[0]], robots, coarsest=self._coarsest, fine=self.fine)

    def _able(self, task: str, work: Work, group: tuple[str, ...], robots: int) -> WorkGroup:
        """Lay the work out for each robot of a group; return those that can follow it."""
        layout, able = self._layout(work, group, robots), group
        for kind, names in self._of_kinds(group).items():
            self._laid[task, kind, False] = work, layout
            try:
                self._materials[task, kind, False, False] = lay_out(task, work, layout, self.pilots[names[0]])
            except UnreachableError as error:
                self._refusals |= {(task, name): str(error) for name in names}
                able = tuple(name for name in able if name not in names)
        return WorkGroup(work, able, layout)

    def changed(
        self,
        homebound: frozenset[str] | None,
        *,
        robots: tuple[Robot, ...] | None = None,
        altitudes: Mapping[str, float] | None = None,
        from_homes: float | None = None,
        spare: float = 0.0,
    ) -> Team:
        """Return a team that does the same tasks in another way, made once; arguments as for a new one."""
        robots = self.scene.robots if robots is None else robots
        returning = tuple(robot.return_home for robot in robots)
        key = (homebound, returning, altitudes is None, from_homes, spare)
        if key not in self._others:
            self._others[key] = Team(
                replace(self.scene, robots=robots),
                fine=self.fine,
                homebound=homebound,
                altitudes=altitudes,
                from_homes=from_homes,
                spaces=self.spaces if from_homes is None else None,
                spare=spare,
                asked=self.asked,
            )
        return self._others[key].wanting({task.name: task.wanted for task in self.scene.tasks})

    def sparing(self, part: float) -> Team:
        """Return the same team that keeps a further part of each charge."""
        return Team(
            self.scene,
            fine=self.fine,
            homebound=self.homebound,
            altitudes=self._altitudes,
            from_homes=self._from_homes,
            spaces=self.spaces,
            spare=self._spare + part,
            asked=self.asked,
        )

    def at_home(self, robots: frozenset[str]) -> Team:
        """Return a team of which some robots stay at home, made once."""
        key = ("at home", robots)
        if key not in self._others:
            works = self.scene.works
            refusals = {
                pair: "stays at home, so that robots keep apart" for pair in works if pair[1] in robots
            }
            self._others[key] = Team(
                replace(
                    self.scene,
                    works={pair: works[pair] for pair in works if pair[1] not in robots},
                    refusals={**self.scene.refusals, **refusals},
                ),
                fine=self.fine,
                homebound=self.homebound,
                spaces=self.spaces,
                asked=self.asked,
            )
        return self._others[key].wanting({task.name: task.wanted for task in self.scene.tasks})

    def wanting(self, wanted: Mapping[str, int | None]) -> Team:
        """Return the same team, materials and all, where tasks want so many robots."""
        tasks = [replace(task, wanted=wanted.get(task.name, task.wanted)) for task in self.scene.tasks]
        other = copy(self)
        other.scene, other.tasks = (
            replace(self.scene, tasks=tuple(tasks)),
            {each.name: each for each in tasks},
        )
        return other

    def timelines(self, *, hasty: bool) -> Timelines:
        """Return what makes the timelines of its plans; `hasty`: whether charging may end too early."""
        robots = {robot.name: robot for robot in self.scene.robots}
        return self._timelines.setdefault(hasty, Timelines(robots, hasty=hasty))

    def forwards(self, task: str, robot: str, *, by_rows: ByRows = False) -> Material | None:
        """Return the material of a task for a robot; None if it cannot do the task, or not that way."""
        if (task, robot) in self._refusals or (task, robot) not in self.scene.works:
            return None
        return self._material(task, robot, by_rows, backwards=False)

    def backwards(self, task: str, robot: str, *, by_rows: ByRows = False) -> Material | None:
        """Return the material in the other direction; None if it has only one."""
        return self._material(task, robot, by_rows, backwards=True)

    def _material(self, task: str, robot: str, by_rows: ByRows, *, backwards: Direction) -> Material | None:
        key = (task, self.kinds[robot], by_rows, backwards)
        if key not in self._materials:
            laid, made = self._laid_out(task, robot, by_rows), None
            if laid is not None and (laid[1].can_turn or not backwards):
                try:
                    made = lay_out(task, *laid, self.pilots[robot], backwards=backwards)
                except UnreachableError:
                    made = None
            self._materials[key] = made
        return self._materials[key]

    def _laid_out(self, task: str, robot: str, by_rows: ByRows) -> tuple[Work, Layout] | None:
        key = (task, self.kinds[robot], by_rows)
        if key not in self._laid:
            work = in_rows(self.scene.works[task, robot])
            group = next(each for each in self.groups[task] if robot in each)
            laid = None if work is None else (work, self._layout(work, group, self.sharers(task)))
            self._laid[key] = laid
        return self._laid[key]

    def able(self, task: str) -> tuple[str, ...]:
        """Return all robots that can do a task, in the scene's order."""
        return self._able_robots[task][0]

    def able_kinds(self, task: str) -> Mapping[str, str]:
        """Return, by kind, the first robot that can do a task."""
        return self._able_robots[task][1]

    def fewest_seconds(self, task: str) -> float:
        """Return seconds of work that robots of one sort take for a task at least; 0 where sorts mix."""
        if task not in self._fewest:
            materials = [self.forwards(task, name) for name in self.able_kinds(task).values()]
            robots = self.sharers(task)
            known = [each.fewest_seconds(robots) for each in materials if each is not None]
            self._fewest[task] = 0.0 if self.mixtures[task] else min(known, default=0.0)
        return self._fewest[task]

    def sharers(self, task: str) -> int:
        """Return how many robots may share a task at most; 1 where it is indivisible."""
        return 1 if self.whole(task) else max(map(len, self.circles(task)), default=0)

    def circles(self, task: str) -> list[tuple[str, ...]]:
        """Return the robots that can share a task with each other, each in one circle."""
        mixed = [self._in_order(each.robots for each in mixture.sorts) for mixture in self.mixtures[task]]
        inside = {name for names in mixed for name in names}
        return [*mixed, *(group for group in self.groups[task] if group and group[0] not in inside)]

    def whole(self, task: str) -> bool:
        """Return whether one robot must do all of a task."""
        if task not in self._whole:
            materials = [self.forwards(task, name) for name in self.able_kinds(task).values()]
            self._whole[task] = any(each is not None and each.whole for each in materials)
        return self._whole[task]

    def sharing_with(self, task: str, robot: str) -> tuple[str, ...]:
        """Return the robots that can share a task with one, itself included."""
        return next((circle for circle in self.circles(task) if robot in circle), ())

    def shortfalls(self) -> Iterator[str]:
        """Yield what makes tasks impossible whatever the plan: no robot can do it, or too few."""
        for task in self.scene.tasks:
            if is_control(task):
                continue
            largest = max(map(len, self.circles(task.name)), default=0)
            if not largest:
                yield f"task '{task.name}' can be done by no robot ({self.why_not(task.name)})"
            elif task.wanted is not None and task.wanted > self.sharers(task.name):
                few = self._too_few(task.name, task.wanted)
                yield f"task '{task.name}' wants {task.wanted} robots, {few}"

    def _too_few(self, task: str, wanted: int) -> str:
        """Return why too few robots can share a task, and what would do."""
        if self.whole(task):
            return "but one robot must do all of it; robotsWanted of 1 would do"
        most = max(self.circles(task), key=len)
        short = wanted - len(most)
        others = "; ".join(each for each in (self.sorts(task), self.why_not(task)) if each)
        return (
            f"{len(most)} can share it: {short} short{f' ({others})' if others else ''};"
            f" robotsWanted of {len(most)}, or {short} more like '{most[0]}', would do"
        )

    def sorts(self, task: str) -> str:
        """Return which robots can share a task among themselves only; empty where all can."""
        groups = [" and ".join(circle) for circle in self.circles(task)]
        apart = ", ".join(groups[:-1]) + f" cannot share it with {groups[-1]}" if len(groups) > 1 else ""
        return (
            f"{apart}: sensors or clearances differ, so that their work is laid out otherwise"
            if apart
            else ""
        )

    def why_not(self, task: str) -> str:
        """Return why robots cannot do a task, robot by robot."""
        refusals = {name: self.refusal(task, name) for name in self.pilots}
        return "; ".join(f"{name}: {refusal}" for name, refusal in refusals.items() if refusal)

    def refusal(self, task: str, robot: str) -> str | None:
        """Return why a robot cannot do a task; None if it can."""
        pair = task, robot
        if pair in self._refusals or pair in self.scene.works:
            return self._refusals.get(pair)
        return self.scene.refusals.get(pair, "has no work for it")

    def too_long(self, task: str) -> bool:
        """Return whether some portion of a task is too long for a sortie of any robot."""
        return all(self._stuck(task, group) for group in self.groups[task] if group)

    def _stuck(self, task: str, group: Sequence[str]) -> bool:
        known = [(self.forwards(task, name), self.pilots[name]) for name in group]
        short = [shortages(material, pilot) for material, pilot in known if material is not None]
        return any(min(portion) > 1e-9 for portion in zip(*short, strict=True))

    def short_of_charge(self, task: str) -> Iterator[str]:
        """Yield, robot by robot, what of a task does not fit into a sortie."""
        for name in self.able(task):
            material = self.forwards(task, name)
            for fault in charge_faults(material, self.pilots[name]) if material is not None else ():
                yield f"{name}: {fault}"


def teams_to_try(team: Team) -> Iterator[Team]:
    """Yield a team, and those to try where no robot of it is left for some job.

    Robots that need not return may keep enough to go home, to recharge there; or they may not, and end
    further away.
    """
    yield team
    everyone = frozenset(team.pilots)
    returning = frozenset(name for name, pilot in team.pilots.items() if pilot.robot.return_home)
    others = [each for each in dict.fromkeys((everyone, returning)) if each != team.homebound]
    yield from (Team(team.scene, homebound=each) for each in others)
    yield from (Team(team.scene, homebound=each, fine=True) for each in (*others, team.homebound))


def _kinds_of(scene: Scene, pilots: Mapping[str, Pilot]) -> dict[str, str]:
    """Return, by robot, the first that does alike what both can do: what is laid out once serves both."""
    tasks, shared = [task.name for task in scene.tasks], scene.works
    first: dict[tuple[object, ...], str] = {}
    kinds = {}
    for name, pilot in pilots.items():
        if isinstance(shared, SharedWorks):
            works: object = shared.sorts[name]
        else:
            works = tuple(id(shared.get((task, name))) for task in tasks)
        key = (id(pilot.robot.type), pilot.kinematics, id(pilot.travel.space), works, pilot.stuck)
        kinds[name] = first.setdefault(key, name)
    return kinds


def _families(sorts: Sequence[tuple[Work, tuple[str, ...]]]) -> list[list[tuple[Work, tuple[str, ...]]]]:
    """Return works and groups, those together that can share a task."""
    families: list[list[tuple[Work, tuple[str, ...]]]] = []
    for each in sorts:
        kin = (known for known in families if all(comparable(each[0], other) for other, _ in known))
        family = next(kin, None)
        if family is None:
            families.append([each])
        else:
            family.append(each)
    return families


def homebound_of(scene: Scene) -> frozenset[str]:
    """Return the names of the robots that must always have enough left to go home.

    These are the robots that return in the end, and those that return with a low battery, by default.
    """
    return frozenset(
        robot.name
        for robot in scene.robots
        if robot.return_home or _response_to_low_battery(scene, robot) == RETURN
    )


def _response_to_low_battery(scene: Scene, robot: Robot) -> str:
    """Return what the mission or the robot's type declares; RETURN where neither does."""
    declared = (policy.response for policy in (*scene.policies, *robot.type.policies) if policy.event == _LOW)
    return next(declared, RETURN)


def _seconds_of_all(scene: Scene) -> float:
    """Return roughly how long all works take one robot: each task's length at some robot's cruise."""
    cruises = {robot.name: kinematics_of(robot).cruise for robot in scene.robots}
    total = 0.0
    for task in scene.tasks:
        robot = next((name for name in cruises if (task.name, name) in scene.works), None)
        if robot is not None and cruises[robot] > 0.0:
            total += (
                sum(length_of(each.points) for each in scene.works[task.name, robot].strokes) / cruises[robot]
            )
    return total
