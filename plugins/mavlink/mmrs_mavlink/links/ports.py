"""Ports to vehicles: UDP and TCP by the standard library, anything else by pymavlink."""

from __future__ import annotations

import socket
from errno import EADDRINUSE
from typing import Any

from mmrs_runtime.ports import NOTHING, Address, Port, Received

LARGEST = 65_535
"""Bytes that a datagram can hold."""

LAST_PORT = 65_535
USUAL_BAUD = 57_600
SOCKETS = ("udpin", "udpout", "tcp")
LAST_SYSTEM = 255


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


def split_system(text: str) -> tuple[str, int]:
    """Return the url and the MAVLink system of ``URL[@SYSTEM]``; 0 where none is given.

    Raises:
        ValueError: the system is not a number from 1 to 255.
    """
    url, separator, number = text.rpartition("@")
    if not separator:
        return text, 0
    if not number.isdecimal() or len(number) > 9 or not 0 < int(number) <= LAST_SYSTEM:
        raise ValueError(f"{text}: {number!r} after the @ must be a MAVLink system from 1 to {LAST_SYSTEM}")
    return url, int(number)


def address_of(url: str) -> Address | None:
    """Return host and port of a url; None where it names a serial device.

    Raises:
        ValueError: it names neither.
    """
    scheme, _, rest = url.partition(":")
    if scheme not in SOCKETS:
        _baud_of(url)
        return None
    host, _, number = rest.rpartition(":")
    if not host or not number.isdecimal() or len(number) > 9 or int(number) > LAST_PORT:
        raise ValueError(f"{url}: is not {scheme}:HOST:PORT")
    return host, int(number)


def _baud_of(url: str) -> int:
    device, _, baud = url.partition(",")
    if not device or not (baud or "0").isdecimal() or len(baud) > 9:
        raise ValueError(f"{url}: is not DEVICE,BAUD")
    return int(baud or USUAL_BAUD)


class UdpPort:
    """A UDP socket; a listening one sends to the given addresses, once they have sent."""

    def __init__(self, address: Address, listens: bool) -> None:
        """Bind to the address, or send to it."""
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._peer = None if listens else address
        if listens:
            try:
                self._socket.bind(address)
            except OSError as error:
                self._socket.close()
                if error.errno != EADDRINUSE:
                    raise
                raise OSError("another program listens there: end it, or choose another port") from error

    def read(self, seconds: float) -> Received:
        """Return the next datagram."""
        self._socket.settimeout(seconds)
        try:
            return Received(*self._socket.recvfrom(LARGEST))
        except (TimeoutError, BlockingIOError, ConnectionRefusedError, ConnectionResetError):
            return NOTHING

    def write(self, data: bytes, to: Address | None = None) -> object:
        """Send a datagram if there is a receiver; an unreachable peer loses it."""
        peer = to or self._peer
        if peer is None:
            return None
        try:
            return self._socket.sendto(data, peer)
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

    def read(self, seconds: float) -> Received:
        """Return what has come.

        Raises:
            OSError: the connection has ended.
        """
        self._socket.settimeout(seconds)
        try:
            data = self._socket.recv(LARGEST)
        except (TimeoutError, BlockingIOError):
            return NOTHING
        if not data:
            raise ConnectionError("the vehicle's side has closed the connection")
        return Received(data)

    def write(self, data: bytes, to: Address | None = None) -> object:
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
        except ImportError as error:
            raise OSError("serial devices need the package pyserial: pip install pyserial") from error
        except Exception as error:
            raise OSError(f"cannot be opened: {error}") from error

    def read(self, seconds: float) -> Received:
        """Return what has come."""
        return Received(bytes(self._file.recv(LARGEST))) if self._file.select(seconds) else NOTHING

    def write(self, data: bytes, to: Address | None = None) -> object:
        """Send all of it."""
        return self._file.write(data)

    def close(self) -> None:
        """Close the device."""
        self._file.close()
