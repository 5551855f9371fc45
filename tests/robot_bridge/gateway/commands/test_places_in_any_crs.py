"""Places that operators give in a CRS of their own: the robot is sent to that place and to no other."""

from __future__ import annotations

import pytest

from robot_bridge.core.errors import RefusedError
from robot_bridge.core.messages.base import MessageError
from robot_bridge.gateway.model.events import RequestHandlers
from robot_bridge.protocol.codec import decode_desk_request

ON_SITE = (66.0, 44.0)
# By PROJ's cs2cs, of (640486, 5193524) in EPSG:32633.
THERE = {
    "EPSG:4326": (16.843788387, 46.880402103),
    "EPSG:32633": (640486.0, 5193524.0),
    "EPSG:23700": (482055.657, 173053.486),
    "EPSG:3857": (1875041.946, 5922574.454),
}


@pytest.fixture
async def ask(roads):
    """Ask as an operator does, with the JSON that comes in: ``await ask(method, **params)``."""
    await roads.ready()
    await roads.acknowledge_all()
    await roads.at(20.0, 8.0)

    fleet = roads.fleet
    handlers = RequestHandlers(fleet.orders, fleet.queues, fleet.roads, fleet.roads.closures)

    async def ask(method, **params):
        request = decode_desk_request(method, params)
        return await handlers.answer(request, "Ada")

    return ask


def near(place):
    return pytest.approx(place, abs=0.001)


@pytest.fixture(params=THERE)
def there(request):
    x, y = THERE[request.param]
    return {"x": x, "y": y, "crs": request.param}


async def test_a_target_of_set_positions_is_where_its_crs_says(ask, there):
    told = await ask("set_positions", positions=[{"robot": "r1", **there}])
    params = told["commands"][0]["params"]
    assert (params["x"], params["y"]) == near(ON_SITE)
    assert "crs" not in params


async def test_a_target_of_send_is_where_its_crs_says(ask, there):
    report = await ask(
        "send", command="command-1", robot="r1", op="SetPosEnd", params={**there, "cone": True}
    )
    assert (report["params"]["x"], report["params"]["y"]) == near(ON_SITE)
    assert report["params"]["cone"] is True


async def test_every_point_of_a_path_is_where_its_crs_says(ask, there):
    points = [[there["x"], there["y"]], [there["x"], there["y"]]]
    report = await ask(
        "send", command="command-1", robot="r1", op="SetPath", params={"points": points, "crs": there["crs"]}
    )
    assert report["params"]["points"] == [near(ON_SITE), near(ON_SITE)]


async def test_a_task_of_a_queue_is_where_its_crs_says(ask, there):
    path = [[there["x"], there["y"]], [there["x"], there["y"]]]
    task = {"task": "task-0001", "kind": "drive", **there, "path": path}
    report = await ask("set_queue", robot="r1", revision=0, tasks=[task])
    assert (report["tasks"][0]["x"], report["tasks"][0]["y"]) == near(ON_SITE)
    report = await ask("get_queue", robot="r1", paths=True)
    assert report["queues"][0]["tasks"][0]["path"] == [near(ON_SITE), near(ON_SITE)]


async def test_a_way_leads_to_where_its_crs_says(ask, there):
    asked = await ask("get_route", robot="r1", **there)
    direct = await ask("get_route", robot="r1", x=ON_SITE[0], y=ON_SITE[1])
    assert asked["metres"] == pytest.approx(direct["metres"], abs=0.01)
    assert asked["points"][-1] == near(ON_SITE)


async def test_targets_of_several_crs_go_to_their_own_robots(ask, roads):
    await roads.ready("r2")
    await roads.ready("r3")
    x, y = THERE["EPSG:4326"]
    told = await ask(
        "set_positions",
        positions=[
            {"robot": "r1", "x": x, "y": y, "crs": "EPSG:4326"},
            {"robot": "r2", "x": 30.0, "y": 8.0},
            {"robot": "r3", "x": 640440.0, "y": 5193488.0, "crs": "EPSG:32633"},
        ],
    )
    places = [(c["robot"], c["params"]["x"], c["params"]["y"]) for c in told["commands"]]
    assert places == [("r1", near(66.0), near(44.0)), ("r2", 30.0, 8.0), ("r3", near(20.0), near(8.0))]


@pytest.mark.parametrize(
    ("place", "text"),
    [
        (
            {"x": 46.8804021, "y": 16.8437884, "crs": "EPSG:4326"},
            r"in EPSG:4326 .* the other way round it lies",
        ),
        ({"x": 19.04, "y": 47.5, "crs": "EPSG:4326"}, r"\(19.04, 47.5\) in EPSG:4326 .* lies outside site"),
        (
            {"x": 16.84, "y": 200.0, "crs": "EPSG:4326"},
            r"\(16.84, 200\) in EPSG:4326, has no place in the site's",
        ),
        ({"x": 66, "y": 44, "crs": "EPSG:99999"}, "'EPSG:99999' is not known to PROJ"),
        ({"x": 66, "y": 44, "crs": "WGS84"}, "crs is 'WGS84'; give a code such as 'EPSG:4326'"),
    ],
)
async def test_a_place_that_is_not_on_the_site_is_refused_with_its_crs(ask, roads, place, text):
    with pytest.raises((RefusedError, MessageError), match=text):
        await ask("set_positions", positions=[{"robot": "r1", **place}])
    with pytest.raises((RefusedError, MessageError), match=text):
        await ask("send", command="command-1", robot="r1", op="SetPosEnd", params=place)
    with pytest.raises((RefusedError, MessageError), match=text):
        await ask("add_tasks", robot="r1", revision=0, tasks=[{"task": "task-0001", **place}])
    assert await roads.states() == {}


async def test_a_crs_that_is_no_text_is_refused(ask):
    with pytest.raises(MessageError, match="crs is 4326; give a code"):
        await ask(
            "send", command="command-1", robot="r1", op="SetPosEnd", params={"x": 1, "y": 1, "crs": 4326}
        )


async def test_a_parameter_that_a_command_does_not_have_is_refused_by_name(ask, roads):
    with pytest.raises(MessageError, match="SetPosEnd: srid is no parameter here; known are: x, y"):
        await ask(
            "send", command="command-1", robot="r1", op="SetPosEnd", params={"x": 1, "y": 1, "srid": 4326}
        )
    assert await roads.states() == {}


async def test_an_abort_with_such_a_parameter_is_done(ask):
    report = await ask(
        "send", command="command-1", robot="r1", op="Abort", params={"crs": "EPSG:4326", "a": 1}
    )
    assert report["state"] == "queued"
