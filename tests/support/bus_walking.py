"""Robots that step through a behaviour on a bus, each in whatever process and over whatever carrier.

Run as a script, one process of them: ``bus_walking.py BEHAVIOUR ROBOT FOLDER [options]``, where the
behaviour is one of `BEHAVIOURS`.
"""

import argparse
import json
import os
import socket
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from mmrs_core.behaviour.log import read_log
from mmrs_core.behaviour.program import Program
from mmrs_core.testing.small_programs import hold, notify, program, robot
from mmrs_runtime.bus import CommandId
from mmrs_runtime.bus.program_bus import recorded_of, shared_bus
from mmrs_runtime.records.steps import StepRecord, log_name, to_line
from mmrs_runtime.semantics import awaited, entry, steps

RUN = "run-0"


def exchange(rounds: int = 6) -> Program:
    """Return two robots that hand things to each other; slots are set, and reset by others, each round.

    One notify of each round resets slots of both at once.
    """
    gives, takes, waits_a, waits_b = [], [], {}, {}
    for n in range(rounds):
        gives += [
            hold(f"throw{n}", 0.0, after=(notify("b.ball"),)),
            hold(f"clear{n}", 0.0, after=(notify("b.ball", "a.ack", active=False), notify("b.go"))),
        ]
        waits_a[f"throw{n}"] = ["ack"]
        takes += [
            hold(f"catch{n}", 0.0),
            hold(f"reply{n}", 0.0, before=(notify("a.ack"),)),
            hold(f"rest{n}", 0.0, before=(notify("b.go", active=False),)),
        ]
        waits_b[f"catch{n}"], waits_b[f"reply{n}"] = ["ball"], ["go"]
    return program(
        robot("a", gives, waits=waits_a, slots=("ack",)),
        robot("b", takes, waits=waits_b, slots=("ball", "go")),
    )


def gathering(robots: int = 3) -> Program:
    """Return robots that all wait for the first one's word, and the first for all of theirs."""
    names = [f"r{n}" for n in range(robots)]
    others = names[1:]
    first = robot(
        "r0",
        [hold("gather", 0.0), hold("tell", 0.0, before=(notify(*(f"{each}.go" for each in others)),))],
        waits={"gather": [f"from_{each}" for each in others]},
        slots=tuple(f"from_{each}" for each in others),
    )
    rest = [
        robot(
            each,
            [hold("come", 0.0, after=(notify(f"r0.from_{each}"),)), hold("leave", 0.0)],
            waits={"come": ["go"]},
            slots=("go",),
        )
        for each in others
    ]
    return program(first, *rest)


def succession(size: int = 4) -> Program:
    """Return robots of which two have ended when the last one comes, which notifies the first all the same.

    The one that stays has nothing to do with the one that is notified.
    """
    return program(
        robot("early", [hold("look", 0.0), hold("go", 0.0)], waits={"look": ["met"]}, slots=("met", "word")),
        robot("other", [hold("meet", 0.0, after=(notify("early.met"),))]),
        robot("stays", [hold("stay", 0.0), hold("leave", 0.0)], waits={"stay": ["go"]}, slots=("go",)),
        robot(
            "late",
            [
                hold("greet", 0.0, after=(notify("early.word"),)),
                hold("free", 0.0, after=(notify("stays.go"),)),
            ],
        ),
    )


BEHAVIOURS: dict[str, Callable[[int], Program]] = {
    "exchange": exchange,
    "gathering": gathering,
    "succession": succession,
}


class Gone(Exception):  # noqa: N818  # what has happened to the robot
    """The robot was killed at this point."""


