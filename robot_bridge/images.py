"""Which image bytes are, told by how they begin and not by what is said of them."""

from __future__ import annotations

from .errors import RefusedError
from .messages import MessageError

_BEGINNINGS = {
    "image/jpeg": b"\xff\xd8\xff",
    "image/png": b"\x89PNG\r\n\x1a\n",
}


def check_size(size: int, largest: int) -> None:
    """Raise RefusedError for an image of more bytes than the site takes."""
    if size > largest:
        raise RefusedError(
            f"SendImage: the image has {size} bytes, and this site takes up to {largest} "
            "([observations] largest_image_bytes); send a smaller one"
        )


def media_type_of(content: bytes, said: str | None = None) -> str:
    """Return the media type of an image.

    Raises MessageError when it is none that is taken, or another than what was ``said``.
    """
    found = next((name for name, begin in _BEGINNINGS.items() if content.startswith(begin)), None)
    if content[:4] == b"RIFF" and content[8:12] == b"WEBP":
        found = "image/webp"
    if found is None:
        raise MessageError(
            f"SendImage: image begins with {content[:8].hex(' ') or 'nothing'}, which is neither JPEG, PNG "
            "nor WebP; send one of these"
        )
    if said is not None and said != found:
        raise MessageError(f"SendImage: media_type is {said!r}, and the bytes are {found}; correct it")
    return found
