"""A phone's browser: a headless Chromium of that size, with touch."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from tests.support.errors import StageError

PHONE: dict[str, Any] = {
    "viewport": {"width": 393, "height": 727},
    "device_scale_factor": 2,
    "is_mobile": True,
    "has_touch": True,
    "locale": "en-GB",
}
"""Options of a context of playwright's."""
GATEWAY_LOST = ("ERR_CONNECTION", "ERR_EMPTY_RESPONSE", "ERR_FAILED", "WebSocket connection")
"""What Chromium's console says of a gateway that ends, whatever was loaded from it at that moment."""
PROGRAMS = ("chromium-headless-shell", "chromium", "google-chrome")
"""The best first: that without a desktop's windows opens a page for two thirds of the processor time."""


@contextmanager
def chromium() -> Iterator[Any]:
    """Give a browser of playwright's; contexts are opened with :data:`PHONE`.

    :raises StageError: when no Chromium is installed.
    """
    from playwright.sync_api import sync_playwright

    program = next(filter(None, map(shutil.which, PROGRAMS)), None)
    if program is None:
        raise StageError("no Chromium is installed: apt-get install chromium-headless-shell, or chromium")
    with sync_playwright() as started:
        # In a container of root's there is no sandbox; to do in software what a GPU would takes longer.
        args = ["--no-sandbox", "--disable-gpu"]
        browser = started.chromium.launch(executable_path=program, args=args)
        yield browser
        browser.close()
