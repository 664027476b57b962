"""From a behaviour model to a program."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

from mmrs_core.behaviour.program import (
    Action,
    Heading,
    Move,
    MoveTarget,
    Program,
    RobotProgram,
    SlotId,
    Transition,
)
from mmrs_core.diagnostics import Diagnostic, Place, in_order
from mmrs_core.errors import InvalidModelError
from mmrs_core.grounding.coordinates import ground_of
from mmrs_core.grounding.features import policies_of
from mmrs_core.grounding.frame import fault
from mmrs_core.grounding.parts import part_of
from mmrs_core.languages import behaviour as bl
from mmrs_core.languages.element import Element, container_of, metaclass_of, place_of
from mmrs_core.languages.registry import Registry
from mmrs_core.scene import Name, Position, Value

UNREADABLE = "BL000"
"""Code of the faults that keep a behaviour from being read at all."""

_HELD_ELSEWHERE = frozenset(
    {"name", "task", "rule", "preActions", "postActions", "target", "distance", "heading", "speed"}
)
"""Features of moves that a `Move` holds in fields of its own."""


def program_of(behaviour: bl.Behaviour, *, registry: Registry) -> Program:
    """Return a behaviour as engines use it.

    Args:
        behaviour: a model whose conformance was checked; constraints need not have been.
        registry: of the metamodels that the behaviour may use.

    Raises:
        InvalidModelError: if it breaks what every program keeps (one Start, one Stop, one transition from
            every other move, transitions inside one robot, waits for own slots, unique identifiers,
            known positions); lists every fault with its place.
    """
    return _Reading(behaviour, registry).program()


class _Reading:
    """The reading of one behaviour; what is found wrong gathers in `faults`."""

    def __init__(self, behaviour: bl.Behaviour, registry: Registry) -> None:
        self._behaviour, self._registry = behaviour, registry
        self._place = place_of(behaviour)
        self._ground = ground_of(behaviour, None)
        self.faults: list[Diagnostic] = list(self._ground.faults)

    def program(self) -> Program:
        behaviour = self._behaviour
        everyone = [*behaviour.robots, *behaviour.idleRobots]
        self._refuse_doubles(everyone, [robot.id for robot in everyone], "robot")
        robots = self._robots(behaviour.robots, "robots")
        idle = self._robots(behaviour.idleRobots, "idleRobots")
        if not robots:
            self._add(behaviour, "has no robots")
        if self.faults:
            faults = in_order(self.faults)
            where = self._place.file or "behaviour"
            raise InvalidModelError(f"{where}: the behaviour cannot be read", faults)
        return Program(
            name=behaviour.name or "",
            frame=self._ground.frame,
            robots=robots,
            position_error=behaviour.positionError,
            minimum_separation=behaviour.minimumSeparation,
            reserve=behaviour.reserve,
            accepted_unknowns=tuple(behaviour.acceptedUnknowns),
            idle=idle,
        )

    def _robots(self, robots: Sequence[bl.Robot], feature: str) -> tuple[RobotProgram, ...]:
        return tuple(self._robot(robot, f"/{feature}[{index}]") for index, robot in enumerate(robots))

    def _robot(self, robot: bl.Robot, path: str) -> RobotProgram:
        flowing = _flowing(robot)
        moves = tuple(
            self._move(move, f"{path}/moves[{index}]", index, move in flowing)
            for index, move in enumerate(robot.moves)
        )
        self._refuse_doubles(robot.moves, [move.id for move in moves], "move")
        self._refuse_doubles(robot.slots, [slot.name for slot in robot.slots], "slot")
        if not robot.id:
            self._add(robot, "has no identifier")
        return RobotProgram(
            id=robot.id,
            type_name=robot.typeName,
            travel_mode=robot.travelMode,
            payload=robot.payload,
            home=self._position(robot.home),
            slots=tuple(slot.name for slot in robot.slots),
            moves=moves,
            transitions=self._transitions(robot, path),
            start=self._only(robot, bl.Start),
            stop=self._only(robot, bl.Stop),
            policies=policies_of(robot),
            place=self._at(robot, path),
        )

    def _move(self, move: bl.Move, path: str, index: int, flows: bool) -> Move:
        goes = move if isinstance(move, bl.GoTo) else None
        turns = move.heading if isinstance(move, bl.GoTo | bl.HeadTo) else None
        if isinstance(move, bl.GoTo) and move.target is None:
            self._add(move, "goes to no target")
        if isinstance(move, bl.HeadTo) and move.heading is None:
            self._add(move, "has no heading to turn to")
        return Move(
            id=move.name or f"moves.{index}",
            metaclasses=self._metaclasses(move),
            attributes=dict(self._attributes(move)),
            target=self._target(goes.target) if goes is not None and goes.target is not None else None,
            distance=goes.distance if goes is not None else 0.0,
            heading=self._heading(turns) if turns is not None else None,
            speed=goes.speed if goes is not None else None,
            before=self._actions(move.preActions, f"{path}/preActions"),
            after=self._actions(move.postActions, f"{path}/postActions"),
            flows=flows,
            task=move.task or "",
            rule=move.rule or "",
            place=self._at(move, path),
        )

    def _attributes(self, move: bl.Move) -> Iterator[tuple[str, Value]]:
        """Yield the features that plug-ins and moves of their own kind have, by name."""
        for feature in metaclass_of(move).features:
            if feature.name in _HELD_ELSEWHERE or feature.is_container:
                continue
            found: object = getattr(move, feature.attribute)
            values = tuple(found) if isinstance(found, list | tuple) else (found,)
            plain = tuple(self._value(value) for value in values)
            yield feature.name, plain if feature.many else plain[0]

    def _value(self, value: object) -> Value:
        if isinstance(value, Element):
            if isinstance(value, bl.Coordinate):
                return self._position(value)
            return part_of(value, self._ground)
        return value if value is None or isinstance(value, bool | int | float | str) else str(value)

    def _target(self, target: bl.Target) -> MoveTarget:
        name = target.name or ""
        if isinstance(target, bl.ObjectTarget):
            return MoveTarget(self._position(target.expectedAt), target.description, target.tolerance, name)
        if not isinstance(target, bl.Coordinate):
            self._add(target, "is a target of an unknown kind")
            return MoveTarget(None, name=name)
        return MoveTarget(self._position(target), name=name)

    def _position(self, coordinate: bl.Coordinate | None) -> Position | None:
        """Return where a coordinate lies; None for none, and for one with a fault."""
        if coordinate is not None and container_of(coordinate) is not self._behaviour:
            self._add(coordinate, "is not a target of this behaviour")
        return self._ground.positions.get(coordinate) if coordinate is not None else None

    def _heading(self, heading: bl.Heading) -> Heading | None:
        if heading.target is None:
            self._add(heading, "points at no target")
            return None
        return Heading(self._target(heading.target), heading.deviceId or "", heading.angle)

    def _actions(self, actions: Iterable[bl.Action], path: str) -> tuple[Action, ...]:
        return tuple(self._action(action, f"{path}[{index}]") for index, action in enumerate(actions))

    def _action(self, action: bl.Action, path: str) -> Action:
        metaclasses, place = self._metaclasses(action), self._at(action, path)
        name = action.name or ""
        if isinstance(action, bl.DeviceAction):
            pairs = tuple((pair.key, pair.value) for pair in action.parameters)
            return Action(metaclasses, action.actionName, action.deviceId, pairs, place=place)
        if isinstance(action, bl.Feedback):
            pairs = tuple((pair.key, pair.value) for pair in action.payload)
            return Action(metaclasses, name, parameters=pairs, place=place)
        if isinstance(action, bl.Notify):
            try:
                sets = slots_set_by(action, self._behaviour)
            except ValueError as error:
                self._add(action, str(error))
                sets = ()
            return Action(metaclasses, name, sets=sets, active=action.active, place=place)
        return Action(metaclasses, name, place=place)

    def _transitions(self, robot: bl.Robot, path: str) -> dict[int, Transition]:
        index = {move: number for number, move in enumerate(robot.moves)}
        found: dict[int, Transition] = {}
        for number, transition in enumerate(robot.moveTransitions):
            made = self._transition(transition, robot, index, f"{path}/moveTransitions[{number}]")
            if made is None:
                continue
            if made.source in found:
                self._add(transition, "leaves a move that another transition leaves already")
            found.setdefault(made.source, made)
        for move, number in index.items():
            if number not in found and not isinstance(move, bl.Stop):
                self._add(move, "is followed by no move, and is not a Stop")
        return found

    def _transition(
        self, transition: bl.MoveTransition, robot: bl.Robot, index: dict[bl.Move, int], path: str
    ) -> Transition | None:
        choice = transition if isinstance(transition, bl.Choice) else None
        ends = [("from", transition.from_), ("to", transition.to)]
        if choice is not None:
            ends.append(("falseBranch", choice.falseBranch))
        astray = [name for name, move in ends if move is None or move not in index]
        for name in astray:
            self._add(transition, f"has no move of robot '{robot.id}' at '{name}'")
        for slot in transition.waitFor:
            if container_of(slot) is not robot:
                self._add(transition, f"waits for slot '{slot.name}', which robot '{robot.id}' does not have")
        if astray:
            return None
        if isinstance(transition.from_, bl.Stop) or any(isinstance(move, bl.Start) for _, move in ends[1:]):
            self._add(transition, "leaves a Stop or leads into a Start")
        return Transition(
            source=index[transition.from_],
            to=index[transition.to],
            waits=tuple(dict.fromkeys(slot.name for slot in transition.waitFor)),
            fluid=transition.fluid,
            condition=choice.conditionIdentifier if choice is not None else None,
            otherwise=index[choice.falseBranch] if choice is not None else None,
            policies=policies_of(transition),
            place=self._at(transition, path),
        )

    def _only(self, robot: bl.Robot, kind: type[bl.Start] | type[bl.Stop]) -> int:
        found = [index for index, move in enumerate(robot.moves) if isinstance(move, kind)]
        if len(found) != 1:
            self._add(robot, f"has {len(found)} moves of kind {kind.__name__}, expected one")
        return found[0] if found else 0

    def _metaclasses(self, element: Element) -> tuple[Name, ...]:
        """Return what an element is; its metamodel must be among the registry's."""
        try:
            ancestry = metaclass_of(element).ancestry
            self._registry.metaclass(*ancestry[0])
        except ValueError as error:
            self._add(element, f"cannot be understood: {error}")
            return ()
        return ancestry

    def _refuse_doubles(self, elements: Iterable[Element], ids: list[str], what: str) -> None:
        counts = Counter(ids)
        for element, id in zip(elements, ids, strict=True):
            if counts[id] > 1:
                self._add(element, f"is one of {counts[id]} named '{id}': a {what}'s name must be unique")

    def _at(self, element: Element, path: str) -> Place:
        # place_of would look for the element in its list, which takes quadratic time over all moves.
        return Place(self._place.file, element._mmrs_line, path)

    def _add(self, element: Element, message: str) -> None:
        self.faults.append(fault(element, message, code=UNREADABLE))


