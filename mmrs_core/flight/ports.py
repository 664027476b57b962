"""Ways to reach a vehicle: UDP and TCP by the standard library, anything else by pymavlink."""

from __future__ import annotations

import socket
from typing import Any, Protocol

LARGEST = 65_535
"""Bytes that a datagram can hold."""

LAST_PORT = 65_535
USUAL_BAUD = 57_600
SOCKETS = ("udpin", "udpout", "tcp")


class Port(Protocol):
    """Carries bytes to and from a vehicle."""

    def read(self, seconds: float) -> bytes:
        """Return what has come, waiting for so many real seconds at most; empty if nothing has.

        Raises:
            OSError: nothing will ever come again.
        """
        ...

    def write(self, data: bytes) -> object:
        """Send bytes, or drop them where nobody can be reached yet.

        Raises:
            OSError: they are lost; those after them need not be.
        """
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
    address = address_of(url)
    if address is None:
        return SerialPort(url)
    scheme = url.partition(":")[0]
    return TcpPort(address) if scheme == "tcp" else UdpPort(address, listens=scheme == "udpin")


def address_of(url: str) -> tuple[str, int] | None:
    """Return host and port of a url; None where it names a serial device.

    Raises:
        ValueError: it names neither.
    """
    scheme, _, rest = url.partition(":")
    if scheme not in SOCKETS:
        _baud_of(url)
        return None
    host, _, number = rest.rpartition(":")
    if not host or not number.isdecimal() or int(number) > LAST_PORT:
        raise ValueError(f"{url}: is not {scheme}:HOST:PORT")
    return host, int(number)


def _baud_of(url: str) -> int:
    device, _, baud = url.partition(",")
    if not device or not (baud or "0").isdecimal():
        raise ValueError(f"{url}: is not DEVICE,BAUD")
    return int(baud or USUAL_BAUD)


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
        except (TimeoutError, ConnectionRefusedError, ConnectionResetError):
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
        """Return what has come.

        Raises:
            OSError: the connection has ended.
        """
        self._socket.settimeout(seconds)
        try:
            data = self._socket.recv(LARGEST)
        except TimeoutError:
            return b""
        if not data:
            raise ConnectionError("the vehicle's side has closed the connection")
        return data

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
            OSError: the device cannot be opened.
        """
        from pymavlink import mavutil

        try:
            self._file: Any = mavutil.mavserial(url.partition(",")[0], baud=_baud_of(url))
        except Exception as error:
            raise OSError(f"{url}: cannot be opened: {error}") from error

    def read(self, seconds: float) -> bytes:
        """Return what has come."""
        return bytes(self._file.recv(LARGEST)) if self._file.select(seconds) else b""

    def write(self, data: bytes) -> object:
        """Send all of it."""
        return self._file.write(data)

    def close(self) -> None:
        """Close the device."""
        self._file.close()
