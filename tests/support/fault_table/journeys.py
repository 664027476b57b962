"""The part of the fault table about several processes, one after the other or at the same time."""

import json
import signal
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import dist
from pathlib import Path

from patience import wait_for
from ports import free_endpoint
from warm_python import FREEZE

from fault_table.fleet import GENERATED, Fleet
from fault_table.project import OUT, TOUR, Pad
from fault_table.record import MOMENTS, Answer, answered, ending, story, struck
from fault_table.row import Outcome, within
from mmrs_mavlink.sitl import SimulatedVehicle

AT, AUTO = "at its place", "on a mission (AUTO)"
PEER_SECONDS, LEASE_SECONDS = 2.0, 1.5
"""Real seconds for which a peer must be lost at least, and for which one that is frozen may be silent."""

AROUND = 2.0
"""Metres from a place that a vehicle which passes it without a stop may be."""


def _reached(fleet: Fleet, robot: str, moment: str) -> bool:
    return wait_for(lambda: MOMENTS[moment](fleet.vehicles[robot]), 30.0)


def _visited(vehicle: SimulatedVehicle) -> list[str]:
    """Return the places of the tour that a vehicle was never at, by its own track."""
    track = [place for _, *place in vehicle.autopilot.track]
    return [str(place) for place in (OUT, *TOUR) if min(dist(place, each) for each in track) > AROUND]


def _finish(outcome: Outcome, fleet: Fleet, robot: str) -> None:
    """Judge a robot that should have carried out its whole program, in the end."""
    steps, result = fleet.steps(robot), fleet.replayed()
    outcome.line = json.dumps(steps[-1]) if steps else ""
    if not steps or (steps[-1]["label"], steps[-1]["move"]) != ("end", "stop"):
        outcome.problems.append(f"does not come to the end of its program: {outcome.line}")
    outcome.problems += [f"the logs do not replay: {each}" for each in result.complaints]
    outcome.problems += [f"was never at {place}" for place in _visited(fleet.vehicles[robot])]
    if outcome.problems:
        outcome.problems.append("said: " + " | ".join(fleet.process.said[-12:]))


def killed_and_resumed(folder: Path, response: str, moment: str) -> Outcome:
    """Kill the process in the air, let the vehicle do what it does by itself, and go on with ``--resume``."""
    policy = ("LINK_LOST", response, 5.0)
    outcome = Outcome(f"process killed {moment}, resumed", f"LINK_LOST → {response} after 5 s")
    with Fleet(folder, [Pad("r0", policies=(policy,), stay=5.0)], GENERATED) as fleet:
        vehicle = fleet.vehicles["r0"]
        first = fleet.start()
        _reached(fleet, "r0", moment)
        since = struck(vehicle)
        first.signal(signal.SIGKILL)
        first.end()
        wait_for(lambda: ending(vehicle, since) == "home", 15.0)
        outcome.answered, outcome.rested = answered(vehicle, since), vehicle.autopilot.time - since.time
        outcome.happened = story(vehicle, since)
        again = struck(vehicle)
        if (code := fleet.start("--resume").end(40.0)) != 0:
            outcome.problems.append(f"the exit code after the resumption is {code}, not 0")
        outcome.happened += "; then, resumed: " + story(vehicle, again)
        _finish(outcome, fleet, "r0")
    return outcome


