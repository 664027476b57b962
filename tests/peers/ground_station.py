"""A ground station of people, as a process that can be killed: pymavlink's connection and heartbeats.

It listens for vehicles, tells each that it hears, and sends heartbeats to all, once a second.
"""

import argparse
import time

from pymavlink import mavutil
from pymavlink.dialects.v20 import ardupilotmega as mavlink

HEARTBEAT_SECONDS = 1.0


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("port", type=int)
    parser.add_argument("--system", type=int, default=255)
    parser.add_argument("--component", type=int, default=190)
    given = parser.parse_args()
    station = mavutil.mavlink_connection(
        f"udpin:127.0.0.1:{given.port}", source_system=given.system, source_component=given.component
    )
    heard: set[int] = set()
    while True:
        station.mav.heartbeat_send(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 4)
        until = time.monotonic() + HEARTBEAT_SECONDS
        while (left := until - time.monotonic()) > 0:
            message = station.recv_match(blocking=True, timeout=left)
            if message is not None and message.get_srcSystem() not in heard:
                heard.add(message.get_srcSystem())
                print(f"hears system {message.get_srcSystem()}", flush=True)


if __name__ == "__main__":
    main()
