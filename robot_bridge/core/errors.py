"""Exception families: bridge, robot map, roads, cone layouts, assignment, sites; phrases of their texts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

# --- The exception family of the gateway and the reference robot ---


class BridgeError(Exception):
    """Something the bridge cannot do; the text names what was wrong, where, and what to do."""


class StoreError(BridgeError):
    """The database cannot be opened, read or written."""


class DataRefusedError(StoreError):
    """The database is in order and refuses a value: too long, or of a kind that it cannot hold."""


class UncertainError(StoreError):
    """The connection was lost during a commit: what it was to store may be stored or not."""


class RefusedError(BridgeError):
    """A request that was understood and is not done: unknown robot, target outside the site, ..."""


class OtherRunError(RefusedError):
    """What another robot says under the account of the one that was let in."""


class ForbiddenError(RefusedError):
    """A request that the operator's role does not allow."""


class OutdatedError(RefusedError):
    """A change to something that has changed since it was looked at; ``newer`` is how it is now, as JSON."""

    def __init__(self, text: str, newer: dict[str, Any]) -> None:
        super().__init__(text)
        self.newer = newer


class OverridableError(RefusedError):
    """A request that is done all the same with an override; ``found`` is all that speaks against it."""

    NAMED = 3
    """So much of what was found stands in the text."""

    def __init__(self, found: Iterable[str], otherwise: str) -> None:
        self.found = list(dict.fromkeys(found))
        more = len(self.found) - self.NAMED
        named = "; ".join(self.found[: self.NAMED]) + (f"; and {more} more" if more > 0 else "")
        super().__init__(f"{named}: {otherwise}")


class LateError(RefusedError):
    """A request whose deadline was over before it was begun; ``now`` is the time by the same clock."""

    def __init__(self, text: str, now: float) -> None:
        super().__init__(text)
        self.now = now


class BusyError(RefusedError):
    """A request that is not dealt with because too many others wait."""


class FatalError(BridgeError):
    """The gateway cannot go on: its process ends with this text, to be started again."""


class NotReadyError(BridgeError):
    """A robot speaks that has not said Ready to this database."""


class AccessError(BridgeError):
    """An account, a token or a certificate that cannot be made, found or used."""


# --- The exception family of the robot map ---


class RobotMapError(Exception):
    """Something is wrong with a robot map; the text names what, where, and what to do."""


class WindowError(RobotMapError):
    """A window that encloses nothing, or of which nothing is known."""


class MapTextError(RobotMapError):
    """A text that is no robot map; names the line, what was expected there and what was found."""


class MapBinaryError(RobotMapError):
    """Bytes that are no robot map, or are damaged; names the check that failed."""


class MissingCodecError(RobotMapError):
    """The binary format needs a package that this Python does not have."""


class ShapingError(RobotMapError):
    """Something that cannot be asked of outlines; names it and what to give instead."""


class MapCancelledError(RobotMapError):
    """Work was ended midway by whoever asked for it."""


class MissingGeometryError(RobotMapError):
    """Reducing outlines needs a package that this Python does not have."""


class NavigationMapError(RobotMapError):
    """A map of Nav2 that cannot be read; the text names the key, its value and what is right."""


# --- What can be wrong with an export; part of the robot map's exception family ---


class ExportError(RobotMapError):
    """A robot map cannot be written in another format; the text names what, where, and what to do."""


class ExportGridError(ExportError):
    """A grid that has no cells or too many."""


class MaskAreaError(ExportError):
    """An area of a mask that is no polygon, or a speed that is none."""


class GeoreferenceError(ExportError):
    """Positions of the map have no place on the earth that the format can express."""


class MissingExportPackageError(ExportError):
    """The format needs a package that this Python does not have."""


# --- The exception family of roads ---


class RoadsError(Exception):
    """Something is wrong with roads or with what is asked of them; names what, where, and what to do."""


class RoadInputError(RoadsError):
    """Centrelines that are no roads: wrong shapes, numbers that are none."""


class OffNetworkError(RoadsError):
    """A place that is too far from every road that may be driven."""


