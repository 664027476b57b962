"""The hub, with python-can's client, with a client by sockets alone, and with people who mean no good."""

import asyncio
import os
import signal
import socket
import struct
import subprocess
import sys
from itertools import pairwise

import can
import pytest
from can_hub import Raw, running
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from patience import wait_for

from auv_vessel.wire import hub as hubs
from auv_vessel.wire.frame import Frame
from auv_vessel.wire.hub import Hub, is_loopback, log_line
from auv_vessel.wire.socketcand import LONGEST, frame_of, frame_word, words_of

FRAMES = st.one_of(
    st.builds(Frame, st.integers(0, 0x7FF), st.binary(max_size=8)),
    st.builds(Frame, st.integers(0, 0x1FFFFFFF), st.binary(max_size=8), st.just(True)),
)


def client(port: int, channel: str = "can0") -> can.BusABC:
    return can.Bus(interface="socketcand", channel=channel, host="127.0.0.1", port=port, tcp_tune=True)


def test_clients_of_python_can_and_by_sockets_hear_each_other_and_not_themselves() -> None:
    with running() as hub, client(hub.port) as first, client(hub.port) as second, Raw(hub.port) as third:
        first.send(can.Message(arbitration_id=0x123, data=[1, 0xAB], is_extended_id=False))
        heard = second.recv(5)
        assert heard is not None
        assert (heard.arbitration_id, bytes(heard.data), heard.is_extended_id) == (0x123, b"\x01\xab", False)
        assert third.word().split()[:3] == ["<", "frame", "123"]
        third.say("< send 1ABCDEF0 0 >")
        for bus in (first, second):
            heard = bus.recv(5)
            assert heard is not None
            assert (heard.arbitration_id, bytes(heard.data), heard.is_extended_id) == (0x1ABCDEF0, b"", True)
        assert first.recv(0.05) is None


@pytest.mark.parametrize("said", ["", "< open can0 >"])
def test_a_client_that_never_hears_the_bus_takes_no_room(said: str) -> None:
    with running(Hub(greeting_seconds=0.1)) as hub, Raw(hub.port, listens=None) as idle:
        assert idle.word() == "< hi >"
        idle.say(said)
        words = [idle.word(), idle.word(), idle.word()]
        assert any("no channel and rawmode within 0.1 s" in word for word in words)
        assert words[-1] == ""
        assert wait_for(lambda: hub.hub.clients == 0)


def test_a_client_that_hears_the_bus_may_be_silent_for_long() -> None:
    with running(Hub(greeting_seconds=0.05)) as hub, Raw(hub.port) as first, Raw(hub.port) as second:
        with Raw(hub.port, listens=None) as idle:
            assert [idle.word(), idle.word()[:7], idle.word()] == ["< hi >", "< error", ""]
        first.say("< send 123 0 >")
        assert second.word().split()[:3] == ["<", "frame", "123"]


