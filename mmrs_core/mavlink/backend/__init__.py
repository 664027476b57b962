"""The backend mavlink: drives a robot of a behaviour over a MAVLink link, in real time."""

from __future__ import annotations

from importlib.util import find_spec

from mmrs_core.contributions.backends import Backend, BackendFactory, BackendInput
from mmrs_core.errors import UnsupportedError, UsageError
from mmrs_core.mavlink.backend.options import link_options


def _connect(given: BackendInput) -> Backend:
    """Return a robot at the end of its link, which is first listened to when the robot gets ready."""
    link_options(given.options)
    if given.live is None:
        raise UsageError("backend 'mavlink': drives robots in real time; 'mmrs run' does that")
    if find_spec("pymavlink") is None:
        raise UnsupportedError("backend 'mavlink': needs pymavlink; pip install 'mmrs-core[mavlink]'")
    from mmrs_core.mavlink.backend.connection import connect

    return connect(given, given.live)


MAVLINK = BackendFactory(
    "mavlink", "ArduPilot and PX4 vehicles over MAVLink 2: serial, UDP or TCP, in real time", _connect
)
