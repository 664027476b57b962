"""Revoked certificates: the list that the authority signs, and which certificate of a holder is valid.

The common name of a holder's first certificate is the holder's name, that of its second ``NAME 2``, and so
on; the serial number of each follows from its common name. So one list, the same for all processes, says
which certificate of each holder is valid: the first that is not on it.
"""

from __future__ import annotations

import base64
import re
import ssl
import tempfile
from datetime import UTC, datetime
from hashlib import sha256
from itertools import count
from pathlib import Path

from .diagnosis import Papers

REVOKED = "revoked.pem"
"""Name of the list, next to the configuration that ``mmrs bus keys`` writes."""

_ONE_LIST = re.compile(rb"\s*-----BEGIN X509 CRL-----\s([A-Za-z0-9+/\s]++={0,2}\s*)-----END X509 CRL-----\s*")
_REVOKED, _OWN_TIMES = 23, (9, 10)
"""OpenSSL's codes for certificates that are revoked, or not yet or no longer valid: seen only behind a list
that is in order."""

_SERIAL_BYTES = 20


def common_name(holder: str, number: int) -> str:
    """Return the common name of a holder's certificate; they are numbered from 1."""
    return holder if number == 1 else f"{holder} {number}"


def serial_of(name: str) -> int:
    """Return the serial number of the certificate with a common name: positive, of 20 bytes."""
    found = bytearray(sha256(name.encode()).digest()[:_SERIAL_BYTES])
    found[0] = found[0] & 0x3F | 0x40
    return int.from_bytes(found)


def valid_name(holder: str, revoked: bytes) -> str:
    """Return the common name of a holder's valid certificate.

    Args:
        holder: its name.
        revoked: what `read_list` returns; of two lists, one may follow the other.
    """
    names = (common_name(holder, number) for number in count(1))
    return next(name for name in names if _as_der(serial_of(name)) not in revoked)


def _as_der(serial: int) -> bytes:
    return bytes([2, _SERIAL_BYTES]) + serial.to_bytes(_SERIAL_BYTES)


def read_list(path: Path, papers: Papers) -> bytes:
    """Return the signed part of a revocation list, in DER.

    Args:
        path: of the list, in PEM.
        papers: of this process; their authority must have signed the list.

    Raises:
        OSError: the list cannot be read, is not signed by the authority, or is not valid at this time; or the
            certificate of this process is on it.
    """
    content, *_ = [_content(each) for each in (path, papers.authority, papers.certificate, papers.key)]
    found = _ONE_LIST.fullmatch(content)
    code, why = _verified(content, papers) if found else (-1, "it is not one revocation list")
    if code == _REVOKED:
        raise OSError(f"{papers.certificate}: this certificate is revoked by {path}")
    if found is None or (code and code not in _OWN_TIMES):
        raise OSError(
            f"{path}: refused: {why}; it must be signed by {papers.authority.name}, and be valid now,"
            f" {datetime.now(UTC):%Y-%m-%d %H:%M} UTC"
        )
    return _signed_part(base64.b64decode(found[1]))


def _content(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise OSError(f"{path}: {error.strerror}; mmrs bus keys writes it") from error


def _signed_part(found: bytes) -> bytes:
    """Return the part of a list in DER that is signed: the first of the outermost sequence."""
    begin, end = _span(found, _span(found, 0)[0])
    return found[begin:end]


def _span(found: bytes, at: int) -> tuple[int, int]:
    """Return where the content of an element in DER begins and ends; `at`: where the element begins."""
    length, begin = found[at + 1], at + 2
    if length & 0x80:
        begin += length & 0x7F
        length = int.from_bytes(found[at + 2 : begin])
    return begin, begin + length


def _verified(content: bytes, papers: Papers) -> tuple[int, str]:
    """Return OpenSSL's code, and words, for this process's certificate and a list; 0: no fault.

    The standard library verifies lists in handshakes only: this process shakes hands with itself.
    """
    trusting, showing = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT), ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    trusting.check_hostname = False
    trusting.verify_flags |= ssl.VERIFY_CRL_CHECK_LEAF
    try:
        trusting.load_verify_locations(papers.authority)
        showing.load_cert_chain(papers.certificate, papers.key)
        with tempfile.TemporaryDirectory() as folder:
            (copy := Path(folder, REVOKED)).write_bytes(content)
            trusting.load_verify_locations(copy)
        there, back = ssl.MemoryBIO(), ssl.MemoryBIO()
        client = trusting.wrap_bio(back, there)
        server = showing.wrap_bio(there, back, server_side=True)
        while not _shakes(client):
            _shakes(server)
    except ssl.SSLCertVerificationError as error:
        return error.verify_code, error.verify_message
    except ssl.SSLError as error:
        return -1, str(error.reason or error).lower().replace("_", " ")
    return 0, ""


def _shakes(end: ssl.SSLObject) -> bool:
    """Take one end of a handshake as far as it goes; return whether it is done."""
    try:
        end.do_handshake()
    except ssl.SSLWantReadError:
        return False
    return True
