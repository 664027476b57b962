"""The backends can and can-sim: drive underwater vehicles over their CAN buses, real or rehearsed."""

from __future__ import annotations

from importlib.util import find_spec

from mmrs_auv.backend.options import connecting
from mmrs_core.contributions.vehicles import VehicleFactory, VehicleInput
from mmrs_core.errors import UnsupportedError
from mmrs_runtime.vehicle import Vehicle


def _rehearse(given: VehicleInput) -> Vehicle:
    """Return a simulated vehicle with its whole control layer, in simulated time."""
    _refuse_without_can("can-sim")
    from mmrs_auv.backend.rehearsed import rehearsed

    return rehearsed(given)


def _connect(given: VehicleInput) -> Vehicle:
    """Return the decision centre of a vehicle on its bus, in real time."""
    connecting(given.options)
    if given.live is None:
        raise UnsupportedError("backend 'can': drives robots in real time; 'mmrs run' does that")
    _refuse_without_can("can")
    from mmrs_auv.backend.connected import connected

    return connected(given, given.live)


def _refuse_without_can(name: str) -> None:
    if find_spec("can") is None or find_spec("cantools") is None:
        raise UnsupportedError(
            f"backend '{name}': needs python-can and cantools; pip install 'mmrs-core[can]'"
        )


CAN = VehicleFactory("can", "underwater vehicles over their CAN bus, in real time", _connect)
CAN_SIM = VehicleFactory(
    "can-sim",
    "underwater vehicles with dynamics, drives and control layer, in simulated time",
    _rehearse,
    simulated=True,
)
