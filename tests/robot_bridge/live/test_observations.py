"""What robots see goes to an operator and onto the next maps, over SQL and over WebSocket alike."""

from __future__ import annotations

import base64

import pytest

from robot_bridge.core.robotmap.binary import decode
from tests.support.bridge.bridge_wires import RefusedError
from tests.support.bridge.either_wire import WIRES

PNG = b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 40
JPEG = b"\xff\xd8\xff\xe0" + b"jpeg" * 100


@pytest.fixture(scope="module")
def bridge(start_bridge, sample_site):
    return start_bridge(sample_site)


def observations(desk, robot, **wanted):
    return desk.ask("get_observations", {"robot": robot.name, **wanted})["observations"]


def objects_on_map(robot, x, y):
    """Return the obstacles around (x, y) that robots saw, by their extras' id."""
    robot.ask("GetMap", {"x": x, "y": y, "area": 100})
    seen = (o for o in decode(robot.hear("SetMap")).obstacles if o.ext.get("src", "").startswith("observ"))
    return {o.ext["id"]: o for o in seen}


def test_an_object_waits_for_review_and_is_on_the_next_maps_when_accepted(robot, desk):
    word = f"cone {robot.name}"
    robot.ask("SetObject", {"x": 100.0, "y": 80.0, "object": word, "label": "cone", "radius": 0.3, "t": 12.5})
    news = desk.until(lambda: [o for o in desk.observations.values() if o["object"] == word])
    (told,) = observations(desk, robot)
    assert told == news[0]
    assert {
        k: told[k] for k in ("robot", "op", "object", "x", "y", "state", "label", "radius", "seen_at")
    } == {
        "robot": robot.name,
        "op": "SetObject",
        "object": word,
        "x": 100.0,
        "y": 80.0,
        "state": "pending",
        "label": "cone",
        "radius": 0.3,
        "seen_at": 12.5,
    }
    assert word not in objects_on_map(robot, 100.0, 80.0)

    review = {"observation": told["observation"], "accept": True, "semantics": "traffic cone", "height": 0.75}
    reviewed = desk.ask("review_observation", review)
    assert (reviewed["state"], reviewed["reviewed_by"]) == ("accepted", "Ada")
    desk.until(lambda: desk.observations[told["observation"]] == reviewed)
    cone = objects_on_map(robot, 100.0, 80.0)[word]
    assert cone.ext == {"src": f"observation:{told['observation']}", "id": word}
    assert cone.id == 1_000_000_000 + 8 * told["observation"]
    assert cone.semantics == "traffic cone"
    assert set(cone.height) == {0.75}
    assert cone.a.mean(axis=0) == pytest.approx((100.0, 80.0), abs=0.01)
    robot.ask("Ready", {"magic": 1})
    assert word in {o.ext.get("id") for o in decode(robot.hear("SetMap")).obstacles}


def test_a_rejected_object_is_on_no_map_and_says_why(robot, desk):
    robot.ask("SetObject", {"x": 90.0, "y": 80.0, "object": f"ghost {robot.name}"})
    (told,) = observations(desk, robot, state="pending")
    desk.ask(
        "review_observation",
        {"observation": told["observation"], "accept": False, "reason": "a reflection"},
    )
    assert objects_on_map(robot, 90.0, 80.0) == {}
    (told,) = observations(desk, robot, state="rejected")
    assert told["reason"] == "a reflection"


def test_what_is_missing_is_off_the_next_maps_when_accepted(robot, desk):
    robot.ask("Ready", {"magic": 1})
    before = decode(robot.hear("SetMap")).obstacles
    bench = next(one for one in before if one.semantics.startswith("bench"))
    x, y = bench.a.mean(axis=0).round(2).tolist()
    source = bench.ext["src"]
    robot.ask(
        "SetObject", {"x": x, "y": y, "object": f"no bench {robot.name}", "radius": 1.0, "doubts": source}
    )
    (told,) = observations(desk, robot)
    assert (told["doubts"], told["state"]) == (source, "pending")

    def sources_on_maps():
        robot.ask("GetMap", {"x": x, "y": y, "area": 400})
        window = decode(robot.hear("SetMap")).obstacles
        robot.ask("Ready", {"magic": 1})
        return [
            {one.ext["src"] for one in found} for found in (window, decode(robot.hear("SetMap")).obstacles)
        ]

    assert all(source in found for found in sources_on_maps())
    with pytest.raises(RefusedError, match="leave out semantics, height and radius"):
        desk.ask("review_observation", {"observation": told["observation"], "accept": True, "height": 1.0})
    desk.ask("review_observation", {"observation": told["observation"], "accept": True})
    window, whole = sources_on_maps()
    assert source not in window | whole
    assert len(whole) == len({one.ext["src"] for one in before}) - 1
    desk.ask("review_observation", {"observation": told["observation"], "accept": False, "revise": True})
    assert all(source in found for found in sources_on_maps())


def test_a_review_is_changed_only_on_purpose(robot, desk):
    robot.ask("SetObject", {"x": 95.0, "y": 80.0, "object": f"box {robot.name}"})
    (told,) = observations(desk, robot)
    accept = {"observation": told["observation"], "accept": True}
    first = desk.ask("review_observation", accept)
    assert desk.ask("review_observation", accept) == first
    reject = {"observation": told["observation"], "accept": False}
    with pytest.raises(RefusedError, match=r"was accepted by Ada before; give revise to change that"):
        desk.ask("review_observation", reject)
    assert f"box {robot.name}" in objects_on_map(robot, 95.0, 80.0)
    assert desk.ask("review_observation", {**reject, "revise": True})["state"] == "rejected"
    assert f"box {robot.name}" not in objects_on_map(robot, 95.0, 80.0)


