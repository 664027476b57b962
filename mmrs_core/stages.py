"""A mission from its models to what is known of its safety, each stage when it is first asked for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cached_property
from itertools import product
from typing import TYPE_CHECKING, TypeVar

from mmrs_core.errors import MmrsError
from mmrs_core.pipeline import (
    BehaviourContext,
    expand,
    ground,
    place_of_scene,
    plan,
    program_of,
    simulate,
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

_MOST_CONDITIONS = 3
"""Conditions at most of which all outcomes are simulated together with all outcomes of the others."""


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
        from mmrs_core.simulation.overdue import plan_in_time

        scene = self.scene
        return self.stage(
            "plan", lambda: plan_in_time(scene, lambda part: self.planned(part, self._seed), self._simulated)
        )

    def _simulated(self, made: Plan) -> list[Plan | str]:
        """Return a plan with the times of its simulated behaviour, or why these are not known.

        Where choices depend on what is not known yet, once for each outcome of their conditions; where these
        are many, once with all of them and once with none.
        """
        from mmrs_core.simulation.run import asked_by

        behaviour, trace = transform(self.scene, made, self._contributions)
        program = program_of(behaviour, self._contributions)
        runs: list[Plan | str] = [self._as_simulated(made, program, trace)]
        if isinstance(runs[0], str) and (asked := asked_by(program)):
            both, few = (True, False), len(asked) <= _MOST_CONDITIONS
            ways = product(both, repeat=len(asked)) if few else ((each,) * len(asked) for each in both)
            assumed = (dict(zip(asked, each, strict=True)) for each in ways)
            runs = [self._as_simulated(made, program, trace, each) for each in assumed]
            runs += [] if few else [f"of {len(asked)} conditions, only all and none were assumed to hold"]
        return runs

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

    @cached_property
    def timed(self) -> Plan:
        """Return the plan with the times that its behaviour is simulated to take.

        Where choices depend on what is not known yet, or the simulation fails, the planner's times remain,
        and a note gives the reason.
        """
        found = self._as_simulated(self.plan, self.program, self.transformed[1])
        if isinstance(found, str):
            return replace(self.plan, notes=(f"times are the planner's: {found}", *self.plan.notes))
        return found

    def _as_simulated(
        self, made: Plan, program: Program, trace: Trace, assume: Mapping[str, bool] | None = None
    ) -> Plan | str:
        """Return a plan with the times that its behaviour is simulated to take, or why that is not known."""
        from mmrs_core.simulation.plan_times import as_simulated
        from mmrs_runtime.semantics import Outcome

        try:
            run = simulate(program, self.place, self._contributions, assume=assume)
        except MmrsError as error:
            return str(error)
        if run.ending.outcome is not Outcome.SUCCESS:
            return f"the simulated run ends with '{run.ending.outcome.value}'"
        return as_simulated(made, run, trace, program.robots)

    @property
    def place(self) -> BehaviourContext:
        """Return what the behaviour is checked against."""
        return place_of_scene(self.scene)

    @cached_property
    def verdicts(self) -> tuple[Verdict, ...]:
        """Return what is known of the behaviour's safety."""
        program, place = self.program, self.place
        return self.stage("verify", lambda: verify(program, place, self._contributions))
