"""What templates see of a robot's behaviour."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from math import isfinite

from auv_vessel.eyes import owner_of
from auv_vessel.goals import SLOWEST
from auv_vessel.refusals import MOST_SPEED
from auv_vessel.sheet import afloat_of
from mmrs_auv.names import IN_WATER_SIZE
from mmrs_auv.sayable import mount_of, parameter_of
from mmrs_auv.sheets import action_number
from mmrs_auv.targets.ada import policies as answers
from mmrs_auv.targets.ada.refusals import SORTS, of_action, of_movement
from mmrs_core.behaviour.program import (
    DEVICE_ACTION,
    NOTIFY,
    Action,
    Move,
    MoveTarget,
    Program,
    RobotProgram,
    SlotId,
    Transition,
)
from mmrs_core.behaviour.travel import capability_of, cruise_of
from mmrs_core.contributions.targets import TracedStep
from mmrs_core.generation.context import RobotContext
from mmrs_core.generation.plan_moves import seconds_of
from mmrs_core.scene import Part, Policy, Position
from mmrs_runtime.conditions import BATTERY, DETECTED, FOUND, is_standard
from mmrs_runtime.faults import DEVICE_SILENT
from mmrs_runtime.policies import AFTER, patience
from mmrs_runtime.program import Notify
from mmrs_runtime.records.steps import log_name
from mmrs_runtime.semantics import slot_text

KINDS: Mapping[str, str] = {
    "start": "Starts", "go": "Goes", "hold": "Holds", "charge": "Charges", "turn": "Turns", "stop": "Stops",
}  # fmt: skip

UNITS: Mapping[str, str] = {DETECTED: "Sight", FOUND: "Sightings"}
"""What decides standard conditions."""


class Mission:
    """A robot's behaviour as its decision centre holds it."""

    def __init__(
        self, context: RobotContext, program: Program, policies: Sequence[Policy], step: float
    ) -> None:
        """Create the view of a robot.

        Args:
            context: of the robot.
            program: of all robots.
            policies: of the robot, the first for an event counts.
            step: metres of depth in a step on its bus; 0: its type does not define its depth.
        """
        self._context, self._program, self._policies = context, program, tuple(policies)
        self._step = step
        robot = context.robot
        self._tasks = tuple(dict.fromkeys(move.task for move in robot.moves if move.task))
        self._slots = {slot: number for number, slot in enumerate(robot.slots, start=1)}

    def view(self) -> Mapping[str, object]:
        """Return what the template of the mission sees."""
        robot = self._context.robot
        return {
            "id": _json(robot.id),
            "eyes": _json(owner_of(robot.id)),
            "name": robot.id,
            "mission": self._program.name,
            "log": log_name(robot.id),
            "step": self._step,
            "reserve": float(self._program.reserve),
            "cruise": self._cruise(),
            "surface": float(self._program.frame.surface),
            "policies": answers.view(self._policies),
            "afloat": self._afloat(),
            "floats": self._floats(),
            "alone": are_apart(self._program),
            "robots": json.dumps([each.id for each in self._program.robots]),
            "start": robot.start + 1,
            "slots": tuple(map(_json, robot.slots)),
            "tasks": self._tasks,
            "moves": [self._move(index, move) for index, move in enumerate(robot.moves)],
        }

    def conditions(self) -> Mapping[str, object]:
        """Return what the template of conditions sees: each, and the steps after which it is asked for."""
        robot = self._context.robot
        asked: dict[str, list[TracedStep]] = {}
        for index, transition in robot.transitions.items():
            if transition.condition is not None:
                asked.setdefault(transition.condition, []).append(self._trace(robot.moves[index]))
        found = [{"id": id, "steps": tuple(steps), **_standard(id)} for id, steps in asked.items()]
        units = [unit for word, unit in UNITS.items() if any(each["word"] == word for each in found)]
        return {"conditions": found, "units": units}

    def undecided(self) -> tuple[str, ...]:
        """Return the conditions that the user has to decide."""
        found = (each.condition for each in self._context.robot.transitions.values())
        return tuple(dict.fromkeys(each for each in found if each and not _standard(each)["word"]))

    def _move(self, index: int, move: Move) -> Mapping[str, object]:
        transition = self._context.robot.transitions.get(index)
        special = (*transition.policies, *self._policies) if transition and transition.policies else ()
        return {
            "kind": KINDS[self._sort(move)],
            "way": _kind_of_way(transition),
            "trace": self._trace(move),
            "features": [*self._features(move), *_way(transition), *self._waits(transition)],
            "policies": answers.view(special) if special else {"bears": (), "answer": ()},
            "actions": [
                *(("Before", self._action(each, f"pre:{n}")) for n, each in enumerate(move.before)),
                *(("After", self._action(each, f"post:{n}")) for n, each in enumerate(move.after)),
            ],
            "waits": [self._slots[slot] for slot in transition.waits] if transition is not None else [],
        }

    def _sort(self, move: Move) -> str:
        """Return what sort of move it is; one that cannot be made holds for no time."""
        return "hold" if any(of_movement(move, self._context, self._step)) else SORTS[move.metaclasses[0]]

    def _features(self, move: Move) -> Iterator[tuple[str, object]]:
        yield "Id", _json(move.id)
        yield "Name", move.id
        if move.task:
            yield "Task_Number", self._tasks.index(move.task) + 1
        sort = self._sort(move)
        if sort == "go" and move.target is not None and move.target.position is not None:
            yield "Target", self._place(move.target.position)
            yield "Away", float(move.distance)
            yield "Speed", self._speed(move)
            yield from self._object(move, move.target)
        if sort in ("go", "turn") and move.heading is not None and move.heading.target.position is not None:
            yield "Looks", True
            yield "Seen", self._place(move.heading.target.position)
            yield "Angle", move.heading.angle_degrees + mount_of(move.heading.device, self._context.type)
        if sort in ("hold", "charge"):
            yield "Seconds", _duration(move)

    def _object(self, move: Move, target: MoveTarget) -> Iterator[tuple[str, object]]:
        """Yield facts about the object that a move leads to."""
        if target.description is None:
            return
        yield "Object", _json(target.description)
        if target.tolerance is not None:
            yield "Tolerance", float(target.tolerance)
        looked_at = move.heading.target.description if move.heading is not None else None
        yield "Looks_At_It", looked_at == target.description

    def _speed(self, move: Move) -> float:
        """Return metres per second, no more than the vehicle can, or its bus can say."""
        fastest = self._speeds[1] if self._speeds is not None else MOST_SPEED
        return _sayable(min(self._context.speed(move) or 0.0, fastest))

    def _cruise(self) -> float:
        """Return metres per second at which the vehicle goes back; 0: as it likes."""
        return _sayable(cruise_of(self._context.robot, self._context.type) or 0.0)

    @property
    def _speeds(self) -> tuple[float, float] | None:
        type = self._context.type
        capability = capability_of(self._context.robot, type) if type is not None else None
        return capability.speed if capability is not None else None

    def _waits(self, transition: Transition | None) -> Iterator[tuple[str, object]]:
        if transition is None:
            return
        if transition.policies:
            yield "Is_Special", True
        if not transition.waits:
            return
        wanted = {(self._context.robot.id, slot) for slot in transition.waits}
        yield "Awaited", json.dumps(transition.waits)
        yield (
            "Senders",
            json.dumps(
                [
                    each.id
                    for each in self._program.robots
                    if each.id != self._context.robot.id and wanted & set(_set_by(each))
                ]
            ),
        )

    def _place(self, position: Position) -> Position:
        """Return metres north, east and below the surface."""
        east, north, up = position
        return (float(north), float(east), float(self._program.frame.surface - up))

    def _action(self, action: Action, detail: str) -> Mapping[str, object]:
        reported: list[tuple[str, object]] = [("Detail", _json(detail))]
        if missing := "; ".join(of_action(action, self._context)):
            return {"kind": "Feedback", "features": [*reported, ("Words", f"is left out: {missing}")]}
        if action.is_a(NOTIFY):
            own = tuple(self._slots[slot] for robot, slot in action.sets if robot == self._context.robot.id)
            reported += [
                ("Slots", _json(slot_text(Notify(action.sets, action.active)))),
                ("Told", json.dumps(action.sets)),
            ]
            return {"kind": "Notify", "features": [*reported, ("Sets", own), ("Active", action.active)]}
        if action.is_a(DEVICE_ACTION) and self._context.type is not None:
            type = self._context.type
            number = action_number(type, action.device, action.name)
            reported += [("Number", list(type.devices).index(action.device)), ("Does", number)]
            answer = patience(DEVICE_SILENT, self._policies)
            waits = seconds_of(action, type) + (AFTER[DEVICE_SILENT] if answer is None else answer)
            reported += [("Parameter", parameter_of(action)), ("Patience", waits)]
            return {"kind": "Device", "features": reported}
        words = " ".join((action.name, *(f"{key}={text}" for key, text in action.parameters)))
        return {"kind": "Feedback", "features": [*reported, ("Words", words)]}

    def _trace(self, move: Move) -> TracedStep:
        return TracedStep(f"move {move.id}", self._context.robot.id, move.id, move.task, move.rule)

    def _afloat(self) -> float:
        """Return the depth above which it is at the surface, metres; 0: its type does not say."""
        height = self._of_size("height")
        return 0.0 if height is None else afloat_of(height)

    def _floats(self) -> bool:
        weight = self._of_size("weightInWater")
        return weight is not None and weight < 0.0

    def _of_size(self, feature: str) -> float | None:
        size = self._context.type.part.attributes.get("size") if self._context.type is not None else None
        found = size.attributes.get(feature) if isinstance(size, Part) and size.is_a(IN_WATER_SIZE) else None
        return float(found) if isinstance(found, int | float) else None