class Walker:
    """Steps through one robot's program as fast as the bus allows, and logs what it does."""

    def __init__(self, made: Program, id: str, folder: Path, bus, *, at=lambda what, number: None):
        """Go on where the log ends; `at` is called at every point where something may be made to happen."""
        self.program, self.bus, self.at = made.executable.by_id[id], bus, at
        self.point, self.lamport, self.number = entry(self.program, self.program.start), 0, 0
        self.log = folder / log_name(id)
        for record in logged(folder, id):
            self._follow(record)
        self.log.parent.mkdir(parents=True, exist_ok=True)

    def walk(self, until: float) -> bool:
        """Walk to the end, or until that time; return whether it is the end."""
        while not self.point.is_final:
            if time.monotonic() > until:
                return False
            self._step()
        self.bus.leave(self.program.id)
        return True

    def _step(self):
        waits = awaited(self.program, self.point)
        states = {slot: self.bus.state(slot) for slot in waits}
        possible = steps(self.program, self.point, {slot for slot, state in states.items() if state.active})
        if not possible:
            self.bus.await_change(0.05)
            return
        step = possible[0]
        if step.sets:
            self._notify(step)
            return
        lamport = max(self.lamport + 1, *(state.lamport + 1 for state in states.values()), 0)
        if waits and not self.bus.passed(waits, lamport):
            self.bus.await_change(0.01)
            return
        self._write(step, lamport)

    def _notify(self, step):
        delivery = self.bus.prepare(CommandId(RUN, self.program.id, "", self.number), step.sets, step.active)
        try:
            while delivery.lamport is None:
                self.bus.await_change(0.05)
                self.at("asking", self.number)
            self.at("granted", self.number)
            self._write(step, max(self.lamport + 1, delivery.lamport))
        except BaseException:
            if not isinstance(sys.exception(), Gone):
                delivery.abort()
            raise
        self.at("logged", self.number)
        delivery.send(self.lamport)
        while delivery.waiting:
            self.bus.await_change(0.05)
            self.at("sending", self.number)
        self.at("acknowledged", self.number)

    def _write(self, step, lamport):
        record = StepRecord(
            RUN,
            self.program.id,
            self.number,
            lamport,
            10.0 * self.number,
            step.label,
            step.move,
            step.detail,
            step.slot,
        )
        with self.log.open("a", encoding="utf-8") as file:
            file.write(to_line(record) + "\n")
            file.flush()
            os.fsync(file.fileno())
        self.point, self.lamport, self.number = step.leads_to, lamport, self.number + 1

    def _follow(self, record):
        everything = {(self.program.id, name) for name in self.program.slots}
        step = next(s for s in steps(self.program, self.point, everything) if s.label == record.label)
        self.point, self.lamport, self.number = step.leads_to, record.lamport, record.seq + 1


def logged(folder: Path, id: str) -> tuple[StepRecord, ...]:
    """Return what a robot has logged so far."""
    path = folder / log_name(id)
    return read_log(path, partial=True) if path.exists() else ()


class GatewayBus:
    """The bus as a program without Zenoh uses it: lines of JSON over loopback TCP, and nothing else."""

    def __init__(self, folder: Path, made: Program, id: str, records=None, patience: float = 20.0):
        """Find the gateway by its file, and say hello; `records` None: not started again."""
        self._changed = threading.Condition()
        self._deliveries: dict[int, GatewayDelivery] = {}
        self._answers: list[dict] = []
        self._robot, self._asking, self.over = id, threading.Lock(), False
        told = json.loads(_awaited(folder / "gateway.json", patience))
        self._socket = socket.create_connection(("127.0.0.1", told["port"]))
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._lines = self._socket.makefile("rb")
        hello = {"do": "hello", "token": told["token"], "alive": 1}
        if records is not None:
            known = recorded_of(made.executable, [id], records)[id]
            notifies = [[*slot, *value] for slot, value in known.notifies.items()]
            hello["resumed"] = {"lamport": known.lamport, "notifies": notifies}
        self._socket.sendall(json.dumps(hello).encode() + b"\n")
        self.welcome = json.loads(self._lines.readline())
        if self.welcome["is"] != "welcome":
            raise OSError(self.welcome["why"])
        threading.Thread(target=self._read, daemon=True).start()
        threading.Thread(target=self._live, daemon=True).start()

    def prepare(self, id, slots, active):
        delivery = GatewayDelivery(self, id.sequence, tuple(sorted({owner for owner, _ in slots})))
        self._deliveries[id.sequence] = delivery
        self._ask(
            {"do": "prepare", "number": id.sequence, "slots": [list(s) for s in slots], "active": active}
        )
        return delivery

    def state(self, slot):
        found = self._ask({"do": "state"})["slots"][slot[1]]
        return type("State", (), found)

    def passed(self, slots, lamport):
        names = [name for _, name in slots]
        return self._ask({"do": "pass", "slots": names, "lamport": lamport})["is"] == "passed"

    def lost(self, robots):
        return tuple(self._ask({"do": "lost", "robots": list(robots)})["robots"])

    def leave(self, robot):
        self._ask({"do": "leave"})

    def await_change(self, seconds):
        with self._changed:
            self._changed.wait(seconds)

    def close(self):
        self._socket.close()

    def _ask(self, content):
        with self._asking, self._changed:
            self._socket.sendall(json.dumps(content).encode() + b"\n")
            while not self._answers:
                if self.over:
                    raise OSError("the gateway has gone")
                self._changed.wait(1.0)
            answer = self._answers.pop(0)
        if answer["is"] == "wrong":
            raise ValueError(answer["why"])
        return answer

    def _live(self):
        with suppress(OSError):
            while not self.over:
                self._ask({"do": "alive"})
                time.sleep(0.3)

    def _read(self):
        with suppress(ConnectionError):
            for line in self._lines:
                self._take(json.loads(line))
        with self._changed:
            self.over = True
            self._changed.notify_all()

    def _take(self, content):
        with self._changed:
            if content["is"] in ("granted", "waiting", "acknowledged", "refused"):
                self._deliveries[content["number"]].told(content)
            elif content["is"] != "changed":
                self._answers.append(content)
            self._changed.notify_all()


