"""The field page in a real Chromium, as phones have it."""

from __future__ import annotations

import pytest

from tests.support.errors import StageError
from tests.support.patience import BUSY
from tests.support.phone import PHONE, chromium


@pytest.fixture(scope="module", name="chromium")
def start_chromium():
    """A headless Chromium without any profile."""
    try:
        with chromium() as browser:
            yield browser
    except StageError as error:
        pytest.skip(str(error))


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
        page.goto(f"http://127.0.0.1:{bridge.port}/field{where}")
        return page

    yield open_page
    for context in contexts:
        context.close()
    assert faults == []
