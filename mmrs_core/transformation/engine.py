"""From a plan to a behaviour model, with a trace of what serves what."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from mmrs_core.contributions.rules import MoveSpec, RobotKind, Rule
from mmrs_core.geometry.frames import LocalFrame
from mmrs_core.languages import behaviour as bl
from mmrs_core.languages import robot as rl
from mmrs_core.languages.registry import Registry
from mmrs_core.scene import (
    AltitudeReference,
    Frame,
    Name,
    Plan,
    Policy,
    PolicyEvent,
    PolicyResponse,
    Position,
    Robot,
    Scene,
    Signal,
    all_steps,
)
from mmrs_core.transformation.chain import (
    Chain,
    Deed,
    DraftMove,
    DraftTransition,
    SendFeedback,
    SendSignal,
    UseDevice,
)
from mmrs_core.transformation.drafting import draft
from mmrs_core.transformation.fluid import FluidTransitions

ORIGIN: Position = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class TraceLink:
    """A move, the task that it serves (empty: none in particular), and the rule that made it.

    `step`: number of the step of the robot's plan that it carries out, as `all_steps` counts; None: none.
    """

    robot: str
    move: str
    task: str
    rule: str
    step: int | None = None


@dataclass(frozen=True, slots=True)
class Trace:
    """What each move of a behaviour is for, robot by robot in the order of the moves."""

    links: tuple[TraceLink, ...]

    def moves(self) -> Mapping[tuple[str, int], list[str]]:
        """Return the moves that carry out each step of a plan, by robot and the step's number."""
        found: dict[tuple[str, int], list[str]] = {}
        for link in self.links:
            if link.step is not None:
                found.setdefault((link.robot, link.step), []).append(link.move)
        return found


def transform(
    scene: Scene,
    plan: Plan,
    *,
    rules: Mapping[Name, Rule],
    robot_kinds: Mapping[Name, RobotKind],
    registry: Registry,
) -> tuple[bl.Behaviour, Trace]:
    """Return the behaviour of every robot that has something to do, and what each move is for.

    The behaviour is monotone: a fresh slot for each synchronisation and receiver, only ever
    activated. Robots without work are its idle robots.
    """
    kinds = {kind.name: kind for kind in robot_kinds.values()}
    by_name = {rule.name: rule for rule in rules.values()}
    chains = {
        each.robot: draft(each, scene, kinds[scene.robot(each.robot).kind], by_name) for each in plan.robots
    }
    with registry.in_use():
        return _Assembly(scene, plan, chains, registry).behaviour()