def _flowing(robot: bl.Robot) -> set[bl.Move | None]:
    return {
        move
        for transition in robot.moveTransitions
        if transition.fluid
        for move in (transition.from_, transition.to)
    }


def slots_set_by(notify: bl.Notify, behaviour: bl.Behaviour) -> tuple[SlotId, ...]:
    """Return the (robot, slot) pairs that a notify sets, each once.

    A unicast sets its slot, a multicast its slots in their order, a broadcast the slot of that name
    in every robot that has one, the sender included, in the order of the robots.

    Raises:
        ValueError: if it refers to no slot of a robot, or is of an unknown kind.
    """
    if isinstance(notify, bl.UnicastNotify):
        return (_slot_id(notify.slot),)
    if isinstance(notify, bl.MulticastNotify):
        if not notify.slots:
            raise ValueError("notifies no slot")
        return tuple(dict.fromkeys(_slot_id(slot) for slot in notify.slots))
    if isinstance(notify, bl.BroadcastNotify):
        name = _slot_id(notify.slot)[1]
        return tuple((robot.id, name) for robot in behaviour.robots if _has_slot(robot, name))
    raise ValueError("is a notify of an unknown kind")


def _slot_id(slot: bl.Slot | None) -> SlotId:
    owner = container_of(slot) if slot is not None else None
    if slot is None or not isinstance(owner, bl.Robot):
        raise ValueError("notifies a slot that no robot has")
    return owner.id, slot.name


def _has_slot(robot: bl.Robot, name: str) -> bool:
    return any(slot.name == name for slot in robot.slots)
