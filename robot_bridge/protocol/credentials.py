"""Credentials of a client: its token, the authority that it trusts, and the error of both ends."""

from __future__ import annotations

import logging
import ssl
import stat
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from ..core.errors import BridgeError
from ..core.messages.base import is_loopback

# --- The exception family of accounts, tokens and certificates ---


class AccessError(BridgeError):
    """An account, a token or a certificate that cannot be made, found or used."""


# --- What a robot brings to the gateway: its token, and the authority that it trusts ---

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class ClientCredentials:
    """Files with a token and with the certificate of the site's authority (PEM); None where there is none."""

    token_file: Path | None = None
    ca: Path | None = None

    def options(self, url: str) -> dict[str, Any]:
        """Return what ``websockets`` is to connect to ``url`` with; the files are read again each time.

        :raises AccessError: when a file cannot be used, or the token would travel for everybody to read.
        """
        parts = urlsplit(url)
        options: dict[str, Any] = {}
        if parts.scheme == "wss":
            options["ssl"] = client_context(self.ca)
        if self.token_file is not None:
            if parts.scheme != "wss" and not is_loopback(parts.hostname or ""):
                raise AccessError(f"{url}: without TLS everybody on the way reads the token; use wss://")
            options["additional_headers"] = {"Authorization": f"Bearer {read_token(self.token_file)}"}
        return options


def client_context(ca: Path | None) -> ssl.SSLContext:
    """Return the context of who connects: trusts the authority in ``ca`` alone, without it the system's.

    :raises AccessError: when ``ca`` cannot be read.
    """
    try:
        context = ssl.create_default_context(cafile=ca)
    except (OSError, ssl.SSLError) as error:
        raise AccessError(
            f"CA file {ca} cannot be used: {error.strerror or error}; give the site's ca.pem"
        ) from error
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    return context


def read_token(file: Path) -> str:
    """Return the token in ``file``; raises AccessError when there is none."""
    try:
        token = file.read_text(encoding="utf-8").strip()
        mode = file.stat().st_mode
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or error
        raise AccessError(f"token file {file} cannot be read: {reason}") from None
    if not token.isascii() or len(token.split()) != 1:
        raise AccessError(f"token file {file} holds no token; write the one that was printed into it, alone")
    if sys.platform != "win32" and mode & (stat.S_IRGRP | stat.S_IROTH):
        log.warning("token file %s can be read by others; chmod 600 keeps it to yourself", file)
    return token