class _Assembly:
    def __init__(self, scene: Scene, plan: Plan, chains: Mapping[str, Chain], registry: Registry) -> None:
        timed = scene.timed or plan.timed
        self._scene, self._chains, self._registry = replace(scene, timed=timed), chains, registry
        self._idle = {each.robot for each in plan.robots if not each.steps}
        self._coordinates = Coordinates(scene.frame, _positions(scene, chains))
        self._objects: dict[tuple[str, Position, float | None], bl.ObjectTarget] = {}
        self._slots = _slots(plan)

    def behaviour(self) -> tuple[bl.Behaviour, Trace]:
        scene = self._scene
        made = {name: self._robot(scene.robot(name), chain) for name, chain in self._chains.items()}
        robots = [robot for name, robot in made.items() if name not in self._idle]
        behaviour = bl.Behaviour(
            name=scene.name,
            crs=scene.frame.crs,
            altitudeReference=self._coordinates.altitude_reference,
            origin=self._coordinates.at(ORIGIN),
            surfaceHeight=scene.frame.surface,
            geoidSeparation=scene.frame.geoid_separation,
            positionError=scene.position_error,
            minimumSeparation=scene.minimum_separation,
            reserve=scene.reserve,
            acceptedUnknowns=list(scene.accepted_unknowns),
            robots=robots,
            idleRobots=[made[name] for name in self._chains if name in self._idle],
            targets=[*self._coordinates.all, *self._objects.values()],
        )
        return behaviour, Trace(tuple(_links(robots, self._chains)))

    def _robot(self, robot: Robot, chain: Chain) -> bl.Robot:
        fluid = FluidTransitions(robot, self._scene, chain)
        moves = [self._move(node, index) for index, node in enumerate(chain.nodes)]
        return bl.Robot(
            id=robot.name,
            typeName=robot.type.name,
            travelMode=robot.travel_mode,
            payload=robot.payload,
            home=self._coordinates.at(robot.home),
            slots=list(self._slots.get(robot.name, {}).values()),
            moves=moves,
            moveTransitions=[self._transition(edge, robot, moves, fluid) for edge in chain.edges],
            policies=[_policy(policy) for policy in self._scene.stated_policies(robot)],
        )

    def _move(self, node: DraftMove, index: int) -> bl.Move:
        spec = node.spec
        features: dict[str, object] = dict(spec.attributes)
        if spec.target is not None:
            features["target"] = self._target(spec, spec.target)
            features["distance"] = spec.distance
            if spec.speed is not None:
                features["speed"] = spec.speed
        if spec.look is not None:
            features["heading"] = self._heading(spec)
        move = self._registry.create(
            *spec.metaclass,
            name=f"{spec.metaclass[1].lower()}_{index:03d}",
            preActions=[self._action(deed) for deed in node.before],
            postActions=[self._action(deed) for deed in node.after],
            **{key: value for key, value in (("task", node.task), ("rule", node.rule)) if value},
            **features,
        )
        assert isinstance(move, bl.Move)
        return move

    def _target(self, spec: MoveSpec, position: Position) -> bl.Target:
        if spec.object is None:
            return self._coordinates.at(position)
        key = (spec.object, position, spec.object_tolerance)
        if key not in self._objects:
            self._objects[key] = bl.ObjectTarget(
                description=spec.object,
                expectedAt=self._coordinates.at(position),
                tolerance=spec.object_tolerance,
            )
        return self._objects[key]

    def _heading(self, spec: MoveSpec) -> bl.Heading:
        look = spec.look
        assert look is not None
        target = self._target(spec, look.at) if spec.facing else self._coordinates.at(look.at)
        return bl.Heading(target=target, angle=look.angle_degrees, deviceId=look.device or None)

    def _action(self, deed: Deed) -> bl.Action:
        if isinstance(deed, UseDevice):
            return bl.DeviceAction(
                actionName=deed.action, deviceId=deed.device, parameters=_pairs(deed.parameters)
            )
        if isinstance(deed, SendFeedback):
            return bl.Feedback(payload=_pairs(deed.payload))
        return self._notify(deed)

    def _notify(self, give: SendSignal) -> bl.Notify:
        slots = [self._slots[receiver][give.signal] for receiver in give.receivers]
        if len(slots) == 1:
            return bl.UnicastNotify(slot=slots[0])
        if len(slots) == len(self._chains) - len(self._idle) - 1:
            return bl.BroadcastNotify(slot=slots[0])
        return bl.MulticastNotify(slots=slots)

    def _transition(
        self, edge: DraftTransition, robot: Robot, moves: list[bl.Move], fluid: FluidTransitions
    ) -> bl.MoveTransition:
        assert edge.to is not None
        waits = [self._slots[robot.name][signal] for signal in edge.waits]
        if edge.condition is None:
            return bl.MoveTransition(
                from_=moves[edge.source], to=moves[edge.to], waitFor=waits, fluid=fluid.may_flow(edge)
            )
        assert edge.otherwise is not None
        return bl.Choice(
            from_=moves[edge.source],
            to=moves[edge.to],
            falseBranch=moves[edge.otherwise],
            waitFor=waits,
            conditionIdentifier=edge.condition,
        )