def are_apart(program: Program) -> bool:
    """Return whether no robot sets slots of another."""
    return all(owner == robot.id for robot in program.robots for owner, _ in _set_by(robot))


def _set_by(robot: RobotProgram) -> Iterator[SlotId]:
    """Yield the slots that a robot sets."""
    for move in robot.moves:
        for action in (*move.before, *move.after):
            yield from action.sets


def _standard(condition: str) -> Mapping[str, object]:
    """Return what a standard condition asks; the others are left to the user."""
    word, _, rest = condition.partition(":")
    if is_standard(condition) and word == BATTERY:
        return {"word": "battery", "argument": float(rest)}
    if is_standard(condition) and word in UNITS:
        return {"word": word, "argument": _json(rest)}
    return {"word": ""}


def _sayable(speed: float) -> float:
    """Return a speed that can be said on the bus, where 0 stands for one that the vehicle likes."""
    return min(max(speed, SLOWEST), MOST_SPEED) if speed > 0.0 else 0.0


def _duration(move: Move) -> float:
    """Return how long a move holds or charges; 0 for others, and where that is not a number."""
    found = move.attributes.get("duration")
    known = SORTS.get(move.metaclasses[0]) in ("hold", "charge")
    return float(found) if known and isinstance(found, (int, float)) and isfinite(found) else 0.0


def _kind_of_way(transition: Transition | None) -> str:
    if transition is None:
        return "Ends"
    return "Takes" if transition.otherwise is None else "Chooses"


def _way(transition: Transition | None) -> Iterator[tuple[str, object]]:
    if transition is None:
        return
    yield "To", transition.to + 1
    if transition.otherwise is not None:
        yield "Otherwise", transition.otherwise + 1
        yield "Condition", transition.condition or ""


def _json(text: str) -> str:
    return json.dumps(text)
