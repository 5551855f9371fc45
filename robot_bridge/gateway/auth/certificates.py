"""A certificate authority for one site, and the gateway's certificate under it.

Keys are on the curve P-256. The authority may sign server certificates only and no further authorities;
clients are given its certificate and trust nothing else.
"""

from __future__ import annotations

import datetime
import ipaddress
import os
import stat
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from ...core.errors import AccessError
from ...core.files import replacement

CA_DAYS = 3650
SERVER_DAYS = 397
"""Longer ones are refused by some clients (CA/Browser Forum, Baseline Requirements, 6.3.2)."""
CLOCK_SKEW = datetime.timedelta(hours=1)


@dataclass(frozen=True)
class TlsFiles:
    """The files of one site's TLS in a folder."""

    folder: Path

    @property
    def ca(self) -> Path:
        """The authority's certificate: for every robot and every desk."""
        return self.folder / "ca.pem"

    @property
    def ca_key(self) -> Path:
        """The authority's key: its holder can pose as the gateway."""
        return self.folder / "ca-key.pem"

    @property
    def certificate(self) -> Path:
        """The gateway's certificate."""
        return self.folder / "server.pem"

    @property
    def key(self) -> Path:
        """The gateway's key."""
        return self.folder / "server-key.pem"


def create(folder: Path, names: Sequence[str], addresses: Sequence[str], days: int = SERVER_DAYS) -> TlsFiles:
    """Create an authority and a server certificate in ``folder``, for host names and IP addresses.

    :raises AccessError: for an invalid name, or when the folder holds an authority already.
    """
    subjects = _subjects(names, addresses)
    files = TlsFiles(folder)
    if any(file.exists() for file in (files.ca, files.ca_key, files.certificate, files.key)):
        raise AccessError(
            f"{folder} holds certificates already, which robots may trust; 'robot-bridge tls renew' "
            "gives the gateway a new one, or choose another folder"
        )
    try:
        folder.mkdir(parents=True, exist_ok=True)
        ca_key = ec.generate_private_key(ec.SECP256R1())
        ca = _authority(ca_key, names[0] if names else addresses[0])
        _write_key(files.ca_key, ca_key)
        _write(files.ca, ca.public_bytes(serialization.Encoding.PEM))
        _write_server(files, ca, ca_key, subjects, days)
    except OSError as error:
        raise AccessError(f"{folder} cannot be written: {error.strerror or error}") from error
    return files


def renew(folder: Path, days: int = SERVER_DAYS) -> datetime.datetime:
    """Give the gateway a new key and certificate for the same names; return the end of its validity.

    :raises AccessError: when the folder holds no readable authority and server certificate.
    """
    files = TlsFiles(folder)
    ca, server = _read_certificate(files.ca), _read_certificate(files.certificate)
    try:
        ca_key = serialization.load_pem_private_key(files.ca_key.read_bytes(), None)
        subjects = server.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except (OSError, ValueError, TypeError, x509.ExtensionNotFound) as error:
        raise AccessError(f"{folder} cannot be used: {error}; 'robot-bridge tls create' makes one") from error
    assert isinstance(ca_key, ec.EllipticCurvePrivateKey)
    if valid_until(files.ca) < _now():
        raise AccessError(f"{files.ca} has expired; make a new folder with 'robot-bridge tls create'")
    try:
        _write_server(files, ca, ca_key, list(subjects), days)
    except OSError as error:
        raise AccessError(f"{folder} cannot be written: {error.strerror or error}") from error
    return valid_until(files.certificate)


def valid_until(file: Path) -> datetime.datetime:
    """Return the end of validity of the certificate in ``file``; raises AccessError when unreadable."""
    certificate = _read_certificate(file)
    # Before version 42 cryptography has only the attribute without a time zone, which later versions drop.
    until: datetime.datetime | None = getattr(certificate, "not_valid_after_utc", None)
    return until or certificate.not_valid_after.replace(tzinfo=datetime.timezone.utc)


def names_of(file: Path) -> tuple[str, ...]:
    """Return the DNS names in the certificate in ``file``; raises AccessError when it cannot be read."""
    try:
        found = _read_certificate(file).extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except x509.ExtensionNotFound:
        return ()
    return tuple(found.get_values_for_type(x509.DNSName))


