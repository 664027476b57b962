"""Measures how long frames take over the hub, what the codec costs, and how busy a vehicle's bus is.

A round trip goes from one process over the hub to another and back: once through our ports, once through
python-can alone. Beside it, in the same run: python-can's virtual bus between two threads of one process,
which has no socket to cross. The codec is measured beside cantools with the same database. The bus is that
of a vehicle in simulation that dives, goes to three places and comes up; its load is by the stuff bits of
the very frames, at the declared bit rate.

    python benchmarks/can_bus.py --seed 1 > benchmarks/results/can_bus.txt
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from datetime import date
from importlib.metadata import version
from statistics import median

import can
from sample_vessels import heavy_sheet, pool_sheet

from auv_vessel.api import Craft
from auv_vessel.body.surroundings import Surroundings
from auv_vessel.body.vehicle import Vehicle
from auv_vessel.control.actuators import Actuators
from auv_vessel.control.sensors import Sensors
from auv_vessel.hosting import Rehearsal
from auv_vessel.movement.movement import Movement
from auv_vessel.sheet import Sheet
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.database import database_of
from auv_vessel.wire.frame import Frame
from auv_vessel.wire.load import MeasuredLoad, load_of, measured_load
from auv_vessel.wire.ports import open_port

FRAME = Frame(0x100, bytes(range(8)))
PLACES = ((6.0, 0.0, 2.0), (6.0, -5.0, 4.0), (0.0, 0.0, 3.0))


def main() -> None:
    """Print the table, or be the process that answers."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1, help="of the vehicle's instruments")
    parser.add_argument("--rounds", type=int, default=3000)
    parser.add_argument("--answer", nargs=2, default=None, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.answer:
        answer(given.answer[0], int(given.answer[1]))
        return
    load = f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}"
    print(f"CAN, {date.today()}, seed {given.seed}, {load}, python-can {version('python-can')}")
    print(f"\n{'round trip':46} {'p50 us':>8} {'p99 us':>8} {'most':>8}")
    virtual = over_virtual(given.rounds)
    tell("python-can's virtual bus, two threads", virtual)
    for name, other in (
        ("hub, our ports, two processes", "port"),
        ("hub, python-can alone, two processes", "can"),
    ):
        found = over_hub(given.rounds, other)
        tell(name, found)
        ratios = median(found) / median(virtual), part(found, 0.99) / part(virtual, 0.99)
        print(f"{'':46} {ratios[0]:7.2f}x {ratios[1]:7.2f}x of the virtual bus")
    codec_costs()
    for name, sheet in (("pool, 6 thrusters", pool_sheet()), ("heavy, 8 thrusters", heavy_sheet())):
        busy(name, sheet, given.seed)


def part(values: list[float], share: float) -> float:
    """Return the value below which that share of them is."""
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


def tell(name: str, seconds: list[float]) -> None:
    """Print a row."""
    p50, p99, most = (value * 1e6 for value in (median(seconds), part(seconds, 0.99), max(seconds)))
    print(f"{name:46} {p50:8.0f} {p99:8.0f} {most:8.0f}", flush=True)


def rounds(count: int, send: Callable[[], object], receive: Callable[[], object | None]) -> list[float]:
    """Return the seconds of each round trip, a few to warm up left out."""
    found = []
    for _ in range(count + 100):
        begin = time.perf_counter()
        send()
        if receive() is None:
            sys.exit("an answer did not come")
        found.append(time.perf_counter() - begin)
    return found[100:]


def over_virtual(count: int) -> list[float]:
    """Return round trips over python-can's virtual bus between two threads."""
    message = can.Message(arbitration_id=FRAME.id, data=FRAME.data, is_extended_id=False)
    with (
        can.Bus(interface="virtual", channel="bench") as here,
        can.Bus(interface="virtual", channel="bench") as there,
    ):
        stop = threading.Event()

        def echo() -> None:
            while not stop.is_set():
                if (heard := there.recv(0.1)) is not None:
                    there.send(heard)

        thread = threading.Thread(target=echo)
        thread.start()
        found = rounds(count, lambda: here.send(message), lambda: here.recv(5))
        stop.set()
        thread.join()
    return found


