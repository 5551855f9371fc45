"""``fleet:importconelayout``: cones of tables and layers, turned and moved to their place."""

from __future__ import annotations

from functools import partial

import pytest
from qgis.core import QgsFeature, QgsGeometry, QgsProcessingContext, QgsProcessingException, QgsVectorLayer

UTM = "EPSG:32633"
X, Y = 640500.0, 5193500.0
PLACE = f"{X},{Y} [{UTM}]"


@pytest.fixture
def bring(run_for_cones):
    """Run the algorithm and return its outputs."""
    return partial(run_for_cones, "fleet:importconelayout")


@pytest.fixture
def table(tmp_path):
    def write(text):
        file = tmp_path / "mine.csv"
        file.write_text(text, encoding="utf-8")
        return str(file)

    return write


def rows(results):
    return [
        (f["id"], f.geometry().asPoint().x() - X, f.geometry().asPoint().y() - Y, f["heading"])
        for f in results["CONES"].getFeatures()
    ]


def test_a_table_is_turned_and_then_moved(bring, table):
    file = table("x_m,y_m,to\n10,0,0\n0,5,90\n")
    first, second = rows(bring(FILE=file, ORIGIN=PLACE, ROTATION=90, HEADING_FIELD="to"))
    assert first == ("mine-1", pytest.approx(0), pytest.approx(10), pytest.approx(270))
    assert second == ("mine-2", pytest.approx(-5), pytest.approx(0), pytest.approx(0))


def test_a_row_that_cannot_be_read_is_named_and_nothing_is_placed(bring, table):
    with pytest.raises(QgsProcessingException, match=r"Row 3, column y_m: 'five' is no number; correct it\."):
        bring(FILE=table("x_m,y_m\n1,2\n3,five\n"), ORIGIN=PLACE)
    with pytest.raises(QgsProcessingException, match="There is no column 'paint': choose among x_m, y_m"):
        bring(FILE=table("x_m,y_m\n1,2\n"), ORIGIN=PLACE, COLOUR_FIELD="paint")
    with pytest.raises(QgsProcessingException, match="ORIGIN is not given: say where"):
        bring(FILE=table("x_m,y_m\n1,2\n"))
    with pytest.raises(QgsProcessingException, match="Neither FILE nor INPUT is given"):
        bring(ORIGIN=PLACE)


def test_points_with_a_crs_are_taken_as_they_lie(bring):
    points = QgsVectorLayer("Point?crs=EPSG:4326&field=nr:integer&field=paint:string", "Points", "memory")
    for number, colour in ((2, "blue"), (1, None)):
        feature = QgsFeature(points.fields())
        feature.setGeometry(QgsGeometry.fromWkt(f"POINT({16.84 + number / 1000} 46.88)"))
        feature.setAttributes([number, colour])
        points.dataProvider().addFeature(feature)
    results = bring(INPUT=points, ORDER_FIELD="nr", COLOUR_FIELD="paint")
    made = sorted(
        (f["order"], f["colour"], round(f.geometry().asPoint().y())) for f in results["CONES"].getFeatures()
    )
    assert [row[:2] for row in made] == [(1, "orange"), (2, "blue")]
    assert results["CONES"].crs().authid() == UTM
    assert 5190000 < made[0][2] < 5195000


def test_a_table_in_qgis_is_read_like_a_file(bring):
    layer = QgsVectorLayer("NoGeometry?field=e:double&field=n:double", "Table", "memory")
    feature = QgsFeature(layer.fields())
    feature.setAttributes([3.0, 4.0])
    layer.dataProvider().addFeature(feature)
    ((_, x, y, _),) = rows(bring(INPUT=layer, X_FIELD="e", Y_FIELD="n", ORIGIN=PLACE))
    assert (x, y) == pytest.approx((3, 4))


def test_cones_too_near_to_one_another_are_findings(bring, table):
    results = bring(FILE=table("x_m,y_m\n0,0\n0.2,0\n9,9\n"), ORIGIN=PLACE)
    (finding,) = results["FINDINGS"].getFeatures()
    assert finding["text"] == "Cone mine-2 is 0.20 m from mine-1: keep 0.5 m between cones."


def test_a_script_places_a_real_layout(by_words, data, tmp_path):
    target = tmp_path / "cones.gpkg"
    done = by_words(
        "run", "fleet:importconelayout", "--", f"FILE={data / 'cones' / 'cone_layouts.csv'}",
        "COLOUR_FIELD=colour", "LAYOUT_FIELD=track", "LAYOUT=fssim_acceleration", f"ORIGIN={PLACE}",
        "ROTATION=30", f"SITE_CRS={UTM}", f"CONES={target}", f"FINDINGS={tmp_path / 'findings.gpkg'}",
    )  # fmt: skip
    assert done.status == 0, done.said
    assert done.result("CONE_COUNT") == 78
    layer = QgsVectorLayer(str(target))
    assert {f["layout"] for f in layer.getFeatures()} == {"fssim_acceleration"}
    assert sum(f["colour"] == "big_orange" for f in layer.getFeatures()) == 8


def test_tracks_and_wide_tables_are_read_by_themselves(bring, table, tmp_path):
    track = tmp_path / "skidpad.yaml"
    track.write_text("cones_left: [[1, 2]]\ncones_right: [[1, -2]]\n", encoding="utf-8")
    for file in (
        str(track),
        table("blue_x,blue_y,yellow_x,yellow_y\n1,2,1,-2\n"),
        table("blue,1,2\nyellow,1,-2\n"),
    ):
        made = bring(FILE=file, ORIGIN=PLACE)["CONES"].getFeatures()
        found = [(f["colour"], f.geometry().asPoint().y() - Y) for f in made]
        assert found == [("blue", pytest.approx(2)), ("yellow", pytest.approx(-2))]


def test_a_file_that_is_not_there_is_named_before_a_crs_is_asked_for(provider, listener, tmp_path):
    import processing

    file = tmp_path / "track.csv"
    said = r"track\.csv cannot be read: No such file or directory"
    with pytest.raises(QgsProcessingException, match=said):
        processing.run(
            "fleet:importconelayout",
            {"FILE": str(file), "ORIGIN": "0,0", "CONES": "memory:"},
            context=QgsProcessingContext(),
            feedback=listener,
        )


def test_a_file_of_another_kind_is_refused_with_what_is_read(bring, tmp_path):
    drawing = tmp_path / "track.dxf"
    drawing.touch()
    with pytest.raises(QgsProcessingException, match=r"track\.dxf is none that is read: give one of \.csv, "):
        bring(FILE=str(drawing), ORIGIN=PLACE)
