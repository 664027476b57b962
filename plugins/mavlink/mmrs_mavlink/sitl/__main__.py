"""Run one simulated MAVLink vehicle until it is interrupted."""

from __future__ import annotations

import argparse
import time

from mmrs_mavlink.sitl import Settings, SimulatedVehicle

SIGNAL_SECONDS = 0.5


def parser_of_arguments() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = argparse.ArgumentParser(prog="python -m mmrs_mavlink.sitl", description=__doc__)
    add = parser.add_argument
    add("--port", type=int, default=14_550, help="UDP port of the ground station")
    add("--host", default="127.0.0.1", help="address of the ground station")
    add("--kind", choices=("copter", "sub", "rover"), default="copter", help="vehicle type")
    add("--firmware", choices=("ardupilot", "px4"), default="ardupilot", help="simulated autopilot")
    add("--home", default="42.37,13.35", metavar="LATITUDE,LONGITUDE", help="home of the vehicle, in degrees")
    add("--system", type=int, default=1, help="MAVLink system of the vehicle")
    add("--speedup", type=float, default=1.0, help="simulated seconds per real second")
    return parser


def main() -> int:
    """Run the vehicle and return the exit code."""
    parser = parser_of_arguments()
    given = parser.parse_args()
    try:
        latitude, longitude = map(float, given.home.split(","))
        settings = Settings(given.kind, latitude, longitude, given.system, firmware=given.firmware)
    except ValueError as error:
        parser.error(f"--home {given.home}, --kind {given.kind}, --system {given.system}: {error}")
    with SimulatedVehicle(given.port, settings, host=given.host, speedup=given.speedup):
        try:
            while True:  # a signal that comes just before a wait does not end it
                time.sleep(SIGNAL_SECONDS)
        except KeyboardInterrupt:
            return 130
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
