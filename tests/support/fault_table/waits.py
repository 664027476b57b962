"""The part of the fault table about devices and other robots that do not answer."""

from fault_table import strikes
from fault_table.links import SILENCE
from fault_table.row import AT, LEG, Row, answered_rows, leave_alone, policy

UNCONFIRMED = 6.0
"""Real seconds in which a device has not confirmed what it was told five times over. Such rounds go on for
half a minute of the run; the last one, and the rest of the leg, come on top."""


def device_rows() -> list[Row]:
    return [
        *answered_rows(
            "device does not answer",
            strikes.mute_camera,
            "DEVICE_SILENT",
            None,
            [(LEG, "HOLD", "holds"), (LEG, "EMERGENCY_AREA", "meadow")],
            fast=(LEG, "EMERGENCY_AREA"),
            within=46.0,
            least=UNCONFIRMED,
        ),
        Row(
            "device does not answer",
            LEG,
            policy("DEVICE_SILENT", "CONTINUE"),
            strikes.mute_camera,
            "",
            "done",
            within=None,
            stay=5.0,
        ),
    ]


def wait_rows() -> list[Row]:
    return [
        *answered_rows(
            "wait too long",
            leave_alone,
            "WAIT_TOO_LONG",
            10.0,
            [(AT, "EMERGENCY_AREA", "meadow"), (AT, "HOLD", "holds")],
            fast=(AT, "EMERGENCY_AREA"),
            within=13.0,
            program="wait",
        ),
        *answered_rows(
            "peer's program ends early",
            strikes.stick,
            "PEER_LOST",
            5.0,
            [(AT, "LAND", "here"), (AT, "EMERGENCY_AREA", "meadow")],
            within=7.0,
            least=SILENCE,
            program="wait",
            strikes_peer=True,
        ),
    ]
