"""Endpoints of Zenoh: an invalid one is reported before anything is opened."""

from __future__ import annotations

import re
from collections.abc import Iterable
from contextlib import suppress
from ipaddress import ip_address

_ADDRESS = r"[^/?#\s]+:(?P<port>\d{1,5})"
_ENDPOINT = re.compile(rf"((tcp|tls|udp|quic|quic_datagram|ws)/{_ADDRESS}|[a-z][a-z_-]*/[^?#\s]+)([?#]\S*)?")
_OTHERS = ("serial", "unixpipe", "unixsock-stream", "vsock")
_OF_THIS_COMPUTER = ("unixpipe", "unixsock-stream")
LAST_PORT = 65_535


def first_fault(endpoints: Iterable[str]) -> str:
    """Return what is wrong with the first endpoint that is none; empty where all are."""
    return next(
        (f"{each}: no endpoint, such as tcp/10.0.0.2:7447" for each in endpoints if not _is(each)), ""
    )


def is_local(endpoint: str) -> bool:
    """Return whether an endpoint is reached from this computer only; unknown names are not."""
    with suppress(ValueError):
        return ip_address(_host(endpoint)).is_loopback
    return endpoint.partition("/")[0] in _OF_THIS_COMPUTER or _host(endpoint) == "localhost"


def is_everywhere(endpoint: str) -> bool:
    """Return whether an endpoint is one of all interfaces."""
    with suppress(ValueError):
        return ip_address(_host(endpoint)).is_unspecified
    return False


def _host(endpoint: str) -> str:
    address = endpoint.partition("/")[2]
    return re.split(r"[?#]", address)[0].rpartition(":")[0].strip("[]")


def _is(text: str) -> bool:
    found = _ENDPOINT.fullmatch(text)
    if found is None:
        return False
    if found["port"] is None:
        return text.partition("/")[0] in _OTHERS
    return int(found["port"]) <= LAST_PORT
