"""TLS for the gateway's port, and for those who connect to it."""

from __future__ import annotations

import asyncio
import datetime
import logging
import ssl
import stat
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from ...core.errors import counted
from ...protocol.credentials import AccessError

log = logging.getLogger(__name__)

CIPHERS = "ECDHE+AESGCM:ECDHE+CHACHA20"
"""TLS 1.2 only with forward secrecy and authenticated encryption; TLS 1.3 has nothing else."""
WATCH_INTERVAL = 2.0
WARN_DAYS = 30
WARN_INTERVAL = 86400.0
"""seconds between two looks at when the certificate ends: a gateway runs for longer than one holds."""


@dataclass(frozen=True)
class ServerFiles:
    """The gateway's certificate (with what leads to its authority) and its key, in PEM."""

    certificate: Path
    key: Path


def server_files(certificate: Path | None, key: Path | None) -> ServerFiles | None:
    """Return both files, None where neither is given; raises AccessError for one alone."""
    if certificate is None and key is None:
        return None
    if certificate is None or key is None:
        raise AccessError("a certificate goes with its key; give both --certificate and --key, or neither")
    return ServerFiles(certificate, key)


class ServerTls:
    """The gateway's TLS: its context, and a new certificate in it whenever the files change."""

    def __init__(self, files: ServerFiles) -> None:
        """Read the files; raises AccessError when they cannot be used."""
        self._files = files
        self._seen = _stamps(files)
        self.context = _server_context(files)
        self.until, self.names = _validity(files.certificate)
        """Until when the certificate holds, and the names of this computer that it holds for."""
        self._warn_of_expiry()

    def reload(self) -> bool:
        """Take the certificate that lies there now for new connections; tell whether it can be used.

        One that cannot be used changes nothing.
        """
        try:
            _server_context(self._files)
            self.context.load_cert_chain(self._files.certificate, self._files.key)
            self.until, self.names = _validity(self._files.certificate)
        except (AccessError, OSError) as error:
            log.error("%s; the certificate in use stays", error)
            return False
        self._warn_of_expiry()
        log.info("took the new certificate %s", self._files.certificate)
        return True

    async def watch(self) -> None:
        """Reload whenever the files change, and warn once a day of an end that is near, until cancelled."""
        warned_at = time.monotonic()
        while True:
            await asyncio.sleep(WATCH_INTERVAL)
            if time.monotonic() - warned_at >= WARN_INTERVAL:
                warned_at = time.monotonic()
                self._warn_of_expiry()
            stamps = _stamps(self._files)
            if stamps != self._seen:
                # Both files are written one after the other: wait until they stand still.
                await asyncio.sleep(WATCH_INTERVAL / 4)
                if stamps == _stamps(self._files):
                    self._seen = stamps
                    self.reload()

    def _warn_of_expiry(self) -> None:
        left = self.until - datetime.datetime.now(datetime.timezone.utc)
        if left < datetime.timedelta(days=WARN_DAYS):
            log.warning(
                "certificate %s %s; 'robot-bridge tls renew' makes a new one",
                self._files.certificate,
                f"holds for {counted(left.days, 'day')} more" if left.days >= 0 else "has expired",
            )


def _server_context(files: ServerFiles) -> ssl.SSLContext:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    context.options |= ssl.OP_NO_COMPRESSION | ssl.OP_NO_RENEGOTIATION | ssl.OP_CIPHER_SERVER_PREFERENCE
    context.set_ciphers(CIPHERS)
    context.set_alpn_protocols(["http/1.1"])
    try:
        # An encrypted key would ask for its password on the terminal, which a service does not have.
        context.load_cert_chain(files.certificate, files.key, password=_no_password)
    except ssl.SSLError as error:
        raise AccessError(
            f"certificate {files.certificate} and key {files.key} cannot be used: {error.reason or error}; "
            "both must be PEM, and belong to each other"
        ) from error
    except OSError as error:
        missing = next((f for f in (files.certificate, files.key) if not f.is_file()), files.key)
        raise AccessError(f"{missing} cannot be read: {error.strerror or error}") from error
    if sys.platform != "win32" and files.key.stat().st_mode & (stat.S_IRWXO | stat.S_IRGRP):
        log.warning("key %s can be read by others; chmod 600 keeps it to the gateway", files.key)
    return context


def _no_password() -> str:
    raise AccessError("the key is encrypted; give one that is not, readable to the gateway's account alone")


def _validity(certificate: Path) -> tuple[datetime.datetime, tuple[str, ...]]:
    """Return until when a certificate holds, and for which names."""
    # A gateway without TLS starts without cryptography, which takes a tenth of the start to import.
    from .certificates import names_of, valid_until

    return valid_until(certificate), names_of(certificate)


def _stamps(files: ServerFiles) -> tuple[object, ...]:
    stamps: list[object] = []
    for file in (files.certificate, files.key):
        try:
            status = file.stat()
        except OSError:
            stamps.append(None)
        else:
            # The time of the last change of its owner or rights, too: it may be readable since then.
            stamps.append((status.st_mtime_ns, status.st_ctime_ns, status.st_ino, status.st_size))
    return tuple(stamps)
