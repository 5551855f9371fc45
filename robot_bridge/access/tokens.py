"""Tokens: 256 random bits, shown once, kept as their SHA-256.

A slow hash protects what people think up; these bits cannot be guessed, and a slow hash would let strangers
keep the gateway's processor busy.
"""

from __future__ import annotations

import hashlib
import re
import secrets
from collections.abc import Sequence
from enum import Enum

from .errors import AccessError

BITS = 256
PROTOCOL = "robot-bridge"
"""The WebSocket subprotocol that web pages have to be answered with."""
_TOKEN_OFFER = "token."
_PROTOCOL_NAME = re.compile(r"[\w!#$%&'*+.^`|~-]+", re.ASCII)


class TokenKind(str, Enum):
    """Whose token it is: an operator's at the desk, a robot's on its WebSocket, a link's for many robots."""

    OPERATOR = "operator"
    ROBOT = "robot"
    LINK = "link"


# A prefix lets people, and programs that look for secrets in the wrong places, see what it is.
PREFIXES = {
    TokenKind.OPERATOR: "fleet_op_",
    TokenKind.ROBOT: "fleet_robot_",
    TokenKind.LINK: "fleet_link_",
}


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


def token_in(authorizations: Sequence[str], offers: Sequence[str]) -> str | None:
    """Return the token that a request carries, None where it carries none.

    ``authorizations`` are its ``Authorization`` headers, ``offers`` its ``Sec-WebSocket-Protocol`` headers: a
    web page's script can send no others, and offers ``robot-bridge`` with ``token.`` and its token.

    :raises AccessError: when it cannot be told which token is meant; the text holds nothing of them.
    """
    if len(authorizations) > 1:
        raise AccessError("The request has several Authorization headers; send one.")
    names = [name.strip(" \t") for offer in offers for name in offer.split(",")]
    if not all(_PROTOCOL_NAME.fullmatch(name) for name in names):
        raise AccessError(
            "Sec-WebSocket-Protocol holds what is no name of a protocol; send the token as it is."
        )
    tokens = [name.removeprefix(_TOKEN_OFFER) for name in names if name.startswith(_TOKEN_OFFER)]
    if tokens and PROTOCOL not in names:
        raise AccessError(f"Sec-WebSocket-Protocol offers a token alone; offer {PROTOCOL} beside it.")
    if len(tokens) + len(authorizations) > 1:
        raise AccessError("The request carries several tokens; send one, in one header.")
    return tokens[0] or None if tokens else bearer(authorizations[0] if authorizations else None)


def chosen_protocol(offered: Sequence[str]) -> str | None:
    """Return the subprotocol that a connection is answered with: a token is never sent back."""
    return PROTOCOL if PROTOCOL in offered else None
