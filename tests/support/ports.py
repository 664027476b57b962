"""Ports of this machine for what tests start."""

import os
import socket
from collections.abc import Iterator
from random import randrange

FIRST, EACH = 10_000, 2_500
"""Of each worker; systems give higher ones to whoever asks for any, so that nobody takes these meanwhile."""


def free_port() -> int:
    """Return a port that nobody uses, neither by UDP nor by TCP; none is given twice.

    Raises:
        RuntimeError: none is left.
    """
    for port in _numbers:
        if all(is_free(port, kind) for kind in (socket.SOCK_DGRAM, socket.SOCK_STREAM)):
            return port
    raise RuntimeError("no port is left")


def free_endpoint() -> str:
    """Return where a bus between robots may listen."""
    return f"tcp/127.0.0.1:{free_port()}"


def is_free(port: int, kind: socket.SocketKind) -> bool:
    """Return whether nobody uses a port of this kind."""
    with socket.socket(socket.AF_INET, kind) as probe:
        try:
            probe.bind(("127.0.0.1", port))
        except OSError:
            return False
    return True


def _all() -> Iterator[int]:
    worker = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw")) % 8
    first, begin = FIRST + worker * EACH, randrange(EACH)
    for number in range(EACH):
        yield first + (begin + number) % EACH


_numbers = _all()
