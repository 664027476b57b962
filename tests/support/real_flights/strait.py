"""A link by UDP between a vehicle and a program that can be cut, in either direction."""

from __future__ import annotations

import select
import socket
import threading

LARGEST = 65_535


class Strait:
    """Passes what a vehicle sends to `port` on to the port of a program, and back; a context.

    Attributes:
        port: to which the vehicle sends. inwards, outwards: whether what the vehicle sends, and what it is
            sent, is lost.
    """

    def __init__(self, program: int, port: int = 0) -> None:
        """Prepare it for a program that listens at a port of this machine; `port` 0 is any that is free."""
        self.inwards = self.outwards = False
        self._program = ("127.0.0.1", program)
        self._near, self._far = _socket(port), _socket(0)
        self.port: int = self._near.getsockname()[1]
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name="strait", daemon=True)

    def __enter__(self) -> Strait:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ending.set()
        self._thread.join()
        self._near.close()
        self._far.close()

    def _run(self) -> None:
        vehicle = None
        while not self._ending.is_set():
            ready, _, _ = select.select([self._near, self._far], [], [], 0.1)
            for each in ready:
                try:
                    data, sender = each.recvfrom(LARGEST)
                except OSError:
                    continue  # the program does not listen yet
                if each is self._near:
                    vehicle = sender
                    if not self.inwards:
                        self._far.sendto(data, self._program)
                elif vehicle is not None and not self.outwards:
                    self._near.sendto(data, vehicle)


def _socket(port: int) -> socket.socket:
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    made.bind(("127.0.0.1", port))
    return made
