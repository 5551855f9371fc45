"""The exception family of roads."""

from __future__ import annotations


class RoadsError(Exception):
    """Something is wrong with roads or with what is asked of them; names what, where, and what to do."""


class RoadInputError(RoadsError):
    """Centrelines that are no roads: wrong shapes, numbers that are none."""


class OffNetworkError(RoadsError):
    """A place that is too far from every road that may be driven."""


class NoRouteError(RoadsError):
    """No way leads from one place to the other under the restrictions that were given."""


class CancelledError(RoadsError):
    """Whoever watches long work said to stop."""


class MissingEngineError(RoadsError):
    """An engine was asked for by name whose package this Python does not have."""


class RoadExportError(RoadsError):
    """A road network that another format cannot hold."""
