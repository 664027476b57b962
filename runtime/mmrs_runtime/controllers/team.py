"""The program of a process: its own robots, and what these must know of all others of their mission."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from .. import program as runtime
from ..program import Move, Notify, SlotId
from .words import Robot

ELSEWHERE = "elsewhere"
"""The one move that is known of a robot that another process runs."""


def program_of(robots: Sequence[Robot]) -> runtime.Program:
    """Return the program of these robots, with those of other processes as far as they are known."""
    own = {robot.id: robot.executable for robot in robots}
    names = [*own, *_strangers(robots)]
    notifies: dict[str, list[Notify]] = {name: [] for name in names}
    slots: dict[str, list[str]] = {name: [] for name in names}
    for robot in robots:
        for told, active in ((robot.senders, True), (robot.resets, False)):
            for sender, slot in _told(robot.id, told):
                notifies[sender].append(Notify((slot,), active))
        for owner, name in robot.volatile:
            notifies[owner].append(Notify(((owner, name),), active=False))
        for notify in robot.executable.notifies:
            for owner, name in notify.slots:
                slots[owner].append(name)
    return runtime.Program(
        tuple(own.get(name) or _stranger(name, notifies[name], slots[name]) for name in names),
        name=robots[0].mission,
        fingerprint=robots[0].plan,
    )


def _strangers(robots: Sequence[Robot]) -> list[str]:
    here = {robot.id for robot in robots}
    return sorted({each for robot in robots for each in (*robot.fleet, *_contacts(robot))} - here)


def _contacts(robot: Robot) -> set[str]:
    told = {sender for side in (robot.senders, robot.resets) for sender, _ in _told(robot.id, side)}
    return told | {owner for notify in robot.executable.notifies for owner, _ in notify.slots}


def _told(owner: str, side: Iterable[tuple[str, tuple[str, ...]]]) -> Iterable[tuple[str, SlotId]]:
    return ((sender, (owner, name)) for name, senders in side for sender in senders)


def _stranger(name: str, notifies: Sequence[Notify], slots: Sequence[str]) -> runtime.ExecutableRobot:
    move = Move(ELSEWHERE, before=tuple(notifies))
    return runtime.ExecutableRobot(name, (move,), ELSEWHERE, tuple(dict.fromkeys(slots)))
