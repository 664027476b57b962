"""Certificates for the bus: an authority of the team's own, and one certificate for each process."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
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
from mmrs_runtime.bus.carriers.revocation import REVOKED, serial_of, valid_name
from mmrs_runtime.records.disk import write_secret

AUTHORITY = "authority"
"""Stem of the authority's files, which sign the certificates; its key belongs on no robot."""

OBSERVER = "observer"
"""Name of the certificate that may look on and may not speak for any robot."""

_CERTIFICATE = "certificate.pem"
_EARLIER = timedelta(hours=1)
"""Clocks may be behind by so much."""


@dataclass(frozen=True, slots=True)
class _Signer:
    certificate: x509.Certificate
    key: ec.EllipticCurvePrivateKey
    list: x509.CertificateRevocationList


def make_keys(
    folder: Path, holders: Sequence[Holder], hosts: Sequence[str], now: datetime, days: int
) -> tuple[Path, ...]:
    """Write an authority, and for each holder a folder with all that its process needs.

    An authority and valid certificates that are in the folder already are used again, so that a robot can be
    added; configurations are rewritten, since each lists all robots. A holder's former certificate is revoked
    when it gets another one.

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
        ValueError: if the authority or the revocation list in the folder cannot be used, or a holder with a
            valid certificate is not named: it would no longer be admitted.
    """
    folder.mkdir(parents=True, exist_ok=True)
    everybody = (*holders, Holder(OBSERVER, ()))
    if (folder / f"{AUTHORITY}.pem").exists():
        signer = _authority(folder)
        _refuse_left_out(folder, {holder.name for holder in everybody}, signer.list.tbs_certlist_bytes)
        # A folder that is gone may have held a certificate: its key must not stay valid.
        gone = [each.name for each in everybody if not (folder / each.name / _CERTIFICATE).exists()]
        signer = _revoked(folder, signer, gone, now)
    else:
        signer = _new_authority(folder, now, days)
    made = []
    for holder in everybody:
        own = folder / holder.name
        own.mkdir(exist_ok=True, mode=0o700)
        name = valid_name(holder.name, signer.list.tbs_certlist_bytes)
        if _name_in(own) != name:
            _certify(own, name, hosts, signer, now, days)
        for common in (f"{AUTHORITY}.pem", REVOKED):
            write_secret(own / common, (folder / common).read_bytes())
        write_secret(
            own / "bus.json5", json.dumps(configuration(holder, everybody), indent=2).encode() + b"\n"
        )
        made.append(own)
    return tuple(made)


def revoke(folder: Path, holder: str, now: datetime) -> tuple[Path, ...]:
    """Revoke the certificate in a holder's folder; one that is revoked already stays so.

    Args:
        folder: where `make_keys` wrote. holder: its name.
        now: when this is done.

    Returns:
        Where the revocation list is: in the folder, and in the folder of each holder.

    Raises:
        OSError: if something cannot be read or written.
        ValueError: if the authority or the revocation list cannot be used, or the holder has no certificate.
    """
    signer = _authority(folder)
    if (name := _name_in(folder / holder)) is None:
        raise ValueError(
            f"{folder / holder}: holds no certificate; where it is lost, mmrs bus keys replaces it"
        )
    if name == valid_name(holder, signer.list.tbs_certlist_bytes):
        _revoked(folder, signer, [holder], now)
    return (folder / REVOKED, *(path.with_name(REVOKED) for path in sorted(folder.glob(f"*/{_CERTIFICATE}"))))


def _refuse_left_out(folder: Path, named: set[str], revoked: bytes) -> None:
    holders = sorted(path.parent.name for path in folder.glob(f"*/{_CERTIFICATE}"))
    valid = [each for each in holders if _name_in(folder / each) == valid_name(each, revoked)]
    if left_out := [each for each in valid if each not in named]:
        raise ValueError(
            f"{folder}: {', '.join(map(repr, left_out))} would not be let in any more: name all who are to be"
            " on the bus, and revoke those who are not (mmrs bus revoke)"
        )


def _name_in(own: Path) -> str | None:
    """Return the common name of the certificate in a holder's folder; None: there is none."""
    if not (own / _CERTIFICATE).exists():
        return None
    made = x509.load_pem_x509_certificate((own / _CERTIFICATE).read_bytes())
    return str(made.subject.get_attributes_for_oid(NameOID.COMMON_NAME)[0].value)


