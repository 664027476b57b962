"""From the steps of a robot's plan to a chain of moves."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from functools import singledispatchmethod
from itertools import pairwise
from math import dist

from mmrs_core.behaviour.program import BEHAVIOUR
from mmrs_core.contributions.rules import MoveSpec, RobotKind, Rule
from mmrs_core.errors import InfeasibleError, InternalError
from mmrs_core.scene import (
    ActionAt,
    Await,
    Branch,
    Launch,
    Position,
    Recharge,
    Recover,
    Robot,
    RobotPlan,
    Scene,
    Serve,
    Signal,
    Step,
    Stroke,
    Transit,
)
from mmrs_core.transformation.chain import Chain, OpenEnd, SendFeedback, SendSignal, UseDevice


def draft(plan: RobotPlan, scene: Scene, kind: RobotKind, rules: Mapping[str, Rule]) -> Chain:
    """Return the moves of one robot.

    Args:
        scene: with the robot and the tasks.
        kind: of that robot; makes its launches, recoveries and ways.
        rules: by name; one that has `moves` makes those of its strokes itself.
    """
    drafting = _Drafting(scene.robot(plan.robot), scene, kind, rules)
    drafting.add_all(plan.steps)
    drafting.chain.add(MoveSpec((BEHAVIOUR, "Stop")), "", "recover")
    return drafting.chain


class _Drafting:
    def __init__(self, robot: Robot, scene: Scene, kind: RobotKind, rules: Mapping[str, Rule]) -> None:
        self.chain = Chain()
        self._count = 0
        self._robot, self._scene, self._kind, self._rules = robot, scene, kind, rules

    def add_all(self, steps: Iterable[Step]) -> None:
        """Add the moves of steps, which are counted as `all_steps` yields them."""
        for step in steps:
            self.chain.step, self._count = self._count, self._count + 1
            self.add(step)
            self.chain.step = None

    @singledispatchmethod
    def add(self, step: Step) -> None:
        """Add the moves of a step."""
        raise InternalError(f"{type(step).__name__}: no such step of a plan")

    @add.register
    def _(self, step: Launch) -> None:
        for spec in self._kind.launch(step.up - step.at[2]):
            self._add(spec, step.task, "launch")

    @add.register
    def _(self, step: Transit) -> None:
        speed = self._commanded(step.speed)
        for spec in self._kind.travel(step.route):
            self._add(spec if speed is None else replace(spec, speed=speed), step.task, "transit")

    @add.register
    def _(self, step: Serve) -> None:
        rule = self._rules.get(step.rule)
        if rule is not None and rule.moves is not None:
            specs = rule.moves(step.stroke, self._scene.task(step.task), self._robot, self._scene)
        else:
            specs = moves_of(step.stroke, self._kind, self._commanded(step.speed))
        for spec in specs:
            self._add(spec, step.task, step.rule)
        if step.last:
            done = SendFeedback((("task", step.task), ("state", "done")))
            self.chain.last(step.task, step.rule).after.append(done)

    @add.register
    def _(self, step: Await) -> None:
        if step.until is not None:
            self.chain.pause(step.task, "wait", max(0.0, step.until - step.begin))
        self.chain.wait(step.signals)

    @add.register
    def _(self, step: Signal) -> None:
        self.chain.last(step.task, "notify").after.append(SendSignal(step.signal, step.receivers))

    @add.register
    def _(self, step: Recover) -> None:
        for spec in self._kind.recover():
            self._add(spec, step.task, "recover")

    @add.register
    def _(self, step: Recharge) -> None:
        known = self._robot.kinematics.recharge if self._robot.kinematics else None
        spec = MoveSpec((BEHAVIOUR, "Recharge"), {"duration": known or step.end - step.begin})
        self._add(spec, step.task, "recharge")

    @add.register
    def _(self, step: Branch) -> None:
        ends: list[OpenEnd] = []
        for condition, steps in step.arms:
            if condition is not None:
                holds, fails = self.chain.branch(condition)
                self.chain.resume(holds)
            self.add_all(steps)
            if not steps:
                self.chain.pause(step.task, "choice")
            ends.extend(self.chain.ends)
            if condition is not None:
                self.chain.resume(fails)
        self.chain.resume(*ends)

    def _add(self, spec: MoveSpec, task: str, rule: str) -> None:
        node = self.chain.add(spec, task, rule)
        node.before.extend(self._deed(action) for action in spec.before)
        node.after.extend(self._deed(action) for action in spec.after)

    def _commanded(self, speed: float | None) -> float | None:
        """Return a speed to be commanded; None where the robot's travel mode alone says as much."""
        kinematics = self._robot.kinematics
        if kinematics is None:
            return None
        against_flow = kinematics.own_speed is not None and kinematics.fastest < kinematics.own_speed
        if against_flow and kinematics.cruise >= kinematics.fastest:
            return kinematics.cruise if speed is None else speed
        return None if speed is None or abs(speed - kinematics.cruise) < 1e-9 else speed

    def _deed(self, action: ActionAt) -> UseDevice:
        device = action.device or self._only_device(action.action)
        return UseDevice(action.action, device, action.parameters)

    def _only_device(self, action: str) -> str:
        devices = self._robot.type.devices
        able = [device.id for device in devices.values() if action in device.actions]
        if len(able) != 1:
            found = f"devices {', '.join(able)} support" if able else "no device supports"
            raise InfeasibleError(f"robot '{self._robot.name}': {found} action '{action}'; name one")
        return able[0]