class NoRouteError(RoadsError):
    """No way leads from one place to the other under the restrictions that were given."""


class RoadsCancelledError(RoadsError):
    """Whoever watches long work said to stop."""


class MissingEngineError(RoadsError):
    """An engine was asked for by name whose package this Python does not have."""


class RoadExportError(RoadsError):
    """A road network that another format cannot hold."""


# --- The exception family of cone layouts ---


class LayoutsError(Exception):
    """Something is wrong with a cone layout; names what, where, and what to do."""


class DimensionError(LayoutsError):
    """A dimension that a layout does not have, or a value that it cannot have."""


class LayoutLineError(LayoutsError):
    """A line that a layout cannot lie along."""


class ConeTableError(LayoutsError):
    """A table of cones that cannot be read; names row and column."""


# --- The exception family of the assignment of cones to robots ---


class AssignmentError(Exception):
    """Something is wrong with a task or a plan; names what, where, and what to do."""


class JobError(AssignmentError):
    """Targets, robots or stores that cannot be planned for: numbers that are none, names used twice."""


class MissingStoreError(JobError):
    """Robots have to load or unload cones, and no store is given."""


class UnservedError(AssignmentError):
    """Targets that no robot can serve; ``targets`` are their ids."""

    def __init__(self, message: str, targets: tuple[str, ...]) -> None:
        super().__init__(message)
        self.targets = targets


class MissingSolverError(AssignmentError):
    """A method was asked for by name whose package this Python does not have."""


class AssignmentCancelledError(AssignmentError):
    """Whoever asked for the plan does not want it any more."""


class PlanEditError(AssignmentError):
    """A change of a plan that cannot be made; the plan is as it was."""


class PlanFileError(AssignmentError):
    """A file that is no plan."""


# --- What can be wrong with a site; every message names what, where and what to do ---


class SiteError(Exception):
    """A site, its settings or its CRS cannot be used."""


class SettingsError(SiteError):
    """``site.toml`` is missing, unreadable or holds a wrong value."""


class LayerError(SiteError):
    """``site.gpkg`` is missing or damaged, or one of its layers is."""


class CrsError(SiteError):
    """A CRS cannot carry a site: unknown, geographic, not in metres, or EPSG:3857."""


class CacheError(SiteError):
    """``site.cache`` is damaged, or belongs to another publication; the site can be read without it."""


# --- A number of things in words ---


def counted(number: int, thing: str) -> str:
    """Return ``number`` with what it is a number of: ``1 cone``, ``2 cones``."""
    return f"{number} {thing}" if number == 1 else f"{number} {thing}s"


# --- What others say, such as a driver or a server, in a text of ours ---


def in_one_line(said: object) -> str:
    """Return what an error or a program says in one line, with single spaces between the words."""
    return " ".join(str(said).split())


# --- Names in a text, which has no room for thousands ---

MOST_NAMES = 10


def listed_names(names: Sequence[str]) -> str:
    """Return ``names`` in one line: the first ten and how many more there are, ``none`` without any."""
    if not names:
        return "none"
    more = len(names) - MOST_NAMES
    return ", ".join(names[:MOST_NAMES]) + (f" and {more} more" if more > 0 else "")


# --- How an optional Python package comes onto a computer: the remedy in errors about one that is missing

_DEBIAN = {
    "cbor2": "python3-cbor2",
    "PyYAML": "python3-yaml",
    "zstandard": "python3-zstandard",
}
_VERSIONS = {"shapely": "'shapely>=2,<2.1'"}
"""What pip is asked for where the newest version does not go with Debian 12's other packages."""


def installation(package: str) -> str:
    """Return how ``package`` is installed, to follow "install it"; Debian's Python refuses a plain pip."""
    elsewhere = f"python3 -m pip install {package}, with the Python that runs this"
    if debian := _DEBIAN.get(package):
        return f"(on Debian: apt install {debian}; elsewhere: {elsewhere})"
    requirement = _VERSIONS.get(package, package)
    pip = f"python3 -m pip install --user --break-system-packages {requirement}"
    return f"(on Debian: apt install python3-pip, then {pip}; elsewhere: {elsewhere})"
