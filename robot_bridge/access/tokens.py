"""Tokens: 256 random bits, shown once, kept as their SHA-256.

A slow hash protects what people think up; these bits cannot be guessed, and a slow hash would let strangers
keep the gateway's processor busy.
"""

from __future__ import annotations

import hashlib
import secrets
from enum import Enum

BITS = 256


class TokenKind(str, Enum):
    """Whose token it is: an operator's at the desk, or a robot's on its WebSocket."""

    OPERATOR = "operator"
    ROBOT = "robot"


# A prefix lets people, and programs that look for secrets in the wrong places, see what it is.
PREFIXES = {TokenKind.OPERATOR: "fleet_op_", TokenKind.ROBOT: "fleet_robot_"}


def new_token(kind: TokenKind) -> str:
    """Return a token that nobody has seen before."""
    return PREFIXES[kind] + secrets.token_urlsafe(BITS // 8)


def new_id() -> str:
    """Return an id for a token or a session; it is no secret."""
    return secrets.token_hex(8)


def digest(token: str) -> str:
    """Return what the database keeps of a token, in hexadecimal digits."""
    return hashlib.sha256(token.encode("utf-8", "surrogateescape")).hexdigest()


def bearer(header: str | None) -> str | None:
    """Return the token in the value of an ``Authorization`` header, None where there is none."""
    scheme, _, token = (header or "").strip().partition(" ")
    return token.strip() or None if scheme.lower() == "bearer" else None
