"""A robot that notifies others again and again, and says how long each took and who is there.

``bus_asking.py ROBOT TARGETS FOLDER LISTEN CONNECT ...`` writes lines of JSON: ``here``, the robots that can
be reached; ``to`` and ``took``, seconds until a notify was acknowledged.
"""

import json
import sys
import time
from pathlib import Path

from mmrs_runtime.bus import CommandId, FileJournal, Member, Node, Owned
from mmrs_runtime.bus.carriers.over_zenoh import ZenohCarrier
from mmrs_runtime.bus.carriers.sessions import Endpoints

ROBOTS = ("a", "b", "c", "d")
RUN = "run-0"


def _node(robot: str, folder: Path, listen: str, connect: tuple[str, ...]) -> Node:
    others = tuple(each for each in ROBOTS if each != robot)
    member = Member(Owned(robot, ("go",), {"go": others}, {"go": others}), frozenset(others))
    carrier = ZenohCarrier("mission", RUN, ROBOTS, Endpoints((listen,), connect))
    return Node([member], RUN, carrier=carrier, journals=lambda id: FileJournal(folder / f"{id}.ndjson"))


def _notify(node: Node, robot: str, target: str, number: int) -> None:
    begun = time.monotonic()
    delivery = node.prepare(CommandId(RUN, robot, "", number), ((target, "go"),), True)
    while delivery.lamport is None:
        node.await_change(0.05)
    delivery.send(delivery.lamport)
    while delivery.waiting:
        node.await_change(0.05)
    _say(to=target, took=time.monotonic() - begun)


def _say(**content: object) -> None:
    print(json.dumps(content), flush=True)


def _main(robot: str, targets: str, folder: str, listen: str, *connect: str) -> None:
    node, number, here = _node(robot, Path(folder), listen, connect), 0, list[str]()
    while True:
        found = [each for each in ROBOTS if each != robot and not node.missing([each])]
        if found != here:
            here = found
            _say(here=here)
        for target in filter(None, targets.split(",")):
            number += 1
            _notify(node, robot, target, number)
        time.sleep(0.02)


if __name__ == "__main__":
    _main(*sys.argv[1:])
