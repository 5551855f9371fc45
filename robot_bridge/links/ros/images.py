"""Images out of ROS messages as the gateway takes them: JPEG, PNG or WebP of a bounded size; no I/O."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...images import encode_png, media_type_of
from ...messages import MessageError
from .errors import FaultError
from .types import COMPRESSED_IMAGE

MOST_PIXELS = 640 * 480
"""of an image that comes uncompressed: of a larger one every second, third ... pixel is taken."""
COARSEST = 16
"""pixels to a side of which one is taken at most."""
_ENCODINGS: dict[str, tuple[int, list[int]]] = {
    "rgb8": (3, [0, 1, 2]),
    "bgr8": (3, [2, 1, 0]),
    "8UC3": (3, [2, 1, 0]),
    "rgba8": (4, [0, 1, 2]),
    "bgra8": (4, [2, 1, 0]),
    "8UC4": (4, [2, 1, 0]),
    "mono8": (1, [0]),
    "8UC1": (1, [0]),
}
"""How many bytes a pixel has, and which of them are red, green and blue, or grey."""


def image_of(type_name: str, message: Any, largest: int) -> bytes:
    """Return the image in a sensor_msgs/Image or CompressedImage, at most ``largest`` bytes.

    :raises FaultError: for what is no image, is encoded in another way, or does not become small enough.
    """
    if type_name == COMPRESSED_IMAGE:
        return _compressed(message, largest)
    pixels = _pixels(message)
    rows, columns = pixels.shape[:2]
    step = max(1, math.ceil(math.sqrt(rows * columns / MOST_PIXELS)))
    while step <= COARSEST:
        image = encode_png(np.ascontiguousarray(pixels[::step, ::step]))
        if len(image) <= largest:
            return image
        step += 1
    raise FaultError(f"its image of {columns} x {rows} pixels does not become smaller than {largest} bytes")


def _compressed(message: Any, largest: int) -> bytes:
    image = bytes(message.data)
    if len(image) > largest:
        raise FaultError(
            f"its image has {len(image)} bytes, and {largest} are taken; have it compressed more, or give "
            "more with largest_image_bytes"
        )
    try:
        media_type_of(image)
    except MessageError:
        raise FaultError(
            f"its image is {str(message.format)[:40]!r}, which is neither JPEG, PNG nor WebP"
        ) from None
    return image


def _pixels(message: Any) -> np.ndarray[Any, Any]:
    """Return the pixels of a sensor_msgs/Image, (rows, columns) or (rows, columns, 3)."""
    encoding = str(message.encoding)
    if encoding not in _ENCODINGS:
        known = ", ".join(_ENCODINGS)
        raise FaultError(f"its image is encoded as {encoding[:40]!r}; known are {known}")
    size, order = _ENCODINGS[encoding]
    rows, columns, line = int(message.height), int(message.width), int(message.step)
    if rows < 1 or columns < 1 or line < columns * size or len(message.data) < rows * line:
        raise FaultError(
            f"its image says {columns} x {rows} pixels in lines of {line} bytes, and has "
            f"{len(message.data)} bytes"
        )
    data = np.asarray(message.data, dtype=np.uint8)[: rows * line].reshape(rows, line)
    pixels = data[:, : columns * size].reshape(rows, columns, size)[..., order]
    return pixels[..., 0] if len(order) == 1 else pixels
