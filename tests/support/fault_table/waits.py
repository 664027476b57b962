"""The part of the fault table about devices and other robots that do not answer."""

from __future__ import annotations

from fault_table import strikes
from fault_table.links import SILENCE
from fault_table.row import AT, LEG, Row, leave_alone, policy

UNCONFIRMED = 6.0
"""Real seconds in which a device has not confirmed what it was told five times over. Such rounds go on for
half a minute of the run; the last one, and the rest of the leg, come on top."""


def device_rows() -> list[Row]:
    cases = [("HOLD", "holds"), ("RETURN", "home"), ("EMERGENCY_AREA", "meadow")]
    rows = [
        Row(
            "device does not answer",
            LEG,
            policy("DEVICE_SILENT", response),
            strikes.mute_camera,
            "DEVICE_SILENT",
            ends,
            within=46.0,
            least=UNCONFIRMED,
            fast=response == "EMERGENCY_AREA",
        )
        for response, ends in cases
    ]
    return [
        *rows,
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
    rows = [
        Row(
            "wait too long",
            AT,
            policy("WAIT_TOO_LONG", response, 10.0),
            leave_alone,
            "WAIT_TOO_LONG",
            ends,
            within=13.0,
            program="wait",
            fast=response == "EMERGENCY_AREA",
        )
        for response, ends in (("RETURN", "home"), ("EMERGENCY_AREA", "meadow"), ("HOLD", "holds"))
    ]
    rows += [
        Row(
            "peer's program ends early",
            AT,
            policy("PEER_LOST", response, 5.0),
            strikes.stick,
            "PEER_LOST",
            ends,
            within=7.0,
            least=SILENCE,
            program="wait",
            strikes_peer=True,
        )
        for response, ends in (("LAND", "here"), ("EMERGENCY_AREA", "meadow"))
    ]
    return rows
