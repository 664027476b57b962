"""What an ArduCopter goes on with by itself although it hears no ground: nothing, where a policy answers."""

from __future__ import annotations

from ..faults import Refused
from ..links.autopilots import is_px4
from ..links.link import Link
from ..services import parameters

OPTIONS = "FS_OPTIONS"
IN_MISSIONS = 2
"""The bit by which missions go on (ArduCopter's ``GCS_CONTINUE_IF_AUTO``), whatever FS_GCS_ENABLE says."""


def end_exemption(link: Link, kind: str) -> str:
    """Have a vehicle respond to a lost link in missions, too; return what people should know of it.

    Raises:
        Refused: it would go on with its mission, and does not confirm that it will not.
    """
    if kind != "copter" or is_px4(link):
        return ""
    was = round(parameters.read(link, [OPTIONS]).get(OPTIONS, 0.0))
    if not was & IN_MISSIONS:
        return ""
    wanted = was & ~IN_MISSIONS
    if not parameters.write(link, OPTIONS, wanted):
        raise Refused(f"response to a lost link: the vehicle does not confirm {OPTIONS} = {wanted}")
    return f"{OPTIONS} = {wanted}, which was {was}: it answers a lost link in missions, too"
