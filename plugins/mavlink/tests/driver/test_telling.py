"""What robots report, as people at ground stations read it."""

import pytest
from flight_crew import robot_of
from hypothesis import given
from hypothesis import strategies as st
from mavlink_peer import HERE, linked
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.driving.moves import Moves
from mmrs_mavlink.links.radio import GROUND_COMPONENT
from mmrs_mavlink.program import Report
from mmrs_mavlink.services.telling import CHUNK, MOST_CHUNKS, pieces_of
from mmrs_mavlink.vehicles.mavlink_vehicle import MavlinkVehicle
from mmrs_mavlink.vehicles.texts import Texts
from mmrs_runtime.clock import Clock
from mmrs_runtime.screen import words_of

ASCII = st.characters(min_codepoint=32, max_codepoint=126)


def heard(text: str) -> list[str]:
    """Return the texts that somebody reads who gets the pieces over a wire."""
    packer, parser, texts = mavlink.MAVLink(None), mavlink.MAVLink(None), Texts(Clock(1.0))
    for piece in pieces_of(text):
        for message in parser.parse_buffer(piece.pack(packer)):
            texts(message, False)
    return [each.text for each in texts.since(0.0)]


@given(st.text(ASCII, min_size=1, max_size=MOST_CHUNKS * CHUNK - 1))
def test_a_text_of_any_length_is_read_as_it_was_said(text):
    assert heard(text) == [text]


@pytest.mark.parametrize("length", [CHUNK, 2 * CHUNK, 3 * CHUNK])
def test_a_text_that_fills_its_pieces_ends(length):
    assert heard("a" * length) == ["a" * length]


def test_a_text_that_is_too_long_for_anybody_ends_with_dots():
    (read,) = heard("long " * 1000)
    assert len(read) < MOST_CHUNKS * CHUNK
    assert read.endswith(" ...")


def test_letters_that_frames_cannot_carry_are_escaped():
    assert heard("400 ppm CO\u2082") == ["400 ppm CO\\u2082"]


def test_several_texts_at_once_are_kept_apart():
    first, second = ({piece.id for piece in pieces_of("a" * 80)} for _ in range(2))
    assert len(first) == len(second) == 1
    assert first != second


def test_a_report_is_told_with_its_robot_and_its_pairs():
    assert words_of("Alba", "gas", {"ppm": "412", "at": "b1"}) == "Alba: gas: ppm 412, at b1"
    assert words_of("Alba", "arrived", {}) == "Alba: arrived"
    assert words_of("Alba", "", {"task": "east"}) == "Alba: task east"


def test_a_report_comes_from_the_vehicles_own_system_which_ground_stations_show():
    with linked() as (link, wire):
        robot = robot_of()
        vehicle = MavlinkVehicle(link, robot.profile, robot.home)
        told = []
        report = Report("gas", (("ppm", "412"),))
        Moves(robot, vehicle, link.clock, {}, lambda *given: told.append(given)).action(report).run()
        ((said, to),) = [(each, to) for each, to in wire.sent if each.get_type() == "STATUSTEXT"]
    assert (said.text, to) == ("alpha: gas: ppm 412", HERE)
    assert (said.get_srcSystem(), said.get_srcComponent()) == (1, GROUND_COMPONENT)
    assert told == [("reported", "gas", {"ppm": "412"})]
