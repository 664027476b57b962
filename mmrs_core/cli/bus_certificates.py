"""Certificates for the bus: an authority of the team's own, and one certificate for each process."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from ipaddress import ip_address
from pathlib import Path

from cryptography import x509
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.hashes import SHA256
from cryptography.hazmat.primitives.serialization import (
    Encoding,
    NoEncryption,
    PrivateFormat,
    load_pem_private_key,
)
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from mmrs_core.cli.bus_access import Holder, configuration

AUTHORITY = "authority"
"""Stem of the files of whoever signs the certificates; its key belongs on no robot."""

OBSERVER = "observer"
"""Name of the certificate that may look on and may not speak for any robot."""


@dataclass(frozen=True, slots=True)
class _Signer:
    certificate: x509.Certificate
    key: ec.EllipticCurvePrivateKey


def make_keys(
    folder: Path, holders: Sequence[Holder], hosts: Sequence[str], now: datetime, days: int
) -> tuple[Path, ...]:
    """Write an authority, and for each holder a folder with all that its process needs.

    An authority and certificates that are in the folder already are used again, so that a robot can be
    added; configurations are written anew, since each lists all robots.

    Args:
        folder: where to write; ``<holder>/`` within it goes to the holder's machine.
        holders: all of the team; an observer is added.
        hosts: names and addresses by which holders are reached.
        now: when validity begins.
        days: how long the certificates are valid.

    Returns:
        The folders of the holders.

    Raises:
        OSError: if something cannot be written.
        ValueError: if the authority in the folder cannot be used, or somebody has a certificate of it who
            is not named: nobody would let them in any more.
    """
    folder.mkdir(parents=True, exist_ok=True)
    left_out = sorted(
        path.parent.name
        for path in folder.glob("*/certificate.pem")
        if path.parent.name not in {OBSERVER, *(holder.name for holder in holders)}
    )
    if left_out:
        raise ValueError(
            f"{folder}: {', '.join(map(repr, left_out))} would not be let in any more: name all who are to be"
            " on the bus, or delete the folders of those who are not"
        )
    signer = _authority(folder, now, days)
    everybody = (*holders, Holder(OBSERVER, ()))
    made = []
    for holder in everybody:
        own = folder / holder.name
        own.mkdir(exist_ok=True, mode=0o700)
        if not (own / "certificate.pem").exists():
            _certify(own, holder.name, hosts, signer, now, days)
        _write(own / "authority.pem", (folder / f"{AUTHORITY}.pem").read_bytes())
        _write(own / "bus.json5", json.dumps(configuration(holder, everybody), indent=2).encode() + b"\n")
        made.append(own)
    return tuple(made)


def _authority(folder: Path, now: datetime, days: int) -> _Signer:
    certificate, key = folder / f"{AUTHORITY}.pem", folder / f"{AUTHORITY}.key.pem"
    if certificate.exists():
        found = load_pem_private_key(key.read_bytes(), None)
        if not isinstance(found, ec.EllipticCurvePrivateKey):
            raise ValueError(f"{key}: no key of the kind that signs for the bus")
        return _Signer(x509.load_pem_x509_certificate(certificate.read_bytes()), found)
    made = ec.generate_private_key(ec.SECP256R1())
    name = _name("MMRS bus")
    signed = (
        _builder(name, name, made, now, days)
        .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
        .add_extension(_usage(signs=True), critical=True)
        .sign(made, SHA256())
    )
    _write(key, _pem(made))
    _write(certificate, signed.public_bytes(Encoding.PEM))
    return _Signer(signed, made)


def _certify(own: Path, name: str, hosts: Sequence[str], signer: _Signer, now: datetime, days: int) -> None:
    key = ec.generate_private_key(ec.SECP256R1())
    both = [ExtendedKeyUsageOID.SERVER_AUTH, ExtendedKeyUsageOID.CLIENT_AUTH]
    signed = (
        _builder(_name(name), signer.certificate.subject, key, now, days)
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(x509.SubjectAlternativeName([_host(host) for host in hosts]), critical=False)
        .add_extension(x509.ExtendedKeyUsage(both), critical=False)
        .add_extension(_usage(signs=False), critical=True)
        .sign(signer.key, SHA256())
    )
    _write(own / "key.pem", _pem(key))
    _write(own / "certificate.pem", signed.public_bytes(Encoding.PEM))


def _builder(
    subject: x509.Name, issuer: x509.Name, key: ec.EllipticCurvePrivateKey, now: datetime, days: int
) -> x509.CertificateBuilder:
    return (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(issuer)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - timedelta(hours=1))
        .not_valid_after(now + timedelta(days=days))
    )


def _name(common: str) -> x509.Name:
    return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, common)])


def _host(host: str) -> x509.GeneralName:
    try:
        return x509.IPAddress(ip_address(host))
    except ValueError:
        return x509.DNSName(host)


def _usage(*, signs: bool) -> x509.KeyUsage:
    return x509.KeyUsage(
        digital_signature=not signs,
        content_commitment=False,
        key_encipherment=False,
        data_encipherment=False,
        key_agreement=False,
        key_cert_sign=signs,
        crl_sign=signs,
        encipher_only=False,
        decipher_only=False,
    )


def _pem(key: ec.EllipticCurvePrivateKey) -> bytes:
    return key.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption())


def _write(path: Path, content: bytes) -> None:
    """Write a file that nobody else may read, whole or not at all."""
    part = path.with_suffix(".part")
    handle = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
    with os.fdopen(handle, "wb") as file:
        file.write(content)
    part.replace(path)
