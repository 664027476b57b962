"""Robots of a kind exchange their tours, so that their paths from home and back cross fewer others.

Paths that cross are longer than the same exchanged (2-opt: Croes, 1958). So that exchange is sought with
which they are shortest, two robots after two others. What then still crosses does so at levels.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from math import inf

import numpy as np

from mmrs_core.planning.assembly import planned
from mmrs_core.planning.effort import UNLIMITED, SearchLimit
from mmrs_core.planning.flight_levels import on_levels
from mmrs_core.planning.jobs import Job
from mmrs_core.planning.schedule import Decisions
from mmrs_core.planning.separation import Traffic
from mmrs_core.planning.sweep import Floats, Indices
from mmrs_core.planning.team import Team
from mmrs_core.scene import Branch, Launch, Plan, Point, Recover, RobotPlan, Serve, Transit

_PASSES = 20

_SHORTER = 1e-6
"""Metres by which paths must become shorter."""

_NEAR = 1.08
"""Times the mission time without separation up to which no other exchange is tried."""


def levelled(
    team: Team, jobs: Sequence[Job], decisions: Decisions, found: Plan, limit: SearchLimit = UNLIMITED
) -> Traffic | None:
    """Return the best traffic in which robots fly at other levels, and may exchange tours; None: none do.

    Two robots that cannot pass each other at any level exchange theirs.

    Args:
        team: of the scene, with a minimum separation.
        jobs: of the scene.
        decisions: of the plan.
        found: the plan, before robots are kept apart.
        limit: what the mission must beat, and until when to seek.
    """
    explicit = _decided(found, decisions)
    best, known = None, dict[tuple[RobotPlan, ...], Traffic]()
    for start in (_with_exchanged(explicit, _shortest_exchange(team, found)), decisions):
        for each in _passing(team, jobs, start, limit, known):
            if best is None or (len(each.conflicts), each.cost) < (len(best.conflicts), best.cost):
                best = each
        if best is not None and not best.conflicts and best.plan.makespan <= _NEAR * found.makespan:
            break
    return best


def _passing(
    team: Team,
    jobs: Sequence[Job],
    decisions: Decisions,
    limit: SearchLimit,
    known: dict[tuple[RobotPlan, ...], Traffic],
) -> Iterator[Traffic]:
    """Yield what becomes of decisions at levels, as two robots that then still meet exchange their tours.

    It ends as soon as that does not help. What becomes of a plan is known from then on.
    """
    fewest = inf
    while not limit.over and (found := planned(team, jobs, decisions)) is not None:
        made = known[found.robots] = known.get(found.robots) or on_levels(team, found, limit)
        yield made
        pairs = (pair for pair in made.conflicts if team.kinds[pair[0]] == team.kinds[pair[1]])
        pair = next(pairs, None)
        if pair is None or len(made.conflicts) >= fewest:
            break
        fewest = len(made.conflicts)
        decisions = _with_exchanged(_decided(found, decisions), dict(zip(pair, reversed(pair), strict=True)))


def _decided(plan: Plan, decisions: Decisions) -> Decisions:
    """Return decisions that give each job to the robots that do it in a plan, which came of them."""
    robots: dict[str, list[str]] = {}
    for each in plan.robots:
        for job in dict.fromkeys(step.task for step in each.steps if isinstance(step, Serve | Branch)):
            robots.setdefault(job, []).append(each.robot)
    return replace(decisions, groups={job: tuple(sorted(mine)) for job, mine in robots.items()})


def _with_exchanged(decisions: Decisions, names: Mapping[str, str]) -> Decisions:
    """Return decisions in which others do the jobs of some robots: each that of which it is the value."""
    groups = {
        job: tuple(sorted(names.get(each, each) for each in group)) if isinstance(group, tuple) else group
        for job, group in decisions.groups.items()
    }
    return replace(decisions, groups=groups)


def _shortest_exchange(team: Team, plan: Plan) -> dict[str, str]:
    """Return who does the tour of each robot with which the paths from home and back are shortest."""
    found: dict[str, str] = {}
    for kind in dict.fromkeys(team.kinds.values()):
        robots = [each for each in plan.robots if team.kinds[each.robot] == kind]
        homes = np.array([team.scene.robot(each.robot).home[:2] for each in robots])
        ways = [np.array(list(_ends(each))).reshape(-1, 2) for each in robots]
        metres = np.stack([np.hypot(*(homes[:, None] - ends).T).sum(axis=0) for ends in ways])
        whose = _exchange(metres)
        found |= {each.robot: robots[mine].robot for each, mine in zip(robots, whose.tolist(), strict=True)}
    return found


def _exchange(metres: Floats) -> Indices:
    """Return (n,) the robot of each tour, by (n, n) metres of paths of tours, in rows, and robots."""
    rows = np.arange(len(metres))
    whose = rows.copy()
    for _ in range(_PASSES):
        changed = False
        for one in range(len(metres)):
            own = metres[rows, whose]
            gains = own[one] + own - metres[one, whose] - metres[rows, whose[one]]
            other = int(gains.argmax())
            if gains[other] > _SHORTER:
                whose[one], whose[other] = whose[other], whose[one]
                changed = True
        if not changed:
            break
    return whose


def _ends(plan: RobotPlan) -> Iterator[Point]:
    """Yield where a robot comes to first from its home, and where it leaves for home, of each sortie."""
    for one, two in pairwise(plan.steps):
        if isinstance(one, Launch) and isinstance(two, Transit):
            yield two.route[-1][:2]
        if isinstance(one, Transit) and isinstance(two, Recover):
            yield one.route[0][:2]
