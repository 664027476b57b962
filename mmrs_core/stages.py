"""A mission from its models to what is known of its safety, each stage when it is first asked for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, TypeVar

from mmrs_core.contributions.checks import Status
from mmrs_core.errors import InfeasibleError
from mmrs_core.pipeline import (
    BehaviourContext,
    expand,
    ground,
    place_of_scene,
    plan,
    program_of,
    transform,
    verify,
)

if TYPE_CHECKING:
    from mmrs_core.behaviour.program import Program
    from mmrs_core.contributions.checks import Verdict
    from mmrs_core.contributions.registry import Contributions
    from mmrs_core.languages.behaviour import Behaviour
    from mmrs_core.languages.modelset import ModelSet
    from mmrs_core.scene import Plan, Scene
    from mmrs_core.transformation.engine import Trace

Result = TypeVar("Result")

SHARES = (0.98, 0.95, 0.9, 0.8)
"""Shares of each charge to plan with, one after the other, where a plan takes more than the check allows."""

OF_CHARGES = frozenset({"endurance", "energy"})
_OF_A_PLAN = ("plan", "transformed", "program", "verdicts")


class Stages:
    """One mission from its models to its verdicts.

    Args:
        models: return the valid models.
        seed: of the planner's search.
    """

    def __init__(
        self, models: Callable[[], ModelSet], contributions: Contributions, *, seed: int = 0
    ) -> None:
        self._models = models
        self._contributions = contributions
        self._seed = seed
        self._share = 1.0

    def stage(self, name: str, make: Callable[[], Result]) -> Result:
        """Return what a stage makes."""
        return make()

    @cached_property
    def models(self) -> ModelSet:
        """Return the valid models."""
        return self._models()

    @cached_property
    def grounded(self) -> Scene:
        """Return the mission in its local frame."""
        models = self.models
        return self.stage("ground", lambda: ground(models))

    @cached_property
    def scene(self) -> Scene:
        """Return the scene with the work of every task."""
        scene = self.grounded
        return self.stage("expand", lambda: expand(scene, self._contributions))

    @cached_property
    def plan(self) -> Plan:
        """Return who does what, when and along which path."""
        scene = self.to_plan
        plan = self.stage("plan", lambda: self.planned(scene, self._seed))
        if self._share == 1.0:
            return plan
        note = f"planned with {100.0 * self._share:.0f} % of each charge: with all, moves might take too long"
        return replace(plan, notes=(*plan.notes, note))

    def planned(self, scene: Scene, seed: int) -> Plan:
        """Return the plan of an expanded scene."""
        return plan(scene, seed=seed)

    @cached_property
    def transformed(self) -> tuple[Behaviour, Trace]:
        """Return the behaviour, and what each of its moves is for."""
        scene, plan = self.scene, self.plan
        return self.stage("transform", lambda: transform(scene, plan, self._contributions))

    @cached_property
    def program(self) -> Program:
        """Return the behaviour as engines use it."""
        return program_of(self.transformed[0], self._contributions)

    def settle_charges(self) -> None:
        """Plan again with less of each charge, until the check accepts what robots use of theirs.

        By what share moves may take longer, the planner takes to be the same for all; the check adds up
        each. If no plan is accepted, the first one remains, with what the check has against it.

        Raises:
            InfeasibleError: there is no plan.
        """
        first: dict[str, object] = {}
        for share in (1.0, *SHARES):
            self._share = share
            try:
                exceeded = {each.property for each in self.verdicts if each.status is Status.VIOLATED}
            except InfeasibleError:
                if not first:
                    raise
                break
            if not exceeded & OF_CHARGES:
                return
            made = {name: self.__dict__.pop(name) for name in _OF_A_PLAN}
            first = first or made
        self._share = 1.0
        self.__dict__.update(first)

    @property
    def to_plan(self) -> Scene:
        """Return the scene as it is planned: with as much of each charge as plans may use."""
        return _with_share(self.scene, self._share)

    @property
    def place(self) -> BehaviourContext:
        """Return what the behaviour is checked against."""
        return place_of_scene(self.scene)

    @cached_property
    def verdicts(self) -> tuple[Verdict, ...]:
        """Return what is known of the behaviour's safety."""
        program, place = self.program, self.place
        return self.stage("verify", lambda: verify(program, place, self._contributions))


def _with_share(scene: Scene, share: float) -> Scene:
    """Return a scene whose robots have that share of their charges."""
    if share == 1.0:
        return scene
    robots = tuple(
        robot
        if (own := robot.kinematics) is None
        else replace(
            robot,
            kinematics=replace(own, endurance=share * own.endurance, energy=share * own.energy),
        )
        for robot in scene.robots
    )
    return replace(scene, robots=robots)