def peer(folder: Path, number: int, response: str, ends: str) -> Outcome:
    """Have two robots in two processes over the bus, and kill or freeze the one that the other waits for."""
    word = "killed" if number == signal.SIGKILL else "frozen"
    outcome = Outcome(f"peer's process {word}", f"PEER_LOST → {response} after 5 s")
    pads = [Pad("r0", "wait", (("PEER_LOST", response, 5.0),)), Pad("g0", "give", (), 200.0, gives="r0")]
    with Fleet(folder, pads, GENERATED) as fleet:
        vehicle, endpoint = fleet.vehicles["r0"], free_endpoint()
        waiting = fleet.start("--bus-listen", endpoint, robot="r0")
        giving = fleet.start("--bus-connect", endpoint, robot="g0")
        _reached(fleet, "r0", AT)
        _reached(fleet, "g0", AT)
        since, begun = struck(vehicle), time.monotonic()
        answer = Answer(vehicle, since, vehicle.autopilot.body.target)
        vehicle.on_tick = answer.look
        giving.signal(number)
        if not wait_for(
            lambda: ending(vehicle, since) == ends and fleet.steps("r0")[-1]["label"] == "fault", 20.0
        ):
            outcome.problems.append(f"does not end as wanted: {ends}")
        outcome.answered, outcome.rested = answer.seconds, vehicle.autopilot.time - since.time
        lease = LEASE_SECONDS if number == FREEZE else 0.0
        limit = within(max(5.0, PEER_SECONDS * fleet.speedup) + lease * fleet.speedup, fleet.speedup)
        if outcome.answered is None or outcome.answered > limit:
            outcome.problems.append(f"answered after {outcome.answered}, not {limit} s")
        outcome.happened = story(vehicle, since) + f"; {time.monotonic() - begun:.1f} s of real time"
        steps = fleet.steps("r0")
        outcome.line = json.dumps(steps[-1])
        if not str(steps[-1]["detail"]).startswith("PEER_LOST"):
            outcome.problems.append("the step log does not say PEER_LOST")
        waiting.signal(signal.SIGINT)
        waiting.end(10.0)
        outcome.problems += [f"the logs do not replay: {each}" for each in fleet.replayed().complaints]
        if outcome.problems:
            outcome.problems.append("said: " + " | ".join(waiting.said[-12:]))
    return outcome


def split_network(folder: Path, faults: str, after: float, event: str, ends: str) -> Outcome:
    """Have two robots in two processes, and a bus between them that is cut or poor."""
    outcome = Outcome(f"bus between processes: {faults}", f"PEER_LOST → RETURN after {after:g} s")
    pads = [
        Pad("r0", "wait", (("PEER_LOST", "RETURN", after),)),
        Pad("g0", "give", (("PEER_LOST", "RETURN", after),), 60.0, gives="r0"),
    ]
    with Fleet(folder, pads, GENERATED) as fleet:
        vehicle, endpoint = fleet.vehicles["r0"], free_endpoint()
        waiting = fleet.start("--bus-listen", endpoint, "--inject", faults, robot="r0")
        giving = fleet.start("--bus-connect", endpoint, robot="g0")
        _reached(fleet, "r0", AT)
        since = struck(vehicle)
        waiting.end(40.0)
        giving.end(20.0)
        outcome.answered, outcome.rested = answered(vehicle, since), vehicle.autopilot.time - since.time
        outcome.happened = story(vehicle, since)
        steps = fleet.steps("r0")
        outcome.line = json.dumps(steps[-1]) if steps else ""
        found = [str(step["detail"]).partition(":")[0] for step in steps if step["label"] == "fault"]
        if found != ([event] if event else []):
            outcome.problems.append(f"the step log has faults {found}, not {event or 'none'}")
        if ending(vehicle, since) != ends:
            outcome.problems.append(f"does not end as wanted: {ends}")
        outcome.problems += [f"the logs do not replay: {each}" for each in fleet.replayed().complaints]
        if outcome.problems:
            outcome.problems.append("said: " + " | ".join([*waiting.said[-12:], *giving.said[-6:]]))
    return outcome


@dataclass(frozen=True, slots=True)
class Journey:
    """A story with several processes: from a folder to what became of it."""

    name: str
    fly: Callable[[Path], Outcome]


def _split(faults: str, after: float, event: str) -> Callable[[Path], Outcome]:
    return partial(split_network, faults=faults, after=after, event=event, ends="home")


JOURNEYS = (
    Journey("killed and resumed", partial(killed_and_resumed, response="RETURN", moment=AUTO)),
    Journey("peer killed", partial(peer, number=signal.SIGKILL, response="RETURN", ends="home")),
    Journey("peer frozen", partial(peer, number=FREEZE, response="LAND", ends="here")),
    Journey("bus cut for 20 s", _split("bus-cut@45+20", 60.0, "")),
    Journey("bus cut for good", _split("bus-cut@45", 5.0, "PEER_LOST")),
    Journey("poor bus", _split("bus-loss=0.3,bus-delay=0.5~0.5,bus-duplicate=0.3,seed=7", 60.0, "")),
)
