"""Where the frames begin in what a client sends, and those that are a short message as they stand; no I/O.

Frames are those of RFC 6455, section 5.2.
"""

from __future__ import annotations

try:
    from websockets.speedups import apply_mask
except ImportError:
    from websockets.utils import apply_mask

LONGEST = 1000
"""bytes of a message that is short: below any limit on messages that a site may set."""
_WHOLE_TEXT = 0x81
_MASKED = 0x80
_TWO_BYTES, _EIGHT_BYTES = 126, 127


def short_text(data: bytes, start: int) -> tuple[bytes, int] | None:
    """Return the message in the frame that begins at ``start``, and where the next frame begins.

    None where that frame is not all there, or is anything but one whole text of at most LONGEST bytes of
    ASCII: what may be wrong, or be a part of something, is for those who know all of the protocol.
    """
    if len(data) - start < 6 or data[start] != _WHOLE_TEXT:
        return None
    length, mask_at = data[start + 1] - _MASKED, start + 2
    if length == _TWO_BYTES:
        length, mask_at = data[start + 2] << 8 | data[start + 3], start + 4
    elif length == _EIGHT_BYTES:
        # Taken for a length, it would now and then find 127 bytes of ASCII in a long text.
        return None
    begin = mask_at + 4
    end = begin + length
    if not 0 < length <= LONGEST or end > len(data):
        return None
    text = apply_mask(data[begin:end], data[mask_at:begin])
    return (text, end) if text.isascii() else None


class FrameEdges:
    """Follows what a client sends from frame to frame, into whatever pieces it comes cut.

    It keeps no more of it than an unfinished header.
    """

    __slots__ = ("_header", "_left")

    def __init__(self) -> None:
        self._header = b""
        self._left = 0

    @property
    def between(self) -> bool:
        """Tell whether the next byte begins a frame."""
        return not self._left and not self._header

    def pass_over(self, data: bytes) -> None:
        """Follow the next bytes."""
        at = 0
        while at < len(data):
            if self._left:
                step = min(self._left, len(data) - at)
                self._left -= step
                at += step
                continue
            header = self._header + data[at : at + 14]
            size, payload = _measured(header)
            if size == 0:
                self._header = header
                return
            at += size - len(self._header)
            self._header, self._left = b"", payload


def _measured(header: bytes) -> tuple[int, int]:
    """Return the bytes of a frame's header and of its payload, (0, 0) while that cannot be told."""
    if len(header) < 2:
        return 0, 0
    mask = 4 if header[1] & _MASKED else 0
    short = header[1] & ~_MASKED
    extended = {_TWO_BYTES: 2, _EIGHT_BYTES: 8}.get(short, 0)
    size = 2 + extended + mask
    if len(header) < size:
        return 0, 0
    return size, int.from_bytes(header[2 : 2 + extended], "big") if extended else short
