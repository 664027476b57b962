"""From values to frames and back."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from functools import lru_cache
from math import isfinite
from types import MappingProxyType
from typing import NamedTuple, NoReturn, TypeAlias

from auv_vessel.sheet import Sheet
from auv_vessel.wire.catalogue import Layout, Message, Slot, layout_of, messages_of
from auv_vessel.wire.frame import Frame, check_of, is_sound

Value: TypeAlias = float | str | bool


class Received(NamedTuple):
    """What a frame says.

    Attributes:
        name: of the message.
        values: by field: quantities as numbers, flags as booleans, named values as their names.
        sequence: its counter; None: it is not guarded.
    """

    name: str
    values: Mapping[str, Value]
    sequence: int | None


class Codec:
    """The messages of one vehicle, as one node sends and receives them.

    Attributes:
        faults: frames with a known identifier that say nothing that can be believed, by message.
    """

    def __init__(self, sheet: Sheet) -> None:
        """Prepare for a vehicle's messages.

        Raises:
            SheetError: a bus cannot be made of the vehicle's data; lists all that is wrong.
        """
        self.faults: Counter[str] = Counter()
        self._codings = {message.name: _Coding(layout_of(message)) for message in messages_of(sheet)}
        self._by_id = {coding.message.id: coding for coding in self._codings.values()}

    def encode(self, name: str, **values: Value) -> Frame:
        """Return a frame that says so; one guarded counts on from the last of its message.

        Quantities are rounded to the nearest step, halves away from zero.

        Raises:
            ValueError: there is no such message, a field is missing or unknown, or a value is out of range.
        """
        return self._coding(name).frame(values)

    def check(self, name: str, **values: Value) -> None:
        """Return if `encode` would say so; nothing is said, and nothing counted.

        Raises:
            ValueError: as `encode`.
        """
        self._coding(name).raw(values)

    def decode(self, frame: Frame) -> Received | None:
        """Return what a frame says; None: it is none of this bus, or cannot be believed (see `faults`)."""
        coding = None if frame.extended else self._by_id.get(frame.id)
        if coding is None:
            return None
        found = _received(coding.layout, frame.data)
        if found is None:
            self.faults[coding.message.name] += 1
        return found

    def _coding(self, name: str) -> _Coding:
        if name not in self._codings:
            raise ValueError(f"there is no message {name!r} on this bus")
        return self._codings[name]


class _Coding:
    """How one message is put into bytes and taken from them."""

    def __init__(self, layout: Layout) -> None:
        self.layout = layout
        self.message: Message = layout.message
        self._own = layout.own
        self._own_length = layout.length - len(layout.slots) + len(self._own)
        self._sequence = 255

    def raw(self, values: Mapping[str, Value]) -> int:
        """Return the bits of the message's own fields."""
        if values.keys() != self._own.keys():
            self._refuse_fields(values)
        bits = 0
        for name, slot in self._own.items():
            bits |= (self._raw(slot, values[name]) & slot.mask) << slot.start
        return bits

    def frame(self, values: Mapping[str, Value]) -> Frame:
        data = self.raw(values).to_bytes(self._own_length, "little")
        if not self.message.guarded:
            return Frame(self.message.id, data)
        self._sequence = (self._sequence + 1) % 256
        data += bytes((self._sequence,))
        return Frame(self.message.id, data + bytes((check_of(self.message.id, data),)))

    def _raw(self, slot: Slot, value: Value) -> int:
        field, _, _, least, most = slot
        if field.names:
            if value not in field.names:
                raise ValueError(self._about(slot, value, f"expected one of {', '.join(field.names)}"))
            return field.names.index(value)
        if isinstance(value, str) or not isfinite(value) or not field.low <= value <= field.high:
            wanted = f"{field.low:g} to {field.high:g}"
            raise ValueError(self._about(slot, value, f"expected {wanted} {field.unit}".rstrip()))
        number = value / field.scale
        whole = int(number)  # halves away from zero, as C's lround and Ada's rounding have it
        if abs(number - whole) >= 0.5:
            whole += 1 if number > 0 else -1
        return least if whole < least else most if whole > most else whole

    def _about(self, slot: Slot, value: Value, wanted: str) -> str:
        return f"{self.message.name}.{slot.field.name}: {value!r}: {wanted}"

    def _refuse_fields(self, values: Mapping[str, Value]) -> NoReturn:
        missing, unknown = self._own.keys() - values.keys(), values.keys() - self._own.keys()
        said = [f"{name} is missing" for name in sorted(missing)]
        said += [f"there is no field {name}" for name in sorted(unknown)]
        raise ValueError(f"{self.message.name}: {', '.join(said)}")


@lru_cache(maxsize=64)  # each node that receives a frame asks
def _received(layout: Layout, data: bytes) -> Received | None:
    """Return what the bytes of a message say; None: nothing that can be believed."""
    guarded = layout.message.guarded
    if len(data) != layout.length:
        return None
    if guarded and not is_sound(layout.message.id, data):
        return None
    bits = int.from_bytes(data, "little")
    values: dict[str, Value] = {}
    for name, slot in layout.own.items():
        field, start, mask, low, high = slot
        number = bits >> start & mask
        if field.signed and number > mask >> 1:
            number -= mask + 1
        if not low <= number <= high:
            return None
        values[name] = (
            field.names[number] if field.names else bool(number) if field.bits == 1 else number * field.scale
        )
    return Received(layout.message.name, MappingProxyType(values), data[-2] if guarded else None)
