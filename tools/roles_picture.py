"""Take the picture of the dialog *Layer roles* over the sample project, in a QGIS of its own under Xvfb.

python -m tools.roles_picture [docs/images/roles-dialog.png]
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from tests.support.picture import reduce_colours
from tests.support.processes import Processes
from tests.support.program import ended
from tests.support.qgis import Profile, virtual_screen
from tests.support.session import follow, start_qgis
from tools.plugin_files import ROOT

FOLDER = ROOT / "build" / "roles_picture"
PROJECT = ROOT / "resources" / "sample_site" / "sample_site.qgz"
SCREEN = (1360, 850)
TIMEOUT = 90.0


def run(picture: Path) -> None:
    """Open QGIS and let it save ``picture``.

    :raises StageError: when something does not come up.
    """
    FOLDER.mkdir(parents=True, exist_ok=True)
    with Processes(FOLDER / "logs") as processes:
        display = virtual_screen(processes, *SCREEN)
        profile = Profile(FOLDER / "profile", link=False)
        plan = {
            "journal": str(FOLDER / "journal.jsonl"),
            "project": str(PROJECT),
            "picture": str(picture),
            "window": SCREEN,
        }
        qgis = start_qgis(processes, profile, "roles_session.py", plan, display)
        for entry in follow(processes, qgis, Path(plan["journal"]), TIMEOUT):
            print(entry["text"], flush=True)
    reduce_colours(picture)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    default = ROOT / "docs" / "images" / "roles-dialog.png"
    parser.add_argument("picture", type=Path, nargs="?", default=default, metavar="PNG")
    picture = parser.parse_args().picture.resolve()
    return ended("roles_picture", lambda: run(picture))


if __name__ == "__main__":
    sys.exit(main())
