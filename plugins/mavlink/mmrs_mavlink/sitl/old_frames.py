"""Frames of MAVLink 1, as a port sends them that never leaves it."""

from __future__ import annotations

from typing import Any

from pymavlink.dialects.v10 import ardupilotmega as old

Message = Any


def packed(message: Message, system: int, component: int, number: int) -> bytes | None:
    """Return a message as MAVLink 1 has it, without the fields that came later; None where it has none.

    Args:
        message: of MAVLink 2.
        system: that sends it. component: of it, that sends it.
        number: of the frame, 0 to 255.
    """
    kind = getattr(old, type(message).__name__, None)
    if kind is None:
        return None
    values = message.to_dict()
    fields = {name: values[name] for name in kind.fieldnames}
    packer = old.MAVLink(None, srcSystem=system, srcComponent=component)
    packer.seq = number
    plain = {name: value.encode() if isinstance(value, str) else value for name, value in fields.items()}
    return bytes(kind(**plain).pack(packer))