@given(FRAMES)
@settings(max_examples=50, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_frames_are_told_as_python_can_reads_them(frame: Frame) -> None:
    from can.interfaces.socketcand.socketcand import (
        convert_ascii_message_to_can_message,
        convert_can_message_to_ascii_message,
    )

    read = convert_ascii_message_to_can_message(frame_word(frame, 12.5).decode())
    assert (read.arbitration_id, bytes(read.data), read.is_extended_id) == (
        frame.id,
        frame.data,
        frame.extended,
    )
    said = can.Message(arbitration_id=frame.id, data=frame.data, is_extended_id=frame.extended)
    (word,) = words_of(bytearray(convert_can_message_to_ascii_message(said).encode()))
    assert word[0] == "send"
    assert frame_of(word[1:]) == frame


@given(st.binary(max_size=400), st.lists(st.integers(0, 400), max_size=5))
@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_words_are_the_same_however_they_arrive(text: bytes, cuts: list[int]) -> None:
    def heard(pieces: list[bytes]) -> list[list[str]]:
        buffer, words = bytearray(), []
        for piece in pieces:
            buffer += piece
            try:
                words += words_of(buffer)
            except ValueError:
                return [*words, ["too long"]]
            assert len(buffer) <= LONGEST
        return words

    places = sorted({0, len(text), *(min(cut, len(text)) for cut in cuts)})
    pieces = [text[begin:end] for begin, end in pairwise(places)]
    whole, cut = heard([text]), heard(pieces)
    assert cut == whole or ["too long"] in cut  # a long word that was whole in one piece is let through


def test_channels_are_buses_of_their_own() -> None:
    with (
        running() as hub,
        Raw(hub.port, listens="can1") as other,
        Raw(hub.port) as said,
        Raw(hub.port) as heard,
    ):
        said.say("< send 100 1 5 >")
        assert heard.word().startswith("< frame 100 ")
        other.say("< echo >")
        assert other.word() == "< echo >"


def test_the_answer_comes_alone_for_clients_that_take_what_they_read_for_one_word(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # Long enough for a client on a computer with other work to read the answer before what follows it.
    monkeypatch.setattr("auv_vessel.wire.hub._HOLD", 2.0)
    with running() as hub, Raw(hub.port) as busy, Raw(hub.port, listens=None) as late:
        assert late.word() == "< hi >"
        late.say("< open can0 >")
        assert late.word() == "< ok >"
        late.say("< rawmode >")
        assert wait_for(lambda: sum(each._raw for each in tuple(hub.hub._clients)) == 2)
        busy.say("< send 100 1 5 >")
        assert wait_for(lambda: hub.hub.counts["frames"] == 1)
        assert late.socket.recv(4096) == b"< ok >"
        assert late.word().startswith("< frame 100 ")


def test_order_of_one_sender_is_kept() -> None:
    with running() as hub, Raw(hub.port) as said, Raw(hub.port) as heard:
        said.say("".join(f"< send 100 2 {number // 256:x} {number % 256:x} >" for number in range(1000)))
        words = [heard.word().split()[4] for _ in range(1000)]
        assert words == [f"{number:04X}" for number in range(1000)]


def test_a_client_of_python_can_is_told_by_an_error_frame_and_goes_on() -> None:
    with running() as hub, client(hub.port) as bus, Raw(hub.port) as other:
        bus.send(can.Message(arbitration_id=0x123, is_remote_frame=True, dlc=4, is_extended_id=False))
        told = bus.recv(5)
        assert told is not None
        assert told.is_error_frame
        other.say("< send 100 1 5 >")
        heard = bus.recv(5)
        assert heard is not None
        assert heard.arbitration_id == 0x100


@pytest.mark.parametrize(
    "said",
    [
        "< send 100 2 5 >",
        "< send 100 9 1 2 3 4 5 6 7 8 9 >",
        "< send 100 12 1 2 3 4 5 6 7 8 9 a b c >",
        "< send 100 01 1 >",
        "< send 100 1 xyz >",
        "< send 100 1 100 >",
        "< send 800 1 1 >",
        "< send FFFFFFFF 1 1 >",
        "< send -10 1 1 >",
        "< send 100 -1 >",
        "< send 1000 1 1 >",
        "< send >",
        "< >",
        "< open can1 >",
        "< rawmode >",
        "< isotpmode >",
        "\xff\xfe< \xff >",
    ],
)
def test_what_is_not_understood_is_told_and_the_client_goes_on(said: str) -> None:
    with running() as hub, Raw(hub.port) as odd, Raw(hub.port) as other:
        odd.say(said.encode("latin-1"))
        assert odd.word().startswith("< error ")
        odd.say("< send 123 1 7 >")
        assert other.word().startswith("< frame 123 ")
        assert hub.hub.counts["wrong"] == 1


@pytest.mark.parametrize(
    "said", ["< send 100 1 5 >", "< rawmode >", "< open a/b >", "< open >", "< open " + "x" * 40 + " >"]
)
def test_nothing_is_said_before_the_channel_is_open(said: str) -> None:
    with running() as hub, Raw(hub.port, listens=None) as early:
        assert early.word() == "< hi >"
        early.say(said)
        assert early.word().startswith("< error ")


def test_who_says_words_without_end_or_only_nonsense_is_sent_away() -> None:
    with (
        running() as hub,
        Raw(hub.port) as endless,
        Raw(hub.port) as mad,
        Raw(hub.port) as said,
        Raw(hub.port) as heard,
    ):
        endless.say("< send " + "1" * 1000)
        assert endless.word().endswith(" a word without end >")
        assert endless.word() == ""
        mad.say("< nonsense >" * 200)
        assert "" in [mad.word() for _ in range(101)]
        said.say("< send 100 1 5 >")
        assert heard.word().startswith("< frame 100 ")
        assert hub.hub.clients == 2


@given(st.binary(max_size=300))
@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_garbage_leaves_the_others_alone(garbage: bytes) -> None:
    with (
        Raw(_SHARED.port) as odd,
        Raw(_SHARED.port, listens="quiet") as said,
        Raw(_SHARED.port, listens="quiet") as heard,
    ):
        odd.say(garbage)
        said.say("< send 100 1 5 >")
        assert heard.word().startswith("< frame 100 ")


@pytest.fixture(autouse=True, scope="module")
def _shared():
    global _SHARED
    with running() as _SHARED:
        yield


def test_a_client_that_does_not_read_misses_frames_and_holds_up_nobody() -> None:
    with running() as hub, Raw(hub.port) as said, Raw(hub.port) as heard, Raw(hub.port, listens=None) as slow:
        slow.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        slow.say("< open can0 >< rawmode >")
        for _ in range(12):
            said.say("< send 100 8 1 2 3 4 5 6 7 8 >" * 1000)
            for _ in range(1000):
                assert heard.word().startswith("< frame 100 ")
            if hub.hub.counts["missed"]:
                break
        assert hub.hub.counts["missed"] > 0
        assert all(
            each._transport.get_write_buffer_size() <= hubs.MOST_BEHIND + LONGEST for each in hub.hub._clients
        )
        while slow.word() != "< ok >":
            pass
        assert slow.word() == "< ok >"  # it hears what came first


def test_clients_that_are_killed_are_forgotten() -> None:
    code = (
        "import can, sys, time; bus = can.Bus(interface='socketcand', channel='can0', host='127.0.0.1', "
        "port=int(sys.argv[1])); print('there', flush=True); time.sleep(60)"
    )
    with running() as hub, Raw(hub.port) as said, Raw(hub.port) as heard:
        child = subprocess.Popen(
            [sys.executable, "-c", code, str(hub.port)], stdout=subprocess.PIPE, text=True
        )
        try:
            assert child.stdout is not None
            assert child.stdout.readline() == "there\n"
            assert hub.hub.clients == 3
        finally:
            os.kill(child.pid, signal.SIGKILL)
            child.communicate()
        assert wait_for(lambda: hub.hub.clients == 2)
        said.say("< send 100 1 5 >")
        assert heard.word().startswith("< frame 100 ")


def test_connections_that_are_reset_are_forgotten() -> None:
    with running() as hub, Raw(hub.port) as said, Raw(hub.port) as heard:
        rude = Raw(hub.port)
        rude.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        rude.close()
        assert wait_for(lambda: hub.hub.clients == 2)
        said.say("< send 100 1 5 >")
        assert heard.word().startswith("< frame 100 ")


def test_many_clients_all_hear_and_one_too_many_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hubs, "MOST_CLIENTS", 60)
    with running() as hub:
        clients = [Raw(hub.port) for _ in range(60)]
        clients[0].say("< send 100 1 5 >")
        assert all(each.word().startswith("< frame 100 ") for each in clients[1:])
        with Raw(hub.port, listens=None) as late:
            assert late.word().endswith(" there are 60 clients >")
            assert late.word() == ""
        for each in clients:
            each.close()
        assert wait_for(lambda: hub.hub.clients == 0)


def test_the_log_is_one_that_python_can_plays(tmp_path) -> None:
    path = tmp_path / "bus.log"
    frames = [Frame(0x100, b"\1\2"), Frame(0x1ABCDEF0, b"", True)]
    path.write_text("".join(log_line(1.5 + each, "can0", frame) for each, frame in enumerate(frames)))
    with can.LogReader(path) as log:
        read = [(each.timestamp, each.arbitration_id, bytes(each.data), each.is_extended_id) for each in log]
    assert read == [(1.5, 0x100, b"\1\2", False), (2.5, 0x1ABCDEF0, b"", True)]


@pytest.mark.parametrize(
    ("host", "expected"),
    [
        ("127.0.0.1", True),
        ("::1", True),
        ("localhost", True),
        ("0.0.0.0", False),
        ("10.0.0.1", False),
        ("example.org", False),
    ],
)
def test_addresses_that_only_this_machine_reaches(host: str, expected: bool) -> None:
    assert is_loopback(host) is expected


def test_a_client_that_is_going_is_told_no_more(caplog: pytest.LogCaptureFixture) -> None:
    async def told() -> bool:
        hub = Hub()
        port = await hub.start()
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        for word in (b"< open can0 >", b"< rawmode >"):
            await reader.readuntil(b">")
            writer.write(word)
        await reader.readuntil(b">")
        (client,) = hub._clients
        while client._held is not None:
            await asyncio.sleep(0.01)
        client._transport.abort()
        missed = [client.tell(b"< frame 1 0.0  >") for _ in range(10)]
        await hub.stop()
        writer.close()
        return all(missed)

    assert asyncio.run(told())
    assert caplog.messages == []
