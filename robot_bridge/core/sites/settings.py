"""``site.toml``: name, frame, bounds and limits of a published site."""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any, Protocol

from ..errors import CrsError, SettingsError
from ..json_decoder import toml_tables
from .frame import SiteBounds, SiteFrame, check_site_crs
from .settings_tables import (
    AuditSettings,
    CommandSettings,
    ConeSettings,
    FenceAction,
    FieldPageOptions,
    GatewayOptions,
    GeofenceSettings,
    LimitSettings,
    LinkOptions,
    LivenessLimits,
    MapSettings,
    NearnessSettings,
    ObservationSettings,
    QueueSettings,
    RouteSettings,
    TrajectorySettings,
    changed_text,
    out_of_range,
    value_text,
)

__all__ = [
    "SETTINGS_FILE",
    "AuditSettings",
    "CommandSettings",
    "ConeSettings",
    "FenceAction",
    "FieldPageOptions",
    "GatewayOptions",
    "GeofenceSettings",
    "LimitSettings",
    "LivenessLimits",
    "MapSettings",
    "NearnessSettings",
    "ObservationSettings",
    "QueueSettings",
    "RouteSettings",
    "SiteSettings",
    "TrajectorySettings",
    "check_settings",
    "check_values",
    "earlier_settings",
    "read_settings",
    "settings_of",
    "settings_text",
]

SETTINGS_FILE = "site.toml"


@dataclass(frozen=True)
class SiteSettings:
    """The content of ``site.toml``: the keys of table ``[site]``, and every other table under its name.

    ``origin`` is in CRS metres, ``rotation_deg`` counter-clockwise in degrees, ``bounds`` in the site frame.
    """

    id: str
    name: str
    version: int
    crs: str
    origin: tuple[float, float]
    bounds: SiteBounds
    rotation_deg: float = 0.0
    reached_tolerance_m: float = 0.20
    liveness: LivenessLimits = field(default_factory=LivenessLimits)
    commands: CommandSettings = field(default_factory=CommandSettings)
    trajectories: TrajectorySettings = field(default_factory=TrajectorySettings)
    observations: ObservationSettings = field(default_factory=ObservationSettings)
    audit: AuditSettings = field(default_factory=AuditSettings)
    maps: MapSettings = field(default_factory=MapSettings)
    routes: RouteSettings = field(default_factory=RouteSettings)
    queues: QueueSettings = field(default_factory=QueueSettings)
    cones: ConeSettings = field(default_factory=ConeSettings)
    geofence: GeofenceSettings = field(default_factory=GeofenceSettings)
    nearness: NearnessSettings = field(default_factory=NearnessSettings)
    field_page: FieldPageOptions = field(default_factory=FieldPageOptions)
    gateway: GatewayOptions = field(default_factory=GatewayOptions)
    limits: LimitSettings = field(default_factory=LimitSettings)
    links: LinkOptions = field(default_factory=LinkOptions)

    @property
    def stamp(self) -> str:
        """The stamp in both files of one publication."""
        return f"{self.id} version {self.version}"

    @property
    def frame(self) -> SiteFrame:
        """The site frame these settings describe."""
        return SiteFrame(self.crs, self.origin, math.radians(self.rotation_deg))


class SettingsSource(Protocol):
    """A source of a site's settings, which may change."""

    @property
    def settings(self) -> SiteSettings:
        """The settings as they are now."""


def read_settings(file: Path) -> SiteSettings:
    """Return the settings in ``file``.

    :raises SettingsError: naming the file, the key, its value and the valid values.
    """
    return settings_of(_tables(file), file)


def settings_of(tables: Mapping[str, Any], file: Path) -> SiteSettings:
    """Return the settings in ``tables``, a ``site.toml`` as nested dictionaries; ``file`` is for messages.

    :raises SettingsError: as :func:`read_settings`.
    """
    site = _table(tables, "site", file)
    others = {name: _table(tables, name, file, optional=True) for name in TABLES}
    _refuse_unknown(tables, {"site", *TABLES}, "", file)
    _refuse_unknown(site, SITE_KEYS, "site.", file)
    for name, table in others.items():
        _refuse_unknown(table, {f.name for f in fields(TABLES[name])}, f"{name}.", file)
    settings = _convert({**site, **others}, file)
    check_settings(settings, file)
    return settings


