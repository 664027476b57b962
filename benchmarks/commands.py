"""Measures how long an order to a robot takes until its vehicle has confirmed it, against a bare command.

One simulated vehicle hovers under `mmrs run`; it is ordered to hold and to go on, in turns, over the control
channel of the run. The bare command is a COMMAND_LONG to the same kind of vehicle and its COMMAND_ACK, by
pymavlink alone, in the same process and at the same time of day.

    python benchmarks/commands.py --seed 1 > benchmarks/results/commands.txt
"""

from __future__ import annotations

import argparse
import random
import socket
import tempfile
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import replace
from datetime import date
from pathlib import Path
from statistics import quantiles
from typing import Any

from mmrs_multicopter.testing import quad, robot_program, take_off
from pymavlink import mavutil

from mmrs_core.behaviour.program import Program
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.simulation.live import live_run_for, run_live
from mmrs_core.simulation.run import inputs_of
from mmrs_core.testing.programs import move, program
from mmrs_mavlink.plugin.backend import MAVLINK
from mmrs_mavlink.sitl import Settings, SimulatedVehicle
from mmrs_runtime.control import Control
from mmrs_runtime.orders.ordering import give
from mmrs_runtime.orders.orders import LAND, Orders
from mmrs_runtime.slots import LocalSlots

ROBOT = "drone"
HEIGHT = 10.0
SET_MODE = mavutil.mavlink.MAV_CMD_DO_SET_MODE
MODES = (4, 17)
"""ArduPilot's numbers of GUIDED and BRAKE."""

PING = mavutil.mavlink.MAV_CMD_SET_MESSAGE_INTERVAL


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--orders", type=int, default=200)
    given = parser.parse_args()
    chance = random.Random(given.seed)
    with hovering() as folder:
        bare, changes = bare_commands(given.orders, chance)
        found = dict(orders(folder, given.orders, chance))
    print(f"orders and commands, {date.today()}, seed {given.seed}, {given.orders} of each; milliseconds")
    print("order: from its line on the control channel until the vehicle is seen to obey\n")
    print(f"{'':<28}{'median':>9}{'99 %':>9}{'worst':>9}{'median / bare':>15}")
    base = _median(bare)
    rows = {"bare COMMAND_LONG and ACK": bare, "bare mode and heartbeat": changes, **found}
    for name, seconds in rows.items():
        spread = quantiles(seconds, n=100)
        worst = max(seconds)
        ratio = _median(seconds) / base
        figures = "".join(f"{1000 * each:9.1f}" for each in (spread[49], spread[98], worst))
        print(f"{name:<28}{figures}{ratio:15.1f}")


def behaviour() -> Program:
    """Return a robot that takes off and then stays where it is for longer than anybody measures."""
    stay = replace(move("stay", "HoldPosition", duration=100_000.0))
    return program(robot_program(ROBOT, [take_off("up", HEIGHT), stay]))


@contextmanager
def hovering() -> Iterator[Path]:
    """Have the interpreter fly a robot until the context ends; give the folder of its logs."""
    made, port, control = behaviour(), free_port(), Orders()
    inputs = inputs_of(TargetInput(made, {"Quad": quad()}, {}, {}), {})
    with tempfile.TemporaryDirectory() as name, SimulatedVehicle(port, Settings(energy=1e6)) as vehicle:
        folder = Path(name)
        live_run = replace(
            live_run_for(made, inputs, MAVLINK, LocalSlots(made.executable), {}),
            orders=control,
            folder=folder,
            links={ROBOT: f"udpin:127.0.0.1:{port}"},
            say=lambda words: None,
        )
        flight = threading.Thread(target=lambda: run_live(live_run))
        with closing(Control(folder, live_run.run, (ROBOT,), control, lambda robot: {})):
            flight.start()
            while vehicle.autopilot.body.position[2] < HEIGHT - 0.4:
                time.sleep(0.1)
            time.sleep(2.0)
            yield folder
        control.give(LAND, (ROBOT,))
        flight.join()


def orders(folder: Path, count: int, chance: random.Random) -> Iterator[tuple[str, list[float]]]:
    """Yield, for each order, the seconds that it took each time."""
    found: dict[str, list[float]] = {"hold": [], "resume": []}
    for _ in range(count):
        for order, seconds in found.items():
            (reply,) = give(folder, order)
            assert reply["confirmed"], reply
            seconds.append(float(reply["seconds"]))
            time.sleep(chance.uniform(0.02, 0.12))
    yield from found.items()


def bare_commands(count: int, chance: random.Random) -> tuple[list[float], list[float]]:
    """Return the seconds from a command to its acknowledgement, and from a mode's to the heartbeat in it."""
    port = free_port()
    answers: list[float] = []
    changes: list[float] = []
    with SimulatedVehicle(port, Settings()):
        link = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}")
        link.wait_heartbeat()
        time.sleep(2.0)
        for number in range(count):
            answers.append(_answered(link, PING, (33, 200_000), "COMMAND_ACK", "command", PING))
            time.sleep(chance.uniform(0.02, 0.12))
            mode = MODES[number % 2]
            changes.append(_answered(link, SET_MODE, (1, mode), "HEARTBEAT", "custom_mode", mode))
            time.sleep(chance.uniform(0.02, 0.12))
        link.close()
    return answers, changes


def _answered(
    link: Any, command: int, params: tuple[float, float], kind: str, field: str, value: int
) -> float:
    """Return the seconds until a message of that kind says that value."""
    begun = time.monotonic()
    link.mav.command_long_send(1, 1, command, 0, *params, 0, 0, 0, 0, 0)
    while True:
        answer = link.recv_match(type=kind, blocking=True)
        if answer is not None and getattr(answer, field) == value:
            return time.monotonic() - begun


def free_port() -> int:
    """Return a port that nobody uses."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def _median(seconds: Sequence[float]) -> float:
    return quantiles(seconds, n=2)[0]


if __name__ == "__main__":
    main()
