"""The plan of an expanded scene: which robot does what, when and along which route."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from math import inf

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.bounds import least_makespan
from mmrs_core.planning.deconfliction import better
from mmrs_core.planning.departures import begun_no_earlier, may_wait, near, waiting_at_home
from mmrs_core.planning.effort import Effort
from mmrs_core.planning.jobs import jobs_of
from mmrs_core.planning.limits import is_small
from mmrs_core.planning.one_search import UnexplainedError, planned
from mmrs_core.planning.relaying import plan_with_relays, relay_tasks
from mmrs_core.planning.team import Team
from mmrs_core.scene import Plan, Scene

_QUICK, _HALF = 0.2, 0.5
"""Shares of the time that is left for a further search."""

_SOONER = 0.98
"""Times the mission time up to which it is worth a stop at every corner."""


def plan(scene: Scene, *, seed: int = 0, effort: Effort | None = None) -> Plan:
    """Return a plan in which the last robot is back as early as could be found.

    Every task is done exactly once, by robots that can do it, in the order of the dependencies; no
    sortie takes more than a charge less the reserve allows, waits included; every leg keeps its
    clearance. The same scene and seed give the same plan, unless a time or a stop ends the search. Where
    a task leaves open how many robots it wants, numbers are tried too (see `robot_counts`): in a small
    mission no other number ends it sooner. Deadlines and longest durations that the plan without them keeps
    change nothing. Tasks in which robots stay as relays are planned around the others
    (see `plan_with_relays`).

    Args:
        scene: expanded: kinematics and works are known.
        seed: of the local search.
        effort: that it may make; None: the steps that the mission's size asks for.

    Raises:
        InfeasibleError: no plan was found; its reasons give what is short, and by how much.
    """
    if relay_tasks(scene):
        return plan_with_relays(scene, lambda part, its: plan(part, seed=seed, effort=its), effort)
    searches = _Searches(scene, seed, effort or Effort())
    refusal = searches.begin()
    searches.stop_at_corners()
    searches.set_out_later()
    if searches.found is None:
        raise refusal.in_full() if isinstance(refusal, UnexplainedError) else refusal
    return searches.once_more(searches.found)


class _Searches:
    """Searches one after the other for a better plan of a scene, which share the time.

    Attributes:
        found: the best plan so far; None: none is known.
    """

    def __init__(self, scene: Scene, seed: int, effort: Effort) -> None:
        self._scene, self._seed, self._effort = scene, seed, effort
        self._shared = effort.timed and (may_wait(scene) or _charges_last(scene))
        self.found: Plan | None = None

    def begin(self) -> InfeasibleError:
        """Search for the first time; return why there is no plan, if there is none."""
        first, refusal = self._effort.trial() if self._shared else self._effort, InfeasibleError("no plan")
        try:
            self.found = planned(self._scene, self._seed, first)
            self._effort.best = min(self._effort.best, self.found.makespan)
        except InfeasibleError as error:
            refusal = error
        self._effort.stopped = self._effort.stopped or first.stopped
        return refusal

    def stop_at_corners(self) -> None:
        """Try whether fewer charges suffice if robots stop at corners: a mission may take longer."""
        found = self.found
        if _charges_last(self._scene) and (found is None or any(each.sorties > 1 for each in found.robots)):
            with suppress(InfeasibleError):
                made = self._again(replace(self._scene, timed=True), _HALF)
                self.found = made if found is None or made.makespan < _SOONER * found.makespan else found

    def set_out_later(self) -> None:
        """Try whether robots that wait at home rather than in the air are done sooner."""
        asked = self._asked
        for earliest in waiting_at_home(asked, self.found, self._again):
            with suppress(InfeasibleError):
                later = begun_no_earlier(asked, earliest)
                if self.found is None or better(self._again(near(later)), self.found) is not self.found:
                    made = replace(self._again(later, _HALF), earliest=earliest)
                    self.found = better(made, self.found)

    def once_more(self, found: Plan) -> Plan:
        """Return the best plan, after a search in all the time that is left."""
        if self._shared:
            with suppress(InfeasibleError):
                made = self._again(begun_no_earlier(self._asked, found.earliest), 1.0, self._seed + 1)
                return better(replace(made, earliest=found.earliest), found)
        return found

    @property
    def _asked(self) -> Scene:
        """Return the scene; if the best plan stops at corners, as one in which robots do."""
        stops = self.found is not None and self.found.timed
        return replace(self._scene, timed=True) if stops else self._scene

    def _again(self, scene: Scene, share: float = _QUICK, seed: int | None = None) -> Plan:
        """Return the plan of a scene that differs in what is asked only, in a share of the time left."""
        if self.found is not None and self._effort.over:
            raise InfeasibleError("no better plan: the search has ended")
        made = planned(scene, self._seed if seed is None else seed, self._effort.again(share))
        if self.found is not None:
            bound = self.found.lower_bound
        else:
            bound = least_makespan(Team(self._scene), jobs_of(self._scene))
        return replace(made, lower_bound=bound, timed=scene.timed and not self._scene.timed)


def _charges_last(scene: Scene) -> bool:
    """Return whether charges are limited and missions uploaded, for few enough tasks to plan them twice."""
    if scene.timed or scene.frame.is_local or not is_small(scene):
        return False
    able = [each.kinematics for each in scene.robots if each.kinematics is not None]
    return any(each.mission is not None and min(each.endurance, each.energy) < inf for each in able)
