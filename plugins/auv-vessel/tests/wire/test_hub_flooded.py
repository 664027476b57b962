"""A hub that one client floods serves the others as before."""

import socket
import threading
import time
from collections.abc import Iterator
from contextlib import suppress

from can_hub import Raw, running

from auv_vessel.wire.hub import MOST_RATE


def test_a_client_that_says_too_much_waits_and_the_others_hear_each_other() -> None:
    block = b"< send 7ff 8 1 2 3 4 5 6 7 8 >" * 200
    ended = threading.Event()

    def flood(client: Raw) -> None:
        with suppress(OSError):
            while not ended.is_set():
                client.socket.sendall(block)

    def drain(client: Raw) -> None:
        with suppress(OSError):
            while client.socket.recv(65536):
                pass

    def frames(client: Raw) -> Iterator[str]:
        while word := client.word():
            if word.startswith("< frame 100 "):
                yield word

    with (
        running() as hub,
        Raw(hub.port) as loud,
        Raw(hub.port) as said,
        Raw(hub.port) as heard,
        Raw(hub.port) as slow,
    ):
        slow.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        threads = [threading.Thread(target=act, args=(loud,)) for act in (flood, drain)]
        threads.append(threading.Thread(target=drain, args=(said,)))
        for thread in threads:
            thread.start()
        arriving, late = frames(heard), []
        for number in range(60):
            begin = time.monotonic()
            said.say(f"< send 100 1 {number:x} >")
            assert next(arriving).endswith(f" {number:02X} >")
            late.append(time.monotonic() - begin)
            time.sleep(0.02)
        ended.set()
        assert sorted(late)[len(late) // 2] < 0.25
        assert hub.hub.counts["slowed"] > 50
        assert hub.hub.counts["frames"] < 60 + MOST_RATE * (sum(late) + 60 * 0.03 + 1.0)
        assert hub.hub.counts["lost"] == 0
        for client in (loud, said):
            client.socket.shutdown(socket.SHUT_RDWR)
        for thread in threads:
            thread.join(10)
