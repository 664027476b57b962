"""Takes the command line of ArduCopter's simulation, and flies one of our vehicles instead.

It stands in for the binary in a test of what starts that, and proves nothing about ArduPilot.
"""

import argparse
import threading
from pathlib import Path

from mmrs_mavlink.sitl import Settings, SimulatedVehicle


def main() -> None:
    parser = argparse.ArgumentParser()
    for name in ("--model", "--home", "--speedup", "--defaults", "--sysid", "--serial0", "--serial1", "-I"):
        parser.add_argument(name, required=True)
    parser.add_argument("--wipe", action="store_true", required=True)
    given = parser.parse_args()
    assert given.model == "quad"
    assert all(Path(file).is_file() for file in given.defaults.split(","))
    latitude, longitude, altitude, _ = map(float, given.home.split(","))
    ground, (host, port) = address(given.serial1), address(given.serial0)
    settings = Settings("copter", latitude, longitude, int(given.sysid), altitude=altitude, ground=ground)
    with SimulatedVehicle(port, settings, host=host, speedup=float(given.speedup)):
        threading.Event().wait()


def address(device: str) -> tuple[str, int]:
    kind, host, port = device.split(":")
    assert kind == "udpclient", device
    return host, int(port)


if __name__ == "__main__":
    main()
