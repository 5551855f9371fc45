"""The thresholds as QGIS keeps them between sessions."""

from __future__ import annotations

from qgis.core import QgsSettings

from .thresholds import NUMBERS, RANGES, AlarmKind, Thresholds

GROUP = "fleet_supervisor/alarms"


def read_limits() -> Thresholds:
    """Return what the operator set; a value that is none, or out of its range, counts as never set."""
    settings = QgsSettings()
    numbers = {name: _number(settings.value(f"{GROUP}/{name}"), name) for name in NUMBERS}
    off = str(settings.value(f"{GROUP}/off") or "").split(",")
    return Thresholds(
        **{name: value for name, value in numbers.items() if value is not None},
        kinds=frozenset(kind for kind in AlarmKind if kind.value not in off),
    )


def write_limits(limits: Thresholds) -> None:
    """Keep the settings."""
    settings = QgsSettings()
    for name in NUMBERS:
        settings.setValue(f"{GROUP}/{name}", getattr(limits, name))
    off = [kind.value for kind in AlarmKind if kind not in limits.kinds]
    settings.setValue(f"{GROUP}/off", ",".join(off))


def _number(value: object, name: str) -> float | None:
    try:
        number = float(str(value))
    except ValueError:
        return None
    least, most = RANGES[name]
    return number if least <= number <= most else None
