"""Images of robots' cameras, as the gateway takes them."""

from __future__ import annotations

import io
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image

from robot_bridge.links.ros.errors import FaultError
from robot_bridge.links.ros.messages import COMPRESSED_IMAGE, IMAGE, MOST_PIXELS, image_of

RED, BLUE = (255, 0, 0), (0, 0, 255)


def raw(encoding, pixels, step=None, **changed):
    pixels = np.asarray(pixels, dtype=np.uint8)
    rows, columns, size = pixels.shape
    lines = np.full((rows, step or columns * size), 77, dtype=np.uint8)
    lines[:, : columns * size] = pixels.reshape(rows, -1)
    fields = {"encoding": encoding, "height": rows, "width": columns, "step": lines.shape[1]}
    return SimpleNamespace(**(fields | {"data": lines.reshape(-1)} | changed))


def opened(content):
    return Image.open(io.BytesIO(content))


@pytest.mark.parametrize(
    ("encoding", "pixels", "seen"),
    [
        ("rgb8", [[RED, BLUE]], [RED, BLUE]),
        ("bgr8", [[RED[::-1], BLUE[::-1]]], [RED, BLUE]),
        ("rgba8", [[(*RED, 9), (*BLUE, 9)]], [RED, BLUE]),
        ("bgra8", [[(*RED[::-1], 9), (*BLUE[::-1], 9)]], [RED, BLUE]),
        ("mono8", [[[3], [200]]], [3, 200]),
    ],
)
@pytest.mark.parametrize("step", [None, 20])
def test_uncompressed_images_become_png(encoding, pixels, seen, step):
    image = opened(image_of(IMAGE, raw(encoding, pixels, step), 10_000))
    assert image.format == "PNG" and image.size == (2, 1)
    assert [image.getpixel((x, 0)) for x in (0, 1)] == seen


def test_a_large_image_is_made_coarser_until_it_is_small_enough():
    noise = np.random.default_rng(1).integers(0, 256, (1080, 1920, 3), dtype=np.uint8)
    image = image_of(IMAGE, raw("rgb8", noise), 300_000)
    assert len(image) <= 300_000
    columns, rows = opened(image).size
    assert columns * rows < MOST_PIXELS and columns / rows == pytest.approx(16 / 9, rel=0.02)


@pytest.mark.parametrize("kind", ["jpeg", "png", "webp"])
def test_compressed_images_pass_as_they_are(kind):
    file = io.BytesIO()
    Image.new("RGB", (4, 3), "orange").save(file, kind)
    told = SimpleNamespace(format=kind, data=np.frombuffer(file.getvalue(), dtype=np.uint8))
    assert image_of(COMPRESSED_IMAGE, told, 10_000) == file.getvalue()


@pytest.mark.parametrize(
    ("kind", "message", "words"),
    [
        (COMPRESSED_IMAGE, SimpleNamespace(format="png", data=bytes(2000)), "has 2000 bytes, and 1000 are"),
        (
            COMPRESSED_IMAGE,
            SimpleNamespace(format="compressedDepth", data=b"abc"),
            "pth', which is neither",
        ),
        (IMAGE, raw("16UC1", [[[1, 2]]]), "encoded as '16UC1'; known are rgb8"),
        (IMAGE, raw("rgb8", [[RED]], height=10**6), "says 1 x 1000000 pixels"),
        (IMAGE, raw("rgb8", [[RED]], width=5), "says 5 x 1 pixels"),
        (IMAGE, raw("rgb8", [[RED]], width=0), "says 0 x 1 pixels"),
    ],
)
def test_what_is_no_image_is_named(kind, message, words):
    with pytest.raises(FaultError, match=words):
        image_of(kind, message, 1000)


def test_an_image_that_compresses_well_is_made_smaller_all_the_same():
    image = image_of(IMAGE, raw("mono8", np.zeros((1500, 2000, 1))), 1_000_000)
    columns, rows = opened(image).size
    assert columns * rows <= MOST_PIXELS
