"""Programs that go, hang or are silent are lost peers, and so are those of gateways that end."""

import os
import signal
import socket
import threading
import time
from contextlib import suppress

import pytest
from stalls import Stalls
from warm_python import FREEZE

from mmrs_runtime.bus.gateway.server import Gateway

pytestmark = pytest.mark.real_time("buses")

LEASE = 1.5


@pytest.fixture
def seconds_until_lost(peer, until):
    """Return a function that has something happen once 'a' is there, and says after how long 'a' is lost.

    Seconds for which the machine stalls do not count.
    """

    def lose(happen):
        stalls = Stalls()
        until(lambda: not peer.missing(["a"]))
        happen()
        return until(lambda: peer.lost(["a"])) - stalls.seconds

    return lose


def test_a_program_that_goes_is_a_lost_peer(client, seconds_until_lost):
    assert seconds_until_lost(client.close) < 0.5


def test_a_program_that_hangs_is_a_lost_peer_until_it_speaks_again(gateway, peer, until):
    with gateway.connect() as client:
        client.ask(gateway.hello(alive=1), "welcome")
        stalls = Stalls()
        until(lambda: not peer.missing(["a"]))
        seconds = until(lambda: peer.lost(["a"]))
        assert 0.5 - stalls.seconds < seconds < 2.0 + stalls.seconds
        client.ask({"do": "alive"}, "alive")
        until(lambda: not peer.missing(["a"]))


def test_a_program_that_reads_nothing_is_a_lost_peer(gateway, peer, until):
    with gateway.connect() as deaf:
        deaf.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)  # else it takes megabytes to fill
        deaf.ask(gateway.hello(alive=1), "welcome")
        until(lambda: not peer.missing(["a"]))
        with suppress(OSError):
            while not peer.lost(["a"]):
                deaf.socket.sendall(b'{"do": "state"}\n' * 1000)
        until(lambda: peer.lost(["a"]))


def test_a_program_that_goes_while_it_waits_to_begin_is_a_lost_peer(client, seconds_until_lost):
    client.say({"do": "begin", "robots": ["a", "b"], "seconds": 60})
    assert seconds_until_lost(client.close) < 2.0


def test_a_program_that_has_waited_to_begin_was_not_silent(gateway, peer, until):
    with gateway.connect() as client:
        client.ask(gateway.hello(alive=1), "welcome")
        until(lambda: not peer.missing(["a"]))
        stalls = Stalls()
        client.ask({"do": "begin", "robots": ["a", "b"], "seconds": 2}, "wrong")
        assert until(lambda: peer.lost(["a"])) > 0.5 - stalls.seconds


@pytest.mark.thorough
def test_a_program_notices_that_its_peer_has_gone(client, peer, until):
    until(lambda: not peer.missing(["a"]))
    time.sleep(0.2)
    peer.close()
    until(lambda: client.ask({"do": "lost", "robots": ["b"]}, "lost")["robots"] == ["b"])


@pytest.mark.thorough
def test_a_gateway_without_a_program_keeps_no_robot(gateway, peer):
    time.sleep(1.0)
    assert peer.missing(["a"]) == ("a",)


def test_a_gateway_that_is_killed_is_a_lost_peer(gateway, client, seconds_until_lost):
    assert seconds_until_lost(lambda: os.kill(gateway.process.pid, signal.SIGKILL)) < 0.5


@pytest.mark.thorough
def test_a_gateway_that_is_frozen_is_a_lost_peer(gateway, client, seconds_until_lost):
    assert seconds_until_lost(lambda: os.kill(gateway.process.pid, FREEZE)) < 1.5 * LEASE


def test_a_gateway_ends_when_it_is_interrupted(gateway, client):
    gateway.process.send_signal(signal.SIGINT)
    assert gateway.process.wait(10.0) == 0
    assert not gateway.file.exists()


@pytest.fixture
def idle(tmp_path):
    """Return a gateway of this process to which no program comes; SIGUSR1 closes it, as an interrupt does."""
    made = Gateway("a", "run-0", lambda recorded: pytest.fail("nobody comes"), tmp_path)
    before = signal.signal(signal.SIGUSR1, lambda number, frame: threading.Thread(target=made.close).start())
    yield made
    signal.signal(signal.SIGUSR1, before)
    made.close()


def test_a_gateway_ends_at_a_signal_that_does_not_break_its_waiting_off(idle):
    """Another thread takes the signal; the main thread, whose handler it is, waits for connections."""
    rescue = threading.Timer(8.0, idle.close)
    signals = threading.Timer(0.2, signal.raise_signal, [signal.SIGUSR1])
    stalls, begun = Stalls(), time.monotonic()
    for timer in (rescue, signals):
        timer.start()
    idle.serve(print)
    seconds = time.monotonic() - begun
    rescue.cancel()
    assert seconds < 3.0 + stalls.seconds