def _revoked(folder: Path, signer: _Signer, holders: Sequence[str], now: datetime) -> _Signer:
    """Revoke the valid certificates of holders, and write the list wherever it belongs."""
    if holders:
        revoked = signer.list.tbs_certlist_bytes
        serials = [serial_of(valid_name(holder, revoked)) for holder in holders]
        entries = [
            x509.RevokedCertificateBuilder().serial_number(each).revocation_date(now).build()
            for each in serials
        ]
        listed = _list(signer.certificate, signer.key, [*signer.list, *entries], now)
        signer = replace(signer, list=listed)
        content = signer.list.public_bytes(Encoding.PEM)
        for path in (folder, *(path.parent for path in folder.glob(f"*/{_CERTIFICATE}"))):
            write_secret(path / REVOKED, content)
    return signer


def _authority(folder: Path) -> _Signer:
    certificate, key, revoked = (
        folder / name for name in (f"{AUTHORITY}.pem", f"{AUTHORITY}.key.pem", REVOKED)
    )
    if certificate.exists() and not revoked.exists():
        raise ValueError(
            f"{revoked}: missing; without it revoked certificates would be valid again. Restore it, or make"
            " new keys in another folder"
        )
    found = load_pem_private_key(key.read_bytes(), None)
    if not isinstance(found, ec.EllipticCurvePrivateKey):
        raise ValueError(f"{key}: no key of the kind that signs for the bus")
    known = x509.load_pem_x509_crl(revoked.read_bytes())
    if not known.is_signature_valid(found.public_key()):
        raise ValueError(f"{revoked}: not signed by {certificate.name}")
    return _Signer(x509.load_pem_x509_certificate(certificate.read_bytes()), found, known)


def _new_authority(folder: Path, now: datetime, days: int) -> _Signer:
    made = ec.generate_private_key(ec.SECP256R1())
    name = _name("MMRS bus")
    signed = (
        _builder(name, name, made, now, days)
        .serial_number(x509.random_serial_number())
        .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
        .add_extension(_usage(signs=True), critical=True)
        .sign(made, SHA256())
    )
    signer = _Signer(signed, made, _list(signed, made, (), now))
    write_secret(folder / f"{AUTHORITY}.key.pem", _pem(made))
    write_secret(folder / REVOKED, signer.list.public_bytes(Encoding.PEM))
    write_secret(folder / f"{AUTHORITY}.pem", signed.public_bytes(Encoding.PEM))
    return signer


def _list(
    authority: x509.Certificate,
    key: ec.EllipticCurvePrivateKey,
    revoked: Sequence[x509.RevokedCertificate],
    now: datetime,
) -> x509.CertificateRevocationList:
    """Return a revocation list, valid for as long as the authority is."""
    made = (
        x509.CertificateRevocationListBuilder()
        .issuer_name(authority.subject)
        .last_update(now - _EARLIER)
        .next_update(authority.not_valid_after_utc)
        .add_extension(x509.CRLNumber(len(revoked)), critical=False)
    )
    for each in revoked:
        made = made.add_revoked_certificate(each)
    return made.sign(key, SHA256())


def _certify(own: Path, name: str, hosts: Sequence[str], signer: _Signer, now: datetime, days: int) -> None:
    key = ec.generate_private_key(ec.SECP256R1())
    both = [ExtendedKeyUsageOID.SERVER_AUTH, ExtendedKeyUsageOID.CLIENT_AUTH]
    signed = (
        _builder(_name(name), signer.certificate.subject, key, now, days)
        .serial_number(serial_of(name))
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(x509.SubjectAlternativeName([_host(host) for host in hosts]), critical=False)
        .add_extension(x509.ExtendedKeyUsage(both), critical=False)
        .add_extension(_usage(signs=False), critical=True)
        .sign(signer.key, SHA256())
    )
    write_secret(own / "key.pem", _pem(key))
    write_secret(own / _CERTIFICATE, signed.public_bytes(Encoding.PEM))


def _builder(
    subject: x509.Name, issuer: x509.Name, key: ec.EllipticCurvePrivateKey, now: datetime, days: int
) -> x509.CertificateBuilder:
    return (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(issuer)
        .public_key(key.public_key())
        .not_valid_before(now - _EARLIER)
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
