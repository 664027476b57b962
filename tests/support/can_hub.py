"""A hub in a thread of its own, and a client that says words as they are written."""

from __future__ import annotations

import asyncio
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager

from auv_vessel.wire.hub import Hub


class RunningHub:
    """A hub that listens; `hub` may be looked at from anywhere, its methods are called in its thread."""

    def __init__(self, hub: Hub, port: int) -> None:
        self.hub = hub
        self.port = port
        self._loop = asyncio.new_event_loop()
        self._ready = threading.Event()
        self._stopping = threading.Lock()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()
        assert self._ready.wait(10)

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        self.port = self._loop.run_until_complete(self.hub.start(port=self.port))
        self._ready.set()
        self._loop.run_forever()
        self._loop.run_until_complete(self.hub.stop())
        self._loop.run_until_complete(asyncio.sleep(0.01))
        self._loop.close()

    def stop(self) -> None:
        with self._stopping:
            if self._thread.is_alive():
                self._loop.call_soon_threadsafe(self._loop.stop)
                self._thread.join(10)


@contextmanager
def running(hub: Hub | None = None, port: int = 0) -> Iterator[RunningHub]:
    """Have a hub run, at a port of its own choice or at that one."""
    found = RunningHub(hub or Hub(), port)
    try:
        yield found
    finally:
        found.stop()


class Raw:
    """A client by sockets alone."""

    def __init__(self, port: int, *, listens: str | None = "can0") -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=10)
        self._text = ""
        if listens is not None:
            assert self.word() == "< hi >"
            for said in (f"< open {listens} >", "< rawmode >"):
                self.say(said)
                assert self.word() == "< ok >"

    def say(self, text: str | bytes) -> None:
        self.socket.sendall(text.encode() if isinstance(text, str) else text)

    def word(self) -> str:
        """Return the next word; empty: the hub has ended the connection."""
        while ">" not in self._text:
            data = self.socket.recv(4096)
            if not data:
                return ""
            self._text += data.decode("ascii")
        word, _, self._text = self._text.partition(">")
        return word + ">"

    def close(self) -> None:
        self.socket.close()

    def __enter__(self) -> Raw:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
