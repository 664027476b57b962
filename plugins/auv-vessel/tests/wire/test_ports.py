"""Ports: what is sent arrives, and a bus that is gone is noticed."""

import socket
import threading
import time
from collections.abc import Callable
from uuid import uuid4

import can
import pytest
from can.interfaces.virtual import VirtualBus
from can_hub import Raw, running
from patience import wait_for

from auv_vessel.wire.frame import Frame
from auv_vessel.wire.ports import Port, PortError, open_port

FRAMES = [Frame(0x123, b"\1\2\3"), Frame(0x7FF, b""), Frame(0x1ABCDEF0, bytes(range(8)), True)]


@pytest.fixture(params=["virtual", "socketcand"])
def opened(request: pytest.FixtureRequest):
    """Return what opens a port of one bus."""
    channel = str(uuid4())[:8]
    if request.param == "virtual":
        yield lambda: open_port("virtual", channel)
        return
    with running() as hub:
        yield lambda: open_port("socketcand", f"{channel}@127.0.0.1:{hub.port}")


def test_frames_go_from_one_to_all_others(opened: Callable[[], Port]) -> None:
    with opened() as first, opened() as second, opened() as third:
        time.sleep(0.05)
        for frame in FRAMES:
            first.send(frame)
        assert [second.receive(5) for _ in FRAMES] == FRAMES
        assert [third.receive(5) for _ in FRAMES] == FRAMES
        assert first.receive(0.02) is None
        assert not first.errors
        assert not second.errors


@pytest.mark.parametrize(
    "frame", [Frame(0x900, b""), Frame(1 << 29, b"", True), Frame(-1, b""), Frame(0x100, bytes(9))]
)
def test_what_is_no_frame_is_not_sent(opened: Callable[[], Port], frame: Frame) -> None:
    with opened() as port, pytest.raises(ValueError, match="no frame of classic CAN"):
        port.send(frame)


def test_nothing_comes_from_a_quiet_bus_in_the_time_that_was_given(opened: Callable[[], Port]) -> None:
    with opened() as port:
        begin = time.monotonic()
        assert port.receive(0.0) is None
        assert port.receive(0.1) is None
        assert 0.1 <= time.monotonic() - begin < 1.0


def test_a_port_that_was_closed_says_so_and_ends_its_thread(opened: Callable[[], Port]) -> None:
    port = opened()
    port.close()
    port.close()
    with pytest.raises(PortError, match="was closed"):
        port.send(FRAMES[0])
    with pytest.raises(PortError, match="was closed"):
        port.receive(0.0)
    assert not port._reader.is_alive()


def test_who_waits_is_told_when_the_port_is_closed(opened: Callable[[], Port]) -> None:
    port = opened()
    threading.Timer(0.1, port.close).start()
    begin = time.monotonic()
    with pytest.raises(PortError):
        port.receive(30)
    assert time.monotonic() - begin < 5


def test_the_oldest_frames_go_when_nobody_takes_them() -> None:
    channel = str(uuid4())
    with open_port("virtual", channel, most_waiting=10) as slow, open_port("virtual", channel) as said:
        for number in range(25):
            said.send(Frame(number, b""))
        assert wait_for(lambda: slow.errors["overrun"] == 15)
        assert [slow.receive(0) for _ in range(10)] == [Frame(number, b"") for number in range(15, 25)]


def test_what_is_no_data_frame_is_counted() -> None:
    channel = str(uuid4())
    with open_port("virtual", channel) as port, can.Bus(interface="virtual", channel=channel) as bus:
        bus.send(can.Message(arbitration_id=1, is_remote_frame=True))
        bus.send(can.Message(arbitration_id=1, is_error_frame=True))
        bus.send(can.Message(arbitration_id=1, is_fd=True, data=bytes(12)))
        bus.send(can.Message(arbitration_id=1, data=b"\5", is_extended_id=False))
        assert port.receive(5) == Frame(1, b"\5")
        assert port.errors == {"remote": 1, "error": 1, "long": 1}


def test_each_sort_of_error_is_told_when_it_first_happens_and_counted_until_the_end() -> None:
    channel, told = str(uuid4()), list[str]()
    with can.Bus(interface="virtual", channel=channel) as bus:
        port = open_port("virtual", channel, say=told.append)
        for _ in range(3):
            bus.send(can.Message(arbitration_id=1, is_remote_frame=True))
        assert wait_for(lambda: port.errors["remote"] == 3)
        assert told == ["errors of the bus: remote frames"]
        bus.send(can.Message(arbitration_id=1, is_error_frame=True))
        assert wait_for(lambda: port.errors["error"] == 1)
        port.close()
        port.close()
    assert told[1:] == ["errors of the bus: error frames", "errors of the bus: 1 error, 3 remote"]


