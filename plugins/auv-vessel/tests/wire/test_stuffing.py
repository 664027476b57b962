"""Lengths of frames, against a reference that goes bit by bit another way."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from auv_vessel.wire.frame import Frame
from auv_vessel.wire.load import bits_of, crc_of, length_of, longest, shortest, stuff_bits

FRAMES = st.one_of(
    st.builds(Frame, st.integers(0, 0x7FF), st.binary(max_size=8)),
    st.builds(Frame, st.integers(0, 0x1FFFFFFF), st.binary(max_size=8), st.just(True)),
)
BITS = st.text("01", max_size=140)
RUNS = st.lists(st.tuples(st.sampled_from("01"), st.integers(1, 12)), max_size=20).map(
    lambda runs: "".join(bit * count for bit, count in runs)
)


def stuffed(bits: str) -> str:
    """Return what goes over the wire: looks at the last five that were sent, stuff bits among them."""
    sent = ""
    for bit in bits:
        sent += bit
        if sent[-5:] in ("00000", "11111"):
            sent += "1" if bit == "0" else "0"
    return sent


def taken_apart(sent: str) -> str:
    """Return what a receiver makes of it: the bit after five that are alike is left out."""
    bits, skip = "", False
    for place, bit in enumerate(sent):
        if skip:
            skip = False
            assert bit != sent[place - 1]
        else:
            bits += bit
        if place >= 4 and len(set(sent[place - 4 : place + 1])) == 1:
            skip = True
    return bits


def divided(bits: str) -> int:
    """Return the remainder of long division by the polynomial x^15+x^14+x^10+x^8+x^7+x^4+x^3+1."""
    number = int(bits or "0", 2) << 15
    while number.bit_length() > 15:
        number ^= 0xC599 << number.bit_length() - 16
    return number


@given(st.one_of(BITS, RUNS))
def test_stuff_bits_are_those_of_the_reference(bits: str) -> None:
    sent = stuffed(bits)
    assert stuff_bits(bits) == len(sent) - len(bits)
    assert taken_apart(sent) == bits


@given(BITS)
def test_the_check_is_the_remainder_of_long_division(bits: str) -> None:
    assert crc_of(bits) == divided(bits)
    assert crc_of(f"{bits}{crc_of(bits):015b}") == 0


@given(FRAMES)
def test_frames_are_between_the_shortest_and_the_longest(frame: Frame) -> None:
    least, most = (each(len(frame.data), frame.extended) for each in (shortest, longest))
    assert least <= length_of(frame) <= most
    assert len(bits_of(frame)) + 13 == least
    assert length_of(frame) == len(stuffed(bits_of(frame))) + 13


@pytest.mark.parametrize(
    ("data", "extended", "least", "most"), [(0, False, 47, 55), (8, False, 111, 135), (8, True, 131, 160)]
)
def test_the_figures_of_the_literature(data: int, extended: bool, least: int, most: int) -> None:
    """Davis, Burns, Bril and Lukkien (2007): 55 + 10 n bits, and 80 + 10 n with identifiers of 29 bits."""
    assert (shortest(data, extended), longest(data, extended)) == (least, most)
    assert most == (80 if extended else 55) + 10 * data


def test_the_longest_stuffing_that_is_reached() -> None:
    assert stuff_bits("00000" + "1111" + "0000" * 2) == 3
    assert stuff_bits("0" * 98) == 19
    assert stuff_bits("00000" + "11110000" * 11 + "11111") == 24  # (98 - 1) // 4


@pytest.mark.parametrize(
    ("frame", "begins"),
    [
        (Frame(0x555, b"\xaa"), "0" + "10101010101" + "000" + "0001" + "10101010"),
        (Frame(0x15555555, b"", True), "0" + "10101010101" + "11" + "010101010101010101" + "000" + "0000"),
    ],
)
def test_bits_are_in_the_order_of_the_standard(frame: Frame, begins: str) -> None:
    assert bits_of(frame).startswith(begins)
    assert len(bits_of(frame)) == len(begins) + 15
