"""Sessions of Zenoh: what configures one, how it is opened, and how it is closed."""

from __future__ import annotations

import atexit
import json
import os
import re
import threading
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import zenoh

from .diagnosis import Papers
from .endpoints import first_fault, is_everywhere, is_local
from .revocation import REVOKED, read_list, valid_name

LEASE_MILLISECONDS = 1500
"""After so long without a sign a frozen peer counts as lost."""

CLOSING_SECONDS, LAST_SECONDS = 1.0, 2.0
"""How long closing may take, and how much longer when the process ends."""

READERS = 64
"""Threads that read from the network. Zenoh blocks two of them for ten seconds with every machine that goes
out of reach (it closes sockets that linger); without a free one, no other peer is received either.
"""

_FILES = (
    "root_ca_certificate",
    "listen_private_key",
    "listen_certificate",
    "connect_private_key",
    "connect_certificate",
)
_SHOWN = ("root_ca_certificate", "connect_certificate", "connect_private_key")
_SOURCES = re.compile(r" at \S+\.rs:\d+\.?")
MEETING = "tcp/127.0.0.1:7446"
"""Where processes of this computer meet: the first listens there, and another one when it ends. Multicast
would reach other computers."""

_LOCAL = "tcp/127.0.0.1:0"
_TLS_TO_IPV6 = re.compile(r"(tls|quic|quic_datagram)/\[")
RETRY = {"period_init_ms": 100, "period_max_ms": 1000, "period_increase_factor": 2}


@dataclass(frozen=True, slots=True)
class Endpoints:
    """How peers are reached.

    Attributes:
        listen: endpoints to listen at, such as ``tcp/0.0.0.0:7447``. connect: endpoints of others; with
            none of either, and no file, processes of this computer meet at `MEETING`.
        file: of Zenoh's configuration, with certificates for example; None: there is none.
    """

    listen: tuple[str, ...] = ()
    connect: tuple[str, ...] = ()
    file: Path | None = None


def configuration(endpoints: Endpoints, revoked: bytes = b"") -> Any:
    """Return Zenoh's configuration.

    Without a file, and with no endpoint that is reached from elsewhere, it is for this computer only.

    Args:
        endpoints: how peers are reached.
        revoked: what `revoked_by` returned before: it stays revoked.

    Raises:
        OSError: the file cannot be read, or is none of Zenoh's configurations; or an endpoint is none; or the
            revocation list is refused, or revokes the certificate of this process.
    """
    if why := first_fault((*endpoints.listen, *endpoints.connect)):
        raise OSError(why)
    config = zenoh.Config() if endpoints.file is None else _from_file(endpoints.file)
    _refuse_ways(endpoints, json.loads(config.get_json("transport/link/protocols")))
    _insert(config, "transport/link/tx/lease", LEASE_MILLISECONDS)
    _insert(config, "connect/retry", RETRY)
    listen, connect = endpoints.listen, endpoints.connect
    if endpoints.file is not None:
        _admit_valid(config, revoked + revoked_by(endpoints.file))
    elif not listen and not connect:
        listen, connect = (MEETING, _LOCAL), (MEETING,)
        _insert(config, "listen/timeout_ms", -1)
        _insert(config, "listen/exit_on_failure", False)
        _insert(config, "listen/retry", RETRY)
    elif not listen and all(map(is_local, connect)):
        listen = (_LOCAL,)
    _insert(config, "listen/endpoints", list(_also_here(listen or _listened(config))))
    if connect:
        _insert(config, "connect/endpoints", list(connect))
    _insert(config, "scouting/multicast/enabled", False)
    # A peer that is not there yet is looked for again and again, and nobody waits for it.
    _insert(config, "connect/timeout_ms", -1)
    _insert(config, "connect/exit_on_failure", False)
    return config


def _listened(config: Any) -> tuple[str, ...]:
    """Return where a peer with a configuration listens; Zenoh's default is by what a session is."""
    found = json.loads(config.get_json("listen/endpoints"))
    return tuple(found.get("peer") or () if isinstance(found, dict) else found)


def _also_here(listen: tuple[str, ...]) -> tuple[str, ...]:
    """Return endpoints, and one of the loopback interface beside those of all interfaces.

    For those, Zenoh announces the addresses of all interfaces but this one: on a machine that has no other,
    peers would learn of each other, and of no address.
    """
    everywhere = [each.partition("/")[0] for each in listen if is_everywhere(each)]
    if not everywhere or any(map(is_local, listen)):
        return listen
    return (*listen, f"{everywhere[0]}/127.0.0.1:0")


def revoked_by(file: Path | None) -> bytes:
    """Return the revocation list next to a configuration; empty where ``mmrs bus keys`` did not write it.

    Raises:
        OSError: the list is refused, or revokes the certificate of the configuration.
    """
    papers = papers_of(file)
    if file is None or papers is None or speaks_for(file) is None:
        return b""
    return read_list(file.with_name(REVOKED), papers)


