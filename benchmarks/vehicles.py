"""Measures what fifty simulated vehicles cost, and to hear them, by our links and by bare pymavlink.

The vehicles are one process and one thread; all are in the air and fly missions. Beside them, one after the
other, three processes hear the same traffic: the links of our flight runtime with a port each, the same with
one port for all, and a selector with nothing but pymavlink's parser. At last, the controllers of a behaviour
for as many robots fly it, all in one process, with everything that they do. CPU is user and system time, as
a part of one core.

    python benchmarks/vehicles.py > benchmarks/results/vehicles.txt
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import selectors
import socket
import subprocess
import sys
import tempfile
import time
from datetime import date
from pathlib import Path

from pymavlink.dialects.v20 import ardupilotmega as mavlink

STEP = 8.23
"""Metres between homes that are APART degrees apart, on this latitude."""

APART = 1e-4

NORTH = -300.0
"""Metres north of the origin, where the areas of the behaviours for tests are."""

SIDES = ("vehicles", "standing", "links", "shared", "bare")


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add("--count", type=int, default=50)
    add("--seconds", type=float, default=20.0, help="of each measurement")
    add("--port", type=int, default=31_000)
    add("--side", choices=SIDES, help=argparse.SUPPRESS)
    add("--shared", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.side == "vehicles":
        be_vehicles(given)
    elif given.side == "standing":
        stand(given)
    elif given.side is not None:
        {"links": hear_by_links, "shared": hear_by_links, "bare": hear_bare}[given.side](given)
    else:
        compare(given)


def compare(given: argparse.Namespace) -> None:
    print(f"{given.count} simulated vehicles, {given.seconds:g} s a measurement")
    print(f"{date.today()}, Python {platform.python_version()}, {os.cpu_count()} cores, {platform.machine()}")
    print()
    vehicles, heard = [], {}
    for side in ("links", "bare", "shared"):
        shared = side == "shared"
        with start("vehicles", given, shared=shared, seconds=given.seconds + 10.0) as flying:
            time.sleep(4.0)
            heard[side] = said_by(start(side, given, shared=shared))
            vehicles.append(said_by(flying))
    mean = sum(each["cpu"] for each in vehicles) / len(vehicles)
    row("the vehicles' side", mean, given.count, vehicles[0]["messages"])
    row("bare pymavlink", heard["bare"]["cpu"], given.count, heard["bare"]["messages"])
    row("our links, a port each", heard["links"]["cpu"], given.count, heard["links"]["messages"])
    row("our links, one port for all", heard["shared"]["cpu"], given.count, heard["shared"]["messages"])
    print()
    bare = heard["bare"]["cpu"] / heard["bare"]["messages"]
    for side, name in (("links", "a port each"), ("shared", "one port for all")):
        ratio = heard[side]["cpu"] / heard[side]["messages"] / bare
        print(f"a message heard by our links, {name}: {ratio:.2f} times what bare pymavlink takes")
    print()
    fly(given)


def row(name: str, cpu: float, count: int, rate: float) -> None:
    print(f"{name:32s} {cpu:6.1%} of a core, {cpu / count:7.3%} a vehicle, {rate:7.0f} messages/s")


def start(side: str, given: argparse.Namespace, *, shared: bool = False, seconds: float = 0.0):
    command = [sys.executable, __file__, "--side", side, "--count", str(given.count)]
    command += [
        "--seconds",
        str(seconds or given.seconds),
        "--port",
        str(given.port),
        *(["--shared"] if shared else []),
    ]
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


def said_by(process) -> dict[str, float]:
    said, _ = process.communicate()
    return json.loads(said)


def ports(given: argparse.Namespace) -> list[int]:
    return [given.port + (0 if given.shared else number) for number in range(given.count)]


def be_vehicles(given: argparse.Namespace) -> None:
    from mmrs_mavlink.sitl import Host, Settings, SimulatedVehicle
    from mmrs_mavlink.sitl.commands import execute
    from mmrs_mavlink.sitl.items import StoredItem
    from mmrs_mavlink.sitl.simulation import advance

    vehicles = []
    for number, port in enumerate(ports(given), start=1):
        settings = Settings(system=number, longitude=13.35 + number * 1e-3, energy=1e6)
        vehicle = SimulatedVehicle(port, settings)
        pilot = vehicle.autopilot
        places = [pilot.degrees_at(place) for place in ((0, 0, 0), (80, 0, 0), (80, 80, 0), (0, 80, 0))]
        items = [StoredItem(3, 16, (0.0,) * 4, round(a * 1e7), round(b * 1e7), 20.0) for a, b in places]
        pilot.stores[0] = [items[0], *items, StoredItem(2, 177, (1.0, -1.0, 0.0, 0.0), 0, 0, 0.0)]
        advance(pilot, 3.0)
        for command, params in ((176, (1, 4)), (400, (1,)), (22, (0, 0, 0, 0, 0, 0, 20))):
            assert execute(pilot, command, (*params, *[0.0] * 7)[:7]) == 0
        advance(pilot, 15.0)
        assert pilot.set_mode(pilot.numbers["auto"]) == 0
        vehicles.append(vehicle)
    host = Host(vehicles)
    host.start()
    time.sleep(2.0)
    before, sent, began = time.process_time(), total(vehicles), time.monotonic()
    time.sleep(given.seconds)
    seconds = time.monotonic() - began
    cpu, messages = (time.process_time() - before) / seconds, (total(vehicles) - sent) / seconds
    assert all(vehicle.autopilot.armed and vehicle.autopilot.body.pace > 0.0 for vehicle in vehicles)
    host.stop()
    print(json.dumps({"cpu": cpu, "messages": messages}))


def stand(given: argparse.Namespace) -> None:
    """Be vehicles that stand at their homes, until standard input ends; print what each has done."""
    from mmrs_mavlink.commands.rehearsal import summary_of
    from mmrs_mavlink.sitl import Host, Settings, SimulatedVehicle

    vehicles = [
        SimulatedVehicle(port, Settings(system=number + 1, longitude=13.35 + number * APART))
        for number, port in enumerate(ports(given))
    ]
    host = Host(vehicles)
    host.start()
    sys.stdin.read()
    host.stop()
    print(json.dumps([summary_of(vehicle) for vehicle in vehicles]))


def total(vehicles) -> int:
    return sum(vehicle.radio.sent for vehicle in vehicles)


def hear_by_links(given: argparse.Namespace) -> None:
    from mmrs_mavlink.links.radios import Radios
    from mmrs_runtime.clock import Clock

    radios = Radios(Clock())
    count = [0] * given.count
    links = [
        radios.open(f"udpin:127.0.0.1:{port}", number) for number, port in enumerate(ports(given), start=1)
    ]
    for index, link in enumerate(links):
        radios.meet(link, "", 20.0)

        def tally(message, outgoing, index=index):
            count[index] += not outgoing

        link.observe(tally)
    before, heard, began = time.process_time(), sum(count), time.monotonic()
    time.sleep(given.seconds)
    seconds = time.monotonic() - began
    cpu, messages = (time.process_time() - before) / seconds, (sum(count) - heard) / seconds
    print(json.dumps({"cpu": cpu, "messages": messages}))
    sys.stdout.flush()
    os._exit(0)  # fifty readers would be closed one after the other


def hear_bare(given: argparse.Namespace) -> None:
    selector, heard = selectors.DefaultSelector(), 0
    for port in ports(given):
        connection = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        connection.bind(("127.0.0.1", port))
        parser = mavlink.MAVLink(None)
        parser.robust_parsing = True
        selector.register(connection, selectors.EVENT_READ, parser)
    before, began = time.process_time(), time.monotonic()
    while (seconds := time.monotonic() - began) < given.seconds:
        for key, _ in selector.select(0.1):
            heard += len(key.data.parse_buffer(key.fileobj.recv(65_535)) or ())
    cpu = (time.process_time() - before) / seconds
    print(json.dumps({"cpu": cpu, "messages": heard / seconds}))


def fly(given: argparse.Namespace) -> None:
    """Fly generated controllers, all in one process, on vehicles in another."""
    with tempfile.TemporaryDirectory() as folder:
        generate(Path(folder), given.count)
        standing = start("standing", given)
        time.sleep(8.0)
        links = [
            part
            for number in range(given.count)
            for part in (
                "--connect",
                f"Vehicle{number + 1}=udpin:127.0.0.1:{given.port + number}@{number + 1}",
            )
        ]
        began, before = time.monotonic(), children()
        done = subprocess.run(
            [sys.executable, "fleet.py", *links], cwd=folder, capture_output=True, text=True, check=False
        )
        seconds = time.monotonic() - began
        ours = (children() - before) / seconds
        flown = said_by(standing)
    if done.returncode:
        print(done.stderr[-2000:])
        raise SystemExit("the controllers did not come to their end")
    metres = sum(each["metres"] for each in flown)
    assert not any(each["armed"] for each in flown)
    print(f"{given.count} controllers in one process, their own message rates, {seconds:.0f} s in all:")
    rate = sum(each["sent"] for each in flown) / seconds
    row("the controllers' side", ours, given.count, rate)
    print(f"{metres:.0f} m flown, all landed and disarmed")


def children() -> float:
    spent = os.times()
    return spent.children_user + spent.children_system


def generate(folder: Path, count: int) -> None:
    from mmrs_multicopter.testing import LAND, go_to, robot_program, take_off, target_input

    from mmrs_core.generation.render import render
    from mmrs_core.generation.writing import write
    from mmrs_core.scene import Frame
    from mmrs_core.testing.programs import program
    from mmrs_mavlink.plugin.controllers import MAVLINK_PYTHON

    frame = Frame("EPSG:4326", 42.37 - NORTH / 111_070.0, 13.35)
    robots = []
    for number in range(count):
        east = number * STEP
        moves = [take_off("up", 10.0)]
        moves += [go_to(f"leg{n}", (east, NORTH + 20.0 * n, 10.0 + n)) for n in range(1, 5)]
        moves += [go_to("back", (east, NORTH, 10.0)), LAND]
        robots.append(robot_program(f"Vehicle{number + 1}", moves, home=(east, NORTH, 0.0)))
    write(render(MAVLINK_PYTHON, target_input(program(*robots, frame=frame))), folder)


if __name__ == "__main__":
    main()
