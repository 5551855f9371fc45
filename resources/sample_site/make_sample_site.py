"""Make the sample site beside this file: source layers, published site, orthophoto and QGIS project.

Run with the project's Python: ``.venv/bin/python resources/sample_site/make_sample_site.py``. Every run
gives the same bytes on the same versions of GDAL, numpy and Pillow; nothing here is measured on a real place.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1])]

from plan import CRS, ORIGIN, make_plan  # noqa: E402
from published import publish  # noqa: E402
from source_layers import write_source_layers  # noqa: E402

from robot_bridge.core.sites.frame import SiteFrame  # noqa: E402

TIME_OF_WRITING = "2026-01-01T00:00:00.000Z"


def main(parts: list[str]) -> None:
    """Make ``parts`` of the site, or all of it: layers, photo, project."""
    os.environ["OGR_CURRENT_DATE"] = TIME_OF_WRITING
    wanted = parts or ["layers", "photo", "project"]
    plan = make_plan()
    if "layers" in wanted:
        write_source_layers(HERE / "sample_site.gpkg", plan, SiteFrame(CRS, ORIGIN))
        publish(HERE, plan)
    if "photo" in wanted:
        from drawing.orthophoto import write_orthophoto

        write_orthophoto(HERE / "orthophoto.tif", plan)
    if "project" in wanted:
        # QGIS has a GDAL of its own, which does not share a process with that of pyogrio.
        # Qt writes attributes in the order of its hash tables, which the seed fixes.
        environment = {**os.environ, "QT_HASH_SEED": "0", "QT_QPA_PLATFORM": "offscreen"}
        subprocess.run([sys.executable, str(HERE / "make_project.py")], check=True, env=environment)


if __name__ == "__main__":
    main(sys.argv[1:])
