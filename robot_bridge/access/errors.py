"""The exception family of accounts, tokens and certificates."""

from __future__ import annotations

from ..errors import BridgeError


class AccessError(BridgeError):
    """An account, a token or a certificate that cannot be made, found or used."""
