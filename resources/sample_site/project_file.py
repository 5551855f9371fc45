"""Saving a QGIS project so that the same project gives the same bytes on every machine."""

from __future__ import annotations

import re
import tempfile
import zipfile
from pathlib import Path

from qgis.core import QgsProject

_UUID = re.compile(r"[0-9a-f]{8}([-_][0-9a-f]{4}){3}[-_][0-9a-f]{12}")


def save_project(project: QgsProject, file: Path) -> None:
    """Write ``project`` to the .qgz ``file`` with paths relative to it, and nothing of who saved it when."""
    with tempfile.TemporaryDirectory(dir=file.parent, prefix=".project-") as folder:
        plain = Path(folder) / f"{file.stem}.qgs"
        if not project.write(str(plain)):
            raise SystemExit(f"{plain} cannot be written: {project.error()}")
        text = _neutral(plain.read_text(encoding="utf-8"))
    # Written one folder deeper than where it is going to lie.
    text = text.replace('="../', '="./').replace(">../", ">./")
    entry = zipfile.ZipInfo(f"{file.stem}.qgs", date_time=(2026, 1, 1, 0, 0, 0))
    entry.compress_type = zipfile.ZIP_DEFLATED
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr(entry, text)


def _neutral(text: str) -> str:
    """Return the project's XML without user, host and time, and with ids that count up."""
    text = re.sub(r' save(User|UserFull|DateTime)="[^"]*"', "", text)
    text = re.sub(r"<creation>[^<]*</creation>", "<creation>2026-01-01T00:00:00</creation>", text)
    text = re.sub(r"<author>[^<]*</author>", "<author></author>", text)
    # Snapping defaults of each layer come in the order of addresses in memory; QGIS restores them by itself.
    text = re.sub(r"\n *<layer-setting [^>]*/>", "", text)
    known: dict[str, str] = {}

    def number(match: re.Match[str]) -> str:
        plain = match[0].replace("-", "_")
        known.setdefault(plain, f"{len(known) + 1:032x}")
        digits, mark = known[plain], "_" if "_" in match[0] else "-"
        return mark.join((digits[:8], digits[8:12], digits[12:16], digits[16:20], digits[20:]))

    return _UUID.sub(number, text)
