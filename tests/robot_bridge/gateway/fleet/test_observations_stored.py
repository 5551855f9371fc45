"""What robots saw is stored before it is acknowledged, once, and outlives the gateway, on each database."""

from __future__ import annotations

import base64
import dataclasses
import json
import os

import pytest

from robot_bridge.core.errors import RefusedError
from robot_bridge.core.messages.base import MessageError
from robot_bridge.core.messages.records import GetImage, GetObservations, ObservationState, ReviewObservation
from robot_bridge.core.messages.robots import SendImage, SetObject
from robot_bridge.core.robotmap.binary import decode
from robot_bridge.core.sites.settings_tables import ObservationSettings

PNG = b"\x89PNG\r\n\x1a\n"
CONE = SetObject(100.0, 80.0, "Kegel ä 7 🚧", label="cone", height=0.75)


@pytest.fixture
async def ready(yard):
    await yard.ready()
    yield yard
    yard.site.show([])


async def told(yard, **wanted):
    return (await yard.fleet.observations.newest(GetObservations(**wanted))).observations


async def image_of(yard, report):
    """Return the image of an observation and its media type."""
    found = (await yard.fleet.observations.image(GetImage(report.observation))).values
    return base64.b64decode(found["image"]), found["media_type"]


async def tell(yard, told, id, link="sql", robot="r1"):
    return await yard.fleet.receive(robot, link, told, id)


def on_map(yard):
    return {o.ext["id"] for o in decode(yard.site.whole_map()).obstacles if "id" in o.ext}


async def test_it_is_stored_when_it_is_acknowledged(ready):
    outcome = await tell(ready, CONE, 7)
    assert (outcome.ack.id, outcome.ack.ok, outcome.answer) == (7, True, None)
    assert ready.sql("select robot, kind, object, x, y, state from observations") == [
        ("r1", "SetObject", CONE.object, 100.0, 80.0, "pending")
    ]


async def test_a_row_that_is_dealt_with_twice_after_a_crash_is_one_observation(ready):
    await tell(ready, CONE, 7)
    await ready.restart()
    await tell(ready, CONE, 7)
    await tell(ready, CONE, 8)
    assert len(await told(ready)) == 2


async def test_the_calls_of_two_runs_of_a_robot_are_told_apart(ready):
    await tell(ready, CONE, 7, link="websocket")
    await tell(ready, CONE, 7, link="websocket")
    await ready.ready(magic=2)
    await tell(ready, CONE, 7, link="websocket")
    assert len(await told(ready)) == 2


async def test_two_robots_may_use_the_same_source(ready):
    await ready.ready("r2")
    for robot in ("r1", "r2"):
        await tell(ready, SetObject(1.0, 1.0, "a", source="1"), 1, robot=robot)
    assert [o.robot for o in await told(ready)] == ["r2", "r1"]
    assert [o.robot for o in await told(ready, robot="r1")] == ["r1"]


async def test_an_image_of_megabytes_comes_back_byte_by_byte(ready):
    image = PNG + os.urandom(3_500_000)
    await tell(ready, SendImage(image, 1.0, 2.0, "a"), 1)
    (report,) = await told(ready)
    assert (report.media_type, report.image_bytes) == ("image/png", len(image))
    assert await image_of(ready, report) == (image, "image/png")


async def test_an_image_in_the_payload_of_a_row_is_taken_and_answered(ready):
    insert = "insert into rr (robot, op, params, payload) values (?, ?, ?, ?)"
    params = json.dumps({"x": 1.0, "y": 2.0, "object": "a"})
    ready.sql(insert, "r1", "SendImage", params, PNG + bytes(range(256)))
    ready.sql(insert, "r1", "SendImage", params, bytes(4_000_001))
    ready.sql(insert, "r1", "SendImage", params, None)
    await ready.link.poll()
    (report,) = await told(ready)
    assert report.image_bytes == len(PNG) + 256
    acks = ready.sql("select params from sa where robot = 'r1' and op = 'OpAck' order by id")
    acks = [json.loads(params) for (params,) in acks]
    assert [ack["ok"] for ack in acks] == [True, False, False]
    assert "4000001 bytes, and this site takes up to 4000000" in acks[1]["reason"]
    assert "SendImage came without its payload" in acks[2]["reason"]
    assert ready.sql("select count(*) from rr") == [(0,)]