def check_settings(settings: SiteSettings, file: Path) -> None:
    """Raise :class:`SettingsError` for the first value of the right type that is invalid."""
    check_values(settings, file)
    try:
        check_site_crs(settings.crs)
    except CrsError as error:
        raise SettingsError(f"{file}: site.crs: {error}") from error


def check_values(settings: SiteSettings, file: Path) -> None:
    """Like :func:`check_settings`, but without the CRS, whose check needs pyproj."""
    wrong = _first_wrong(settings)
    if wrong is not None:
        raise SettingsError(f"{file}: {wrong}")


def settings_text(settings: SiteSettings, earlier: str = "") -> str:
    """Return ``settings`` as the text of a ``site.toml``.

    In the text of an ``earlier`` one only what a publication sets is changed: table ``[site]``, table
    ``[liveness]`` and values of ``settings`` that differ from the default. Everything else, including
    comments, belongs to the operator and stays.
    """
    everything = asdict(settings)
    tables = {"site": {key: value for key, value in everything.items() if key not in TABLES}}
    for name, kind in TABLES.items():
        default = asdict(kind())
        chosen = {k: v for k, v in everything[name].items() if name == "liveness" or v != default[k]}
        if chosen:
            tables[name] = chosen
    return changed_text(earlier, tables)


TABLES: dict[str, type[Any]] = {
    "liveness": LivenessLimits,
    "commands": CommandSettings,
    "trajectories": TrajectorySettings,
    "observations": ObservationSettings,
    "audit": AuditSettings,
    "maps": MapSettings,
    "routes": RouteSettings,
    "queues": QueueSettings,
    "cones": ConeSettings,
    "geofence": GeofenceSettings,
    "nearness": NearnessSettings,
    "field_page": FieldPageOptions,
    "gateway": GatewayOptions,
    "limits": LimitSettings,
    "links": LinkOptions,
}
"""The tables besides ``[site]``, by name."""
SITE_KEYS = {f.name for f in fields(SiteSettings)} - set(TABLES)


def earlier_settings(folder: Path, id: str) -> str:
    """Return the text of the ``site.toml`` in ``folder``; empty if there is none, or one of another site."""
    file = folder / SETTINGS_FILE
    if not file.is_file():
        return ""
    text = file.read_text(encoding="utf-8", errors="replace")
    found = value_text(text, "site", "id") or ""
    return text if found[1:-1] == id else ""


def _first_wrong(settings: SiteSettings) -> str | None:
    """Return the first fault, None if there is none."""
    wrong = [*_not_finite(settings), *_broken_rules(settings)]
    wrong += [text for name in TABLES for text in out_of_range(name, getattr(settings, name))]
    return next(iter(wrong), None)


def _not_finite(settings: SiteSettings) -> list[str]:
    numbers = {
        "site.origin": settings.origin,
        "site.bounds": tuple(settings.bounds),
        "site.rotation_deg": (settings.rotation_deg,),
        "site.reached_tolerance_m": (settings.reached_tolerance_m,),
    }
    return [
        f"{key} = {list(values)}: nan and inf are no numbers for a site; write finite ones."
        for key, values in numbers.items()
        if not all(math.isfinite(value) for value in values)
    ]