def test_an_object_of_unknown_height_is_marked_as_estimated_and_has_the_sites_radius(robot, desk):
    robot.ask("SetObject", {"x": 85.0, "y": 80.0, "object": f"thing {robot.name}"})
    (told,) = observations(desk, robot)
    desk.ask("review_observation", {"observation": told["observation"], "accept": True})
    thing = objects_on_map(robot, 85.0, 80.0)[f"thing {robot.name}"]
    assert thing.ext["h"] == "est"
    assert thing.a[:, 0].max() - thing.a[:, 0].min() == pytest.approx(0.5, abs=0.05)
    desk.ask("review_observation", {"observation": told["observation"], "accept": False, "revise": True})


def test_an_image_is_kept_byte_by_byte_and_changes_no_map(robot, desk):
    robot.ask("SendImage", {"x": 10.0, "y": 80.0, "object": f"cone {robot.name}"}, PNG)
    (told,) = observations(desk, robot)
    assert (told["op"], told["media_type"], told["image_bytes"]) == ("SendImage", "image/png", len(PNG))
    image = desk.ask("get_image", {"observation": told["observation"]})
    assert image["media_type"] == "image/png"
    assert base64.b64decode(image["image"]) == PNG
    reviewed = desk.ask("review_observation", {"observation": told["observation"], "accept": True})
    assert reviewed["state"] == "accepted"
    assert objects_on_map(robot, 10.0, 80.0) == {}
    with pytest.raises(RefusedError, match="is an image, which is not drawn on the map"):
        desk.ask(
            "review_observation",
            {"observation": told["observation"], "accept": True, "height": 1.0, "revise": True},
        )


@pytest.mark.parametrize(
    ("image", "params", "reason"),
    [
        (
            b"GIF89a....",
            {},
            r"image begins with 47 49 46 38 39 61 2e 2e, which is neither JPEG, PNG nor WebP",
        ),
        (b"", {}, r"image begins with nothing"),
        (JPEG, {"media_type": "image/png"}, r"media_type is 'image/png', and the bytes are image/jpeg"),
        (PNG + bytes(4_000_000), {}, r"the image has 4010248 bytes, and this site takes up to 4000000"),
    ],
)
def test_what_is_no_image_or_too_large_is_refused(robot, desk, image, params, reason):
    with pytest.raises(RefusedError, match=reason):
        robot.ask("SendImage", {"x": 10.0, "y": 80.0, "object": "cone", **params}, image)
    assert observations(desk, robot) == []


def test_what_is_told_again_under_the_same_source_is_stored_once(robot, desk):
    for t in (1.0, 2.0):
        robot.ask("SetObject", {"x": 70.0, "y": 80.0, "object": "a", "source": "7", "t": t})
    robot.ask("SetObject", {"x": 70.5, "y": 80.0, "object": "a", "source": "7"})
    robot.ask("SetObject", {"x": 70.0, "y": 80.0, "object": "a"})
    robot.ask("SendImage", {"x": 70.0, "y": 80.0, "object": "a", "source": "7"}, PNG)
    robot.ask("SendImage", {"x": 70.0, "y": 80.0, "object": "a", "source": "7"}, JPEG)
    assert [(o["op"], o["x"]) for o in observations(desk, robot)] == [
        ("SendImage", 70.0),
        ("SendImage", 70.0),
        ("SetObject", 70.0),
        ("SetObject", 70.5),
        ("SetObject", 70.0),
    ]


def test_observations_are_read_in_pages(robot, desk):
    for number in range(5):
        robot.ask("SetObject", {"x": 70.0 + number, "y": 70.0, "object": str(number)})
    first = observations(desk, robot, limit=2)
    second = observations(desk, robot, limit=2, before=first[-1]["observation"])
    last = observations(desk, robot, limit=2, before=second[-1]["observation"])
    assert [o["object"] for o in first + second + last] == ["4", "3", "2", "1", "0"]


def test_what_is_not_there_cannot_be_reviewed_or_looked_at(bridge):
    desk = bridge.desk()
    with pytest.raises(RefusedError, match="there is no observation 987654"):
        desk.ask("review_observation", {"observation": 987654, "accept": True})
    with pytest.raises(RefusedError, match="observation 987654 has no image"):
        desk.ask("get_image", {"observation": 987654})


def test_what_was_accepted_is_on_the_map_after_a_power_cut(start_bridge, sample_site):
    bridge = start_bridge(sample_site)
    robot = WIRES["websocket"](bridge, "seer")
    robot.ask("Ready", {"magic": 1})
    robot.hear("SetMap")
    for number in range(20):
        robot.ask("SetObject", {"x": 50.0 + number, "y": 80.0, "object": str(number)})
    robot.ask("SendImage", {"x": 50.0, "y": 80.0, "object": "0"}, PNG)
    desk = bridge.desk()
    told = desk.ask("get_observations")["observations"]
    for each in told[1:11]:
        desk.ask("review_observation", {"observation": each["observation"], "accept": True})
    bridge.kill_gateway()
    bridge.start_gateway()
    after = bridge.desk().ask("get_observations")["observations"]
    assert [o["object"] for o in after] == [o["object"] for o in told]
    assert sum(o["state"] == "accepted" for o in after) == 10
    again = WIRES["websocket"](bridge, "seer")
    again.ask("Ready", {"magic": 1})
    on_map = {o.ext.get("id") for o in decode(again.hear("SetMap")).obstacles} - {None}
    assert on_map == {str(number) for number in range(10, 20)}
    bridge.end()
