"""The database (DBC) of a vehicle's bus, for third-party tools."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping
from typing import TYPE_CHECKING, TypeAlias

from auv_vessel.refusals import MOST_THRUSTERS
from auv_vessel.sheet import Sheet
from auv_vessel.wire.catalogue import COMMAND_BASE, NODES, Message, Slot, layout_of, messages_of

if TYPE_CHECKING:
    from cantools.database import Database
    from cantools.database.can import Message as Entry
    from cantools.database.can import Signal
    from cantools.database.can.formats.dbc.dbc_attribute import DbcAttribute
    from cantools.database.can.formats.dbc.dbc_attribute_definition import DbcAttributeDefinition

Attributes: TypeAlias = "Mapping[str, DbcAttribute[int]]"

WATCHDOG = "WatchdogTime"
"""Attribute of messages: milliseconds without a valid one after which the drives that obey it stop."""


def database_of(sheet: Sheet) -> Database:
    """Return the database of a vehicle's bus.

    Raises:
        SheetError: a bus cannot be made of the vehicle's data; lists all that is wrong.
    """
    from cantools.database import Database
    from cantools.database.can import Bus, Node
    from cantools.database.can.formats.dbc.dbc_attribute_definition import DbcAttributeDefinition
    from cantools.database.can.formats.dbc.dbc_specifics import DbcSpecifics

    watchdog = DbcAttributeDefinition(WATCHDOG, 0, "BO_", "INT", 0, 65535)
    entries = [entry_of(message, _attributes(message, sheet, watchdog)) for message in messages_of(sheet)]
    return Database(
        entries,
        [Node(name) for name in NODES],
        [Bus("", baudrate=int(sheet.bit_rate))],
        version=_ascii(sheet.robot),
        dbc_specifics=DbcSpecifics(attribute_definitions=OrderedDict({WATCHDOG: watchdog})),
    )


def dbc_of(sheet: Sheet) -> str:
    """Return the text of a vehicle's DBC, in ASCII.

    Raises:
        SheetError: as `database_of`.
    """
    text: str = database_of(sheet).as_dbc_string()
    return text.replace("\r\n", "\n")


def entry_of(message: Message, attributes: Attributes | None = None) -> Entry:
    """Return a message as databases have it."""
    from cantools.database.can import Message as Entry
    from cantools.database.can.formats.dbc.dbc_specifics import DbcSpecifics

    layout = layout_of(message)
    return Entry(
        message.id,
        message.name,
        layout.length,
        [_signal(slot, message) for slot in layout.slots.values()],
        senders=[message.sender],
        cycle_time=None if message.period is None else round(message.period * 1000),
        comment=_ascii(message.comment) or None,
        dbc_specifics=DbcSpecifics(attributes=OrderedDict(attributes or {})),
    )


def _attributes(message: Message, sheet: Sheet, watchdog: DbcAttributeDefinition[int]) -> Attributes:
    from cantools.database.can.formats.dbc.dbc_attribute import DbcAttribute

    limit = _patience(message, sheet)
    return {WATCHDOG: DbcAttribute(round(limit * 1000), watchdog)} if limit else {}


def _patience(message: Message, sheet: Sheet) -> float:
    """Return the seconds without this message after which a thruster's drive stops; 0: it goes by another."""
    return sheet.watchdog if COMMAND_BASE <= message.id < COMMAND_BASE + MOST_THRUSTERS else 0.0


def _signal(slot: Slot, message: Message) -> Signal:
    from cantools.database.can import Signal
    from cantools.database.conversion import BaseConversion

    field = slot.field
    choices = dict(enumerate(field.names)) or None
    return Signal(
        field.name,
        slot.start,
        field.bits,
        is_signed=field.signed,
        conversion=BaseConversion.factory(field.scale, 0, choices),  # type: ignore[arg-type]
        minimum=round(slot.low * field.scale, 9),
        maximum=round(slot.high * field.scale, 9),
        unit=field.unit or None,
        receivers=[node for node in NODES if node != message.sender],
        comment=_ascii(field.comment) or None,
    )


def _ascii(text: str) -> str:
    """Return a text for files that may be read in any of the encodings that DBC files are found in."""
    return text.encode("ascii", "backslashreplace").decode("ascii")