def _broken_rules(settings: SiteSettings) -> list[str]:
    limits, bounds = settings.liveness, settings.bounds
    rules = (
        (
            re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_.-]*", settings.id) is not None,
            f"site.id = {settings.id!r} is not an id: use letters, digits, '_', '.' and '-' only.",
        ),
        (
            settings.name.strip() != "" and settings.name.isprintable(),
            f"site.name = {settings.name!r} is empty or has a line break: write a name on one line.",
        ),
        (settings.version >= 1, f"site.version = {settings.version} is below 1, the first version."),
        (
            bounds.x_min < bounds.x_max and bounds.y_min < bounds.y_max,
            f"site.bounds = {list(bounds)} has no area: write [x_min, y_min, x_max, y_max], in site metres.",
        ),
        (
            settings.reached_tolerance_m > 0,
            f"site.reached_tolerance_m = {settings.reached_tolerance_m} is not above 0 metres.",
        ),
        (
            not limits.stale_after_s >= limits.lost_after_s,
            f"liveness.stale_after_s = {limits.stale_after_s} and lost_after_s = {limits.lost_after_s} "
            "do not follow each other: a robot turns stale before it is lost.",
        ),
        (
            all(re.fullmatch(r"https?://[^/\s]+", origin) for origin in settings.limits.origins),
            f"limits.origins = {list(settings.limits.origins)}: write each like https://host or "
            "https://host:port, without a path.",
        ),
        (
            settings.field_page.tiles == ""
            or re.fullmatch(r"https?://[A-Za-z0-9.:\[\]-]+/[!-~]*", settings.field_page.tiles) is not None,
            f"field_page.tiles = {settings.field_page.tiles!r} is no address: write it like "
            "https://maps.example.org/tiles/{z}/{x}/{y}.png.",
        ),
    )
    return [text for right, text in rules if not right]


def _tables(file: Path) -> Mapping[str, Any]:
    try:
        return toml_tables(file.read_text(encoding="utf-8"))
    except ImportError as error:
        raise SettingsError(f"{file} cannot be read: this needs Python 3.11 or newer (tomllib).") from error
    except FileNotFoundError as error:
        raise SettingsError(
            f"{file} is missing: a published site is a folder with {SETTINGS_FILE} and site.gpkg. "
            "Check the folder's name or publish the site again."
        ) from error
    except (OSError, UnicodeDecodeError) as error:
        raise SettingsError(f"{file} cannot be read: {error}") from error
    except ValueError as error:
        raise SettingsError(f"{file} is not valid TOML: {error}. Correct that line.") from error


def _table(tables: Mapping[str, Any], name: str, file: Path, optional: bool = False) -> Mapping[str, Any]:
    table = tables.get(name, {} if optional else None)
    if not isinstance(table, Mapping):
        found = "is missing" if table is None else f"is {table!r}, not a table"
        raise SettingsError(f"{file}: [{name}] {found}: write a table [{name}].")
    return table


def _refuse_unknown(table: Mapping[str, Any], known: Iterable[str], prefix: str, file: Path) -> None:
    for key in table:
        if key not in known:
            near = difflib.get_close_matches(key, known, n=1)
            hint = f"did you mean {near[0]}? Known are" if near else "known are"
            raise SettingsError(
                f"{file}: {prefix}{key} is not a setting: {hint} {', '.join(sorted(known))}. "
                "Remove it or correct its name."
            )


def _convert(content: Mapping[str, Any], file: Path) -> SiteSettings:
    try:
        import msgspec
    except ImportError as error:
        raise SettingsError(
            f"{file} cannot be checked: the Python package msgspec is missing; install it with "
            "'python3 -m pip install msgspec'."
        ) from error
    try:
        return msgspec.convert(content, SiteSettings)
    except msgspec.ValidationError as error:
        reason, _, place = str(error).partition(" - at `$")
        key = _key(place.rstrip("`"))
        raise SettingsError(f"{file}: {key}{_value_at(content, place)}: {reason}.") from error


def _key(place: str) -> str:
    inner = place.lstrip(".")
    table = re.split(r"[.\[]", inner)[0]
    return inner if table in TABLES else f"site.{inner}".rstrip(".")


def _value_at(content: Any, place: str) -> str:
    """Return `` = value`` for a msgspec path such as ``.origin[0]``, or nothing when it leads nowhere."""
    for step in re.findall(r"\.(\w+)|\[(\d+)\]", place):
        try:
            content = content[step[0]] if step[0] else content[int(step[1])]
        except (KeyError, IndexError, TypeError):
            return ""
    return f" = {content!r}" if place else ""
