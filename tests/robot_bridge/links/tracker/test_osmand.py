"""Reports of phones: the forms that clients send, and what must not be believed."""

from __future__ import annotations

import json

import pytest

from robot_bridge.links.tracker.osmand import ReportError, reports_in_form, reports_in_json

PLAIN = "id=7&lat=46.9&lon=16.8&timestamp=1790000000&speed=10&bearing=90&altitude=200&accuracy=4&batt=81"
PLACE = {"latitude": 46.9, "longitude": 16.8, "accuracy": 4.0, "speed": 3.0, "heading": 45.0, "altitude": 200}
LOCATION = {"timestamp": "2026-09-21T14:13:20.500Z", "coords": PLACE, "battery": {"level": 0.81}}


def test_a_form_is_read_in_its_units():
    (report,) = reports_in_form(PLAIN)
    fix = report.fix
    assert report.device == "7"
    assert (fix.lat, fix.lon, fix.heading, fix.altitude, fix.accuracy) == (46.9, 16.8, 90.0, 200.0, 4.0)
    assert fix.v == pytest.approx(5.14444)
    assert (fix.battery, fix.fix_t) == (0.81, 1790000000.0)


def test_json_is_read_in_its_units():
    (report,) = reports_in_json(json.dumps({"device_id": "7", "location": LOCATION}).encode())
    fix = report.fix
    assert (fix.v, fix.heading, fix.battery, fix.fix_t) == (3.0, 45.0, 0.81, 1790000000.5)
    several = reports_in_json(json.dumps({"device_id": 7, "location": [LOCATION, LOCATION]}).encode())
    assert [one.device for one in several] == ["7", "7"]


@pytest.mark.parametrize(
    ("text", "name", "value"),
    [
        ("id=7&location=46.9,16.8", "lat", 46.9),
        ("deviceid=7&lat=46.9&lon=16.8&timestamp=1790000000123", "fix_t", 1790000000.123),
        ("id=7&lat=46.9&lon=16.8&timestamp=2026-09-21T14:13:20Z", "fix_t", 1790000000.0),
        ("id=7&lat=46.9&lon=16.8&timestamp=2026-09-21 14:13:20", "fix_t", 1790000000.0),
        ("id=7&lat=46.9&lon=16.8&speed=0.1&bearing=0", "heading", None),
        ("id=7&lat=46.9&lon=16.8&speed=9&heading=361", "heading", 1.0),
        ("id=7&lat=46.9&lon=16.8", "v", None),
    ],
)
def test_other_spellings_are_understood(text, name, value):
    assert getattr(reports_in_form(text)[0].fix, name) == value


def test_what_a_phone_does_not_know_is_not_told():
    place = {**PLACE, "speed": -1, "heading": -1, "accuracy": -1}
    (report,) = reports_in_json(json.dumps({"device_id": "7", "location": {"coords": place}}).encode())
    assert (report.fix.v, report.fix.heading, report.fix.accuracy) == (None, None, None)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "id is missing"),
        ("id=7", "lat is missing"),
        ("id=7&lat=x&lon=16.8", "lat is 'x'"),
        ("id=7&lat=nan&lon=16.8", "lat is 'nan'"),
        ("id=7&lat=91&lon=16.8", "lat is 91"),
        ("id=7&lat=0&lon=0", "no fix"),
        ("id=7&lat=46.9&lon=16.8&valid=false", "no fix"),
        ("id=7&lat=46.9&lon=16.8&speed=1e9", "v is"),
        ("id=7&lat=46.9&lon=16.8&batt=900", "battery is 9"),
        ("id=7&lat=46.9&lon=16.8&timestamp=yesterday", "timestamp is 'yesterday'"),
        ("id=7&lat=46.9&lon=16.8&timestamp=1e308", "fix_t is"),
        (f"id={'7' * 65}&lat=46.9&lon=16.8", "id is missing, or not"),
        ("id=a%0Ab&lat=46.9&lon=16.8", "id is missing, or not"),
        ("&".join(f"k{n}=1" for n in range(200)), "cannot be read"),
    ],
)
def test_what_is_wrong_is_named(text, reason):
    with pytest.raises(ReportError, match=reason):
        reports_in_form(text)


@pytest.mark.parametrize(
    "body",
    [
        b"",
        b"[]",
        b"{}",
        b"\xff",
        b"[" * 100_000,
        b'{"device_id": "7", "location": 5}',
        b'{"device_id": "7", "location": {"coords": {"latitude": [], "longitude": 1}}}',
        b'{"device_id": "7", "location": {"coords": {"latitude": true, "longitude": 1}}}',
        b'{"device_id": "7", "location": {"coords": {"latitude": 1e999, "longitude": 1}}}',
        b'{"device_id": {}, "location": []}',
    ],
)
def test_json_that_is_none_of_a_phone_is_refused(body):
    with pytest.raises(ReportError):
        reports_in_json(body)
