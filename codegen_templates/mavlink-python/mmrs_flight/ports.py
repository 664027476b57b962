"""Ways to reach a vehicle: UDP and TCP by the standard library, anything else by pymavlink."""

from __future__ import annotations

import socket
from typing import Any, Protocol

LARGEST = 65_535


class Port(Protocol):
    """Carries bytes to and from a vehicle."""

    def read(self, seconds: float) -> bytes:
        """Return what has come, waiting for so many real seconds at most; empty if nothing has."""
        ...

    def write(self, data: bytes) -> object:
        """Send bytes, or drop them where nobody can be reached yet."""
        ...

    def close(self) -> None:
        """Release the port."""
        ...


def open_port(url: str) -> Port:
    """Return an open port.

    Args:
        url: ``udpin:HOST:PORT`` (the vehicle speaks first), ``udpout:HOST:PORT``, ``tcp:HOST:PORT``,
            or a serial device such as ``/dev/ttyUSB0,57600``.

    Raises:
        ValueError: the url is none of these.
        OSError: the port cannot be opened.
    """
    scheme, _, rest = url.partition(":")
    if scheme in ("udpin", "udpout", "tcp"):
        host, _, number = rest.rpartition(":")
        if not host or not number.isdecimal():
            raise ValueError(f"{url}: is not {scheme}:HOST:PORT")
        address = (host, int(number))
        return TcpPort(address) if scheme == "tcp" else UdpPort(address, listens=scheme == "udpin")
    return SerialPort(url)


class UdpPort:
    """A UDP socket; one that listens answers whoever spoke last."""

    def __init__(self, address: tuple[str, int], listens: bool) -> None:
        """Bind to the address, or send to it."""
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._peer = None if listens else address
        if listens:
            self._socket.bind(address)

    def read(self, seconds: float) -> bytes:
        """Return the next datagram."""
        self._socket.settimeout(seconds)
        try:
            data, sender = self._socket.recvfrom(LARGEST)
        except (TimeoutError, ConnectionRefusedError):
            return b""
        self._peer = sender
        return data

    def write(self, data: bytes) -> object:
        """Send a datagram if there is somebody to send it to; an unreachable peer loses it."""
        if self._peer is None:
            return None
        try:
            return self._socket.sendto(data, self._peer)
        except ConnectionRefusedError:
            return None

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()


class TcpPort:
    """A TCP connection."""

    def __init__(self, address: tuple[str, int]) -> None:
        """Connect."""
        self._socket = socket.create_connection(address, timeout=10.0)

    def read(self, seconds: float) -> bytes:
        """Return what has come."""
        self._socket.settimeout(seconds)
        try:
            return self._socket.recv(LARGEST)
        except TimeoutError:
            return b""

    def write(self, data: bytes) -> object:
        """Send all of it."""
        self._socket.sendall(data)
        return None

    def close(self) -> None:
        """Close the connection."""
        self._socket.close()


class SerialPort:
    """A serial device, opened by pymavlink; needs the package pyserial."""

    def __init__(self, url: str) -> None:
        """Open ``DEVICE,BAUD``; the rate is 57600 where none is given.

        Raises:
            ValueError: the device cannot be opened.
        """
        from pymavlink import mavutil

        device, _, baud = url.partition(",")
        try:
            self._file: Any = mavutil.mavserial(device, baud=int(baud or 57_600))
        except Exception as error:
            raise ValueError(f"{url}: cannot be opened: {error}") from error

    def read(self, seconds: float) -> bytes:
        """Return what has come."""
        return bytes(self._file.recv(LARGEST)) if self._file.select(seconds) else b""

    def write(self, data: bytes) -> object:
        """Send all of it."""
        return self._file.write(data)

    def close(self) -> None:
        """Close the device."""
        self._file.close()
