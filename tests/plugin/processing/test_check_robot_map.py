"""``fleet:checkrobotmap``: each finding is a feature at its place, with what to do."""

from __future__ import annotations

import pytest
from qgis.core import QgsProcessingContext, QgsProcessingException, QgsProject, QgsVectorLayer

PLACED = "%crs EPSG:32633\n%origin 600000,5100000\n%rotation 0\n"
BORDER = "border;\n-10;60;\n60;-10;\n#\n"


def obstacle(id, *points, height=3, kind=1):
    """Return the text of a ring along ``points``."""
    pairs = zip(points, [*points[1:], points[0]], strict=True)
    lines = "".join(f"{a[0]};{a[1]};\n{b[0]};{b[1]};\n{height};1;;\n#\n" for a, b in pairs)
    return f"obstacle;\n{id};{kind};{len(points)};house;\n#\n{lines}"


HOUSE = obstacle(1, (0, 0), (10, 0), (10, 10), (0, 10))
CLOCKWISE = obstacle(2, (20, 0), (20, 10), (30, 10), (30, 0))
LEVEL = obstacle(3, (40, 0), (50, 0), (50, 10), (40, 10), height=0)


@pytest.fixture
def check(provider, tmp_path, listener):
    """Run the algorithm on a text and return its outputs."""
    import processing

    project = QgsProject()

    def run(text, **parameters):
        file = tmp_path / "given.map"
        file.write_text(text)
        context = QgsProcessingContext()
        context.setProject(project)
        everything = {"MAP": str(file), "FINDINGS": "memory:", **parameters}
        return processing.run("fleet:checkrobotmap", everything, context=context, feedback=listener)

    return run


def test_a_sound_map_has_no_finding_and_says_so(check, listener):
    results = check(PLACED + BORDER + HOUSE)
    assert results["FINDING_COUNT"] == 0 and results["FINDINGS"].featureCount() == 0
    assert "Nothing is odd in this map." in listener.infos


def test_each_finding_has_kind_severity_obstacle_text_and_place(check, listener):
    results = check(PLACED + BORDER + HOUSE + CLOCKWISE + LEVEL)
    layer = results["FINDINGS"]
    found = {f["kind"]: f for f in layer.getFeatures()}
    assert set(found) == {"orientation", "height"}
    turned = found["orientation"]
    assert (turned["severity"], turned["obstacle"]) == ("error", 2)
    assert "turn it round" in turned["text"]
    box = turned.geometry().boundingBox()
    assert (box.xMinimum(), box.yMinimum(), box.xMaximum(), box.yMaximum()) == (
        600020,
        5100000,
        600030,
        5100010,
    )
    assert layer.crs().authid() == "EPSG:32633"
    counts = [results[name] for name in ("FINDING_COUNT", "ERROR_COUNT", "WARNING_COUNT", "INFO_COUNT")]
    assert counts == [2, 1, 1, 0]
    assert "error: orientation: 1" in listener.infos


def test_what_reading_found_odd_is_said_too(check, listener, fig_2):
    results = check(fig_2)
    assert any("declares 4 segments, and 1 came" in warning for warning in listener.warnings)
    kinds = [f["kind"] for f in results["FINDINGS"].getFeatures()]
    assert kinds == ["gap"]


def test_the_limits_are_parameters(check):
    room = obstacle(1, (0, 0), (0, 10), (10, 10), (10, 0), kind=1)
    house = obstacle(2, (-5, -5), (20, -5), (20, 20), (-5, 20))
    assert check(PLACED + BORDER + house + room)["INFO_COUNT"] == 1
    assert check(PLACED + BORDER + house + room, POCKET=500)["INFO_COUNT"] == 0
    assert check(PLACED + BORDER + house + room, ROBOT_WIDTH=11)["INFO_COUNT"] == 0


def test_a_limit_below_zero_and_a_missing_file_are_refused(check, tmp_path):
    with pytest.raises(QgsProcessingException, match="GAP"):
        check(BORDER + HOUSE, GAP=-1)
    with pytest.raises(QgsProcessingException, match="There is no file"):
        check(BORDER + HOUSE, MAP=str(tmp_path / "gone.map"))


def test_a_damaged_map_is_refused_with_its_line(check):
    with pytest.raises(QgsProcessingException, match=r"given\.map cannot be read: line 13"):
        check(BORDER + HOUSE.replace("10;0;\n10;10;", "10;0;\n10;ten;"))


def test_cancelling_gives_no_result(check, listener):
    listener.cancel()
    assert check(BORDER + HOUSE).get("FINDINGS") is None


def test_a_script_makes_the_layer(by_words, tmp_path):
    file, target = tmp_path / "given.map", tmp_path / "findings.gpkg"
    file.write_text(PLACED + BORDER + HOUSE + CLOCKWISE)
    done = by_words("run", "fleet:checkrobotmap", "--", f"MAP={file}", f"FINDINGS={target}")
    assert done.status == 0, done.said
    assert done.result("ERROR_COUNT") == 1
    (finding,) = QgsVectorLayer(str(target)).getFeatures()
    assert finding["kind"] == "orientation"


def test_the_campus_has_no_error(export, by_words, data, tmp_path):
    campus = data / "upc_campus_nord" / "upc_campus_nord_local.gpkg"
    layers = [f"{campus}|layername={name}" for name in ("buildings", "walls", "furniture")]
    file = export(*layers, CENTER="48,48", WIDTH=104, HEIGHT=104).file
    done = by_words("run", "fleet:checkrobotmap", "--", f"MAP={file}", f"FINDINGS={tmp_path / 'f.gpkg'}")
    assert done.status == 0, done.said
    assert done.result("ERROR_COUNT") == 0
    assert done.result("FINDING_COUNT") == QgsVectorLayer(str(tmp_path / "f.gpkg")).featureCount()
