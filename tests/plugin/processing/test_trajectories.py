"""``fleet:trajectories``: lines of stored positions, in QGIS and by ``qgis_process``."""

from __future__ import annotations

import json
import math
import time

import pytest
from fleet_supervisor.robot_bridge.core.messages.robots import SendPos
from osgeo import ogr
from qgis.core import (
    QgsCoordinateTransformContext,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProject,
    QgsVectorFileWriter,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QDateTime, Qt

from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from robot_bridge.gateway.storage.repositories import trajectories
from robot_bridge.gateway.storage.repositories.trajectories import Fix, pack
from tests.support.bridge.command_line import run_command

ogr.UseExceptions()
T0 = 1_790_000_000
FIELDS = "&field=robot:string&field=time:datetime&field=v:double"


def at(seconds):
    return QDateTime.fromMSecsSinceEpoch(round((T0 + seconds) * 1000), Qt.TimeSpec.UTC)


@pytest.fixture
def positions(make_layer):
    """r1 drives 3 m and 4 m, is silent for two minutes, and drives 10 m; r2 is in between; not in order."""
    rows = [
        ("Point(500103 5000000)", "r1", at(1), 2.0),
        ("Point(500100 5000000)", "r1", at(0), 3.0),
        ("Point(500000 5000100)", "r2", at(1), None),
        ("Point(500103 5000004)", "r1", at(3), 2.0),
        ("Point(500000 5000108)", "r2", at(3), None),
        ("Point(500103 5000014)", "r1", at(123), 5.0),
        ("Point(500103 5000024)", "r1", at(125), 5.0),
        ("Point(500001 5000100)", "r2", at(1), None),
        ("Point(500000 5000100)", "lonely", at(1), None),
        (None, "r1", at(2), 1.0),
        ("Point(500000 5000100)", "r1", None, 1.0),
    ]
    return make_layer("positions", "Point", FIELDS, rows)


@pytest.fixture
def run(provider, listener):
    """Run the algorithm and return what it gave, with its lines as (values by field, geometry)."""
    import processing

    def run(feedback=None, **parameters):
        context = QgsProcessingContext()
        context.setProject(QgsProject())
        told = processing.run(
            "fleet:trajectories",
            {"OUTPUT": "memory:", **parameters},
            context=context,
            feedback=feedback or listener,
        )
        layer = told.get("OUTPUT")
        lines = [] if layer is None else [(f.attributeMap(), f.geometry()) for f in layer.getFeatures()]
        return told, lines

    return run


def test_each_drive_is_a_line_with_time_length_and_speed(run, positions, listener):
    told, lines = run(INPUT=positions)
    assert [(one["robot"], one["count"]) for one, _ in lines] == [("r1", 3), ("r1", 2), ("r2", 2)]
    first, shape = lines[0]
    assert (first["begin"], first["end"]) == (at(0), at(3))
    assert (first["duration_s"], first["length_m"]) == (3.0, 7.0)
    assert first["mean_speed"] == pytest.approx(7 / 3)
    assert first["top_speed"] == 3.0
    assert [(p.x(), p.y(), p.m()) for p in shape.vertices()] == [
        (500100, 5000000, T0),
        (500103, 5000000, T0 + 1),
        (500103, 5000004, T0 + 3),
    ]
    # Of two positions of r2 at one time the last counts; it told no speed, so its fastest step does.
    assert lines[2][0]["length_m"] == pytest.approx(math.hypot(1, 8))
    assert lines[2][0]["top_speed"] == pytest.approx(math.hypot(1, 8) / 2)
    assert (told["LINE_COUNT"], told["POSITION_COUNT"]) == (3, 9)
    assert told["TOTAL_LENGTH"] == pytest.approx(17 + math.hypot(1, 8))
    assert listener.warnings == ["2 features have no place, robot or time; they are left out."]


def test_a_speed_that_is_no_field_or_no_number_is_said(run, positions, make_layer, listener):
    with pytest.raises(QgsProcessingException, match="no field speed for the speed: they have robot"):
        run(INPUT=positions, SPEED_FIELD="speed")
    told, _ = run(INPUT=positions, SPEED_FIELD="robot")
    assert "9 values of the field robot are no numbers" in listener.warnings[-1]
    assert told["WARNING_COUNT"] == 2
    # The default need not be there.
    rows = [("Point(0 0)", "r1", 1.0), ("Point(3 0)", "r1", 2.0)]
    bare = make_layer("bare", "Point", "&field=robot:string&field=time:double", rows, crs="EPSG:32633")
    assert run(INPUT=bare)[1][0][0]["top_speed"] == 3.0


def test_a_feature_of_several_points_is_no_position(run, make_layer, listener):
    rows = [
        ("MultiPoint((0 0))", "r1", 1.0),
        ("MultiPoint((1 0),(9 9))", "r1", 2.0),
        ("MultiPoint((4 0))", "r1", 3.0),
    ]
    layer = make_layer("seen", "MultiPoint", "&field=robot:string&field=time:double", rows, crs="EPSG:32633")
    told, _ = run(INPUT=layer)
    assert (told["POSITION_COUNT"], told["TOTAL_LENGTH"]) == (2, 4.0)
    assert listener.warnings == ["1 feature has no place, robot or time; it is left out."]


def test_positions_without_a_crs_are_in_metres_in_a_geopackage_too(run, make_layer, tmp_path):
    rows = [("Point(0 0)", "r1", 1.0), ("Point(3 4)", "r1", 2.0)]
    layer = make_layer("seen", "Point", "&field=robot:string&field=time:double", rows, crs="")
    file, context = str(tmp_path / "seen.gpkg"), QgsCoordinateTransformContext()
    QgsVectorFileWriter.writeAsVectorFormatV3(layer, file, context, QgsVectorFileWriter.SaveVectorOptions())
    for given in (layer, file):
        assert run(INPUT=given)[0]["TOTAL_LENGTH"] == pytest.approx(5.0)


def test_a_longer_gap_joins_drives_and_steps_part_them(run, positions):
    _, joined = run(INPUT=positions, GAP=200)
    assert [one["count"] for one, _ in joined] == [5, 2]
    _, steps = run(INPUT=positions, STEPS=True)
    assert [(one["robot"], one["length_m"]) for one, _ in steps[:3]] == [
        ("r1", 3.0),
        ("r1", 4.0),
        ("r1", 10.0),
    ]
    assert all(one["count"] == 2 for one, _ in steps)


@pytest.mark.parametrize(("crs", "step"), [("EPSG:4326", (0.0, 0.001)), ("EPSG:3857", (0.0, 100.0))])
def test_where_units_are_no_metres_lengths_are_measured_on_the_ellipsoid(run, make_layer, crs, step):
    begin = (16.8, 46.9) if crs == "EPSG:4326" else (1870000.0, 5930000.0)
    ends = [begin, (begin[0] + step[0], begin[1] + step[1])]
    rows = [(f"Point({x} {y})", "r1", at(k), None) for k, (x, y) in enumerate(ends)]
    _, lines = run(INPUT=make_layer("positions", "Point", FIELDS, rows, crs=crs))
    # A thousandth of a degree of latitude is 111.2 m there; a "metre" of Web Mercator 0.68 m.
    assert lines[0][0]["length_m"] == pytest.approx({"EPSG:4326": 111.17, "EPSG:3857": 68.5}[crs], rel=0.005)


def test_times_may_be_seconds_or_texts(run, make_layer):
    for kind, values in (
        ("double", (T0, T0 + 2.0)),
        ("string", ("2026-09-21T14:13:20Z", "2026-09-21 16:13:22+02:00")),
    ):
        rows = [(f"Point({k} 0)", "r1", value) for k, value in enumerate(values)]
        _, lines = run(INPUT=make_layer("p", "Point", f"&field=robot:string&field=time:{kind}", rows))
        assert (lines[0][0]["begin"], lines[0][0]["duration_s"]) == (at(0), 2.0)


def test_times_without_an_offset_are_utc_wherever_the_desk_is(run, make_layer, monkeypatch):
    monkeypatch.setenv("TZ", "Europe/Budapest")
    time.tzset()
    try:
        local = QDateTime.fromString("2026-09-21T14:13:20", Qt.DateFormat.ISODate)
        rows = [("Point(0 0)", "r1", local, None), ("Point(1 0)", "r1", local.addSecs(1), None)]
        _, lines = run(INPUT=make_layer("positions", "Point", FIELDS, rows))
    finally:
        monkeypatch.undo()
        time.tzset()
    assert lines[0][1].vertexAt(0).m() == T0


def test_a_layer_without_the_fields_is_refused_with_what_to_give(run, make_layer):
    layer = make_layer("cones", "Point", "&field=name:string", [("Point(0 0)", "c")])
    with pytest.raises(QgsProcessingException, match=r"no field robot .*they have name.*trajectories export"):
        run(INPUT=layer)


def test_no_positions_are_no_lines(run, make_layer):
    told, lines = run(INPUT=make_layer("positions", "Point", FIELDS, []))
    assert (told["LINE_COUNT"], told["TOTAL_LENGTH"], lines) == (0, 0.0, [])


def test_it_can_be_cancelled(run, make_layer, cancels_at):
    rows = [(f"Point({k} 0)", "r1", at(k), 1.0) for k in range(5000)]
    told, _ = run(cancels_at(20), INPUT=make_layer("positions", "Point", FIELDS, rows))
    assert "LINE_COUNT" not in told


def test_the_loaded_layer_can_be_played(root, make_layer):
    layer = QgsVectorLayer(
        "LineString?field=robot:string&field=begin:datetime&field=end:datetime", "t", "memory"
    )
    layer.loadNamedStyle(str(root / "resources" / "styles" / "trajectories.qml"))
    times = layer.temporalProperties()
    assert times.isActive()
    assert (times.startField(), times.endField()) == ("begin", "end")


@pytest.fixture
def export(root, tmp_path):
    """What a gateway's database gives: r1 drove east for ten seconds with 1 m/s."""
    database = f"sqlite:///{tmp_path}/fleet.db"
    run_once(database, revisions.create)
    fixes = [Fix("r1", T0 + float(k), SendPos(20.0 + k, 8.0, 0.0, 1.0, t=float(k))) for k in range(11)]
    run_once(database, trajectories.add, list(map(pack, fixes)))
    file = tmp_path / "drives.gpkg"
    options = ["trajectories", "export", file, "--site", root / "resources" / "sample_site"]
    done = run_command(*options, "--database", database)
    assert done.returncode == 0, done.stderr
    return file


def test_a_gateways_export_becomes_lines_by_a_script(by_words, export, tmp_path):
    made = tmp_path / "lines.gpkg"
    given = f"INPUT={export}|layername=positions"
    done = by_words("run", "fleet:trajectories", "--", given, f"OUTPUT={made}")
    assert done.status == 0, done.said
    assert (done.result("LINE_COUNT"), done.result("POSITION_COUNT")) == (1, 11)
    source = ogr.Open(str(made))
    (line,) = source.GetLayer(0)
    assert line.GetField("length_m") == pytest.approx(10.0)
    assert line.GetField("mean_speed") == pytest.approx(1.0)
    # QGIS 3.22 writes no offset.
    assert line.GetField("begin").removesuffix("+00") == "2026/09/21 14:13:20"
    assert json.loads(line.geometry().ExportToJson())["coordinates"][0][:2] == [640440.0, 5193488.0]