def _subjects(names: Sequence[str], addresses: Sequence[str]) -> list[x509.GeneralName]:
    if not names and not addresses:
        raise AccessError("a certificate needs a name; give --name HOST, or --ip ADDRESS")
    subjects: list[x509.GeneralName] = []
    for name in names:
        try:
            ipaddress.ip_address(name)
        except ValueError:
            subjects.append(_host(name))
        else:
            raise AccessError(f"{name} is an IP address; give it as --ip {name}")
    for address in addresses:
        try:
            subjects.append(x509.IPAddress(ipaddress.ip_address(address)))
        except ValueError:
            raise AccessError(f"{address!r} is no IP address; write it like 192.168.1.10") from None
    return subjects


def _host(name: str) -> x509.DNSName:
    try:
        ascii_name = name.encode("idna").decode("ascii")
    except UnicodeError:
        ascii_name = ""
    labels = ascii_name.split(".")
    if not all(label and label.replace("-", "").isalnum() for label in labels):
        raise AccessError(f"{name!r} is no host name; write it like gateway.example.org")
    return x509.DNSName(ascii_name)


def _authority(key: ec.EllipticCurvePrivateKey, place: str) -> x509.Certificate:
    name = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, f"Fleet Supervisor site CA, {place}"[:64])])
    usage = _usage(sign=True)
    return (
        _builder(name, name, key.public_key(), CA_DAYS)
        .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
        .add_extension(usage, critical=True)
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(key.public_key()), critical=False)
        .sign(key, hashes.SHA256())
    )


def _write_server(
    files: TlsFiles,
    ca: x509.Certificate,
    ca_key: ec.EllipticCurvePrivateKey,
    subjects: Sequence[x509.GeneralName],
    days: int,
) -> None:
    key = ec.generate_private_key(ec.SECP256R1())
    name = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, str(subjects[0].value)[:64])])
    authority = x509.AuthorityKeyIdentifier.from_issuer_public_key(ca_key.public_key())
    certificate = (
        _builder(name, ca.subject, key.public_key(), days)
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(_usage(sign=False), critical=True)
        .add_extension(x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH]), critical=False)
        .add_extension(x509.SubjectAlternativeName(subjects), critical=False)
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(key.public_key()), critical=False)
        .add_extension(authority, critical=False)
        .sign(ca_key, hashes.SHA256())
    )
    _write_key(files.key, key)
    _write(files.certificate, certificate.public_bytes(serialization.Encoding.PEM))


def _builder(
    subject: x509.Name, issuer: x509.Name, key: ec.EllipticCurvePublicKey, days: int
) -> x509.CertificateBuilder:
    now = _now()
    return (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(issuer)
        .public_key(key)
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - CLOCK_SKEW)
        .not_valid_after(now + datetime.timedelta(days=days))
    )


def _usage(*, sign: bool) -> x509.KeyUsage:
    return x509.KeyUsage(
        digital_signature=not sign,
        content_commitment=False,
        key_encipherment=False,
        data_encipherment=False,
        key_agreement=False,
        key_cert_sign=sign,
        crl_sign=sign,
        encipher_only=False,
        decipher_only=False,
    )


def _write_key(file: Path, key: ec.EllipticCurvePrivateKey) -> None:
    text = key.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    _write(file, text, mode=0o600)


def _write(file: Path, content: bytes, mode: int = 0o644) -> None:
    """Replace ``file`` by ``content`` atomically, readable from the first byte on to ``mode`` only.

    The owner of ``file`` is kept: root renews files that the gateway's account must read.
    """
    with replacement(file) as fresh, open(fresh, "wb", opener=partial(os.open, mode=mode)) as stream:
        stream.write(content)
        if file.exists():
            _copy_ownership(file, stream.fileno())


def _copy_ownership(file: Path, fresh: int) -> None:
    """Give an open file the owner, group and rights of another; raises OSError where that is not allowed."""
    status, own = file.stat(), os.fstat(fresh)
    if (status.st_uid, status.st_gid) != (own.st_uid, own.st_gid):
        os.fchown(fresh, status.st_uid, status.st_gid)
    os.fchmod(fresh, stat.S_IMODE(status.st_mode))


def _read_certificate(file: Path) -> x509.Certificate:
    try:
        return x509.load_pem_x509_certificate(file.read_bytes())
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise AccessError(
            f"certificate {file} cannot be read: {reason}; correct the path, or make one with "
            "'robot-bridge tls create'"
        ) from error


def _now() -> datetime.datetime:
    return datetime.datetime.now(datetime.timezone.utc)
