"""Why peers cannot be reached: Zenoh retries again and again without reporting the cause."""

from __future__ import annotations

import socket
import ssl
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from ..threads import Net

FIRST_SECONDS, THEN_SECONDS = 4.0, 30.0
"""Seconds after which an unreachable peer is reported, and between two checks of it."""

ANSWER_SECONDS = 2.0
_MOST = 1 << 16

_ALERTS = {
    "UNKNOWN_CA": "another authority made it",
    "DECRYPT_ERROR": "another authority made it",
    "CERTIFICATE_EXPIRED": "it has expired, or is not valid yet, by the clock there",
    "CERTIFICATE_REQUIRED": "it shows none",
}


@dataclass(frozen=True, slots=True)
class Papers:
    """Files of what a process shows to others, and of whom it believes."""

    authority: Path
    certificate: Path
    key: Path


class Doubts:
    """Tells people, in a thread of its own, what keeps peers from being reached."""

    def __init__(
        self, endpoints: Sequence[str], papers: Papers | None, peers: Callable[[], int], net: Net
    ) -> None:
        """Create without reports.

        Args:
            endpoints: of the peers.
            papers: None: there are none.
            peers: how many can be reached now.
            net: reports to the operator, each thing once.
        """
        self._endpoints, self._papers, self._peers, self._net = endpoints, papers, peers, net
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._wonder, name="bus doubts", daemon=True)

    def start(self) -> None:
        """Begin, if there are peers to be reached."""
        if self._endpoints:
            self._thread.start()

    def stop(self) -> None:
        """End; does not wait for what is tried at that moment."""
        self._over.set()

    def _wonder(self) -> None:
        wait = FIRST_SECONDS
        while not self._over.wait(wait):
            wait = THEN_SECONDS
            with self._net.under("looking for what keeps peers away"):
                self._look()

    def _look(self) -> None:
        for endpoint in self._endpoints:
            if (peers := self._peers()) >= len(self._endpoints):
                return
            unheard, refused = why_not(endpoint, self._papers)
            # Who has not come yet is told where nobody has: others need not be there at once.
            if (why := refused or ("" if peers else unheard)) and not self._over.is_set():
                self._net.tell(f"{endpoint}: {why}")


def why_not(endpoint: str, papers: Papers | None) -> tuple[str, str]:
    """Return why there is no listener at an endpoint, and why its listener and this process disconnect again.

    Each is empty where it does not apply, and for endpoints that are neither TCP nor TLS.
    """
    way, _, address = endpoint.partition("/")
    host, _, port = address.partition("#")[0].partition("?")[0].rpartition(":")
    if way not in ("tcp", "tls"):
        return "", ""
    try:
        with socket.create_connection((host.strip("[]"), int(port)), ANSWER_SECONDS) as connection:
            return "", _shaken(connection, papers) if way == "tls" and papers is not None else ""
    except TimeoutError:
        return "nothing answers at this address", ""
    except ConnectionRefusedError:
        return "no listener there yet", ""
    except OSError as error:
        return (error.strerror or str(error)).lower(), ""


def _shaken(connection: socket.socket, papers: Papers) -> str:
    """Return why two processes do not accept each other's certificates; empty: they do."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.load_verify_locations(papers.authority)
    context.load_cert_chain(papers.certificate, papers.key)
    incoming, outgoing = ssl.MemoryBIO(), ssl.MemoryBIO()
    shaken = context.wrap_bio(incoming, outgoing)

    def carry(act: Callable[[], object]) -> None:
        while True:
            try:
                act()
                return
            except ssl.SSLWantReadError:
                connection.sendall(outgoing.read())
                if received := connection.recv(_MOST):
                    incoming.write(received)
                else:
                    incoming.write_eof()

    try:
        carry(shaken.do_handshake)
        # Whether the other one accepts this certificate is said after the handshake.
        connection.settimeout(ANSWER_SECONDS / 2)
        carry(lambda: shaken.read(1))
    except TimeoutError:
        return ""  # it waits for what Zenoh would say
    except ssl.SSLCertVerificationError as error:
        return f"its certificate is not accepted here: {_doubted(error.verify_message)}"
    except ssl.SSLEOFError:
        return ""  # it has gone
    except ssl.SSLError as error:
        return _parted(error.reason or "")
    except OSError:
        return ""
    return ""


def _doubted(why: str) -> str:
    if "expired" in why or "not yet valid" in why:
        return f"{why}; the clock here says {datetime.now(UTC):%Y-%m-%d %H:%M} UTC"
    return f"another authority made it ({why})"


def _parted(reason: str) -> str:
    known = next((words for alert, words in _ALERTS.items() if reason.endswith(alert)), "")
    if known or "ALERT" in reason:
        return f"this process's certificate is not accepted there: {known or reason.lower()}"
    return f"what listens there does not speak TLS as it should ({reason.lower()})"
