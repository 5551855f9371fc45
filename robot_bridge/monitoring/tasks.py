"""Work that goes on as long as the gateway does: what fails is logged, counted and tried again."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Awaitable, Callable

from ..errors import BridgeError, HopelessError
from .tally import Tally

log = logging.getLogger(__name__)

FIRST_PAUSE, LONGEST_PAUSE = 0.25, 30.0
LAST_ATTEMPT = 20
"""failures in a row, each soon after the one before, after which the process had better be started anew."""
SOUND = 60.0
"""seconds of work without a failure after which earlier ones no longer count."""


async def keep_going(name: str, work: Callable[[], Awaitable[None]], tally: Tally) -> None:
    """Run ``work``, and again after a growing pause when it raises; returns when it returns.

    :raises HopelessError: when ``work`` raises it, or fails again and again for a reason nobody foresaw.
    """
    pause, unforeseen = FIRST_PAUSE, 0
    while True:
        began = time.monotonic()
        try:
            return await work()
        except HopelessError:
            raise
        except Exception as error:
            if time.monotonic() - began > SOUND:
                pause, unforeseen = FIRST_PAUSE, 0
            tally.failures[name] += 1
            if isinstance(error, BridgeError):
                log.error("%s: %s; trying again in %g s", name, error, pause)
            else:
                unforeseen += 1
                log.exception("%s: unexpected %s; trying again in %g s", name, type(error).__name__, pause)
            if unforeseen >= LAST_ATTEMPT:
                raise HopelessError(
                    f"{name} failed {unforeseen} times in a row, last with {type(error).__name__}: {error}; "
                    "see the log, and report it"
                ) from error
        await asyncio.sleep(pause)
        pause = min(2 * pause, LONGEST_PAUSE)


async def every(seconds: float, work: Callable[[], Awaitable[None]], name: str, tally: Tally) -> None:
    """Run ``work`` every so many seconds for ever, each success noted as a beat of ``name``."""
    while True:
        await asyncio.sleep(seconds)
        await work()
        tally.beat(name)
