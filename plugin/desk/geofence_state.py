"""What the gateway told last of robots in keepouts and at obstacles, and what it does not watch."""

from __future__ import annotations

from collections.abc import Callable

from ...robot_bridge.messages import FenceAlarm, Geofence
from ..language import tr

SILENT_AFTER = 10.0
"""Seconds without a word after which nothing is known: a gateway tells of them every few seconds."""
NAMED = 3


class GeofenceState:
    """Keeps the newest report; ``clock`` returns seconds that only ever go on."""

    def __init__(self, clock: Callable[[], float]):
        self._clock = clock
        self._report: Geofence | None = None
        self._since = clock()

    def update(self, report: Geofence) -> None:
        """Take in what the gateway told."""
        self._report, self._since = report, self._clock()

    def begin_link(self) -> None:
        """Wait for the first word on a new link; what was told on the one before holds until then."""
        self._since = self._clock()

    def clear(self) -> None:
        """Forget everything, and wait for the first word of another gateway."""
        self._report, self._since = None, self._clock()

    @property
    def is_silent(self) -> bool:
        """Whether the gateway has not told of them for so long that nothing is known."""
        return self._clock() - self._since > SILENT_AFTER

    @property
    def alarms(self) -> list[FenceAlarm]:
        """The robots in keepouts and at obstacles now."""
        return [] if self._report is None or self.is_silent else self._report.alarms

    def why_not(self) -> str:
        """Return what is not watched and why, empty when everything is or nothing was to be heard yet."""
        if self.is_silent:
            return tr(
                "Keepouts and obstacles are not watched: the gateway tells nothing of them. It may be older "
                "than this plugin."
            )
        report = self._report
        if report is None:
            return ""
        if report.fault:
            return tr("Keepouts and obstacles are not watched: {why}.", why=report.fault.rstrip("."))
        return " ".join(text for text in (*_without(report), _unjudged(report), _more(report)) if text)


def _without(report: Geofence) -> list[str]:
    texts = []
    if not report.keepouts:
        texts.append(tr("The published site has no keepouts."))
    if not report.obstacles:
        texts.append(tr("The published site has no obstacles, so nobody is told to be at one."))
    return texts


def _unjudged(report: Geofence) -> str:
    if not report.unjudged:
        return ""
    hidden = max(len(report.unjudged) - NAMED, 0) + report.unjudged_more
    names = [*report.unjudged[:NAMED], *([tr("{more} more", more=hidden)] if hidden else [])]
    return tr(
        "Not judged by keepouts and obstacles, since it is not known where they are: {names}.",
        names=", ".join(names),
    )


def _more(report: Geofence) -> str:
    if not report.more:
        return ""
    return tr("{more} more are in keepouts or at obstacles and not listed.", more=report.more)