def _positions(scene: Scene, chains: Mapping[str, Chain]) -> Iterator[Position]:
    yield ORIGIN
    for name, chain in chains.items():
        yield scene.robot(name).home
        for node in chain.nodes:
            if node.spec.target is not None:
                yield node.spec.target
            if node.spec.look is not None:
                yield node.spec.look.at


def _slots(plan: Plan) -> dict[str, dict[str, bl.Slot]]:
    """Return a slot for each signal in each robot that receives it; names are unique in the plan."""
    slots: dict[str, dict[str, bl.Slot]] = {}
    for each in plan.robots:
        for step in all_steps(each.steps):
            if isinstance(step, Signal):
                for receiver in step.receivers:
                    slots.setdefault(receiver, {})[step.signal] = bl.Slot(name=step.signal)
    return slots


def _links(robots: list[bl.Robot], chains: Mapping[str, Chain]) -> Iterator[TraceLink]:
    for robot in robots:
        for move, node in zip(robot.moves, chains[robot.id].nodes, strict=True):
            yield TraceLink(robot.id, move.name or "", node.task, node.rule, node.step)


def _pairs(pairs: tuple[tuple[str, str], ...]) -> list[bl.Pair]:
    return [bl.Pair(key=key, value=value) for key, value in pairs]


def _policy(policy: Policy) -> rl.Policy:
    event, response = cast(PolicyEvent, policy.event), cast(PolicyResponse, policy.response)
    return rl.Policy(event=event, response=response, after=policy.after)


DEGREE_DIGITS = 12
"""Digits after the point of a degree: a tenth of a micrometre on the ground."""

METRE_DIGITS = 7
"""Digits after the point of a metre.

A position is rounded up to three times: in metres, in degrees, and with the altitude of the origin. That
moves it by a quarter of a micrometre at most. Checks tolerate a whole one
(`mmrs_core.analysis.verdicts.TOLERANCE`), and so accept what is planned exactly at a limit.
"""


class Coordinates:
    """Makes one target for each position, however often it is used.

    Geographic in a mission with a place on the Earth, relative to the origin in a local one.
    Altitudes keep the mission's reference where its origin has an altitude in it; otherwise they
    count from the origin.
    """

    def __init__(self, frame: Frame, positions: Iterable[Position]) -> None:
        self._frame = frame
        self._lift = frame.altitude if frame.altitude_reference != "ORIGIN" else 0.0
        unique = list(dict.fromkeys(_rounded(position) for position in positions))
        self._made = dict(zip(unique, self._make(unique), strict=True))

    @property
    def altitude_reference(self) -> AltitudeReference:
        """Return what the altitudes of the coordinates count from."""
        return "ORIGIN" if self._lift is None else self._frame.altitude_reference

    @property
    def all(self) -> list[bl.Coordinate]:
        """Return every coordinate, in the order in which positions were given."""
        return list(self._made.values())

    def at(self, position: Position) -> bl.Coordinate:
        """Return the coordinate of a position that was given at the beginning."""
        return self._made[_rounded(position)]

    def _make(self, positions: list[Position]) -> list[bl.Coordinate]:
        if self._frame.latitude is None or self._frame.longitude is None:
            return [bl.RelativeCoordinate(x=east, y=north, z=up) for east, north, up in positions]
        frame = LocalFrame(self._frame.crs, self._frame.latitude, self._frame.longitude)
        flat = np.array([position[:2] for position in positions], dtype=float).reshape(-1, 2)
        degrees = frame.to_geographic(flat)
        lift = self._lift or 0.0
        return [
            bl.GeoCoordinate(
                latitude=round(float(latitude), DEGREE_DIGITS),
                longitude=round(float(longitude), DEGREE_DIGITS),
                altitude=round(up + lift, METRE_DIGITS),
            )
            for (latitude, longitude), (_, _, up) in zip(degrees, positions, strict=True)
        ]


def _rounded(position: Position) -> Position:
    east, north, up = (round(float(value), METRE_DIGITS) + 0.0 for value in position)
    return (east, north, up)
