"""Work that goes on as long as the gateway does: what fails is logged, counted and tried again."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Awaitable, Callable, Mapping

from ..errors import BridgeError, HopelessError
from .tally import Tally

log = logging.getLogger(__name__)

Work = Callable[[], Awaitable[None]]

FIRST_PAUSE, LONGEST_PAUSE = 0.25, 2.0
"""seconds before something foreseen, such as a database that is away, is tried again."""
LONGEST_PAUSE_UNFORESEEN = 30.0
LAST_ATTEMPT = 20
"""failures in a row that nobody foresaw, after which the process had better be started anew."""
SOUND = 60.0
"""seconds of work without a failure after which earlier ones no longer count."""
SAY_AGAIN_AFTER = 60.0


async def keep_all_going(works: Mapping[str, Work], tally: Tally) -> None:
    """Run every work side by side, as :func:`keep_going`, until one of them is hopeless.

    :raises HopelessError: when one of them cannot go on.
    """
    tasks = [asyncio.create_task(keep_going(name, work, tally), name=name) for name, work in works.items()]
    try:
        await asyncio.gather(*tasks)
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


async def keep_going(name: str, work: Work, tally: Tally) -> None:
    """Run ``work``, and again after a growing pause when it raises; returns when it returns.

    :raises HopelessError: when ``work`` raises it, or fails again and again for a reason nobody foresaw.
    """
    trouble = Trouble(name)
    while True:
        began = time.monotonic()
        try:
            return await work()
        except HopelessError:
            raise
        except Exception as error:
            tally.failures[name] += 1
            pause = trouble.take(error, lasted=time.monotonic() - began)
        await asyncio.sleep(pause)


class Trouble:
    """The failures of one work in a row: how long to wait after each, and which the log is told of."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._pause = FIRST_PAUSE
        self._unforeseen = 0
        self._told = ("", 0.0)

    def take(self, error: Exception, lasted: float) -> float:
        """Log ``error`` and return the seconds to wait; ``lasted`` is how long the work went well before it.

        :raises HopelessError: when it has failed too often for a reason nobody foresaw.
        """
        if lasted > SOUND:
            self._pause, self._unforeseen = FIRST_PAUSE, 0
        foreseen = isinstance(error, BridgeError)
        self._unforeseen += 0 if foreseen else 1
        pause = self._pause
        self._pause = min(2 * pause, LONGEST_PAUSE if foreseen else LONGEST_PAUSE_UNFORESEEN)
        self._tell(error, foreseen, pause)
        if self._unforeseen >= LAST_ATTEMPT:
            raise HopelessError(
                f"{self._name} failed {self._unforeseen} times, last with {type(error).__name__}: {error}; "
                "see the log, and report it"
            ) from error
        return pause

    def _tell(self, error: Exception, foreseen: bool, pause: float) -> None:
        text, told_at = self._told
        now = time.monotonic()
        if not foreseen:
            name = type(error).__name__
            log.exception("%s: unexpected %s; trying again in %g s", self._name, name, pause)
        elif str(error) != text or now - told_at > SAY_AGAIN_AFTER:
            log.error("%s: %s; trying again until it works", self._name, error)
            self._told = (str(error), now)


class Steps:
    """The steps of one work: each is done whatever becomes of the others."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._told: dict[str, tuple[str, float]] = {}

    async def run(self, steps: Mapping[str, Work]) -> None:
        """Do every step in its order; the log is told of each that fails, once a minute while it does.

        What nobody foresaw stays with its step: what a robot or a row has brought about there would end the
        gateway, and the next one too.

        :raises BridgeError: the first one of any step, after the last step.
        """
        failed: list[BridgeError] = []
        for step, work in steps.items():
            try:
                await work()
                self._told.pop(step, None)
            except BridgeError as error:
                failed.append(error)
                if self._is_news(step, error):
                    log.error("%s, %s: %s; trying again until it works", self._name, step, error)
            except Exception as error:
                if self._is_news(step, error):
                    log.exception("%s, %s: unexpected %s", self._name, step, type(error).__name__)
        if failed:
            raise failed[0]

    def _is_news(self, step: str, error: Exception) -> bool:
        text, now = f"{type(error).__name__} {error}", time.monotonic()
        told, at = self._told.get(step, ("", 0.0))
        if text == told and now - at <= SAY_AGAIN_AFTER:
            return False
        self._told[step] = text, now
        return True


async def every(seconds: float, work: Work, name: str, tally: Tally) -> None:
    """Run ``work`` every so many seconds for ever, each success noted as a beat of ``name``."""
    while True:
        await asyncio.sleep(seconds)
        await work()
        tally.beat(name)