SAME_PLACE = 1e-6


def moves_of(stroke: Stroke, kind: RobotKind, speed: float | None) -> tuple[MoveSpec, ...]:
    """Return the moves of a stroke for a robot that is at its first point.

    Actions at the first point come before the first movement; all others after the movement that
    ends where they are due; those at the last point after the hold there.

    Args:
        speed: commanded, metres per second; None: by the travel mode.
    """
    stops = list(_stops(stroke))
    specs: list[MoveSpec] = []
    (here, first), rest = stops[0], stops[1:]
    pending = first
    for place, actions in rest:
        (spec,) = kind.travel((here, place))
        specs.append(replace(spec, look=stroke.look, speed=speed, before=pending, after=actions))
        here, pending = place, ()
    if stroke.settles and specs:
        specs[0], specs[-1] = replace(specs[0], settles=True), replace(specs[-1], settles=True)
    return (*specs, *_at_the_end(stroke, here, pending, specs))


def _at_the_end(
    stroke: Stroke, here: Position, pending: tuple[ActionAt, ...], specs: list[MoveSpec]
) -> Iterator[MoveSpec]:
    """Yield turn, hold and approach at the last point; moves actions that are due after them there."""
    stays = stroke.hold > 0 or bool(pending) or (not specs and stroke.object is None)
    if stays or stroke.object is not None:
        due = pending or (specs[-1].after if specs else ())
        if not pending and specs:
            specs[-1] = replace(specs[-1], after=())
        ends = [_turn(stroke)] if stroke.look is not None else []
        if stays:
            ends.append(MoveSpec((BEHAVIOUR, "HoldPosition"), {"duration": stroke.hold}))
        if stroke.object is not None:
            ends.append(_approach(stroke, here))
        ends[-1] = replace(ends[-1], after=due)
        yield from ends


def _turn(stroke: Stroke) -> MoveSpec:
    return MoveSpec((BEHAVIOUR, "HeadTo"), look=stroke.look)


def _approach(stroke: Stroke, here: Position) -> MoveSpec:
    return MoveSpec(
        (BEHAVIOUR, "GoTo"),
        target=here,
        object=stroke.object,
        object_tolerance=stroke.object_tolerance,
        distance=stroke.object_distance,
        look=None,
    )


def _stops(stroke: Stroke) -> Iterator[tuple[Position, tuple[ActionAt, ...]]]:
    """Yield each vertex and each place of an action, in order, with the actions due there."""
    todo = list(stroke.commands)
    yield stroke.points[0], _due(todo, 0.0)
    travelled = 0.0
    for start, end in pairwise(stroke.points):
        length = dist(start, end)
        if length <= SAME_PLACE:
            continue
        while todo and todo[0].at < travelled + length - SAME_PLACE:
            part = (todo[0].at - travelled) / length
            place = tuple(a + part * (b - a) for a, b in zip(start, end, strict=True))
            yield (place[0], place[1], place[2]), _due(todo, todo[0].at)
        travelled += length
        yield end, _due(todo, travelled)


def _due(todo: list[ActionAt], at: float) -> tuple[ActionAt, ...]:
    due = []
    while todo and todo[0].at <= at + SAME_PLACE:
        due.append(todo.pop(0))
    return tuple(due)
