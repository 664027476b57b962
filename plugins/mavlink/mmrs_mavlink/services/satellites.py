"""Takes satellites away from a simulated vehicle, by parameters that no real vehicle has."""

from __future__ import annotations

import time
from collections.abc import Mapping
from functools import partial

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.injection.rehearsal import Attended

from ..links.link import Link

SWITCHES: Mapping[str, tuple[float, float]] = {"SIM_GPS1_ENABLE": (0.0, 1.0), "SIM_GPS_DISABLE": (1.0, 0.0)}
"""Parameters of ArduPilot's simulators, newer and older, with their values without and with satellites."""

ANSWER_SECONDS = 1.0
GLANCE_SECONDS = 0.05
TRIES = 5


def attended(link: Link) -> Attended:
    """Return what injected faults need of a vehicle at the end of a link."""
    return Attended(link.stations, partial(switch, link))


def switch(link: Link, on: bool) -> bool:
    """Enable or disable satellite reception; return whether the vehicle confirms it, as no real one does."""
    values = {name: pair[on] for name, pair in SWITCHES.items()}
    with link.inbox("PARAM_VALUE") as inbox:
        for _ in range(TRIES):
            for name, value in values.items():
                link.send(
                    mavlink.MAVLink_param_set_message(
                        link.system, link.component, name.encode(), value, mavlink.MAV_PARAM_TYPE_INT8
                    )
                )
            until = time.monotonic() + ANSWER_SECONDS
            while time.monotonic() < until:
                if any(values.get(answer.param_id) == answer.param_value for answer in tuple(inbox)):
                    return True
                time.sleep(GLANCE_SECONDS)
    return False
