"""Build build/fleet_supervisor-VERSION.zip, the file for plugins.qgis.org.

The same input gives the same bytes.

python scripts/package.py [--output FOLDER]
"""

from __future__ import annotations

import argparse
import sys
import zipfile
from pathlib import Path

from plugin_files import PACKAGE, ROOT, PackageError, plugin_files, version

LIMIT = 25 * 1024 * 1024
"""What plugins.qgis.org accepts, in bytes."""

EPOCH = (1980, 1, 1, 0, 0, 0)
"""The time of every entry: the oldest a zip can hold, so that the day of building leaves no trace."""


def build(folder: Path) -> Path:
    """Write the zip into ``folder`` and return its path.

    :raises PackageError: when a part is missing or the zip is larger than :data:`LIMIT`.
    """
    folder.mkdir(parents=True, exist_ok=True)
    target = folder / f"{PACKAGE}-{version()}.zip"
    unfinished = target.with_suffix(".unfinished")
    with zipfile.ZipFile(unfinished, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, content in plugin_files().items():
            entry = zipfile.ZipInfo(f"{PACKAGE}/{name}", EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o100644 << 16
            archive.writestr(entry, content)
    if unfinished.stat().st_size > LIMIT:
        raise PackageError(f"{unfinished} is larger than {LIMIT} bytes, which plugins.qgis.org refuses")
    return unfinished.replace(target)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", type=Path, default=ROOT / "build")
    try:
        target = build(parser.parse_args().output)
    except PackageError as error:
        print(f"package: error: {error}", file=sys.stderr)
        return 1
    print(f"{target} ({target.stat().st_size / 1e6:.2f} MB)")
    return 0


if __name__ == "__main__":
    sys.exit(main())
