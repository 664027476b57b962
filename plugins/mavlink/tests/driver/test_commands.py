"""Commands: answers, retries, progress, and what is cancelled."""

import threading

import pytest
from mavlink_peer import acknowledged, eventually, linked
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.services.commands import CommandCancel, command
from mmrs_runtime.faults import FaultError, RefusedError, UnansweredError

ARM = mavlink.MAV_CMD_COMPONENT_ARM_DISARM


def in_turn(*answers):
    """Return what answers each command that comes with the next of these; None: not at all."""
    left = iter(answers)

    def answer(message):
        if message.get_type() != "COMMAND_LONG":
            return []
        found = next(left, None)
        return [] if found is None else [found]

    return answer


def test_an_accepted_command_was_sent_once_with_its_parameters():
    with linked(in_turn(acknowledged(ARM))) as (link, wire):
        command(link, ARM, 1.0, 21.0)
        (sent,) = wire.of("COMMAND_LONG")
        assert (sent.command, sent.confirmation, sent.param1, sent.param2, sent.param7) == (ARM, 0, 1, 21, 0)


def test_what_is_not_answered_is_sent_again_with_the_confirmation_counted_up():
    with linked(in_turn(None, None, acknowledged(ARM))) as (link, wire):
        command(link, ARM)
        assert [sent.confirmation for sent in wire.of("COMMAND_LONG")] == [0, 1, 2]


def test_without_any_answer_it_ends_after_the_tries():
    with linked() as (link, wire):
        with pytest.raises(UnansweredError, match="COMPONENT_ARM_DISARM: no answer to 3 tries"):
            command(link, ARM)
        assert len(wire.sent) == 3


def test_a_refusal_is_told_in_words_and_not_repeated():
    with linked(in_turn(acknowledged(ARM, mavlink.MAV_RESULT_DENIED))) as (link, wire):
        with pytest.raises(RefusedError, match="COMPONENT_ARM_DISARM: the vehicle answers 'denied'"):
            command(link, ARM)
        assert len(wire.sent) == 1


def test_a_vehicle_that_asks_for_patience_is_asked_again():
    busy = acknowledged(ARM, mavlink.MAV_RESULT_TEMPORARILY_REJECTED)
    with linked(in_turn(busy, acknowledged(ARM))) as (link, wire):
        command(link, ARM)
        assert len(wire.sent) == 2


def test_a_vehicle_that_always_asks_for_patience_refuses_in_the_end():
    busy = acknowledged(ARM, mavlink.MAV_RESULT_TEMPORARILY_REJECTED)
    with (
        linked(in_turn(busy, busy, busy)) as (link, _),
        pytest.raises(RefusedError, match="temporarily rejected"),
    ):
        command(link, ARM)


def test_progress_is_waited_for_without_sending_again():
    begun = acknowledged(ARM, mavlink.MAV_RESULT_IN_PROGRESS, 10)
    with linked(in_turn(begun)) as (link, wire):
        timer = threading.Timer(0.6, wire.say, [acknowledged(ARM)])
        timer.start()
        command(link, ARM)
        timer.join()
        assert wire.kinds() == ["COMMAND_LONG"]


def test_what_is_broken_off_while_it_is_in_progress_is_cancelled():
    begun = acknowledged(ARM, mavlink.MAV_RESULT_IN_PROGRESS, 10)
    with linked(in_turn(begun)) as (link, wire):

        def guard() -> None:
            if wire.sent:
                raise FaultError("STOPPED", "stop was asked for")

        begin = threading.Event()
        link.guard = lambda: guard() if begin.is_set() else None
        threading.Timer(0.5, begin.set).start()
        cancelled = []
        link.observe(lambda message, outgoing: cancelled.append(message) if outgoing else None)
        with pytest.raises(FaultError, match="stop was asked for"):
            command(link, ARM)
        assert isinstance(cancelled[-1], CommandCancel)
        assert cancelled[-1].command == ARM
        eventually(lambda: wire.kinds()[-1].startswith("UNKNOWN_80") or wire.kinds()[-1] == "COMMAND_CANCEL")


def test_answers_to_other_commands_and_other_stations_are_not_ours():
    other = acknowledged(mavlink.MAV_CMD_NAV_LAND)
    theirs = mavlink.MAVLink_command_ack_message(ARM, mavlink.MAV_RESULT_DENIED, 0, 0, 77, 190)
    with linked(lambda message: [other, theirs, acknowledged(ARM)]) as (link, _):
        command(link, ARM)


def test_a_component_of_its_own_answers_for_itself():
    photo = mavlink.MAV_CMD_IMAGE_START_CAPTURE
    with linked() as (link, wire):

        def answer(message):
            wire.say(acknowledged(photo, mavlink.MAV_RESULT_UNSUPPORTED))
            wire.say(acknowledged(photo), component=100)
            return []

        wire.answer = answer
        command(link, photo, component=100)
        (sent,) = wire.of("COMMAND_LONG")
        assert sent.target_component == 100


def test_what_is_sent_while_the_link_is_silent_does_not_count_where_somebody_watches_it():
    with linked() as (link, wire):
        watched = []

        def guard() -> None:
            watched.append(link.silent_for())
            if link.silent_for() > 1.5:
                raise FaultError("LINK_LOST", "the vehicle has been silent")

        link.guard = guard
        with pytest.raises(FaultError, match="has been silent") as fault:
            command(link, ARM)
        assert fault.value.event == "LINK_LOST"
        assert len(wire.of("COMMAND_LONG")) > 3
