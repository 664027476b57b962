"""Regions of interest: places on the Earth at which a vehicle, or a gimbal on it, looks while it goes.

On missions an ArduCopter turns its front there unless it has a gimbal that turns sideways, a PX4 unless
MIS_MNT_YAW_CTL says so (``AutoYaw::set_roi``, ``MissionBase::on_active``). An ArduCopter forgets the region
when it enters AUTO, a PX4 when a mission is uploaded.
"""

from __future__ import annotations

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.faults import RefusedError, UnansweredError

from ..links.link import Link
from ..links.messages import ANYBODY
from ..program import Geographic, Look
from ..services import parameters
from ..services.commands import command, command_at
from .guidance import Guidance


def look_at_place(link: Link, guidance: Guidance, look: Look) -> None:
    """Make a vehicle or a gimbal look at a place; other targets are ignored."""
    if isinstance(look.at, Geographic):
        frame, height = guidance.level(look.at.height)
        at = Geographic(look.at.latitude, look.at.longitude, height)
        command_at(link, mavlink.MAV_CMD_DO_SET_ROI_LOCATION, at, frame, look.device)


def look_ahead(link: Link, look: Look) -> None:
    """Make what has looked at a place look ahead again."""
    if isinstance(look.at, Geographic):
        command(link, mavlink.MAV_CMD_DO_SET_ROI_NONE, look.device)


def gimbal_looks(link: Link) -> bool:
    """Return whether a gimbal may turn to regions of interest on missions, and the vehicle not.

    A vehicle that does not answer may have one.
    """
    if name := link.profile.autopilot.missions.gimbal_looks:
        return bool(round(parameters.read(link, [name]).get(name, 0.0)))
    with link.inbox("GIMBAL_MANAGER_INFORMATION", component=ANYBODY) as inbox:
        try:
            information = mavlink.MAVLINK_MSG_ID_GIMBAL_MANAGER_INFORMATION
            command(link, mavlink.MAV_CMD_REQUEST_MESSAGE, information, tries=2)
            link.wait(lambda: bool(inbox), link.patience)
        except UnansweredError:
            return True
        except RefusedError:
            return False
        return any(each.cap_flags & mavlink.GIMBAL_MANAGER_CAP_FLAGS_HAS_YAW_AXIS for each in tuple(inbox))
