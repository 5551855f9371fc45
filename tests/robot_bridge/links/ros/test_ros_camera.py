"""How often a robot's images are sent, and what comes of one that cannot be."""

from __future__ import annotations

import asyncio
from types import SimpleNamespace

import pytest

from robot_bridge.core.messages.robots import SendGPS, SendPos
from robot_bridge.links.base.errors import CommandRefusedError
from robot_bridge.links.ros.messages import COMPRESSED_IMAGE
from robot_bridge.links.ros.robot import Camera
from robot_bridge.links.ros.sensing import Sensing
from robot_bridge.links.ros.settings import RobotSettings

STAMP = SimpleNamespace(sec=1_700_000_000, nanosec=0)
JPEG = b"\xff\xd8\xff\xe0" + bytes(1000)


class Link:
    """Keeps the images that are sent; the gateway answers when ``answered`` is set."""

    largest_image_bytes = 4_000_000
    site = SimpleNamespace(crs="EPSG:32633", origin=(500_000.0, 5_193_480.0), rotation=0.0)

    def __init__(self):
        self.sent, self.answered, self.refusal = [], asyncio.Event(), None

    async def ask(self, robot, told):
        self.sent.append(told)
        await self.answered.wait()
        if self.refusal is not None:
            raise CommandRefusedError(self.refusal)


class Rig:
    def __init__(self):
        self.link = Link()
        self.sensing = Sensing("r1", RobotSettings(image_every_s=10.0), None)
        self.sensing.pose = SendPos(5.0, 6.0, 0.0, 0.0)
        self.camera = Camera("r1", RobotSettings(image_every_s=10.0), self.link, self.sensing)

    def sees(self):
        header = SimpleNamespace(stamp=STAMP, frame_id="front")
        message = SimpleNamespace(header=header, format="jpeg", data=JPEG)
        self.sensing.receive("image", "/r1/camera", COMPRESSED_IMAGE, message)

    async def until(self, found):
        async with asyncio.timeout(20):
            while not found():
                await asyncio.sleep(0.001)


@pytest.fixture
async def rig():
    return Rig()


async def test_images_are_sent_one_by_one_and_no_sooner_than_is_set(rig):
    rig.sees()
    assert rig.sensing.image is None, "none was due yet"
    rig.camera.step(1.0)
    rig.sees()
    rig.camera.step(1.1)
    await rig.until(lambda: rig.link.sent)
    assert not rig.sensing.wants_image
    rig.camera.step(50.0)
    assert not rig.sensing.wants_image, "the one before is not acknowledged"
    rig.link.answered.set()
    await rig.until(lambda: rig.camera.step(11.0) or rig.camera._sending.done())
    rig.camera.step(11.0)
    assert not rig.sensing.wants_image
    rig.camera.step(11.2)
    assert rig.sensing.wants_image
    (told,) = rig.link.sent
    assert (told.x, told.y, told.object, told.t) == (5.0, 6.0, "front", 1_700_000_000.0)


async def test_an_image_that_the_gateway_would_not_take_is_not_sent(rig):
    rig.link.largest_image_bytes = 900
    rig.camera.step(1.0)
    rig.sees()
    rig.camera.step(1.1)
    await rig.until(lambda: rig.sensing.faults)
    assert "has 1004 bytes, and 900 are taken" in rig.sensing.faults["/r1/camera"] and not rig.link.sent


async def test_what_the_gateway_refuses_is_named(rig):
    rig.link.refusal = "1000 observations wait for review"
    rig.link.answered.set()
    rig.camera.step(1.0)
    rig.sees()
    rig.camera.step(1.1)
    await rig.until(lambda: rig.sensing.faults)
    assert rig.sensing.faults == {"/r1/camera": "/r1/camera: 1000 observations wait for review"}


async def test_a_robot_with_gps_has_its_place_on_the_site(rig):
    rig.sensing.pose = None
    rig.camera.step(1.0)
    assert not rig.sensing.wants_image, "nobody knows where it is"
    rig.sensing.fix = SendGPS(46.8948565, 15.0)
    rig.camera.step(1.1)
    rig.sees()
    rig.camera.step(1.2)
    await rig.until(lambda: rig.link.sent)
    assert (rig.link.sent[0].x, rig.link.sent[0].y) == pytest.approx((0.0, 0.0), abs=0.1)
