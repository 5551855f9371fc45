"""The field page in a real Chromium, as phones have it."""

from __future__ import annotations

import shutil

import pytest

from tests.support.patience import BUSY

PHONE = {
    "viewport": {"width": 393, "height": 727},
    "device_scale_factor": 2,
    "is_mobile": True,
    "has_touch": True,
    "locale": "en-GB",
}


@pytest.fixture(scope="module")
def chromium():
    """A headless Chromium without any profile."""
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright drives the browser")
    program = shutil.which("chromium") or shutil.which("google-chrome")
    if program is None:
        pytest.skip("no Chromium is installed; make setup installs it where it may")
    with playwright.sync_playwright() as started:
        # In a container of root's there is no sandbox.
        browser = started.chromium.launch(executable_path=program, args=["--no-sandbox"])
        yield browser
        browser.close()


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
