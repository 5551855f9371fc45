"""The published sites that lie in one folder, and which of them may follow one another on one gateway."""

from __future__ import annotations

from pathlib import Path

from .settings import SETTINGS_FILE, SiteSettings


def neighbours(folder: Path) -> list[str]:
    """Return the names of the folders beside ``folder`` that hold a site, itself included, sorted."""
    return sorted(file.parent.name for file in folder.resolve().parent.glob(f"*/{SETTINGS_FILE}"))


def other_frame(served: SiteSettings, other: SiteSettings) -> str | None:
    """Return why ``other`` cannot follow ``served`` where commands and positions are kept, None if it can."""
    if (served.crs, served.origin, served.rotation_deg) == (other.crs, other.origin, other.rotation_deg):
        return None
    x, y = other.origin
    return (
        f"{other.id} has another frame ({other.crs}, origin {x:.12g}, {y:.12g}, "
        f"rotation {other.rotation_deg:g}°) than {served.id}, and positions of the one are wrong in the "
        "other; start a gateway on it, with a database of its own"
    )
