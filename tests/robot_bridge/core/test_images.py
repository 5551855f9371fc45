"""An image is what its bytes say it is."""

from __future__ import annotations

import io

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from robot_bridge.core.errors import RefusedError
from robot_bridge.core.images import check_size, media_type_of
from robot_bridge.core.messages.base import MessageError


def picture(kind: str) -> bytes:
    file = io.BytesIO()
    Image.new("RGB", (4, 3), "orange").save(file, kind)
    return file.getvalue()


@pytest.mark.parametrize("kind", ["jpeg", "png", "webp"])
def test_real_images_are_known_by_their_bytes(kind):
    assert media_type_of(picture(kind)) == f"image/{kind}"
    assert media_type_of(picture(kind), f"image/{kind}") == f"image/{kind}"


@pytest.mark.parametrize("kind", ["gif", "bmp", "tiff", "ico"])
def test_other_kinds_are_refused(kind):
    with pytest.raises(MessageError, match="neither JPEG, PNG nor WebP; send one of these"):
        media_type_of(picture(kind))


@pytest.mark.parametrize("content", [b"", b"\xff", b"<svg/>", b"RIFF\0\0\0\0WAVE", b"RIFF"])
def test_what_is_no_image_is_refused(content):
    with pytest.raises(MessageError, match=r"image begins with "):
        media_type_of(content)


def test_a_media_type_that_is_not_that_of_the_bytes_is_refused():
    with pytest.raises(MessageError, match="media_type is 'image/jpeg', and the bytes are image/png"):
        media_type_of(picture("png"), "image/jpeg")


@given(st.binary(max_size=64))
def test_any_bytes_are_an_image_or_refused(content):
    try:
        assert media_type_of(content).startswith("image/")
    except MessageError as error:
        assert len(str(error)) < 200


def test_the_largest_size_belongs_to_what_is_taken():
    check_size(100, 100)
    with pytest.raises(RefusedError, match=r"has 101 bytes, and this site takes up to 100 "):
        check_size(101, 100)
