"""Coordinates as people write them."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.control.coordinates import PlaceTextError, read_place

LON_LAT = (16.3725, 48.2083)


@pytest.mark.parametrize(
    "text",
    [
        "48.2083, 16.3725",
        "48.2083,16.3725",
        "48.2083 16.3725",
        "48,2083; 16,3725",
        "48,2083 16,3725",
        "48,2083, 16,3725",
        "(48.2083, 16.3725)",
        "lat: 48.2083, lon: 16.3725",
        "48.2083\t16.3725",
        "N 48.2083 E 16.3725",
        "48.2083N, 16.3725E",
        "16.3725° E, 48.2083° N",
        "48° 12' 29.88\" N 16° 22' 21\" E",
        "48°12′29.88″N, 16°22′21″E",
        "N48 12.498' E16 22.35'",
    ],
)
def test_latitude_comes_first_unless_letters_say_otherwise(text):
    assert read_place(text, geographic=True) == pytest.approx(LON_LAT, abs=1e-9)


def test_south_and_west_are_negative():
    assert read_place("33.9 S, 18.4 W", geographic=True) == (-18.4, -33.9)
    assert read_place("-33.9, -18.4", geographic=True) == (-18.4, -33.9)


@pytest.mark.parametrize("text", ["488070.5, 5190055.2", "488070,5; 5190055,2", "x 488070.5 y 5190055.2"])
def test_in_metres_x_comes_first(text):
    assert read_place(text, geographic=False) == (488070.5, 5190055.2)


@pytest.mark.parametrize(
    ("text", "geographic"),
    [
        ("", True),
        ("here", True),
        ("48.2", True),
        ("48.2, 16.3, 200", True),
        ("48° 75' N, 16° E", True),
        ("48 N, 16 N", True),
        ("-48 N, 16 E", True),
        ("48 N, 16 O", True),
        ("488070 N, 5190055 E", False),
    ],
)
def test_what_is_no_place_or_may_be_two_is_not_guessed(text, geographic):
    with pytest.raises(PlaceTextError, match="is no place: write"):
        read_place(text, geographic=geographic)


def test_metres_for_degrees_are_named_with_what_to_do():
    with pytest.raises(PlaceTextError, match=r"are not on the earth.*choose the CRS"):
        read_place("488070.5, 5190055.2", geographic=True)
