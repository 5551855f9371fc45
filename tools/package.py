"""Build build/fleet_supervisor-VERSION.zip, the file for plugins.qgis.org.

The same input gives the same bytes. plugins.qgis.org takes only what says where its source is and where
faults are reported: this repository has no public address of its own, so whoever publishes it says so.

python -m tools.package [--output FOLDER] [--repository URL] [--tracker URL]
"""

from __future__ import annotations

import argparse
import os
import sys
import zipfile
from collections.abc import Mapping
from pathlib import Path
from urllib.parse import urlsplit

from tools.plugin_files import PACKAGE, ROOT, PackageError, plugin_files, version

LIMIT = 25 * 1024 * 1024
"""What plugins.qgis.org accepts, in bytes."""

EPOCH = (1980, 1, 1, 0, 0, 0)
"""The time of every entry: the oldest a zip can hold, so that the day of building leaves no trace."""


LINKS = ("repository", "tracker")
"""What plugins.qgis.org requires in metadata.txt beside what is there."""


def build(folder: Path, links: Mapping[str, str] | None = None) -> Path:
    """Write the zip into ``folder``, with ``links`` in its metadata, and return its path.

    :raises PackageError: when a part is missing, a link is none, or the zip is larger than :data:`LIMIT`.
    """
    files = plugin_files()
    files["metadata.txt"] = with_links(files["metadata.txt"], links or {})
    folder.mkdir(parents=True, exist_ok=True)
    target = folder / f"{PACKAGE}-{version()}.zip"
    unfinished = target.with_suffix(".unfinished")
    with zipfile.ZipFile(unfinished, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(f"{PACKAGE}/{name}", EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o100644 << 16
            archive.writestr(entry, content)
    if unfinished.stat().st_size > LIMIT:
        raise PackageError(f"{unfinished} is larger than {LIMIT} bytes, which plugins.qgis.org refuses")
    return unfinished.replace(target)


def with_links(metadata: bytes, links: Mapping[str, str]) -> bytes:
    """Return ``metadata`` with ``links`` at its end.

    :raises PackageError: when one of them is no address of a web page.
    """
    for key, url in links.items():
        parts = urlsplit(url)
        if parts.scheme not in ("http", "https") or "." not in (parts.hostname or ""):
            raise PackageError(f"{key} {url!r} is no address of a web page; write it like https://host/path")
    lines = "".join(f"{key}={url}\n" for key, url in links.items())
    return metadata.rstrip(b"\n") + b"\n" + lines.encode()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", type=Path, default=ROOT / "build")
    for key in LINKS:
        # An empty variable, as from make, is none.
        parser.add_argument(f"--{key}", default=os.environ.get(key.upper()) or "")
    options = parser.parse_args()
    links = {key: getattr(options, key) for key in LINKS if getattr(options, key)}
    try:
        target = build(options.output, links)
    except PackageError as error:
        print(f"package: error: {error}", file=sys.stderr)
        return 1
    print(f"{target} ({target.stat().st_size / 1e6:.2f} MB)")
    missing = [key for key in LINKS if key not in links]
    if missing:
        given = " ".join(f"{key.upper()}=https://..." for key in missing)
        print(f"For QGIS's own 'Install from ZIP'. plugins.qgis.org also wants: make package {given}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
