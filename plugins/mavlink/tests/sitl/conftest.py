"""A ground station for simulated vehicles."""

from __future__ import annotations

import socket

import pytest
from simulated.ground import Ground


@pytest.fixture
def ground():
    """Return a ground station that hears whatever vehicle sends to its port."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as connection:
        connection.bind(("127.0.0.1", 0))
        connection.settimeout(0.1)
        yield Ground(connection)
