"""The field page where several gateways serve the fleet and its own one dies."""

from __future__ import annotations

import re

import pytest

from tests.support.bridge.bridge_programs import wait_until
from tests.support.patience import BUSY
from tests.support.phone import GATEWAY_LOST

SLOW = BUSY * 15_000


@pytest.fixture(scope="module")
def pair(start_bridge, sample_site, new_database, tmp_path_factory):
    """Two gateways of one fleet, which tell operators of both."""
    database, folder = new_database("postgresql"), tmp_path_factory.mktemp("state")
    both = []
    for name in ("a", "b"):
        (folder / name).mkdir()
        both.append(start_bridge(sample_site, database, ["--gateway-name", name, "--state", folder / name]))
    for bridge in both:
        wait_until(lambda bridge=bridge: len(bridge.desk().hello["gateways"]) == 2)
    return both


@pytest.fixture(scope="module")
def chromium(pair, chromium):
    """The browser, after all that asyncio is asked to run: playwright holds this thread's loop."""
    return chromium


def test_a_page_whose_gateway_died_leads_to_another_one(pair, open_phone):
    a, b = pair
    page = open_phone(a, expected=GATEWAY_LOST)
    page.locator("#connection.up").wait_for(timeout=SLOW)
    links = page.locator("#banners a")
    assert links.count() == 0
    a.kill_gateway()
    links.first.wait_for(timeout=SLOW)
    page.locator("#banners", has_text=re.compile("at another gateway of the fleet")).wait_for(timeout=SLOW)
    assert links.all_inner_texts() == [f"127.0.0.1:{b.port}"]
    links.first.tap()
    page.wait_for_url(f"http://127.0.0.1:{b.port}/field", timeout=SLOW)
    page.locator("#connection.up").wait_for(timeout=SLOW)
    assert links.count() == 0