def test_a_hub_that_ends_is_noticed_by_who_only_listens() -> None:
    with running() as hub, open_port("socketcand", "can0", port=hub.port) as port, Raw(hub.port) as said:
        said.say("< send 100 1 5 >")
        assert wait_for(lambda: len(port._frames) == 1)
        hub.stop()
        assert port.receive(5) == Frame(0x100, b"\5")
        with pytest.raises(PortError, match="has ended the connection"):
            port.receive(5)
        with pytest.raises(PortError):
            port.send(FRAMES[0])
        assert wait_for(lambda: not port._reader.is_alive())


def test_a_hub_that_takes_nothing_any_more_holds_nobody_up_for_long() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:

        def answer() -> None:
            server.accept()[0].close()  # who only looks whether anybody is there
            stuck.append(server.accept()[0])
            for word in (b"< hi >", b"< ok >", b"< ok >"):
                stuck[0].sendall(word)
                time.sleep(0.1)

        stuck: list[socket.socket] = []
        threading.Thread(target=answer).start()
        port = open_port("socketcand", "can0", port=server.getsockname()[1])
        longest = 0.0

        def send() -> None:
            nonlocal longest
            for _ in range(1_000_000):
                begin = time.monotonic()
                try:
                    port.send(FRAMES[2])
                finally:
                    longest = max(longest, time.monotonic() - begin)

        try:
            with pytest.raises(PortError, match=r"cannot be written to|has ended the connection"):
                send()
            assert longest < 3.0
        finally:
            port.close()
            stuck[0].close()


def test_a_hub_that_comes_late_is_waited_for() -> None:
    with running() as other:
        pass
    late = running(port=other.port)
    timer = threading.Timer(0.3, late.__enter__)
    timer.start()
    with open_port("socketcand", "can0", port=other.port, patience=10) as port:
        port.send(FRAMES[0])
    timer.join()
    late.__exit__(None, None, None)


def test_where_no_hub_is_that_is_told_in_time() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        begin = time.monotonic()
        with pytest.raises(PortError, match=r"no hub at 127\.0\.0\.1:"):
            open_port("socketcand", "can0", port=taken.getsockname()[1], patience=0.2)
        assert time.monotonic() - begin < 3


@pytest.mark.parametrize("channel", ["can0@", "can0@host", "can0@:1", "can0@host:x"])
def test_misspelt_channels_of_a_hub(channel: str) -> None:
    with pytest.raises(ValueError, match="expected CHANNEL@HOST:PORT"):
        open_port("socketcand", channel)


def test_interfaces_that_there_are_not() -> None:
    with pytest.raises(ValueError, match="interface 'nosuch'"):
        open_port("nosuch", "can0")
    with pytest.raises(PortError, match="socketcan nosuch0"):
        open_port("socketcan", "nosuch0")


class LocalBus(VirtualBus):
    """Marks frames as Linux does: those of every process of this computer were not received from outside."""

    def recv(self, timeout: float | None = None) -> can.Message | None:
        message = super().recv(timeout)
        if message is not None:
            message.is_rx = False
        return message


def test_processes_of_one_computer_hear_each_other_though_linux_marks_their_frames() -> None:
    channel = str(uuid4())[:8]
    with Port(LocalBus(channel)) as first, Port(LocalBus(channel)) as second:
        for frame in FRAMES:
            first.send(frame)
        assert [second.receive(5) for _ in FRAMES] == FRAMES
        second.send(FRAMES[0])
        assert first.receive(5) == FRAMES[0]
        assert not first.errors
        assert not second.errors


def test_what_an_adapter_gives_back_of_ones_own_is_not_heard_and_is_counted() -> None:
    bus = VirtualBus(str(uuid4())[:8], receive_own_messages=True)
    with Port(bus, echoes=True) as port:
        port.send(FRAMES[0])
        assert port.receive(0.3) is None
        assert port.errors == {"echo": 1}


@pytest.mark.parametrize(
    ("interface", "options"), [("virtual", {"receive_own_messages": True}), ("udp_multicast", {})]
)
def test_interfaces_that_would_give_back_ones_own_frames_are_refused(
    interface: str, options: dict[str, bool]
) -> None:
    with pytest.raises(ValueError, match="its own frames as if another had sent them"):
        open_port(interface, "can0", **options)
