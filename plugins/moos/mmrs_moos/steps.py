"""A robot's moves as steps, one after the other: the helm's task, and the event that ends it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import ceil, dist

from mmrs_core.behaviour.earth import metres
from mmrs_core.behaviour.program import DEVICE_ACTION, FEEDBACK, Action, Move, SlotId
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.context import RobotContext
from mmrs_core.generation.plan_moves import (
    DEEPEST,
    MOVES,
    above_surface,
    seconds_of,
    seconds_of_hold,
    writable_speed,
)
from mmrs_core.scene import Position, RobotType
from mmrs_core.transformation.kinds import before_target
from mmrs_moos.words import MESSAGE, variables_of, words_of

POSTS = "moos.post."
"""Property of a device before the name of an action: what is posted, as in ``SONAR=on;RANGE=50``."""

TOLD = "MMRS_FEEDBACK"
"""The variable in which feedback is posted for operators."""

TOLERANCE = 0.5
"""Metres of depth within which a place is reached."""

PIECE = 1.0
"""Metres of depth that one piece of a sloping way takes: so near it keeps to its straight line."""

SHORTEST = 0.1
"""Seconds that a step lasts at least."""

MOST_PIECES = 400
"""Pieces of one sloping way at most."""


@dataclass(slots=True)
class Step:
    """Something that a helm does until it has done it.

    Attributes:
        move: that it serves.
        place: (east, north) where it goes or holds, metres; depth: below the surface.
        speed: metres per second at which it goes there; None: it holds there.
        seconds: for how long it holds.
        waits: conditions that must be met meanwhile, each a variable and its value.
        posts: what is posted at its end.
        ways: (variable, value, step) of a choice; empty: the next step follows.
    """

    id: str
    move: Move
    place: tuple[float, float]
    depth: float
    speed: float | None = None
    seconds: float = 0.1
    waits: tuple[tuple[str, str], ...] = ()
    posts: list[tuple[str, str]] = field(default_factory=list)
    ways: tuple[tuple[str, str, str], ...] = ()
    next: str = ""


@dataclass(frozen=True, slots=True)
class Variables:
    """The variables of a robot.

    Attributes:
        slots: by slot of the robot; conditions: by condition of its choices.
        posts: what is posted to set a slot, by the slot and its value.
    """

    slots: Mapping[str, str]
    conditions: Mapping[str, str]
    posts: Mapping[tuple[SlotId, bool], tuple[str, str]]


def variables_for(context: RobotContext, input: TargetInput, nodes: Mapping[str, str]) -> Variables:
    """Return the variables of a robot; `nodes`: names of the communities of all robots."""
    robot = context.robot
    conditions = {each.condition for each in robot.transitions.values() if each.condition is not None}
    of_all = {each.id: variables_of(each.slots, "MMRS_SLOT_") for each in input.program.robots}
    posts = {
        ((owner, slot), active): _posted(nodes[robot.id], nodes[owner], variable, active)
        for owner, slots in of_all.items()
        for slot, variable in slots.items()
        for active in (True, False)
    }
    return Variables(of_all[robot.id], variables_of(sorted(conditions), "MMRS_IF_"), posts)


def _posted(node: str, owner: str, variable: str, active: bool) -> tuple[str, str]:
    """Return what a community posts to set a slot of its own, or of another."""
    value = str(active).lower()
    if owner == node:
        return variable, value
    return MESSAGE, f"src_node={node},dest_node={owner},var_name={variable},string_val={value}"


@dataclass(frozen=True, slots=True)
class Course:
    """The steps of a robot, and what of its moves they cannot do."""

    steps: tuple[Step, ...]
    faults: tuple[tuple[Move, str], ...]


def course_of(context: RobotContext, variables: Variables) -> Course:
    """Return the steps of a robot, from its start on; of those that come after a choice, one way first."""
    walk = _Walk(context, variables)
    walk.go_through()
    return Course(tuple(walk.steps), tuple(walk.faults))


class _Walk:
    """Goes through a robot's moves, each once."""

    def __init__(self, context: RobotContext, variables: Variables) -> None:
        self._context, self._variables = context, variables
        names = [move.id for move in context.robot.moves]
        self._words = words_of(names, "s_")
        self.steps: list[Step] = []
        self.faults: list[tuple[Move, str]] = []

    def go_through(self) -> None:
        """Make the steps of every move."""
        robot = self._context.robot
        home: Position = robot.home or (0.0, 0.0, 0.0)
        todo, begun = [(robot.start, home)], dict[int, Position]()
        while todo:
            index, here = todo.pop()
            if index in begun:
                self._meet(robot.moves[index], begun[index], here)
                continue
            begun[index] = here
            here = self._perform(index, here)
            transition = robot.transitions.get(index)
            todo += [(way, here) for way in reversed(transition.next_moves)] if transition is not None else []

    def _meet(self, move: Move, one: Position, other: Position) -> None:
        """Note a slope that begins in two places: its pieces lead from one of them only."""
        sloping = sum(each.move is move and each.speed is not None for each in self.steps) > 1
        if dist(one, other) > TOLERANCE and (sloping or abs(one[2] - other[2]) > TOLERANCE):
            self.faults.append((move, "slopes, and begins in two places"))

    def _perform(self, index: int, here: Position) -> Position:
        robot = self._context.robot
        move, transition = robot.moves[index], robot.transitions.get(index)
        first = len(self.steps)
        word = self._words[move.id]
        self._begin(word, move, here)
        self._act(move, move.before, here)
        if MOVES.get(move.metaclasses[0]) == "go" and move.target is not None and move.target.position:
            goal = before_target(here, move.target.position, move.distance)
            here = self._go(word, move, here, goal)
        elif seconds_of_hold(move) > 0.0:
            self._hold(f"{word}_holds", move, here, seconds_of_hold(move))
        self._act(move, move.after, here)
        if transition is not None and transition.waits:
            waits = tuple((self._variables.slots[slot], "true") for slot in transition.waits)
            self._hold(f"{word}_waits", move, here, 0.1).waits = waits
        if transition is not None and transition.condition is not None:
            variable = self._variables.conditions[transition.condition]
            to, otherwise = (self._words[robot.moves[way].id] for way in transition.next_moves)
            chooses = self._hold(f"{word}_chooses", move, here, 0.1)
            chooses.ways = ((variable, "true", to), (variable, "false", otherwise))
        for one, other in zip(self.steps[first:], self.steps[first + 1 :], strict=False):
            one.next = other.id
        if transition is not None and transition.condition is None:
            self.steps[-1].next = self._words[robot.moves[transition.to].id]
        return here

    def _begin(self, word: str, move: Move, here: Position) -> None:
        self._hold(word, move, here, 0.1)

    def _go(self, word: str, move: Move, here: Position, goal: Position) -> Position:
        pieces = max(1, ceil(abs(goal[2] - here[2]) / PIECE))
        if dist(here[:2], goal[:2]) < TOLERANCE:
            pieces = 1
        if pieces > MOST_PIECES:
            self.faults.append((move, f"slopes over more than {MOST_PIECES * PIECE:g} m of depth"))
            pieces = MOST_PIECES
        speed = writable_speed(self._context.speed(move) or TOLERANCE)
        for piece in range(1, pieces + 1):
            east, north, up = (a + (b - a) * piece / pieces for a, b in zip(here, goal, strict=True))
            step = self._hold(f"{word}_goes_{piece}", move, (east, north, up), 0.1)
            step.speed = speed
        return goal

    def _hold(self, id: str, move: Move, here: Position, seconds: float) -> Step:
        depth = min(DEEPEST, max(0.0, -above_surface(here, self._context)))
        step = Step(
            id, move, (metres(here[0]), metres(here[1])), metres(depth), seconds=max(SHORTEST, seconds)
        )
        self.steps.append(step)
        return step

    def _act(self, move: Move, actions: Sequence[Action], here: Position) -> None:
        """Post the actions' messages at the end of the step before, and stay for their duration."""
        for number, action in enumerate(actions):
            posts = posts_of(action, self._context.type, self._variables)
            if isinstance(posts, str):
                continue
            self.steps[-1].posts += posts
            seconds = seconds_of(action, self._context.type) if action.is_a(DEVICE_ACTION) else 0.0
            if seconds:
                sort = "before" if actions is move.before else "after"
                self._hold(f"{self._words[move.id]}_{sort}_{number}", move, here, seconds)


