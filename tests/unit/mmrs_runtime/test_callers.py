"""Callers of a server: the silent go, and block none that has something to say."""

import socket
import threading
from contextlib import ExitStack

import pytest

from mmrs_runtime.callers import Callers

pytestmark = pytest.mark.real_time("parts of flights")


class Door:
    """A server with a clock of its own."""

    def __init__(self, stack: ExitStack, most: int) -> None:
        """Listen."""
        self.seconds = 0.0
        self._stack = stack
        self._server = stack.enter_context(socket.create_server(("127.0.0.1", 0)))
        self.callers = Callers(self._server, most, 5.0, b"full\n", tick=0.05, now=lambda: self.seconds)

    def call(self) -> tuple[socket.socket, socket.socket | None]:
        """Return both ends of a connection."""
        near = socket.create_connection(self._server.getsockname(), 5.0)
        self._stack.enter_context(near)
        far = self.callers.take()
        if far is not None:
            self._stack.enter_context(far)
            far.settimeout(0.05)
        return near, far


@pytest.fixture
def door():
    """Return a server with room for two."""
    with ExitStack() as stack:
        yield Door(stack, 2)


def is_heard(far: socket.socket) -> bool:
    try:
        return far.recv(1) != b""
    except TimeoutError:
        return True


def test_the_silent_are_dismissed_in_time_and_no_earlier(door):
    _, far = door.call()
    door.seconds = 4.9
    door.callers.dismiss()
    assert is_heard(far)
    door.seconds = 5.0
    door.callers.dismiss()
    assert not is_heard(far)


def test_a_line_in_drops_wins_no_time(door):
    near, far = door.call()
    for second in range(5):
        door.seconds = float(second)
        near.sendall(b" ")
        door.callers.dismiss()
        assert far.recv(1) == b" "
    door.seconds = 5.0
    door.callers.dismiss()
    assert not is_heard(far)


def test_the_one_that_is_silent_for_longest_gives_way_to_a_newcomer(door):
    first, second, third = (door.call()[1] for _ in range(3))
    assert [is_heard(each) for each in (first, second, third)] == [False, True, True]


def test_one_that_is_served_gives_way_to_none_and_has_all_the_time(door):
    _, served = door.call()
    with door.callers.served(served):
        door.seconds = 100.0
        _, second = door.call()
        _, third = door.call()
        assert [is_heard(each) for each in (served, second, third)] == [True, False, True]
        door.seconds = 104.0
    door.seconds = 108.9
    door.callers.dismiss()
    assert is_heard(served)
    door.seconds = 109.0
    door.callers.dismiss()
    assert not is_heard(served)


def test_where_all_are_served_a_newcomer_reads_that_there_is_no_room(door):
    with ExitStack() as stack:
        for _ in range(2):
            stack.enter_context(door.callers.served(door.call()[1]))
        near, far = door.call()
        assert (far, near.recv(100)) == (None, b"full\n")


def test_one_that_has_gone_takes_no_room(door):
    _, first = door.call()
    _, second = door.call()
    door.callers.leave(second)
    door.call()
    assert is_heard(first)


def test_whoever_is_served_gets_the_answer_before_the_end(door):
    near, far = door.call()
    ended = threading.Event()

    def finish() -> None:
        door.callers.finish(60.0)
        ended.set()

    with door.callers.served(far):
        threading.Thread(target=finish, daemon=True).start()
        assert not ended.wait(0.1)
        far.sendall(b"done\n")
    assert ended.wait(60.0)
    assert near.recv(5) == b"done\n"


def test_the_end_waits_for_nobody_for_ever(door):
    _, far = door.call()
    with door.callers.served(far):
        door.callers.finish(0.01)
