"""Where a robot is in its program, by its log: so that it can go on after a break."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from mmrs_runtime.faults import Refused
from mmrs_runtime.records.steps import StepRecord, merge

from ..places import at_height, ends_of
from ..program import (
    Choose,
    GoTo,
    Land,
    Local,
    Notify,
    Object,
    Operate,
    Place,
    Recharge,
    Robot,
    Step,
    TakeOff,
    Then,
)
from ..vehicles.footing import footing

CAMERA_STATES = {206: 206, 2500: 2500, 2501: 2500}
"""Commands after which a camera goes on by itself, and which of them concern the same."""


@dataclass(frozen=True, slots=True)
class Progress:
    """Where a robot is in its program.

    Attributes:
        move: that it is at.
        before, after: how many of its actions before and after the movement are done.
        begun, ended: whether the movement is.
        over: why nothing follows any more; empty where something does.
    """

    move: str
    before: int = 0
    begun: bool = False
    ended: bool = False
    after: int = 0
    over: str = ""

    def then(self, label: str, detail: str, step: Step) -> Progress:
        """Return where the robot is after a step of its log, made at the move `step`."""
        if label in ("act", "ntf"):
            when, _, index = detail.partition(":")
            done = int(index) + 1
            return self._maybe_over(
                replace(self, before=done) if when == "pre" else replace(self, after=done), step
            )
        if label == "begin":
            return replace(self, begun=True)
        if label == "end":
            return self._maybe_over(replace(self, ended=True), step)
        if label == "fault":
            return replace(self, over=f"it has ended by {detail}")
        return Progress(_next(label, detail, step))

    def _maybe_over(self, made: Progress, step: Step) -> Progress:
        if step.then is None and made.ended and made.after == len(step.after):
            return replace(made, over="it has come to its end")
        return made


def progress_of(robot: Robot, records: Iterable[StepRecord]) -> Progress:
    """Return where a robot is after the steps of its log.

    Raises:
        Refused: the log is of another program.
    """
    steps = {step.move: step for step in robot.steps}
    here = Progress(robot.start)
    for number, record in enumerate(records, start=1):
        if record.move != here.move or here.over:
            raise Refused(f"line {number} of the log is no step of this program after those before it")
        try:
            here = here.then(record.label, record.detail, steps[here.move])
        except (ValueError, KeyError) as error:
            raise Refused(f"line {number} of the log is no step of this program") from error
    return here


def track_of(robot: Robot, records: Iterable[StepRecord]) -> list[tuple[str, Place]]:
    """Return the places that a robot has passed in its present sortie, with the moves that ended there.

    Raises:
        Refused: it went to an object, and nobody knows where that was.
    """
    return _sortie(robot, records)[1]


def began_at(robot: Robot, records: Iterable[StepRecord]) -> Place:
    """Return where a robot's present sortie began: where its program has landed last; else its home.

    Raises:
        Refused: it went to an object, and nobody knows where that was.
    """
    return _sortie(robot, records)[0]


def starts_of(robot: Robot, records: Sequence[StepRecord]) -> tuple[Place, ...]:
    """Return where a robot may stand whose log ends with these steps, if it stands on the ground.

    That is where its sortie began; or, where it was to land last, there.

    Raises:
        Refused: it went to an object, and nobody knows where that was.
    """
    began = footing(robot.home, began_at(robot, records))
    if not records or not is_landing(robot, records[-1]):
        return (began,)
    landed = [*records, replace(records[-1], label="end")]
    return began, footing(robot.home, began_at(robot, landed))


def is_landing(robot: Robot, last: StepRecord) -> bool:
    """Return whether a robot was to land when its log ended with that step."""
    return last.label == "begin" and isinstance(robot.step(last.move).movement, Land)


def _sortie(robot: Robot, records: Iterable[StepRecord]) -> tuple[Place, list[tuple[str, Place]]]:
    steps = {step.move: step.movement for step in robot.steps}
    began = here = robot.home
    track: list[tuple[str, Place]] = []
    for record in records:
        move = record.move
        movement = steps[move]
        if record.label == "begin" and isinstance(movement, TakeOff):
            track = []
        if record.label != "end":
            continue
        if isinstance(movement, TakeOff):
            here = at_height(began, movement.height)
            track = [(move, here)]
        elif isinstance(movement, Land | Recharge):
            began, track = at_height(here, robot.home.height), []
        elif isinstance(movement, GoTo):
            here = track[-1][1] if track else began
            track += [] if track else [(move, here)]
            track += [(move, place) for place in _ends(here, movement)]
            here = track[-1][1]
    return began, track


def slots_of(robots: Iterable[Robot], records: Iterable[StepRecord]) -> tuple[set[tuple[str, str]], int]:
    """Return the slots that are active after the steps of these robots, and the last logical time."""
    steps = {(robot.id, step.move): step for robot in robots for step in robot.steps}
    active: set[tuple[str, str]] = set()
    last = 0
    for record in merge(records):
        last = record.lamport
        if record.label == "ntf":
            action = steps[record.robot, record.move].action(record.detail)
            assert isinstance(action, Notify)
            active = active | set(action.slots) if action.active else active - set(action.slots)
    return active, last


def still_on(robot: Robot, records: Iterable[StepRecord]) -> Iterator[Operate]:
    """Yield what has to be told a camera again, since it went on by itself before the break."""
    steps = {step.move: step for step in robot.steps}
    last: dict[tuple[str, int], Operate] = {}
    for record in records:
        if record.label != "act":
            continue
        action = steps[record.move].action(record.detail)
        if isinstance(action, Operate) and action.command in CAMERA_STATES:
            last[action.device, CAMERA_STATES[action.command]] = action
    yield from last.values()


def _next(label: str, detail: str, step: Step) -> str:
    if label == "take" and isinstance(step.then, Then):
        return step.then.move
    if label == "choose" and isinstance(step.then, Choose):
        return step.then.move if detail == "true" else step.then.otherwise
    raise ValueError(label)


def _ends(here: Place, movement: GoTo) -> tuple[Place, ...]:
    target = movement.at
    if isinstance(target, Object):
        if target.expected is None:
            raise Refused(f"object {target.description!r}: nobody knows where it was; start afresh")
        target = target.expected
    if isinstance(here, Local) != isinstance(target, Local):
        raise Refused(f"{target}: is not in the frame of the robot's home")
    return ends_of(here, target, movement.legs, movement.distance)