def posts_of(action: Action, type: RobotType | None, variables: Variables) -> list[tuple[str, str]] | str:
    """Return what an action posts, each a variable and its value; or why it posts nothing."""
    if action.sets:
        return [variables.posts[slot, action.active] for slot in action.sets]
    if action.is_a(FEEDBACK):
        said = ",".join([action.name, *(f"{key}={value}" for key, value in action.parameters)])
        return [(TOLD, said)] if _is_plain(said) else f"feedback '{said}' is not plain text"
    if not action.is_a(DEVICE_ACTION):
        return f"action {action.metaclasses[0][1]} has no form in a behaviour file"
    device = type.devices.get(action.device) if type is not None else None
    said = device.properties.get(POSTS + action.name, "") if device is not None else ""
    if not said:
        return f"action '{action.name}': device '{action.device}' has no {POSTS}{action.name}"
    pairs = [each.partition("=") for each in said.split(";")]
    if not all(_is_variable(name.strip()) and _is_plain(value.strip()) for name, _, value in pairs):
        return f"action '{action.name}': {POSTS}{action.name} is '{said}', not NAME=value;NAME=value"
    return [(name.strip(), value.strip()) for name, _, value in pairs]


def _is_variable(name: str) -> bool:
    return name.isascii() and name.replace("_", "a").isalnum() and not name[0].isdigit()


def _is_plain(value: str) -> bool:
    plain = value.isascii() and value.isprintable() and value != ""
    return plain and "//" not in value and not set("{}$") & set(value)
