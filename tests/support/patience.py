"""How long to wait for what must come."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

BUSY = 4.0
"""How many times longer than on an idle machine something may take before it counts as not coming."""

START = 60.0
"""Seconds that one of our programs has until it is ready; one that ends before is noticed at once."""


async def until(condition: Callable[[], object], seconds: float = 10.0) -> None:
    """Wait until a condition holds; raises TimeoutError after ``seconds`` on an idle machine."""
    async with asyncio.timeout(BUSY * seconds):
        while not condition():
            await asyncio.sleep(0.005)
