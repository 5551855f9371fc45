"""``site.toml``: what a published site is called, where it lies and which limits hold on it."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, NamedTuple

from .errors import CrsError, SettingsError
from .frame import SiteFrame, check_site_crs

SETTINGS_FILE = "site.toml"


class Bounds(NamedTuple):
    """The rectangle of the site in the site frame, metres; its edges belong to it."""

    x_min: float
    y_min: float
    x_max: float
    y_max: float

    def contains(self, x: float, y: float) -> bool:
        """Tell whether (x, y), metres in the site frame, lies in the rectangle."""
        return self.x_min <= x <= self.x_max and self.y_min <= y <= self.y_max


@dataclass(frozen=True)
class LivenessLimits:
    """Seconds without a message after which a robot counts as stale and as lost (design, section 4)."""

    stale_after_s: float = 3.0
    lost_after_s: float = 10.0


@dataclass(frozen=True)
class SiteSettings:
    """The content of ``site.toml``: table ``[site]``, and table ``[liveness]`` as ``liveness``.

    ``origin`` is in CRS metres, ``rotation_deg`` counter-clockwise in degrees, ``bounds`` in the site frame.
    """

    id: str
    name: str
    version: int
    crs: str
    origin: tuple[float, float]
    bounds: Bounds
    rotation_deg: float = 0.0
    reached_tolerance_m: float = 0.20
    liveness: LivenessLimits = field(default_factory=LivenessLimits)

    @property
    def stamp(self) -> str:
        """What both files of one publication carry."""
        return f"{self.id} version {self.version}"

    @property
    def frame(self) -> SiteFrame:
        """The site frame these settings describe."""
        return SiteFrame(self.crs, self.origin, math.radians(self.rotation_deg))


def read_settings(file: Path) -> SiteSettings:
    """Return the settings in ``file``.

    :raises SettingsError: naming the file, the key, its value and what is right.
    """
    return settings_of(_tables(file), file)


def settings_of(tables: Mapping[str, Any], file: Path) -> SiteSettings:
    """Return the settings in ``tables``, a ``site.toml`` as nested dictionaries; ``file`` is for messages.

    :raises SettingsError: as :func:`read_settings`.
    """
    site, liveness = _table(tables, "site", file), _table(tables, "liveness", file, optional=True)
    _refuse_unknown(tables, {"site", "liveness"}, "", file)
    _refuse_unknown(site, {f.name for f in fields(SiteSettings)} - {"liveness"}, "site.", file)
    _refuse_unknown(liveness, {f.name for f in fields(LivenessLimits)}, "liveness.", file)
    settings = _convert({**site, "liveness": liveness}, file)
    check_settings(settings, file)
    return settings


def check_settings(settings: SiteSettings, file: Path) -> None:
    """Raise :class:`SettingsError` for the first value that has the right type and is still wrong."""
    check_values(settings, file)
    try:
        check_site_crs(settings.crs)
    except CrsError as error:
        raise SettingsError(f"{file}: site.crs: {error}") from error


def check_values(settings: SiteSettings, file: Path) -> None:
    """As :func:`check_settings`, but for the CRS, which needs pyproj to be understood."""
    wrong = _first_wrong(settings)
    if wrong is not None:
        raise SettingsError(f"{file}: {wrong}")


def settings_text(settings: SiteSettings) -> str:
    """Return ``settings`` as the text of a ``site.toml``."""
    site = {f.name: getattr(settings, f.name) for f in fields(settings) if f.name != "liveness"}
    lines = ["[site]", *(f"{key} = {_toml(value)}" for key, value in site.items())]
    limits = settings.liveness
    lines += ["", "[liveness]", *(f"{f.name} = {_toml(getattr(limits, f.name))}" for f in fields(limits))]
    return "\n".join(lines) + "\n"


def _first_wrong(settings: SiteSettings) -> str | None:
    limits, bounds = settings.liveness, settings.bounds
    numbers = {
        "site.origin": settings.origin,
        "site.bounds": tuple(bounds),
        "site.rotation_deg": (settings.rotation_deg,),
        "site.reached_tolerance_m": (settings.reached_tolerance_m,),
        "liveness": (limits.stale_after_s, limits.lost_after_s),
    }
    for key, values in numbers.items():
        if not all(math.isfinite(value) for value in values):
            return f"{key} = {list(values)}: nan and inf are no numbers for a site; write finite ones."
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
            0 < limits.stale_after_s < limits.lost_after_s,
            f"liveness.stale_after_s = {limits.stale_after_s} and lost_after_s = {limits.lost_after_s} "
            "do not follow each other: a robot turns stale before it is lost, both after more than 0 s.",
        ),
    )
    return next((text for right, text in rules if not right), None)


def _tables(file: Path) -> Mapping[str, Any]:
    try:
        import tomllib
    except ImportError as error:
        raise SettingsError(f"{file} cannot be read: this needs Python 3.11 or newer (tomllib).") from error
    try:
        return tomllib.loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError as error:
        raise SettingsError(
            f"{file} is missing: a published site is a folder with {SETTINGS_FILE} and site.gpkg. "
            "Check the folder's name or publish the site again."
        ) from error
    except (OSError, UnicodeDecodeError) as error:
        raise SettingsError(f"{file} cannot be read: {error}") from error
    except tomllib.TOMLDecodeError as error:
        raise SettingsError(f"{file} is not valid TOML: {error}. Correct that line.") from error


def _table(tables: Mapping[str, Any], name: str, file: Path, optional: bool = False) -> Mapping[str, Any]:
    table = tables.get(name, {} if optional else None)
    if not isinstance(table, Mapping):
        found = "is missing" if table is None else f"is {table!r}, not a table"
        raise SettingsError(f"{file}: [{name}] {found}: write a table [{name}].")
    return table


def _refuse_unknown(table: Mapping[str, Any], known: set[str], prefix: str, file: Path) -> None:
    for key in table:
        if key not in known:
            raise SettingsError(
                f"{file}: {prefix}{key} is not a setting: known are {', '.join(sorted(known))}. "
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
    return inner if inner.startswith("liveness") else f"site.{inner}".rstrip(".")


def _value_at(content: Any, place: str) -> str:
    """Return `` = value`` for a msgspec path such as ``.origin[0]``, or nothing when it leads nowhere."""
    for step in re.findall(r"\.(\w+)|\[(\d+)\]", place):
        try:
            content = content[step[0]] if step[0] else content[int(step[1])]
        except (KeyError, IndexError, TypeError):
            return ""
    return f" = {content!r}" if place else ""


def _toml(value: Any) -> str:
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, tuple):
        return f"[{', '.join(_toml(item) for item in value)}]"
    return repr(value)
