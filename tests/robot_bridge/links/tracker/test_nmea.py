"""Sentences of GPS receivers: fixes as they are meant, and what must not be believed."""

from __future__ import annotations

import asyncio
import contextlib
import os
import termios

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.core.messages.robots import SetPosEnd
from robot_bridge.links.base.adapter import Command
from robot_bridge.links.base.errors import CommandRefusedError
from robot_bridge.links.tracker import nmea
from robot_bridge.links.tracker.adapter import TrackerAdapter, TrackerSettings
from robot_bridge.links.tracker.nmea import NmeaSources, Receiver
from robot_bridge.links.tracker.osmand import ReportError


def said(content):
    """Return a sentence with its checksum."""
    total = 0
    for character in content:
        total ^= ord(character)
    return f"${content}*{total:02X}\r\n"


RMC = "GPRMC,141320.50,A,4652.8300,N,01650.6160,E,010.0,084.4,210926,003.1,W"
GGA = "GNGGA,141320.50,4652.8300,N,01650.6160,E,1,08,0.9,155.4,M,46.9,M,,"


def fixes(*sentences):
    receiver = Receiver()
    return [fix for one in sentences if (fix := receiver.feed(said(one))) is not None]


def test_the_example_of_many_manuals_has_a_right_checksum():
    example = "$GPRMC,123519,A,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W*6A"
    fix = Receiver().feed(example)
    assert (round(fix.lat, 5), round(fix.lon, 5)) == (48.1173, 11.51667)


def test_rmc_is_a_fix_in_our_units():
    (fix,) = fixes(RMC)
    assert (fix.lat, fix.lon) == pytest.approx((46.8805, 16.8436))
    assert (fix.v, fix.heading, fix.fix_t) == (pytest.approx(5.14444), 84.4, 1790000000.5)
    (south_west,) = fixes(RMC.replace(",N,", ",S,").replace(",E,", ",W,"))
    assert (south_west.lat, south_west.lon) == pytest.approx((-46.8805, -16.8436))


def test_other_sentences_say_more_about_the_fix():
    (fix,) = fixes(GGA, "GNGST,141320.50,1.0,,,,3.0,4.0,5.0", RMC)
    assert fix.altitude == pytest.approx(202.3)
    assert fix.accuracy == pytest.approx(3.5355, abs=1e-3)


def test_a_receiver_without_rmc_is_placed_by_gga():
    found = fixes(GGA, "GNVTG,90.0,T,,M,10.0,N,18.5,K", GGA, GGA, GGA)
    assert len(found) == 2
    assert (found[0].v, found[0].heading, found[0].fix_t) == (pytest.approx(5.14444), 90.0, None)
    assert fixes(GGA, RMC, GGA, RMC, GGA, RMC)[0].heading == 84.4


def test_without_a_fix_nothing_is_told():
    assert fixes(RMC.replace(",A,", ",V,"), GGA.replace("E,1,08", "E,0,00"), "GPGSV,1,1,00") == []


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("$GPRMC,1*00", "the checksum is 00, and"),
        ("$GPRMC,123519,A", "without its checksum"),
        ("hello", "no NMEA sentence"),
        ("$GPRMC," + "1" * 200, "207 characters"),
        (said(RMC.replace("4652.8300", "4662.8300")), "has 62.83 minutes"),
        (said(RMC.replace("4652.8300", "46x2.8300")), "no latitude"),
        (said(RMC.replace(",N,", ",E,", 1).replace("4652.8300", "9952.8300")), "lat is 99"),
        (said(RMC.replace("010.0", "nan")), "'nan' is no number"),
        (said(RMC.replace("010.0", "9e9")), "v is"),
        (said(RMC.replace("210926", "311326")), "no date"),
    ],
)
def test_what_is_wrong_is_named(line, reason):
    with pytest.raises(ReportError, match=reason):
        Receiver().feed(line)


@given(st.text(max_size=130), st.lists(st.text("0123456789.,NSEWAV", max_size=80), max_size=5))
def test_nothing_that_a_receiver_says_does_more_than_be_refused(text, contents):
    receiver = Receiver()
    kinds = ("RMC", "GGA", "GST", "VTG")
    for line in (text, *(said(f"GP{kind},{content}") for content in contents for kind in kinds)):
        try:
            receiver.feed(line)
        except ReportError:
            continue


class SerialLine:
    """A serial device under ``path``: one side is read as a device, the other one is a receiver's."""

    def __init__(self, path):
        self.receiver, self._device = os.openpty()
        path.unlink(missing_ok=True)
        path.symlink_to(os.ttyname(self._device))

    @property
    def baud(self):
        return termios.tcgetattr(self._device)[5]

    def pull_out(self):
        os.close(self.receiver)
        os.close(self._device)


async def test_a_serial_device_is_read_and_once_more_when_it_is_back(tmp_path, monkeypatch):
    monkeypatch.setattr(nmea, "OPEN_AGAIN", 0.01)
    heard, refused = asyncio.Queue(), []
    sources = NmeaSources(heard.put_nowait, lambda source, error: refused.append((source, str(error))))
    device = tmp_path / "ttyUSB0"
    watching = asyncio.create_task(sources.watch_serial(device, 4800))
    try:
        for lat in (46.8805, 46.8905):
            line = SerialLine(device)
            sentence = RMC.replace("4652.8300", f"46{(lat - 46) * 60:.4f}")
            async with asyncio.timeout(30):
                while line.baud != termios.B4800:
                    await asyncio.sleep(0.01)
                os.write(line.receiver, b"half of a sentence\r\n" + said(sentence).encode())
                report = await heard.get()
            assert (report.device, report.fix.lat) == (str(device), pytest.approx(lat))
            assert len(refused) == 1 and refused.pop()[0] == str(device)
            line.pull_out()
        assert not watching.done()
    finally:
        watching.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await watching


async def test_a_tracker_refuses_what_a_gateway_would_have_it_do():
    adapter = TrackerAdapter(TrackerSettings(), "phones.toml: tracker")
    with pytest.raises(CommandRefusedError, match="a tracker is seen and not commanded"):
        await adapter.command(Command("anna", 7, SetPosEnd(1.0, 2.0), False))
