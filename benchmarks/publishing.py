"""The part on QGIS's algorithms on large cities: publishing, and the map of a window."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import pyogrio

from benchmarks.clock import Spread, spread, table
from benchmarks.page import Part, goal
from benchmarks.qgis_process import QgisProcess, Run, qgis_process
from benchmarks.trial import size
from tools.made_up_city import CRS, City

BUILDINGS = size(1_000_000, 20_000)
RUNS = size(5, 2)
"""How often a window is exported; each time beside QGIS's own algorithm."""
SIDE = 100.0
MOST_CPU, MOST_MB = 90.0, 600.0
MOST_TIMES, MOST_BEYOND = 1.2, 1.0
MALTA = "osm/malta_2018_utm33n.gpkg"
MALTA_LAYERS = {
    "OBSTACLES": ("buildings", "barriers", "steps", "furniture"),
    "ROAD_CENTRELINES": ("roads",),
}

TEXT = """\
Each run is a `qgis_process` of its own that starts QGIS with the plugin; seconds are of processor time, the
memory is the most that the process had. QGIS's own algorithms run in the same profile, one after the other
with ours.

### Publishing

The city is made up (`tools/made_up_city.py`): {buildings:,} buildings of six shapes, some with courtyards,
with {features:,} features in six layers, heights and widths by expressions, one way or both. Malta is
OpenStreetMap's. `native:package` copies the same layers into one GeoPackage and reads nothing of them; in
brackets, times ours.

{publishing}

Of the made-up city: {cpu:.0f} s ({cpu_goal}); {megabytes:.0f} MB ({memory_goal}).

### What is warned of

{warnings}

Every warning of the made-up city, in full:

{said}

### The map of a window

{side:g} m × {side:g} m of the {buildings:,} buildings. QGIS's own `native:extractbyextent` copies the
features of the same layer that touch it; QGIS's start is `qgis_process help`, which runs nothing. Each {runs}
times, in turns.

{window}

Ours takes {times:.2f} times QGIS's ({times_goal}), and {beyond:.2f} s beyond QGIS's start ({beyond_goal}).
"""


class Site(NamedTuple):
    """Layers that are published, and what publishing and copying them took."""

    title: str
    features: int
    ours: Run
    copied: Run

    def row(self) -> list[str]:
        """Return a line of the table."""
        return [
            self.title,
            f"{self.features:,}",
            f"{self.ours.cpu:.1f}",
            f"{self.ours.wall:.0f}",
            f"{self.ours.megabytes:.0f}",
            f"{self.copied.cpu:.1f} ({self.copied.cpu / self.ours.cpu:.2f})",
            f"{self.copied.megabytes:.0f} ({self.copied.megabytes / self.ours.megabytes:.2f})",
        ]


def measure(data: Path) -> Part:
    """Publish the made-up city and Malta, and export a window of the city."""
    with TemporaryDirectory(prefix="fleet-publishing-") as name, qgis_process() as process:
        folder = Path(name)
        city = City(BUILDINGS)
        file = city.write(folder)
        arguments = city.publish_arguments(folder, folder / "site")
        sites = [
            _site("made-up city", arguments, process, folder),
            _site("Malta", _malta(data / MALTA, folder / "malta"), process, folder),
        ]
        starts, native, ours = _windows(city, file, process, folder)
    first = sites[0]
    times, beyond = ours.median / native.median, ours.median - starts.median
    head = ("", "features", "ours, s", "passed, s", "ours, MB", "`native:package`, s", "MB")
    text = TEXT.format(
        buildings=BUILDINGS,
        features=first.features,
        publishing=table(head, [site.row() for site in sites]),
        cpu=first.ours.cpu,
        cpu_goal=goal(f"at most {MOST_CPU:g} s", first.ours.cpu <= MOST_CPU),
        megabytes=first.ours.megabytes,
        memory_goal=goal(f"at most {MOST_MB:g} MB", first.ours.megabytes <= MOST_MB),
        warnings=table(
            ("", "warnings", "characters of them"),
            [(site.title, len(site.ours.warnings), sum(map(len, site.ours.warnings))) for site in sites],
        ),
        said="\n".join(f"- {warning}" for warning in first.ours.warnings),
        side=SIDE,
        runs=RUNS,
        window=table(
            ("s of processor time", "median"),
            [
                ("QGIS's start", f"{starts:.2f}"),
                ("`native:extractbyextent`", f"{native:.2f}"),
                ("`fleet:exportrobotmap`", f"{ours:.2f}"),
            ],
        ),
        times=times,
        times_goal=goal(f"at most {MOST_TIMES:g} times", times <= MOST_TIMES),
        beyond=beyond,
        beyond_goal=goal(f"below {MOST_BEYOND:g} s", beyond < MOST_BEYOND),
    )
    return Part("Large cities in QGIS", text)


def _site(title: str, arguments: list[str], process: QgisProcess, folder: Path) -> Site:
    """Publish with ``arguments``, and copy the same layers."""
    sources = [one.partition("=")[2] for one in arguments if "|layername=" in one]
    layers = [source.split("|layername=") for source in sources]
    features = sum(pyogrio.read_info(file, layer=layer)["features"] for file, layer in layers)
    ours = process.run("run", *arguments)
    copy = folder / "copy.gpkg"
    copied = process.run("run", "native:package", *[f"--LAYERS={one}" for one in sources], f"--OUTPUT={copy}")
    copy.unlink()
    return Site(title, features, ours, copied)


def _malta(file: Path, site: Path) -> list[str]:
    given = [f"--{name}={file}|layername={one}" for name, some in MALTA_LAYERS.items() for one in some]
    named = ["--PROFILE=openstreetmap", "--SITE_ID=malta", "--SITE_CRS=EPSG:32633"]
    return ["fleet:publishsite", *given, *named, "--ORIGIN=430000,3960000 [EPSG:32633]", f"--FOLDER={site}"]


def _windows(city: City, file: Path, process: QgisProcess, folder: Path) -> tuple[Spread, Spread, Spread]:
    """Return what QGIS's start, its own algorithm and ours took on a window in the middle of ``city``."""
    x, y = city.centre
    extent = f"{x - SIDE / 2},{x + SIDE / 2},{y - SIDE / 2},{y + SIDE / 2} [{CRS}]"
    layer = f"{file}|layername=buildings"
    commands = (
        ("help", "native:extractbyextent"),
        (
            "run",
            "native:extractbyextent",
            f"--INPUT={layer}",
            f"--EXTENT={extent}",
            f"--OUTPUT={folder / 'extract.gpkg'}",
        ),
        (
            "run",
            "fleet:exportrobotmap",
            f"--OBSTACLES={layer}",
            f"--EXTENT={extent}",
            f"--SITE_CRS={CRS}",
            f"--PROFILE={folder / 'city.toml'}",
            f"--OUTPUT={folder / 'map.txt'}",
        ),
    )
    taken = [[process.run(*command).cpu for command in commands] for _ in range(RUNS)]
    starts, native, ours = (spread(column) for column in zip(*taken, strict=True))
    return starts, native, ours
