"""Surfaces and ways over HTTP: GeoJSON that GIS programs open, as the OpenAPI document says."""

from __future__ import annotations

import asyncio
import http.client
import json
from urllib.parse import urlencode

import jsonschema
import numpy as np
import pytest
from openapi_spec_validator import validate
from osgeo import gdal, ogr
from websockets.datastructures import Headers
from websockets.http11 import Request

from robot_bridge.core.messages.base import MessageError
from robot_bridge.core.sites.frame import lonlat_of
from robot_bridge.core.sites.site import read_site
from robot_bridge.gateway.api.metrics_and_queries import MOST_AT_ONCE, MOST_FIELDS, SiteQueries, read_query
from robot_bridge.protocol.schemas import PARAMETERS, PROBLEM, ROUTE, SURFACES, openapi
from tests.support.bridge.bridge_programs import wait_until

START, GOAL = (20.0, 8.0), (92.0, 22.0)


@pytest.fixture(scope="module")
def bridge(start_bridge, sample_site):
    return start_bridge(sample_site)


@pytest.fixture(scope="module")
def frame(sample_site):
    return read_site(sample_site).frame


@pytest.fixture
def ask(bridge):
    """Ask a question; return the status, the content type and what was answered."""

    def ask(path, query, **headers):
        connection = http.client.HTTPConnection("127.0.0.1", bridge.port, timeout=60)
        text = query if isinstance(query, str) else urlencode(query, doseq=True)
        connection.request("GET", f"{path}?{text}", headers=headers)
        answer = connection.getresponse()
        kind, body = answer.getheader("Content-Type"), answer.read()
        return answer.status, kind, json.loads(body) if "json" in kind else body.decode()

    return ask


def schema_of(path, status):
    """Return the schema of an answer by the document, with all that it refers to."""
    document = openapi()
    ((_, content),) = document["paths"][path]["get"]["responses"][status]["content"].items()
    return {**content["schema"], "components": document["components"]}


def test_the_document_is_one_of_openapi_and_is_served(ask):
    validate(openapi())
    assert ask("/schemas/openapi.json", "")[2] == openapi()


@pytest.mark.parametrize("crs", ["site", "EPSG:32633", "EPSG:4326", None])
def test_surfaces_are_points_in_the_order_asked_whatever_their_crs(ask, frame, crs):
    places = [START, (1.0, 1.0), GOAL]
    degrees = lonlat_of(frame)(np.array(places)).tolist()
    here = {"site": places, "EPSG:32633": frame.to_crs(np.array(places)).tolist()}.get(crs, degrees)
    query = {"point": [f"{x!r},{y!r}" for x, y in here]} | ({"crs": crs} if crs else {})
    status, kind, found = ask(SURFACES, query)
    assert (status, kind) == (200, "application/geo+json")
    jsonschema.validate(found, schema_of(SURFACES, "200"))
    assert [one["properties"]["surface"] for one in found["features"]] == ["asphalt", None, "asphalt"]
    for one, place in zip(found["features"], degrees, strict=True):
        assert one["geometry"]["coordinates"] == pytest.approx(place, abs=1e-6)


def test_a_way_is_the_one_that_a_desk_is_shown_and_gdal_opens_it(ask, bridge, frame):
    query = {"start": "20,8", "goal": "92,22", "crs": "site"}
    status, _, found = ask(ROUTE, query)
    assert status == 200
    jsonschema.validate(found, schema_of(ROUTE, "200"))
    shown = bridge.desk().ask("get_route", {"start": START, "x": GOAL[0], "y": GOAL[1]})
    (way,) = found["features"]
    assert way["properties"]["metres"] == shown["metres"]
    degrees = lonlat_of(frame)(np.array(shown["points"])).ravel().tolist()
    assert np.ravel(way["geometry"]["coordinates"]).tolist() == pytest.approx(degrees, abs=1e-6)
    gdal.UseExceptions()
    source = ogr.Open(f"http://127.0.0.1:{bridge.port}{ROUTE}?{urlencode(query)}")
    (feature,) = source.GetLayer()
    assert feature.GetField("metres") == shown["metres"]
    assert feature.geometry().GetPointCount() == len(shown["points"])


