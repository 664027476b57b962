"""Processes on a bus in a made-up world: time stands still until told, and messages go astray.

Robots step through behaviours by the rules, and log what they do; whatever happens to processes and
messages, the logs together must be a trace of the behaviour.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from random import Random

from mmrs_core.behaviour.program import Program
from mmrs_runtime.bus import CommandId, Node, Recorded
from mmrs_runtime.bus.program_bus import members_of
from mmrs_runtime.records.steps import StepRecord
from mmrs_runtime.semantics import awaited, entry, steps

RUN = "run-0"


class MemoryDisk:
    """A journal that survives its process."""

    def __init__(self):
        self.kept = []

    def lines(self):
        yield from tuple(self.kept)

    def keep(self, line):
        self.kept.append(json.loads(json.dumps(line)))


@dataclass
class Flying:
    """A message on its way; a reply where `answered` is called with the text."""

    process: Process
    peer: Process | None
    owner: str
    sender: str
    text: str
    answered: Callable[[str], None]
    reply: bool = False


class Post:
    """A carrier that hands everything over to the world."""

    def __init__(self, world, process):
        self.world, self.process = world, process
        self.station = None

    def open(self, station):
        self.station = station
        for other in self.world.processes:
            if other is not self.process and other.alive and not self.world.is_cut(self.process, other):
                for robot in other.robots:
                    station.noticed(robot, True)

    def ask(self, sender, owner, request, answered):
        flying = Flying(self.process, None, owner, sender, request, self._only_now(answered))
        self.world.flying.append(flying)
        self.world.said.add(json.loads(request)["do"])

    def _only_now(self, answered):
        life = self.process.life
        return lambda text: answered(text) if self.process.life == life and self.process.alive else None

    def appear(self, robot):
        self.world.tell(self.process, robot, True)

    def vanish(self, robot):
        self.world.tell(self.process, robot, False)

    def publish(self, robot):
        pass

    def close(self):
        pass


class Walker:
    """A robot that steps through its program; `step` makes half a step, as far as it can."""

    def __init__(self, program, process, disk, chance):
        self.program, self.process, self.log, self.chance = program, process, disk, chance
        self.point = entry(program, program.start)
        self.lamport, self.active = 0, True
        self.delivery = None
        for record in self.log:
            self.follow(record)

    def follow(self, record):
        self.lamport = record.lamport
        everything = {(self.program.id, name) for name in self.program.slots}
        for step in steps(self.program, self.point, everything):
            if (step.label, step.detail) == (record.label, record.detail):
                self.point = step.leads_to
                return
        raise AssertionError(record)

    @property
    def node(self):
        return self.process.node

    def step(self):
        if self.delivery is not None:
            return self._deliver()
        if self.point.is_final:
            self.node.leave(self.program.id)
            return False
        waits = awaited(self.program, self.point)
        active = {slot for slot in waits if self.node.state(slot).active}
        possible = steps(self.program, self.point, active)
        if not possible:
            return False
        step = self.chance.choice(possible)
        if step.sets:
            id = CommandId(RUN, self.program.id, self.node.incarnation, len(self.log))
            self.delivery = (self.node.prepare(id, step.sets, step.active), step, False)
            return True
        clocks = [self.node.state(slot).lamport + 1 for slot in waits]
        lamport = max(self.lamport + 1, *clocks, 0)
        if waits and not self.node.passed(waits, lamport):
            return False
        self._write(step, lamport)
        return True

    def _deliver(self):
        delivery, step, sent = self.delivery
        if sent == "logged":
            delivery.send(self.lamport)
            self.delivery = (delivery, step, "sent")
            return True
        if sent == "sent":
            if delivery.waiting:
                return False
            self.delivery = None
            return True
        if delivery.lamport is None:
            if self.chance.random() < 0.02:
                delivery.abort()
                self.delivery = None
            return False
        self._write(step, max(self.lamport + 1, delivery.lamport))
        self.delivery = (delivery, step, "logged")
        if self.process.world.spoiling and self.chance.random() < 0.1:
            self.process.crash()
        return True

    def _write(self, step, lamport):
        self.log.append(
            StepRecord(
                RUN,
                self.program.id,
                len(self.log),
                lamport,
                100.0 * len(self.log),
                step.label,
                step.move,
                step.detail,
                step.slot,
            )
        )
        self.lamport, self.point = lamport, step.leads_to

    def recorded(self):
        notifies = {}
        for record in self.log:
            if record.label == "ntf":
                for slot in record.slot[1:].split():
                    notifies[tuple(slot.split(".", 1))] = (record.slot[0] == "+", record.lamport)
        return Recorded(self.log[-1].lamport if self.log else 0, notifies)


class Process:
    """One process, with the disk that survives it."""

    def __init__(self, world, robots):
        self.world, self.robots = world, [robot.id for robot in robots]
        self._programs = robots
        self._disks = {robot.id: MemoryDisk() for robot in robots}
        self.logs = {robot.id: [] for robot in robots}
        self.alive, self.life = False, 0
        self.node = None
        self.walkers = []

    def start(self):
        again = self.life > 0
        self.life += 1
        self.walkers = [
            Walker(robot, self, self.logs[robot.id], self.world.chance) for robot in self._programs
        ]
        recorded = {walker.program.id: walker.recorded() for walker in self.walkers} if again else None
        self.alive = True
        self.node = Node(
            [self.world.members[robot] for robot in self.robots],
            RUN,
            carrier=Post(self.world, self),
            journals=self._disks.__getitem__,
            recorded=recorded,
            now=lambda: self.world.time,
            threaded=False,
            chance=self.world.chance,
        )

    def crash(self):
        self.alive = False
        for robot in self.robots:
            self.world.tell(self, robot, False)


@dataclass
class World:
    """All processes, and what is on its way between them."""

    program: Program
    chance: Random
    processes: list[Process] = field(default_factory=list)
    flying: list[Flying] = field(default_factory=list)
    cuts: set[frozenset[int]] = field(default_factory=set)
    time: float = 0.0
    spoiling: bool = True
    said: set[str] = field(default_factory=set)

    def __post_init__(self):
        self.members = members_of(self.program.executable)
        robots = list(self.program.executable.robots)
        while robots:
            taken = min(len(robots), self.chance.choice((1, 1, 2)))
            self.processes.append(Process(self, robots[:taken]))
            del robots[:taken]

    def is_cut(self, one, other):
        return frozenset((id(one), id(other))) in self.cuts

    def tell(self, process, robot, here):
        for other in self.processes:
            if (
                other is not process
                and other.alive
                and other.node is not None
                and not self.is_cut(process, other)
            ):
                other.node.noticed(robot, here)

    def cut(self, one, other):
        self.cuts.add(frozenset((id(one), id(other))))
        self._notice(one, other, False)

    def heal(self, one, other):
        self.cuts.discard(frozenset((id(one), id(other))))
        self._notice(one, other, True)

    def _notice(self, one, other, here):
        if one.alive and other.alive:
            for robot in one.robots:
                other.node.noticed(robot, here)
            for robot in other.robots:
                one.node.noticed(robot, here)

    def owner_of(self, robot):
        return next(process for process in self.processes if robot in process.robots)

    def deliver(self, message):
        target = message.peer or self.owner_of(message.owner)
        if self.is_cut(message.process, target):
            return
        if message.reply:
            message.answered(message.text)
        elif target.alive:
            text = target.node.serve(message.owner, message.sender, message.text)
            self.flying.append(
                Flying(message.process, target, message.owner, message.sender, text, message.answered, True)
            )

    def pump(self):
        for process in self.processes:
            if process.alive:
                process.node.pump()

    def records(self):
        return [record for process in self.processes for log in process.logs.values() for record in log]


def spoil(world: World, faults: int) -> None:
    """Let robots step while messages and processes suffer so many faults, then let everything settle."""
    chance = world.chance
    for process in world.processes:
        if chance.random() < 0.8:
            process.start()
    while faults > 0:
        kind = chance.random()
        process, other = chance.choice(world.processes), chance.choice(world.processes)
        if kind < 0.45:
            if process.alive and process.walkers:
                chance.choice(process.walkers).step()
        elif kind < 0.75 and world.flying:
            world.deliver(world.flying.pop(chance.randrange(len(world.flying))))
        elif kind < 0.83:
            world.time += chance.choice((0.01, 0.1, 0.7, 2.0, 12.0))
            world.pump()
        else:
            faults -= _fault(world, process, other, chance)
    _settle(world)


def _fault(world, process, other, chance):
    kind = chance.random()
    if kind < 0.3 and world.flying:
        world.flying.pop(chance.randrange(len(world.flying)))
    elif kind < 0.5 and world.flying:
        again = chance.choice(world.flying)
        world.flying.append(again)
    elif kind < 0.6 and process is not other:
        (world.heal if world.is_cut(process, other) else world.cut)(process, other)
    elif kind < 0.8 and process.alive:
        process.crash()
    elif not process.alive:
        process.start()
    else:
        return 0
    return 1


def _settle(world):
    world.spoiling = False
    for one in world.processes:
        for other in world.processes:
            if world.is_cut(one, other):
                world.heal(one, other)
    for process in world.processes:
        if not process.alive:
            process.start()
    idle = 0
    while idle < 200:
        moved = False
        for process in world.processes:
            for walker in process.walkers:
                while walker.step():
                    moved = True
        world.pump()
        while world.flying:
            world.deliver(world.flying.pop(0))
            moved = True
        world.time += 0.3
        idle = (
            0
            if moved
            and any(w.delivery or not w.point.is_final for p in world.processes for w in p.walkers)
            and _changed(world)
            else idle + 1
        )


def _changed(world):
    now = sum(len(log) for process in world.processes for log in process.logs.values())
    before, world.made = getattr(world, "made", -1), now
    return now != before
