"""Reads IMC packets: written from the published definitions of the protocol, apart from what writes them.

Sizes of payloads are those that the definitions state for messages without any text or list in them.
"""

import struct

TEXT, INLINE, MANY = "text", "inline", "many"
PLACE = [("lat", "d"), ("lon", "d"), ("z", "f"), ("z_units", "B")]
FORMS = {
    450: ("Goto", 54, [("timeout", "H"), *PLACE, ("speed", "f"), ("speed_units", "B"), ("roll", "d"),
                       ("pitch", "d"), ("yaw", "d"), ("custom", TEXT)]),
    451: ("PopUp", 37, [("timeout", "H"), *PLACE, ("speed", "f"), ("speed_units", "B"), ("duration", "H"),
                        ("radius", "f"), ("flags", "B"), ("custom", TEXT)]),
    461: ("StationKeeping", 34, [*PLACE, ("radius", "f"), ("duration", "H"), ("speed", "f"),
                                 ("speed_units", "B"), ("custom", TEXT)]),
    551: ("PlanSpecification", 18, [("plan_id", TEXT), ("description", TEXT), ("vnamespace", TEXT),
                                    ("variables", MANY), ("start_man_id", TEXT), ("maneuvers", MANY),
                                    ("transitions", MANY), ("start_actions", MANY), ("end_actions", MANY)]),
    552: ("PlanManeuver", 8, [("maneuver_id", TEXT), ("data", INLINE), ("start_actions", MANY),
                              ("end_actions", MANY)]),
    553: ("PlanTransition", 8, [("source_man", TEXT), ("dest_man", TEXT), ("conditions", TEXT),
                                ("actions", MANY)]),
    556: ("PlanDB", 10, [("type", "B"), ("op", "B"), ("request_id", "H"), ("plan_id", TEXT), ("arg", INLINE),
                         ("info", TEXT)]),
    801: ("EntityParameter", 4, [("name", TEXT), ("value", TEXT)]),
    804: ("SetEntityParameters", 4, [("name", TEXT), ("params", MANY)]),
}  # fmt: skip


def read_packet(data):
    """Return the message of a packet as a dictionary; refuse whatever is not one packet to the byte."""
    sync, number, size, time, source, source_entity, to, to_entity = struct.unpack_from("<HHHdHBHB", data)
    assert sync == 0xFE54
    assert struct.calcsize("<HHHdHBHB") == 20
    assert len(data) == 20 + size + 2
    assert struct.unpack_from("<H", data, 20 + size)[0] == check_sum(data[:-2])
    assert (time, source, source_entity, to, to_entity) == (0.0, 0xFFFF, 0xFF, 0xFFFF, 0xFF)
    message, end = read_message(number, data, 20)
    assert end == 20 + size
    return message


def check_sum(data):
    """Return CRC-16-IBM bit by bit: polynomial x^16 + x^15 + x^2 + 1, least significant bit first."""
    register = 0
    for byte in data:
        for bit in range(8):
            feedback = (byte >> bit & 1) ^ (register & 1)
            register >>= 1
            if feedback:
                register ^= int(f"{0x8005:016b}"[::-1], 2)
    return register


def read_message(number, data, at):
    """Return a message and where it ends."""
    name, _, fields = FORMS[number]
    message = {"": name}
    for field, form in fields:
        if form == TEXT:
            (length,) = struct.unpack_from("<H", data, at)
            message[field] = data[at + 2 : at + 2 + length].decode("ascii")
            at += 2 + length
        elif form == INLINE:
            message[field], at = read_inline(data, at)
        elif form == MANY:
            (count,) = struct.unpack_from("<H", data, at)
            at += 2
            message[field] = []
            for _ in range(count):
                inline, at = read_inline(data, at)
                message[field].append(inline)
        else:
            (message[field],) = struct.unpack_from("<" + form, data, at)
            at += struct.calcsize("<" + form)
    return message, at


def read_inline(data, at):
    """Return a message within another and where it ends; None where there is none."""
    (number,) = struct.unpack_from("<H", data, at)
    return (None, at + 2) if number == 0xFFFF else read_message(number, data, at + 2)


def smallest(number):
    """Return the bytes of a message's payload whose texts and lists are empty."""
    sizes = {TEXT: 2, MANY: 2, INLINE: 2}
    return sum(sizes.get(form) or struct.calcsize("<" + form) for _, form in FORMS[number][2])