@pytest.mark.parametrize(
    ("path", "query", "status", "said"),
    [
        (SURFACES, "", 400, "point is missing"),
        (SURFACES, "point=1,2,3", 400, "point is '1,2,3'; give x,y"),
        (SURFACES, "point=1,2&" * 141, 400, "point is there more than 140 times; ask in parts"),
        (SURFACES, f"point=1,2.{'0' * 50}", 400, "point has 54 characters; at most 48 are taken"),
        (SURFACES, "point=.7e89,2&crs=site", 422, "a place lies nowhere on the earth"),
        (
            ROUTE,
            "start=20,8&goal=30,8&crs=site&" + "surface=mud&" * 21,
            400,
            "surface is there more than 20 times",
        ),
        (SURFACES, "point=nan,2&crs=site", 400, "give a finite number"),
        (SURFACES, "point=1,2&points=3,4", 400, "unknown parameter 'points'; known are point, crs"),
        (SURFACES, "point=1,2&crs=EPSG:1", 400, "crs is 'EPSG:1'"),
        (SURFACES, "point=1,2&crs=EPSG:99999", 422, "EPSG:99999"),
        (ROUTE, "start=1,2&goal=3,4&fastest=yes", 400, "fastest is 'yes'; give true or false"),
        (ROUTE, "start=1,2&start=1,2&goal=3,4", 400, "start is there twice"),
        (ROUTE, "goal=3,4", 400, "give one of robot and start"),
        (ROUTE, "robot=nobody&goal=3,4&crs=site", 422, "'nobody' is not known"),
        (ROUTE, "start=20,8&goal=9200,22&crs=site", 422, "no way along the roads: The goal"),
        (ROUTE, "start=20,8&goal=92,22", 422, "site"),
    ],
)
def test_what_cannot_be_answered_says_why(ask, path, query, status, said):
    found, kind, problem = ask(path, query)
    assert (found, kind) == (status, PROBLEM), problem
    jsonschema.validate(problem, schema_of(path, str(status)))
    assert said in problem["detail"] and problem["detail"].startswith(f"{path}: ")
    assert "get_" not in problem["detail"]


def test_no_query_is_read_without_end():
    with pytest.raises(MessageError, match="cannot be read"):
        read_query("point=1,2&" * (MOST_FIELDS + 1), PARAMETERS[SURFACES])
    with pytest.raises(MessageError, match="cannot be read"):
        read_query("point=%ff", PARAMETERS[SURFACES])


def test_more_questions_than_can_be_answered_are_asked_again_later(ask, monkeypatch):
    class Waiting:
        async def answer(self, request, operator):
            await asyncio.Event().wait()

    async def play():
        queries = SiteQueries(None, Waiting())
        asked = Request(f"{ROUTE}?start=1,2&goal=3,4&crs=site", Headers())
        tasks = [asyncio.create_task(queries.answer(asked)) for _ in range(MOST_AT_ONCE)]
        await asyncio.sleep(0)
        refused = await queries.answer(asked)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        assert (refused.status_code, refused.headers["Retry-After"]) == (503, "1")
        assert "ask again" in json.loads(refused.body)["detail"]
        return queries

    assert asyncio.run(play())._under_way == 0


def test_a_token_is_needed_once_there_are_accounts(ask, bridge, accounts_of):
    query = {"start": "20,8", "goal": "92,22", "crs": "site"}
    token = accounts_of(bridge).do("operators", "add", "Vera", "--role", "viewer")
    wait_until(lambda: ask(ROUTE, query)[0] == 401)
    assert ask(ROUTE, query, Authorization=f"Bearer {token}")[0] == 200
    assert ask(ROUTE, query, Origin="https://elsewhere.example", Authorization=f"Bearer {token}")[0] == 403