def over_hub(count: int, kind: str) -> list[float]:
    """Return round trips from this process over a hub to another process."""
    hub = subprocess.Popen(
        [sys.executable, "-m", "mmrs_core", "can", "hub", "--port", "0"],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
    )  # fmt: skip
    assert hub.stdout is not None
    port = int(hub.stdout.readline().split()[2].rpartition(":")[2].rstrip(";"))
    other = subprocess.Popen(
        [sys.executable, __file__, "--answer", kind, str(port)], stdout=subprocess.PIPE, text=True
    )
    try:
        assert other.stdout is not None
        other.stdout.readline()
        if kind == "port":
            with open_port("socketcand", "can0", port=port) as here:
                return rounds(count, lambda: here.send(FRAME), lambda: here.receive(5))
        message = can.Message(arbitration_id=FRAME.id, data=FRAME.data, is_extended_id=False)
        with client(port) as bus:
            return rounds(count, lambda: bus.send(message), lambda: bus.recv(5))
    finally:
        other.terminate()
        hub.terminate()
        other.wait()
        hub.wait()


def client(port: int) -> can.BusABC:
    """Return python-can's own client of a hub."""
    return can.Bus(interface="socketcand", channel="can0", host="127.0.0.1", port=port, tcp_tune=True)


def answer(kind: str, port: int) -> None:
    """Send back what is heard, until this process is ended."""
    if kind == "port":
        with open_port("socketcand", "can0", port=port) as here:
            print("there", flush=True)
            while True:
                if (frame := here.receive(1.0)) is not None:
                    here.send(frame)
    with client(port) as bus:
        print("there", flush=True)
        while True:
            if (heard := bus.recv(1.0)) is not None:
                bus.send(heard)


def codec_costs() -> None:
    """Print what a frame costs in our codec and in cantools."""
    sheet = pool_sheet()
    codec, database = Codec(sheet), database_of(sheet)
    values = {"Roll": 1.25, "Pitch": -2.5, "Heading": 123.45}
    frame = codec.encode("Pose", **values)
    pose = database.get_message_by_name("Pose")
    raw = {**values, "Sequence": 0, "Check": 0}
    print(f"\n{'one frame':46} {'encode us':>10} {'decode us':>10}")
    ours = each(lambda: codec.encode("Pose", **values)), each(lambda: codec.decode(frame))
    theirs = each(lambda: pose.encode(raw)), each(lambda: pose.decode(frame.data))
    print(f"{'cantools: scaling and ranges':46} {theirs[0]:10.1f} {theirs[1]:10.1f}")
    print(f"{'codec: also counter, check, names of faults':46} {ours[0]:10.1f} {ours[1]:10.1f}")
    print(f"{'':46} {ours[0] / theirs[0]:9.2f}x {ours[1] / theirs[1]:9.2f}x of cantools")


def each(work: Callable[[], object], count: int = 20_000) -> float:
    """Return the microseconds of processor time of a call, the best of three."""

    def once() -> float:
        begin = time.process_time()
        for _ in range(count):
            work()
        return (time.process_time() - begin) / count * 1e6

    return min(once() for _ in range(3))


def busy(name: str, sheet: Sheet, seed: int) -> None:
    """Print how busy the bus of a vehicle is, by design and in a dive."""
    designed, found = load_of(sheet), dive(sheet, seed)
    seconds = max(share.latest or 0.0 for share in designed.shares)
    print(f"\nbus of {name}, {sheet.bit_rate // 1000} kbit/s")
    print(f"  by design: {designed.least:.1%} without stuff bits, {designed.most:.1%} at most")
    print(f"  last message over by {seconds * 1e3:.1f} ms in the worst case")
    print(f"  dive of {found.seconds:.0f} s, {found.frames} frames: mean {found.mean:.1%}")
    print(f"  windows of 100 ms: p50 {found.median:.1%}, p99 {found.high:.1%}, most {found.peak:.1%}")
    print(f"  stuff bits: {found.stuffing:.1f} on 100")


def dive(sheet: Sheet, seed: int) -> MeasuredLoad:
    """Return how busy the bus was while a simulated vehicle went to three places and came up."""
    frames: list[tuple[float, Frame]] = []
    craft = Craft(sheet, Codec(sheet))
    parts = [part(sheet, Codec(sheet)) for part in (Sensors, Actuators, Movement)]
    body = Vehicle(sheet, Codec(sheet), Surroundings(current=(0.1, 0.05), bottom=10.0), seed)
    run = Rehearsal([body, *parts, craft], watch=lambda now, frame: frames.append((now, frame)))
    run.run(2.0)
    for place in PLACES:
        craft.go_to(*place)
        run.run(20.0)
    craft.surface()
    run.run(20.0)
    found = measured_load(frames, sheet.bit_rate)
    assert found is not None
    return found


if __name__ == "__main__":
    main()
