"""Placed cones as CSV and GeoPackage, made by the real command line and read with other programs."""

import csv

import pytest
from osgeo import ogr

from robot_bridge.gateway.storage.database import Database, read_address
from robot_bridge.gateway.storage.repositories import records
from robot_bridge.gateway.storage.repositories.records import CollectedCone, NewPlacement
from tests.support.bridge.command_line import run_command

ogr.UseExceptions()
AT = 1_790_000_000.125
"""2026-09-21T14:13:20.125Z"""


def run(*options):
    return run_command("placements", "export", *options)


def cone(n, layout="slalom", robot="r1", plan=None):
    return NewPlacement(
        task=f"task-{layout}-{n}",
        robot=robot,
        command=f"command-{n}",
        planned_x=10.0 * n,
        planned_y=5.0,
        x=10.0 * n + 0.03,
        y=5.04,
        theta=0.5,
        deviation=0.05,
        placed_at=AT + n,
        cone=f"c{n}",
        layout=layout,
        plan=plan,
    )


@pytest.fixture
async def where(sample_site, tmp_path, new_database):
    """The options for a database with three cones of a slalom, one of them collected, and one of a circle."""
    database = Database(read_address(new_database.at(tmp_path / "fleet.db")))
    await database.open()
    for n in range(3):
        await database.run(records.add_placed_cones, cone(n))
    await database.run(records.add_placed_cones, cone(7, layout="circle", robot="r2", plan="p1"))
    await database.run(records.collect, CollectedCone("r2", AT + 60, cone="c1", layout="slalom"))
    await database.close()
    return "--site", sample_site, "--database", f"sqlite:///{tmp_path}/fleet.db"


def table(file):
    with file.open(encoding="utf-8", newline="") as text:
        return list(csv.DictReader(text))


def test_a_table_has_plan_place_deviation_robot_and_time(where, tmp_path):
    done = run(tmp_path / "cones.csv", *where)
    assert done.stdout.strip().endswith("cones.csv: 4 cones, 0.050 m off their places at most")
    rows = table(tmp_path / "cones.csv")
    assert [(row["layout"], row["cone"]) for row in rows] == [
        ("slalom", "c0"),
        ("slalom", "c1"),
        ("slalom", "c2"),
        ("circle", "c7"),
    ]
    row = rows[1]
    assert (row["planned_x"], row["x"], row["dx"], row["dy"]) == ("10.000", "10.030", "0.030", "0.040")
    assert (row["deviation"], row["robot"], row["label"]) == ("0.050", "r1", "")
    assert (row["easting"], row["northing"]) == ("640430.030", "5193485.040")
    assert row["placed_at"] == "2026-09-21T14:13:21.125+00:00"
    assert (row["collected_by"], row["collected_at"]) == ("r2", "2026-09-21T14:14:20.125+00:00")


def test_a_geopackage_has_what_stands_what_was_planned_and_the_way_between(where, tmp_path):
    done = run(tmp_path / "cones.gpkg", *where)
    assert done.returncode == 0, done.stderr
    found = ogr.Open(str(tmp_path / "cones.gpkg"))
    assert sorted(layer.GetName() for layer in found) == ["deviations", "placed", "planned"]
    assert {layer.GetFeatureCount() for layer in found} == {4}
    assert found.GetLayerByName("placed").GetSpatialRef().GetAuthorityCode(None) == "32633"
    feature = next(iter(found.GetLayerByName("placed")))
    assert (feature.geometry().GetX(), feature.geometry().GetY()) == pytest.approx((640420.03, 5193485.04))
    assert feature.GetField("placed_at") == "2026/09/21 14:13:20.125+00"
    assert feature.GetField("collected_at") is None
    feature = next(iter(found.GetLayerByName("deviations")))
    line = feature.geometry()
    assert line.Length() == pytest.approx(0.05)
    assert (line.GetX(0), line.GetY(0)) == pytest.approx((640420.0, 5193485.0))


@pytest.mark.parametrize(
    ("options", "cones"),
    [
        (["--layout", "slalom"], ["c0", "c1", "c2"]),
        (["--standing"], ["c0", "c2", "c7"]),
        (["--collected"], ["c1"]),
        (["--robot", "r2"], ["c7"]),
        (["--plan", "p1"], ["c7"]),
        (["--since", "2026-09-21T14:13:22"], ["c2", "c7"]),
        (["--layout", "circle", "--collected"], []),
    ],
)
def test_it_is_narrowed_down(where, tmp_path, options, cones):
    done = run(tmp_path / "cones.csv", *where, *options)
    assert done.returncode == 0, done.stderr
    assert [row["cone"] for row in table(tmp_path / "cones.csv")] == cones


def test_nothing_at_all_is_a_file_that_says_so(where, tmp_path):
    assert run(tmp_path / "cones.gpkg", *where, "--layout", "circle", "--collected").returncode == 0
    assert ogr.Open(str(tmp_path / "cones.gpkg")).GetLayerByName("placed").GetFeatureCount() == 0


@pytest.mark.parametrize(
    ("option", "known"), [("layout", "circle, slalom"), ("plan", "p1"), ("robot", "r1, r2")]
)
def test_a_name_that_no_cone_has_is_said_and_nothing_is_written(where, tmp_path, option, known):
    done = run(tmp_path / "cones.csv", *where, f"--{option}", "nowhere")
    assert done.returncode == 1
    assert (
        f"no cone of {option} 'nowhere' is stored in this database; {option}s with cones in it: {known}."
        in (done.stderr)
    )
    assert list(tmp_path.glob("cones.*")) == []


def test_a_time_that_ends_before_it_begins_is_said(where, tmp_path):
    done = run(tmp_path / "cones.csv", *where, "--since", "2026-09-22", "--until", "2026-09-21")
    assert done.returncode == 1
    assert "--since '2026-09-22' is later than --until '2026-09-21'; nothing lies between" in done.stderr


def test_a_file_is_replaced_only_when_that_is_wanted(where, tmp_path):
    file = tmp_path / "cones.csv"
    file.write_text("mine")
    assert "is there already" in run(file, *where).stderr
    assert file.read_text() == "mine"
    assert run(file, *where, "--replace").returncode == 0
    assert "ends in .csv or .gpkg" in run(tmp_path / "cones.xlsx", *where).stderr
