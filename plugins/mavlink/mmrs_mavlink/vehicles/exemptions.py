"""Exemptions of a vehicle's failsafe for a lost ground station: none may stay where a policy answers."""

from __future__ import annotations

from mmrs_runtime.faults import RefusedError

from ..links.autopilots import is_px4
from ..links.link import Link
from ..services import parameters
from . import modes

OPTIONS = "FS_OPTIONS"
IN_MISSIONS = 2
"""The bit that continues missions (ArduCopter's ``GCS_CONTINUE_IF_AUTO``), whatever FS_GCS_ENABLE is."""

PX4_OPTIONS = "COM_DLL_EXCEPT"
IN_OUR_MODES = 0b111
"""The bits by which a PX4 continues missions, its other own modes, OFFBOARD, whatever NAV_DLL_ACT is."""


def end_exemption(link: Link, kind: str) -> str:
    """Make the failsafe for a lost link act in all modes of programs; return what operators should know.

    Raises:
        RefusedError: it would continue, and does not confirm that it will not.
    """
    coded = parameters.REAL
    if is_px4(link):
        name, bits, where = PX4_OPTIONS, IN_OUR_MODES, "the modes of its program"
        coded = modes.MAV_PARAM_TYPE_INT32
    elif kind == "copter":
        name, bits, where = OPTIONS, IN_MISSIONS, "missions"
    else:
        return ""
    was = round(parameters.read(link, [name]).get(name, 0.0))
    if not was & bits:
        return ""
    wanted = was & ~bits
    if not parameters.write(link, name, wanted, coded):
        raise RefusedError(f"response to a lost link: the vehicle does not confirm {name} = {wanted}")
    return f"{name} = {wanted}, which was {was}: it answers a lost link in {where}, too"
