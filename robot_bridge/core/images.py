"""Images: media type by the leading bytes, not by the declared one; PNG encoding."""

from __future__ import annotations

import struct
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import RefusedError
from .messages.base import MessageError

_BEGINNINGS = {
    "image/jpeg": b"\xff\xd8\xff",
    "image/png": b"\x89PNG\r\n\x1a\n",
}


def check_size(size: int, largest: int) -> None:
    """Raise RefusedError for an image of more bytes than the site accepts."""
    if size > largest:
        raise RefusedError(
            f"SendImage: the image has {size} bytes, and this site takes up to {largest} "
            "([observations] largest_image_bytes); send a smaller one"
        )


def media_type_of(content: bytes, declared: str | None = None) -> str:
    """Return the media type of an image.

    Raises MessageError when the type is not accepted, or differs from the ``declared`` one.
    """
    found = next((name for name, begin in _BEGINNINGS.items() if content.startswith(begin)), None)
    if content[:4] == b"RIFF" and content[8:12] == b"WEBP":
        found = "image/webp"
    if found is None:
        raise MessageError(
            f"SendImage: image begins with {content[:8].hex(' ') or 'nothing'}, which is neither JPEG, PNG "
            "nor WebP; send one of these"
        )
    if declared is not None and declared != found:
        raise MessageError(f"SendImage: media_type is {declared!r}, and the bytes are {found}; correct it")
    return found


def encode_png(pixels: NDArray[Any]) -> bytes:
    """Return the PNG of uint8 pixels: (rows, columns) grey or (rows, columns, 3) red, green, blue."""
    rows, columns = pixels.shape[:2]
    lines = np.zeros((rows, 1 + pixels[0].size), dtype=np.uint8)
    lines[:, 1:] = pixels.reshape(rows, -1)
    head = struct.pack(">IIBBBBB", columns, rows, 8, 2 if pixels.ndim == 3 else 0, 0, 0, 0)
    parts = ((b"IHDR", head), (b"IDAT", zlib.compress(lines.tobytes())), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(name, body) for name, body in parts)


def _chunk(name: bytes, body: bytes) -> bytes:
    return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))