def _admit_valid(config: Any, revoked: bytes) -> None:
    """Let in each holder by its valid certificate only."""
    if revoked:
        subjects = json.loads(config.get_json("access_control/subjects")) or []
        for subject in subjects:
            names = subject.get("cert_common_names") or ()
            subject["cert_common_names"] = [valid_name(name, revoked) for name in names]
        _insert(config, "access_control/subjects", subjects)


def admitted(config: Any) -> list[str]:
    """Return the common names of the certificates that are let in; none where a configuration lists none."""
    subjects = json.loads(config.get_json("access_control/subjects")) or []
    return [name for subject in subjects for name in subject.get("cert_common_names") or ()]


def exposed(config: Any) -> tuple[str, ...]:
    """Return where a session can be reached from other computers without a certificate."""
    secured = ("tls/", "quic") if json.loads(config.get_json("transport/link/tls/enable_mtls")) else ()
    return tuple(each for each in _listened(config) if not is_local(each) and not each.startswith(secured))


def _refuse_ways(endpoints: Endpoints, allowed: Sequence[str] | None) -> None:
    """Refuse endpoints that Zenoh would retry silently without success.

    Raises:
        OSError: one needs certificates and there are none, the file does not allow it, or Zenoh, which takes
            an IPv6 address for a name, does not reach it by TLS.
    """
    for each in endpoints.connect:
        if _TLS_TO_IPV6.match(each):
            raise OSError(f"{each}: IPv6 addresses are not reached by TLS: say a name that stands for it")
    for each in (*endpoints.listen, *endpoints.connect):
        way = each.partition("/")[0]
        if endpoints.file is None and way in ("tls", "quic"):
            raise OSError(f"{each}: needs certificates, and the configuration with them (mmrs bus keys)")
        if allowed and way not in allowed:
            raise OSError(f"{each}: {endpoints.file} allows {', '.join(allowed)} only")


def papers_of(file: Path | None) -> Papers | None:
    """Return a configuration's certificates; None where it names none, or not all of them."""
    if file is None:
        return None
    config = _from_file(file)
    found = [json.loads(config.get_json(f"transport/link/tls/{name}")) for name in _SHOWN]
    return Papers(*map(Path, found)) if all(isinstance(each, str) for each in found) else None


def _from_file(path: Path) -> Any:
    """Return the configuration in a file; names of files in it are those of files beside it."""
    try:
        config = zenoh.Config.from_file(str(path))
    except zenoh.ZError as error:
        raise OSError(f"{path}: cannot be read as a configuration of Zenoh: {_plain(error)}") from error
    for name in _FILES:
        found = json.loads(config.get_json(f"transport/link/tls/{name}"))
        if isinstance(found, str) and not Path(found).is_absolute():
            _insert(config, f"transport/link/tls/{name}", str((path.parent / found).absolute()))
    return config


def _insert(config: Any, name: str, value: object) -> None:
    config.insert_json5(name, json.dumps(value))


def closed(session: Any) -> None:
    """Close a session, but do not wait for peers that are frozen: Zenoh would, for ten seconds."""

    def close() -> None:
        # What fails here is that a peer does not say goodbye; there is nobody left to be told.
        with suppress(zenoh.ZError):
            session.close()

    closing = threading.Thread(target=close, name="bus closing", daemon=True)
    closing.start()
    closing.join(CLOSING_SECONDS)
    if closing.is_alive():
        # A thread that comes back from Zenoh while the interpreter ends would abort the process.
        atexit.register(closing.join, LAST_SECONDS)


def opened(config: Any) -> Any:
    """Return a session with a configuration.

    Raises:
        OSError: it cannot be opened.
    """
    # Read when the first session of a process is opened, and nowhere else can it be said.
    os.environ.setdefault("ZENOH_RUNTIME", f"(rx: (worker_threads: {READERS}))")
    try:
        return zenoh.open(config)
    except zenoh.ZError as error:
        raise OSError(f"bus: cannot be opened: {_plain(error)}") from error


def _plain(error: zenoh.ZError) -> str:
    """Return what Zenoh says, without the lines of its sources."""
    return _SOURCES.sub("", str(error)).strip()


def speaks_for(file: Path | None) -> frozenset[str] | None:
    """Return the robots for which the certificate of a configuration speaks; None where it does not say.

    Raises:
        OSError: the file cannot be read, or is none of Zenoh's configurations.
    """
    reported = json.loads(_from_file(file).get_json("metadata")) if file is not None else None
    robots = reported.get("robots") if isinstance(reported, dict) else None
    return frozenset(map(str, robots)) if isinstance(robots, list) else None
