"""What this plug-in contributes: a codec for thrusters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from mmrs_core.contributions.codecs import Codec, ThrusterData, ThrusterDriver
from mmrs_core.hookspecs import hookimpl


@hookimpl
def mmrs_codecs() -> tuple[Codec, ...]:
    """Contribute how drives that speak DroneCAN are told what to do."""
    return (Codec("dronecan", "electronic speed controllers on DroneCAN: RawCommand, Status", _open),)


def _open(thrusters: Sequence[ThrusterData], options: Mapping[str, str]) -> ThrusterDriver:
    from mmrs_dronecan.speed_controllers import opened

    return opened(thrusters, options)
