"""Exception families: bridge, robot map, roads, cone layouts, assignment, sites; helpers for their texts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

# --- The exception family of the gateway and the reference robot ---


class BridgeError(Exception):
    """Something the bridge cannot do; the text names the cause, the place and the remedy."""


class StoreError(BridgeError):
    """The database cannot be opened, read or written."""


class LockedError(StoreError):
    """A lock that a transaction needed is held by another session; nothing was done."""


class DataRefusedError(StoreError):
    """The database works but refuses a value: too long, or of a type that it cannot hold."""


class UncertainError(StoreError):
    """The connection was lost during a commit, which may or may not have been stored."""


class RefusedError(BridgeError):
    """A request that was understood but is refused: unknown robot, target outside the site, ..."""


class UsedIdError(RefusedError):
    """The id of a command is that of an earlier command of another kind, or of another robot."""


class OtherRunError(RefusedError):
    """A message of another robot under the account of the one that was admitted."""


class ForbiddenError(RefusedError):
    """A request that the operator's role does not allow."""


class OutdatedError(RefusedError):
    """A change to something that has changed since it was read; ``newer`` is its present state, as JSON."""

    def __init__(self, text: str, newer: dict[str, Any]) -> None:
        super().__init__(text)
        self.newer = newer


class OverridableError(RefusedError):
    """A request that needs an override; ``found`` lists all objections."""

    NAMED = 3
    """Number of objections named in the text."""

    def __init__(self, found: Iterable[str], otherwise: str) -> None:
        self.found = list(dict.fromkeys(found))
        more = len(self.found) - self.NAMED
        named = "; ".join(self.found[: self.NAMED]) + (f"; and {more} more" if more > 0 else "")
        super().__init__(f"{named}: {otherwise}")


class LateError(RefusedError):
    """A request whose deadline passed before it was begun; ``now`` is the time by the same clock."""

    def __init__(self, text: str, now: float) -> None:
        super().__init__(text)
        self.now = now


class BusyError(RefusedError):
    """A request that is not handled because too many others wait."""


class FatalError(BridgeError):
    """The gateway cannot continue: its process ends with this text and should be restarted."""


class NotReadyError(BridgeError):
    """A message of a robot that has not sent Ready to this database."""


class AccessError(BridgeError):
    """An account, a token or a certificate that cannot be made, found or used."""


# --- The exception family of the robot map ---


class RobotMapError(Exception):
    """Something is wrong with a robot map; the text names what, where, and what to do."""


class WindowError(RobotMapError):
    """A window that encloses nothing, or for which there is no data."""


class MapTextError(RobotMapError):
    """A text that is no robot map; names the line, what was expected there and what was found."""


class MapBinaryError(RobotMapError):
    """Bytes that are no robot map, or are damaged; names the check that failed."""


class MissingCodecError(RobotMapError):
    """The binary format needs a package that this Python does not have."""


class ShapingError(RobotMapError):
    """An invalid parameter for outlines; names it and the valid values."""


class MapCancelledError(RobotMapError):
    """Work was cancelled by its caller."""


class MissingGeometryError(RobotMapError):
    """Reducing outlines needs a package that this Python does not have."""


class NavigationMapError(RobotMapError):
    """A map of Nav2 that cannot be read; the text names the key, its value and the valid values."""


# --- Errors of exports; part of the robot map's exception family ---


class ExportError(RobotMapError):
    """A robot map cannot be written in another format; the text names what, where, and what to do."""


class ExportGridError(ExportError):
    """A grid that has no cells or too many."""


class MaskAreaError(ExportError):
    """An area of a mask that is no polygon, or an invalid speed."""


class GeoreferenceError(ExportError):
    """Positions of the map have no place on the earth that the format can express."""


class MissingExportPackageError(ExportError):
    """The format needs a package that this Python does not have."""


# --- The exception family of roads ---


class RoadsError(Exception):
    """Something is wrong with roads or with a request about them; names what, where, and what to do."""


class RoadInputError(RoadsError):
    """Centrelines that are no roads: wrong shapes or invalid numbers."""


class OffNetworkError(RoadsError):
    """A place too far from every drivable road."""


class NoRouteError(RoadsError):
    """No route leads from one place to the other under the given restrictions."""


class RoadsCancelledError(RoadsError):
    """Long work was cancelled by its caller."""


class MissingEngineError(RoadsError):
    """An engine was requested by name whose package is not installed."""


class RoadExportError(RoadsError):
    """A road network that the target format cannot represent."""


# --- The exception family of cone layouts ---


class LayoutsError(Exception):
    """Something is wrong with a cone layout; names what, where, and what to do."""


class DimensionError(LayoutsError):
    """A dimension that a layout does not have, or a value that it cannot have."""


