"""The field page in a real Chromium, as phones have it."""

from __future__ import annotations

import pytest

from tests.support.errors import StageError
from tests.support.patience import BUSY
from tests.support.phone import PHONE, chromium

CHANGED = "ERR_NETWORK_CHANGED"
"""Chromium gives up what it loads as a network comes to this computer; tests of cut links make such ones."""


@pytest.fixture(scope="module", name="chromium")
def start_chromium():
    """A headless Chromium without any profile."""
    try:
        with chromium() as browser:
            yield browser
    except StageError as error:
        pytest.skip(str(error))


def load(page, address: str, faults: list[str]) -> None:
    """Open a page; once more where Chromium gave up what it was loading, for a :data:`CHANGED` network."""
    from playwright.sync_api import Error

    for _ in range(5):
        try:
            page.goto(address)
        except Error as error:
            faults.append(str(error))
        if not any(CHANGED in fault for fault in faults):
            return
        faults[:] = [fault for fault in faults if CHANGED not in fault]
    pytest.fail(f"{address} cannot be loaded: {CHANGED}")


@pytest.fixture
def open_phone(chromium):
    """Open a phone's browser: ``open_phone(bridge, "#token=...")``; fails when the page broke any rule."""
    contexts, faults = [], []

    def open_page(bridge, where: str = "", **how):
        how = {"expected": (), **how}
        expected = how.pop("expected")
        context = chromium.new_context(**{**PHONE, **how})
        context.set_default_timeout(BUSY * 15_000)
        contexts.append(context)
        page = context.new_page()

        def note(text: str) -> None:
            if not any(part in text for part in expected):
                faults.append(text)

        page.on("pageerror", lambda error: note(f"error: {error}"))
        page.on("console", lambda said: said.type == "error" and note(f"console: {said.text}"))
        load(page, f"http://127.0.0.1:{bridge.port}/field{where}", faults)
        return page

    yield open_page
    for context in contexts:
        context.close()
    assert [fault for fault in faults if CHANGED not in fault] == []
