"""A TCP proxy on loopback that can be cut: nothing passes, nobody is told, until it heals."""

import socket
import threading
from contextlib import suppress


class CutProxy:
    """Passes bytes on to a port of this machine; what was connected before a cut is closed when it heals."""

    def __init__(self, target: int) -> None:
        """Listen at a port of its own."""
        self._target = target
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port: int = self._listener.getsockname()[1]
        self._open = threading.Event()
        self._open.set()
        self._links: list[tuple[socket.socket, socket.socket]] = []
        self._unaware: list[socket.socket] = []
        threading.Thread(target=self._accept, daemon=True).start()

    def cut(self) -> None:
        """Pass nothing on from now."""
        self._open.clear()

    def heal(self) -> None:
        """Pass on what comes by new connections."""
        links, self._links = self._links, []
        for each in (each for link in links for each in link):
            _shut(each)
        self._open.set()

    def end_unnoticed(self) -> None:
        """End all connections, but let callers notice nothing."""
        links, self._links = self._links, []
        self._unaware += [caller for caller, _ in links]
        for _, called in links:
            _shut(called)

    def close(self) -> None:
        """Stop."""
        for each in (self._listener, *self._unaware):
            _shut(each)
        self.heal()

    def _accept(self) -> None:
        while True:
            try:
                caller, _ = self._listener.accept()
            except OSError:
                return  # it is closed
            self._open.wait()
            try:
                called = socket.create_connection(("127.0.0.1", self._target))
            except OSError:
                _shut(caller)
                continue
            self._links.append((caller, called))
            for one, other in ((caller, called), (called, caller)):
                threading.Thread(target=self._pass, args=(one, other), daemon=True).start()

    def _pass(self, one: socket.socket, other: socket.socket) -> None:
        try:
            one.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            while data := one.recv(65_536):
                self._open.wait()
                other.sendall(data)
        except OSError:
            self._open.wait()
        for each in (one, other):
            if each not in self._unaware:
                _shut(each)


def _shut(each: socket.socket) -> None:
    with suppress(OSError):  # it is closed already
        each.shutdown(socket.SHUT_RDWR)
    each.close()