async def test_what_is_told_while_too_much_waits_is_refused_until_something_is_reviewed(ready, monkeypatch):
    few = dataclasses.replace(ready.site.settings.observations, most_pending=2)
    settings = dataclasses.replace(ready.site.settings, observations=few)
    monkeypatch.setattr(type(ready.site), "settings", property(lambda _: settings))
    for number in (1, 2):
        await tell(ready, CONE, number)
    with pytest.raises(RefusedError, match="2 observations of robot 'r1' to be reviewed, and no more"):
        await tell(ready, CONE, 3)
    await tell(ready, CONE, 2)
    (first, _) = await told(ready)
    await ready.fleet.observations.review(ReviewObservation(first.observation, accept=False), "Ada")
    await tell(ready, CONE, 3)
    assert len(await told(ready)) == 3


async def test_an_object_and_its_images_are_found_by_its_id(ready):
    for number, told_of in enumerate(
        [CONE, SetObject(1.0, 1.0, "other"), SendImage(PNG, 1.0, 1.0, CONE.object)]
    ):
        await tell(ready, told_of, number)
    assert [o.op for o in await told(ready, object=CONE.object)] == ["SendImage", "SetObject"]


async def test_what_is_refused_leaves_nothing_behind(ready):
    for wrong, reason in (
        (SetObject(-5.0, 80.0, "a"), r"\(-5.00, 80.00\) lies outside site"),
        (SendImage(b"BM", 1.0, 1.0, "a"), "neither JPEG, PNG nor WebP"),
        (SendImage(PNG + bytes(4_000_000), 1.0, 1.0, "a"), "largest_image_bytes"),
    ):
        with pytest.raises((RefusedError, MessageError), match=reason):
            await tell(ready, wrong, 1)
    assert ready.sql("select count(*) from observations") == [(0,)]


async def test_the_largest_image_that_a_site_may_allow_is_stored_whatever_is_in_it(ready, monkeypatch):
    largest = next(f for f in dataclasses.fields(ObservationSettings) if f.name == "largest_image_bytes")
    size = largest.metadata["most"]
    settings = dataclasses.replace(
        ready.site.settings, observations=ObservationSettings(largest_image_bytes=size)
    )
    monkeypatch.setattr(type(ready.site), "settings", settings)
    # Each of these bytes takes two in a statement of MariaDB.
    image = PNG + bytes(size - len(PNG))
    await tell(ready, SendImage(image, 1.0, 1.0, "a"), 1)
    (found,) = await told(ready)
    assert await image_of(ready, found) == (image, "image/png")


async def test_an_accepted_object_is_on_the_map_before_and_after_a_restart(ready):
    await tell(ready, CONE, 1)
    await tell(ready, SetObject(90.0, 80.0, "ghost"), 2)
    (ghost, cone) = [o.observation for o in await told(ready)]
    book = ready.fleet.observations
    report = await book.review(ReviewObservation(cone, True, semantics="traffic cone"), "Ada")
    await book.review(ReviewObservation(ghost, False, reason="a reflection"), "Bert")
    assert (report.semantics, report.height, report.reviewed_by) == ("traffic cone", 0.75, "Ada")
    assert on_map(ready) == {CONE.object}
    ready.site.show([])
    await ready.restart()
    assert on_map(ready) == {CONE.object}
    assert [(o.state.value, o.reason) for o in await told(ready)] == [
        ("rejected", "a reflection"),
        ("accepted", None),
    ]
    assert [o.object for o in await told(ready, state=ObservationState.ACCEPTED)] == [CONE.object]


async def test_each_new_and_each_reviewed_one_is_announced_once(ready):
    heard = []
    ready.fleet.listeners.add(Listening(heard))
    for _ in range(2):
        await tell(ready, CONE, 1)
    for _ in range(2):
        await ready.fleet.observations.review(ReviewObservation(1, accept=True), "Ada")
    assert [(method, key, params["state"]) for method, key, params in heard] == [
        ("observation", "1", "pending"),
        ("observation", "1", "accepted"),
    ]


class Listening:
    """A desk that keeps what it hears."""

    def __init__(self, heard):
        self.notify = lambda *news: heard.append(news)
