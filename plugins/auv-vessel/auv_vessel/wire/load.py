"""The load of a vehicle's bus: as designed, and as measured."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import ceil, floor

from auv_vessel.sheet import Sheet
from auv_vessel.wire.catalogue import Message, layout_of, messages_of
from auv_vessel.wire.frame import Frame

POLYNOMIAL = 0x4599
TAIL = 13
"""Bits after the check, which are not stuffed: delimiters and acknowledge, end of frame, and the pause."""

_STANDARD, _EXTENDED = 34, 54
"""Bits before the tail without data and stuff bits: start, identifier, control, check."""


def crc_of(bits: str) -> int:
    """Return CRC-15 of a frame's bits up to its data, a text of 0 and 1."""
    crc = 0
    for bit in bits:
        crc = (crc << 1) ^ (POLYNOMIAL | 0x8000 if (bit == "1") != bool(crc & 0x4000) else 0)
        crc &= 0x7FFF
    return crc


def bits_of(frame: Frame) -> str:
    """Return a frame's bits from its start to its check, before stuffing, as a text of 0 and 1."""
    length = f"{len(frame.data):04b}"
    if frame.extended:
        id = f"{frame.id:029b}"
        head = f"0{id[:11]}11{id[11:]}000"
    else:
        head = f"0{frame.id:011b}000"
    said = head + length + "".join(f"{byte:08b}" for byte in frame.data)
    return said + f"{crc_of(said):015b}"


def stuff_bits(bits: str) -> int:
    """Return how many bits are put between these: one of the other value after every five that are alike."""
    count = run = 0
    last = ""
    for bit in bits:
        run = run + 1 if bit == last else 1
        last = bit
        if run == 5:
            count, run = count + 1, 1
            last = "1" if bit == "0" else "0"
    return count


def length_of(frame: Frame) -> int:
    """Return for how many bit times a frame keeps the bus, the pause after it included."""
    bits = bits_of(frame)
    return len(bits) + stuff_bits(bits) + TAIL


def longest(data_bytes: int, extended: bool = False) -> int:
    """Return for how many bit times a frame with so much data keeps the bus at most, whatever it says."""
    stuffed = shortest(data_bytes, extended) - TAIL
    return stuffed + (stuffed - 1) // 4 + TAIL


def shortest(data_bytes: int, extended: bool = False) -> int:
    """Return for how many bit times a frame with so much data keeps the bus if nothing is stuffed."""
    return (_EXTENDED if extended else _STANDARD) + 8 * data_bytes + TAIL


_WINDOW = 0.1
"""Seconds over which the load of a bus is measured."""

_ROUNDING = 1e-6
"""Part of a window by which a time may come before it and still count in it: times are rounded."""


@dataclass(frozen=True, slots=True)
class Share:
    """What a message takes of the bus.

    Attributes:
        period: seconds between two of them; None: it is only sent when there is something to say.
        shortest, longest: bits without any stuff bit, and with as many as there can be.
        latest: seconds after which it is on the bus and over at the latest, if all are sent as often as
            they are to be, none is repeated, and nodes say them when they are due; None: no limit is known.
    """

    name: str
    id: int
    period: float | None
    shortest: int
    longest: int
    latest: float | None


@dataclass(frozen=True, slots=True)
class Load:
    """How busy a bus is by design; parts of its time.

    Attributes:
        least, most: without any stuff bit, and with as many as there can be.
        shares: of the messages, by identifier.
    """

    bit_rate: int
    least: float
    most: float
    shares: tuple[Share, ...]


@dataclass(frozen=True, slots=True)
class MeasuredLoad:
    """The load of a bus, by the stuff bits of the frames received; fractions of its time.

    Attributes:
        mean: over all the time.
        median, high: of all windows, and the 99th percentile.
        peak: of the busiest window.
        stuffing: stuff bits in a hundred others.
    """

    frames: int
    seconds: float
    window: float
    mean: float
    median: float
    high: float
    peak: float
    stuffing: float


def load_of(sheet: Sheet) -> Load:
    """Return how busy a vehicle's bus is if all messages with a period are sent as often as that.

    Raises:
        SheetError: a bus cannot be made of the vehicle's data; lists all that is wrong.
    """
    messages = messages_of(sheet)
    lengths = [layout_of(message).length for message in messages]
    least = sum(shortest(n) / m.period for n, m in zip(lengths, messages, strict=True) if m.period)
    most = sum(longest(n) / m.period for n, m in zip(lengths, messages, strict=True) if m.period)
    shares = tuple(
        Share(
            m.name,
            m.id,
            m.period,
            shortest(n),
            longest(n),
            _latest(number, messages, lengths, sheet.bit_rate),
        )
        for number, (m, n) in enumerate(zip(messages, lengths, strict=True))
    )
    return Load(sheet.bit_rate, least / sheet.bit_rate, most / sheet.bit_rate, shares)


def _latest(number: int, messages: Sequence[Message], lengths: Sequence[int], rate: float) -> float | None:
    """Return by when a message is over in the worst case.

    It waits for the longest frame that may just have begun, and for all with lower identifiers that come
    meanwhile (Davis, Burns, Bril and Lukkien 2007, equations 3 to 5, their sufficient form). Messages
    without a period are not reckoned with: they are few.
    """
    own = longest(lengths[number]) / rate
    blocking = max(longest(length) for length in lengths[number:]) / rate
    before = [
        (longest(length) / rate, message.period)
        for length, message in zip(lengths[:number], messages[:number], strict=True)
        if message.period
    ]
    limit = max(message.period or 0.0 for message in messages)
    waiting, last = blocking, -1.0
    while waiting != last:
        if waiting > limit:
            return None
        last = waiting
        waiting = blocking + sum(ceil((last + 1.0 / rate) / period) * each for each, period in before)
    return waiting + own


def measured_load(frames: Iterable[tuple[float, Frame]], bit_rate: int) -> MeasuredLoad | None:
    """Return how busy a bus was.

    Args:
        frames: with the times in seconds at which they were received, in order.
        bit_rate: that the bus has or, if it is a hub, would have.

    Returns:
        None if there are not two frames at different times.
    """
    windows: dict[int, int] = {}
    count = bits = plain = 0
    first = last = None
    for time, frame in frames:
        first = time if first is None else first
        last = time
        length = length_of(frame)
        number = floor((time - first) / _WINDOW + _ROUNDING)
        windows[number] = windows.get(number, 0) + length
        count, bits = count + 1, bits + length
        plain += shortest(len(frame.data), frame.extended)
    if first is None or last is None or last <= first:
        return None
    whole = max(1, floor((last - first) / _WINDOW + _ROUNDING))
    shares = sorted(windows.get(each, 0) / (bit_rate * _WINDOW) for each in range(whole))
    return MeasuredLoad(
        count, last - first, _WINDOW, bits / bit_rate / (last - first),
        _part(shares, 0.5), _part(shares, 0.99), shares[-1], 100.0 * (bits - plain) / plain,
    )  # fmt: skip


def _part(values: Sequence[float], part: float) -> float:
    """Return the value below which that part of the sorted ones is, by nearest rank."""
    return values[max(0, ceil(part * len(values)) - 1)]
