"""DDS Security (SROS 2) of a link: its files, and their properties for cyclonedds."""

from __future__ import annotations

import ssl
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import msgspec

from ..ros.errors import RosError

PLUGINS = ("auth", "access", "crypto")
_LIBRARIES = {
    "auth": ("dds_security_auth", "authentication"),
    "access": ("dds_security_ac", "access_control"),
    "crypto": ("dds_security_crypto", "crypto"),
}
SECURED = b"dds.sec.auth.library.path"
"""A string in libddsc only if it was built with DDS Security."""


class SecuritySettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Table ``[ros2.security]``: files of an enclave of SROS 2, beside the settings.

    ``permissions_ca`` is ``identity_ca`` unless named. ``plugins`` is the folder of Cyclone DDS's plug-ins,
    for systems whose loader does not find them by their names.
    """

    identity_ca: str
    certificate: str
    private_key: str
    governance: str
    permissions: str
    permissions_ca: str | None = None
    plugins: str | None = None

    def beside(self, folder: Path) -> DdsSecurity:
        """Return the same with the files' paths; raises RosError, beginning with the key, for bad ones."""
        named: Mapping[str, str | None] = msgspec.structs.asdict(self)
        found = {key: folder / name for key, name in named.items() if name is not None}
        return DdsSecurity(
            identity_ca=found["identity_ca"],
            certificate=found["certificate"],
            private_key=found["private_key"],
            governance=found["governance"],
            permissions=found["permissions"],
            permissions_ca=found.get("permissions_ca", found["identity_ca"]),
            plugins=found.get("plugins"),
        )


@dataclass(frozen=True)
class DdsSecurity:
    """A participant's credentials, and those by which it verifies others.

    :raises RosError: for a file that is unreadable or of the wrong kind, beginning with its key.
    """

    identity_ca: Path
    certificate: Path
    private_key: Path
    governance: Path
    permissions: Path
    permissions_ca: Path
    plugins: Path | None = None

    def __post_init__(self) -> None:
        for key in ("identity_ca", "certificate", "private_key", "permissions_ca"):
            if b"-----BEGIN " not in _content(key, getattr(self, key)):
                raise RosError(f"{key} = {str(getattr(self, key))!r} is no PEM file")
        for key in ("governance", "permissions"):
            if b"multipart/signed" not in _content(key, getattr(self, key)):
                raise RosError(
                    f"{key} = {str(getattr(self, key))!r} is not signed; make it with "
                    "ros2 security create_enclave, or openssl smime -sign -text"
                )
        try:
            ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT).load_cert_chain(
                self.certificate, self.private_key, password=_no_password
            )
        except (ssl.SSLError, RosError) as error:
            raise RosError(
                f"private_key = {str(self.private_key)!r} is not the key of certificate "
                f"{str(self.certificate)!r} ({getattr(error, 'reason', None) or error})"
            ) from None
        if self.plugins is not None and not self.plugins.is_dir():
            raise RosError(f"plugins = {str(self.plugins)!r} is no folder")

    def properties(self) -> dict[str, str]:
        """Return the properties of a participant, by their names in DDS Security."""
        names = {
            "dds.sec.auth.identity_ca": self.identity_ca,
            "dds.sec.auth.identity_certificate": self.certificate,
            "dds.sec.auth.private_key": self.private_key,
            "dds.sec.access.permissions_ca": self.permissions_ca,
            "dds.sec.access.governance": self.governance,
            "dds.sec.access.permissions": self.permissions,
        }
        properties = {key: f"file:{path.resolve()}" for key, path in names.items()}
        for plugin in PLUGINS:
            library, function = _LIBRARIES[plugin]
            where = library if self.plugins is None else str(self.plugins.resolve() / f"lib{library}.so")
            properties[f"dds.sec.{plugin}.library.path"] = where
            properties[f"dds.sec.{plugin}.library.init"] = f"init_{function}"
            properties[f"dds.sec.{plugin}.library.finalize"] = f"finalize_{function}"
        return properties


def _content(key: str, file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError as error:
        raise RosError(f"{key} = {str(file)!r} cannot be read: {error.strerror or error}") from None


def _no_password() -> str:
    raise RosError("it is encrypted; keep it without a password, readable by the link's account alone")