class GatewayDelivery:
    """A notify that a gateway delivers."""

    def __init__(self, bus, number, owners):
        self._bus, self._number = bus, number
        self.lamport, self.waiting, self.refused = None, owners, ""

    def told(self, content):
        what = content["is"]
        if what == "granted":
            self.lamport, self.waiting = content["lamport"], ()
        elif what == "waiting":
            self.waiting = tuple(content["for"])
        elif what == "refused":
            self.refused = content["why"]
        else:
            self.waiting = ()

    def send(self, lamport):
        self.waiting = ("not known yet",)
        self._bus._ask({"do": "send", "number": self._number, "lamport": lamport})

    def abort(self):
        self._bus._ask({"do": "abort", "number": self._number})


def _awaited(path: Path, patience: float) -> str:
    until = time.monotonic() + patience
    while not path.exists():
        if time.monotonic() > until:
            raise FileNotFoundError(path)
        time.sleep(0.01)
    return path.read_text()


def _main() -> int:
    parser = argparse.ArgumentParser()
    for name in ("behaviour", "robot", "folder"):
        parser.add_argument(name)
    parser.add_argument("--size", type=int, default=6)
    parser.add_argument("--listen", action="append", default=[])
    parser.add_argument("--connect", action="append", default=[])
    parser.add_argument("--config", type=Path)
    parser.add_argument("--gateway", type=Path, help="folder of a gateway's file")
    parser.add_argument("--again", action="store_true", help="started again, after whatever end")
    parser.add_argument("--pause", type=float, default=0.0, help="seconds before each notify")
    parser.add_argument("--die", action="append", default=[], help="WHERE:NUMBER")
    parser.add_argument("--seconds", type=float, default=60.0)
    given = parser.parse_args()
    made, folder = BEHAVIOURS[given.behaviour](given.size), Path(given.folder)
    records = logged(folder, given.robot) if given.again else None
    if given.gateway is not None:
        bus = GatewayBus(given.gateway, made, given.robot, records)
    else:
        bus = _zenoh_bus(made, given, folder, records)

    def at(what, number):
        if what == "granted":
            time.sleep(given.pause)
        if f"{what}:{number}" in given.die:
            os._exit(9)

    if given.gateway is None:
        die_after_applying(bus.node, given.die)
    done = Walker(made, given.robot, folder, bus, at=at).walk(time.monotonic() + given.seconds)
    bus.close()
    return 0 if done else 1


def _zenoh_bus(made, given, folder, records):
    from mmrs_runtime.bus.carriers.over_zenoh import ZenohCarrier
    from mmrs_runtime.bus.carriers.sessions import Endpoints

    names = [each.id for each in made.robots]
    carrier = ZenohCarrier(
        "m", RUN, names, Endpoints(tuple(given.listen), tuple(given.connect), given.config)
    )
    bus = shared_bus(made.shared, [given.robot], RUN, folder, carrier, records)
    bus.await_change = bus.node.await_change
    return bus


def die_after_applying(node, points):
    """Have the process die once a command is on its disk, before the answer; points are WHERE:NUMBER."""
    owner = node._owners._owners[node.robots[0]]
    commit = owner.commit

    def dying(sent):
        answer = commit(sent)
        if f"applied:{sent.id.sequence}" in points:
            os._exit(9)
        return answer

    owner.commit = dying
    return node


if __name__ == "__main__":
    raise SystemExit(_main())
