"""The backend ardusub-manual: drives ArduSub vehicles by their pilot's sticks, without any position.

The vehicle holds its depth by its pressure sensor (depth hold); heading, depth and the way are steered
here. Where it is follows from heading, commanded speed and time alone, from its home on: nothing sees
a current, and the longer the way, the less is known. What has a position flies with backend mavlink.
"""

from __future__ import annotations

from mmrs_core.contributions.vehicles import VehicleFactory, VehicleInput
from mmrs_runtime.vehicle import Vehicle

NAME = "ardusub-manual"


def _connect(given: VehicleInput) -> Vehicle:
    from mmrs_mavlink.plugin.manual.connecting import connect

    return connect(given)


ARDUSUB_MANUAL = VehicleFactory(
    NAME,
    "ArduSub vehicles by MANUAL_CONTROL in depth hold: no position needed, the way by dead reckoning",
    _connect,
)
