"""Small behaviours made by hand: for tests of what reads, runs or checks behaviours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from mmrs_core.behaviour.program import (
    BEHAVIOUR,
    Action,
    Move,
    MoveTarget,
    Program,
    RobotProgram,
    SlotId,
    Transition,
)
from mmrs_core.scene import (
    Battery,
    Capability,
    Device,
    DeviceAction,
    Frame,
    Part,
    Policy,
    Position,
    RobotType,
)

ROBOT_TYPE = "plain"
MOVE = (BEHAVIOUR, "Move")


def go(id: str, to: Position, **more: object) -> Move:
    """Return a GoTo; keywords are those of `Move`."""
    return Move(id, ((BEHAVIOUR, "GoTo"), MOVE), target=MoveTarget(to), **more)  # type: ignore[arg-type]


def hold(id: str, seconds: float = 1.0, **more: object) -> Move:
    """Return a HoldPosition; keywords are those of `Move`."""
    kind = ((BEHAVIOUR, "HoldPosition"), MOVE)
    return Move(id, kind, {"duration": seconds}, **more)  # type: ignore[arg-type]


def notify(*slots: str | SlotId, active: bool = True) -> Action:
    """Return a notify of slots, also given as ``robot.slot``."""
    kind = "UnicastNotify" if len(slots) == 1 else "MulticastNotify"
    sets = tuple(slot_id(slot) if isinstance(slot, str) else slot for slot in slots)
    return Action(((BEHAVIOUR, kind), (BEHAVIOUR, "Notify")), sets=sets, active=active)


def use(device: str, action: str) -> Action:
    """Return a device action."""
    return Action(((BEHAVIOUR, "DeviceAction"), (BEHAVIOUR, "Action")), action, device)


def slot_id(text: str) -> SlotId:
    """Return the slot that is written as ``robot.slot``."""
    robot, _, slot = text.partition(".")
    return robot, slot


def robot(
    id: str,
    moves: Sequence[Move],
    *,
    waits: Mapping[str, Sequence[str]] | None = None,
    choices: Mapping[str, tuple[str, str, str]] | None = None,
    jumps: Mapping[str, str] | None = None,
    fluid: Sequence[str] = (),
    slots: Sequence[str] = (),
    home: Position | None = (0.0, 0.0, 0.0),
    policies: tuple[Policy, ...] = (),
    wait_policies: Mapping[str, tuple[Policy, ...]] | None = None,
) -> RobotProgram:
    """Return a robot that makes these moves one after another, between Start and Stop.

    Args:
        id: of the robot.
        moves: between ``start`` and ``stop``.
        waits: by move: names of the slots that it waits for after it.
        choices: by move: (condition, next move, next move otherwise).
        jumps: by move: the next move, where that is not the one after it.
        fluid: moves whose transition is fluid.
        slots: beside those that are waited for.
        home: of the robot.
        policies: of the robot. wait_policies: by move: of the transition after it.
    """
    start = Move("start", ((BEHAVIOUR, "Start"), MOVE))
    stop = Move("stop", ((BEHAVIOUR, "Stop"), MOVE))
    every = (start, *moves, stop)
    index = {move.id: number for number, move in enumerate(every)}
    transitions = {}
    for number, move in enumerate(every[:-1]):
        condition, to, otherwise = (choices or {}).get(move.id, (None, None, None))
        target = to or (jumps or {}).get(move.id)
        transitions[number] = Transition(
            number,
            index[target] if target else number + 1,
            tuple((waits or {}).get(move.id, ())),
            move.id in fluid,
            condition,
            index[otherwise] if otherwise else None,
            (wait_policies or {}).get(move.id, ()),
        )
    awaited = [slot for names in (waits or {}).values() for slot in names]
    names = tuple(dict.fromkeys((*awaited, *slots)))
    return RobotProgram(
        id, ROBOT_TYPE, "NORMAL", 0.0, home, names, every, transitions, 0, len(every) - 1, policies
    )


def program(*robots: RobotProgram, surface: float = 0.0) -> Program:
    """Return a local behaviour of these robots."""
    return Program("test", Frame("EPSG:4326", None, None, surface=surface), robots)


def robot_type(
    *,
    speed: tuple[float, float] = (0.0, 4.0),
    lifetime: float | None = 1000.0,
    energy: float = 100_000.0,
    acceleration: float | None = None,
    climb_rate: float | None = 2.0,
    recharge_time: float | None = 60.0,
    devices: Mapping[str, Mapping[str, float]] | None = None,
    attributes: Mapping[str, float] | None = None,
    metaclass: tuple[str, str] = ("urn:mmrs:robot:1.0", "Robot"),
) -> RobotType:
    """Return a robot type; `devices` are seconds by action by device."""
    capability = Capability(0.0, lifetime, speed, acceleration, climb_rate, climb_rate, 90.0)
    made = {
        name: Device(name, {action: DeviceAction(action, seconds) for action, seconds in actions.items()}, {})
        for name, actions in (devices or {}).items()
    }
    batteries = (Battery(energy, recharge_time),) if energy else ()
    part = Part((metaclass,), dict(attributes or {}))
    return RobotType(ROBOT_TYPE, (metaclass,), (), 0.5, None, (capability,), batteries, made, part)
