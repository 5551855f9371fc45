"""The files of the field page as the gateway serves them: rules for the browser, caches, and who may read."""

from __future__ import annotations

import gzip
import http.client
import json
import re
import socket

import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from robot_bridge.core.errors import SettingsError
from robot_bridge.core.sites.settings import read_settings
from tests.support.bridge.bridge_programs import wait_until

FILES = (
    "",
    "/",
    "/alarms.js",
    "/banners.js",
    "/budget.js",
    "/field.js",
    "/field.css",
    "/leaflet.js",
    "/leaflet.css",
    "/leaflet-LICENSE.txt",
    "/own-position.js",
    "/robot-list.js",
    "/robot-panel.js",
    "/target.js",
    "/view.js",
    "/icon.svg",
)
TILES = "https://maps.example.org:8443/wmts/{z}/{y}/{x}.png"


@pytest.fixture(scope="module")
def bridge(start_bridge, limited_site):
    return start_bridge(limited_site(f'[field_page]\ntiles = "{TILES}"\nattribution = "<b>Us</b>"\n'))


def get(bridge, path, **headers):
    connection = http.client.HTTPConnection("127.0.0.1", bridge.port, timeout=20)
    connection.request("GET", path, headers=headers)
    answer = connection.getresponse()
    return answer, answer.read()


@pytest.mark.parametrize("file", FILES)
def test_each_file_comes_with_the_rules_that_keep_other_scripts_out(bridge, file):
    answer, body = get(bridge, f"/field{file}")
    assert answer.status == 200 and body
    policy = dict(part.split(" ", 1) for part in answer.getheader("Content-Security-Policy").split("; "))
    assert policy["default-src"] == "'none'"
    assert policy["script-src"] == policy["style-src"] == "'self'"
    assert policy["frame-ancestors"] == policy["base-uri"] == policy["form-action"] == "'none'"
    assert policy["img-src"] == "'self' data: https://maps.example.org:8443"
    host = f"127.0.0.1:{bridge.port}"
    assert policy["connect-src"] == f"'self' ws://{host} wss://{host}"
    assert answer.getheader("X-Content-Type-Options") == "nosniff"
    assert answer.getheader("Referrer-Policy") == "no-referrer"


def test_nothing_comes_from_elsewhere_and_nothing_is_written_into_the_page(bridge):
    _, body = get(bridge, "/field")
    page = body.decode()
    assert not re.search(r"<script(?![^>]*\bsrc=)|\son\w+=|\sstyle=|https?://", page)
    named = set(re.findall(r'(?:src|href)="(/[^"]+)"', page))
    assert all(get(bridge, path)[0].status == 200 for path in named) and len(named) >= 5


def test_a_phone_that_has_a_file_is_not_sent_it_again(bridge):
    answer, plain = get(bridge, "/field/field.js")
    tag = answer.getheader("ETag")
    again, body = get(bridge, "/field/field.js", **{"If-None-Match": tag})
    assert (again.status, body) == (304, b"")
    packed, body = get(bridge, "/field/field.js", **{"Accept-Encoding": "gzip, br"})
    assert packed.getheader("Content-Encoding") == "gzip" and gzip.decompress(body) == plain
    assert len(body) < len(plain) / 2


@pytest.mark.parametrize(
    "path", ["/field/../app.py", "/field/%2e%2e/app.py", "/field/nothing.js", "/field//etc/passwd"]
)
def test_there_are_no_other_files(bridge, path):
    answer, body = get(bridge, path)
    assert answer.status == 404 and b"/field" in body


def test_a_name_that_is_not_the_gateways_gets_nothing(bridge):
    answer, _ = get(bridge, "/field", Host="rebound.example.net")
    assert answer.status == 421


@pytest.mark.parametrize(
    ("path", "origin", "status"),
    [
        ("/desk", "http://127.0.0.1:{port}", 101),
        ("/desk", "http://127.0.0.1:1", 403),
        ("/desk", "https://127.0.0.1:{port}", 403),
        ("/desk", "null", 403),
        ("/robot", "http://127.0.0.1:{port}", 403),
        ("/link", "http://127.0.0.1:{port}", 403),
    ],
)
def test_only_the_gateways_own_page_connects_and_to_the_desk_only(bridge, path, origin, status):
    try:
        connect(f"{bridge.address}{path}", origin=origin.format(port=bridge.port)).close()
        found = 101
    except InvalidStatus as error:
        found = error.response.status_code
    assert found == status


def test_a_page_that_had_its_name_lead_here_does_not_connect(bridge):
    name = f"rebound.example.net:{bridge.port}"
    with pytest.raises(InvalidStatus) as refused:
        connect(
            f"ws://{name}/desk",
            sock=socket.create_connection(("127.0.0.1", bridge.port)),
            origin=f"http://{name}",
        )
    assert refused.value.response.status_code == 403


def test_the_site_is_read_with_a_token_only(bridge, accounts_of):
    answer, body = get(bridge, "/field/site.json")
    assert answer.status == 200
    site = json.loads(body)
    assert site["tiles"] == {"url": TILES, "attribution": "<b>Us</b>", "largest_zoom": 22}
    token = accounts_of(bridge).do("operators", "add", "Vera", "--role", "viewer")
    wait_until(lambda: get(bridge, "/field/site.json")[0].status == 401)
    answer, body = get(bridge, "/field/site.json")
    assert (answer.status, b"No token came with the request" in body) == (401, True)
    answer, _ = get(bridge, "/field/site.json", Authorization=f"Bearer {token}")
    assert answer.status == 200


@pytest.mark.parametrize(
    "tiles", ["javascript:alert(1)", "https://a.org/x y", "//a.org/{z}", "https://a.org/;script-src *"]
)
def test_an_address_of_tiles_that_is_none_is_refused(limited_site, tiles):
    folder = limited_site(f"[field_page]\ntiles = {json.dumps(tiles)}\n")
    with pytest.raises(SettingsError, match=r"field_page.tiles"):
        read_settings(folder / "site.toml")


def test_a_site_without_the_page_has_none(start_bridge, limited_site):
    bridge = start_bridge(limited_site("[field_page]\nserved = false\n"))
    answer, body = get(bridge, "/field")
    assert answer.status == 404 and b"is not served here" in body