class ConeCountError(DimensionError):
    """A dimension, named ``dimension``, that makes more cones than a layout may have."""

    def __init__(self, text: str, dimension: str) -> None:
        super().__init__(text)
        self.dimension = dimension


class LayoutLineError(LayoutsError):
    """A line that a layout cannot lie along."""


class ConeTableError(LayoutsError):
    """A table of cones that cannot be read; names row and column."""


# --- The exception family of the assignment of cones to robots ---


class AssignmentError(Exception):
    """Something is wrong with a task or a plan; names what, where, and what to do."""


class JobError(AssignmentError):
    """Targets, robots or stores that cannot be planned for: invalid numbers, names used twice."""


class MissingStoreError(JobError):
    """Robots have to load or unload cones, and no store is given."""


class UnservedError(AssignmentError):
    """Targets that no robot can serve; ``targets`` are their ids."""

    def __init__(self, message: str, targets: tuple[str, ...]) -> None:
        super().__init__(message)
        self.targets = targets


class MissingSolverError(AssignmentError):
    """A method was requested by name whose package is not installed."""


class AssignmentCancelledError(AssignmentError):
    """The caller cancelled the plan."""


class PlanEditError(AssignmentError):
    """A change of a plan that cannot be made; the plan stays unchanged."""


class PlanFileError(AssignmentError):
    """A file that is no plan."""


# --- Errors of sites; every message names what, where and what to do ---


class SiteError(Exception):
    """A site, its settings or its CRS cannot be used."""


class SettingsError(SiteError):
    """``site.toml`` is missing, unreadable or holds a wrong value."""


class LayerError(SiteError):
    """``site.gpkg`` is missing or damaged, or one of its layers is."""


class CrsError(SiteError):
    """A CRS is unsuitable for a site: unknown, geographic, not in metres, or EPSG:3857."""


class CacheError(SiteError):
    """``site.cache`` is damaged or belongs to another publication; the site can be read without it."""


# --- Counts in words ---


def counted(number: int, thing: str) -> str:
    """Return ``number`` with its noun: ``1 cone``, ``2 cones``."""
    return f"{number} {thing}" if number == 1 else f"{number} {thing}s"


# --- Messages of others, such as a driver or a server, within our own texts ---


def in_one_line(said: object) -> str:
    """Return the text of an error or a program in one line, with single spaces between the words."""
    return " ".join(str(said).split())


# --- Long lists of names, shortened ---

MOST_NAMES = 10


def listed_names(names: Sequence[str]) -> str:
    """Return ``names`` in one line: the first ten and how many more there are, ``none`` without any."""
    if not names:
        return "none"
    more = len(names) - MOST_NAMES
    return ", ".join(names[:MOST_NAMES]) + (f" and {more} more" if more > 0 else "")


def with_abort_sent(error: Exception, robots: Sequence[str]) -> str:
    """Return the text of ``error``, which refuses what ``robots`` were sent an Abort for, with what to do.

    Where another gateway refused it, its text may say so already.
    """
    sent = f"{listed_names(robots)} had been sent an Abort by then"
    if not robots or sent in str(error):
        return str(error)
    return f"{error}. {sent}: look where it stands, then send it on, or abort it"


STORED_LATER = "it is stored and sent as soon as the database takes it"
"""What becomes of an Abort that the database does not take."""


def unstored_abort(recipients: str, *, is_pause: bool, may_be_stored: bool = False) -> str:
    """Return that an Abort is not stored, or the pause that has become one, and who was sent it all the same.

    ``recipients`` follows "was", such as "sent to no robot".
    """
    what, abort = ("The pause", "an Abort") if is_pause else ("The Abort", "it")
    return f"{what} {'may not be' if may_be_stored else 'is not'} stored; {abort} was {recipients}"


# --- How to install an optional Python package: the remedy in errors about a missing one

_DEBIAN = {
    "cbor2": "python3-cbor2",
    "PyYAML": "python3-yaml",
    "zstandard": "python3-zstandard",
}
_VERSIONS = {"shapely": "'shapely>=2,<2.1'"}
"""Requirements for pip where the newest version does not work with Debian 12's other packages."""


def installation(package: str) -> str:
    """Return how to install ``package``, to follow "install it"; Debian's Python refuses a plain pip."""
    elsewhere = f"python3 -m pip install {package}, with the Python that runs this"
    if debian := _DEBIAN.get(package):
        return f"(on Debian: apt install {debian}; elsewhere: {elsewhere})"
    requirement = _VERSIONS.get(package, package)
    pip = f"python3 -m pip install --user --break-system-packages {requirement}"
    return f"(on Debian: apt install python3-pip, then {pip}; elsewhere: {elsewhere})"
