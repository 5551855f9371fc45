"""``fleet:asplacedreport``: a PDF of placed cones, in QGIS and by ``qgis_process``."""

from __future__ import annotations

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from fleet_supervisor.plugin.processing.algorithms import as_placed_report
from fleet_supervisor.plugin.processing.common.placed_cones import (
    PlacedCone,
    bars,
    cone_deviations,
    extent_of,
    factor_of,
    histogram,
    map_layers,
    ticks,
)
from fleet_supervisor.plugin.processing.common.report_layout import (
    ReportContent,
    ReportPages,
    shared_widths,
    shortened,
    widths_of,
)
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsLayoutItemLabel,
    QgsLayoutItemMap,
    QgsLayoutItemTextTable,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProject,
)
from qgis.gui import QgsMessageBar

from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from robot_bridge.gateway.storage.repositories import records
from robot_bridge.gateway.storage.repositories.records import NewPlacement
from tests.support.bridge.command_line import run_command

FIELDS = (
    "&field=planned_easting:double&field=planned_northing:double&field=easting:double&field=northing:double"
    "&field=cone:string&field=robot:string&field=layout:string&field=placed_at:datetime"
)
E, N = 640450.0, 5193500.0
UTM = "EPSG:32633"


def rows(*offs):
    return [
        (
            f"Point({E + 5 * k + east} {N + north})",
            E + 5 * k,
            N,
            E + 5 * k + east,
            N + north,
            f"c{k}",
            "r1",
            "slalom",
            None,
        )
        for k, (east, north) in enumerate(offs)
    ]


def cones(*offs):
    return [
        PlacedCone(f"c{k}", "r1", "slalom", (E + 5 * k, N), (E + 5 * k + east, N + north), None)
        for k, (east, north) in enumerate(offs)
    ]


def pages_of(report, folder):
    """Return the layouts of the report's pages."""
    project = QgsProject()
    project.setCrs(report.crs)
    pages, found = ReportPages(report, project, folder), []
    while pages.next():
        found.append(pages.layout())
    assert len(found) == pages.count()
    return project, found


def texts_of(layouts):
    return "\n".join(
        item.text() for layout in layouts for item in layout.items() if isinstance(item, QgsLayoutItemLabel)
    )


def tables_of(layouts):
    """Return the table of each page that has one, and the texts of all their cells."""
    tables = [
        frame
        for layout in layouts
        for frame in layout.multiFrames()
        if isinstance(frame, QgsLayoutItemTextTable)
    ]
    rows = [row for table in tables for row in table.contents()]
    return tables, [[cell.content() if hasattr(cell, "content") else cell for cell in row] for row in rows]


@pytest.fixture
def run(provider, listener, tmp_path):
    """Run the algorithm into report.pdf and return what it gave."""
    import processing

    def run(**parameters):
        context = QgsProcessingContext()
        context.setProject(QgsProject())
        everything = {"OUTPUT": str(tmp_path / "report.pdf"), **parameters}
        return processing.run("fleet:asplacedreport", everything, context=context, feedback=listener)

    return run


def test_figures_and_a_pdf(run, make_layer, tmp_path):
    layer = make_layer("placed", "Point", FIELDS, rows((0.03, 0.04), (0.0, 0.2), (-0.3, 0.0)), crs=UTM)
    told = run(INPUT=layer)
    assert (told["CONE_COUNT"], told["WITHIN_COUNT"], told["PAGE_COUNT"]) == (3, 2, 2)
    assert told["MEAN"] == pytest.approx((0.05 + 0.2 + 0.3) / 3)
    assert told["RMS"] == pytest.approx(((0.05**2 + 0.2**2 + 0.3**2) / 3) ** 0.5)
    assert told["MAX"] == pytest.approx(0.3)
    assert (tmp_path / "report.pdf").read_bytes().startswith(b"%PDF-")
    assert [file.name for file in tmp_path.iterdir()] == ["report.pdf"]


def test_the_layout_says_it_all(qgis_app, tmp_path):
    offs = [(0.03, 0.04), (0.0, 0.1), (-0.3, 0.0)]
    given = sorted(cones(*offs), key=lambda cone: -cone.deviation)
    crs = QgsCoordinateReferenceSystem(UTM)
    _project, layouts = pages_of(
        ReportContent("Slalom", given, cone_deviations(given, 0.2), 0.2, crs), tmp_path
    )
    texts = texts_of(layouts)
    assert "Slalom" in texts
    assert "2 of 3 cones (67 %) stand within 20 cm" in texts
    assert "EPSG:32633 - WGS 84 / UTM zone 33N" in texts
    assert "! beyond the tolerance of 20 cm" in texts
    assert "Slalom · 2 / 2" in texts
    assert "largest 30.0 cm" in texts
    (table,), contents = tables_of(layouts)
    assert contents[0] == ["c2", "slalom", "r1", "", "640460.00", "5193500.00", "-30.0", "+0.0", "30.0", "!"]
    assert [row[0] for row in contents] == ["c2", "c1", "c0"]
    (shown,) = (item for item in layouts[0].items() if isinstance(item, QgsLayoutItemMap))
    assert shown.extent().contains(extent_of(given))
    assert [layer.name() for layer in shown.layers()] == ["Deviations", "Planned", "Beyond", "Within"]
    # Nothing of the table beyond the paper's margins.
    assert table.totalSize().width() <= 180.0


def text_of(given, tmp_path):
    crs = QgsCoordinateReferenceSystem(UTM)
    _project, layouts = pages_of(
        ReportContent("Slalom", given, cone_deviations(given, 0.2), 0.2, crs), tmp_path
    )
    return texts_of(layouts)


def test_robots_stand_in_the_order_of_their_numbers_and_a_day_is_named_once(qgis_app, tmp_path):
    begin = 1_790_000_000.0
    given = [
        PlacedCone(f"c{k}", f"r{k}", "", (E, N), (E + 0.01 * k, N), begin + 60 * k) for k in (10, 9, 2, 1)
    ]
    told = text_of(given, tmp_path)
    assert "Robots: r1, r2, r9, r10" in told
    assert "2026-09-21 14:14:20 to 14:23:20 UTC" in told
    assert "2026-09-21 14:14:20 UTC;" in text_of(given[-1:], tmp_path)
    later = replace(given[0], at=begin + 86_400)
    assert "2026-09-21 14:14:20 to 2026-09-22 14:13:20 UTC" in text_of([later, given[-1]], tmp_path)


def test_a_metre_is_told_in_metres_and_a_line_of_true_length_as_such(qgis_app, tmp_path):
    told = text_of(cones((0.0, 0.0), (7.0, 0.0)), tmp_path)
    assert "largest 7.00 m" in told
    assert "times as long" not in told
    assert "10 times as long" in text_of(cones((0.0, 0.0), (0.1, 0.0)), tmp_path)


def test_long_names_are_told_apart_on_every_page_of_the_table(qgis_app, tmp_path):
    names = [f"constant-radius-circle-{k:03d}" for k in range(100)]
    given = [replace(cones((0.01, 0.0))[0], name=name, layout="circle-of-a-hundred-metres") for name in names]
    crs = QgsCoordinateReferenceSystem(UTM)
    _project, layouts = pages_of(
        ReportContent("Circle", given, cone_deviations(given, 0.2), 0.2, crs), tmp_path
    )
    tables, contents = tables_of(layouts)
    assert len(tables) == 2
    (columns,) = {tuple(column.width() for column in table.columns()) for table in tables}
    letters = widths_of(layouts[1], tables[0].contentTextFormat())
    for row in contents:
        assert all(letters(text) <= width for text, width in zip(row, columns, strict=True))
    assert [row[0][-3:] for row in contents] == [name[-3:] for name in names]
    assert sum(columns) == pytest.approx(164.0)
    # None is continued where nobody sees it, and none would have room for another row.
    assert [round(table.totalSize().height()) for table in tables] == [264, 264]
    full = tables[0]
    full.setContents([*full.contents(), full.contents()[0]])
    assert full.totalSize().height() > 265


@pytest.mark.parametrize(
    ("needs", "given"),
    [
        ([10, 10, 10], [10, 10, 40]),
        ([10, 50, 50], [10, 25, 25]),
        ([90, 5, 15], [40, 5, 15]),
        ([0, 0, 0], [0, 0, 60]),
    ],
)
def test_what_a_column_does_not_need_the_longest_gets(needs, given):
    assert shared_widths(60, needs) == given


def test_a_text_loses_its_middle():
    assert shortened("slalom-12", 9, len) == "slalom-12"
    assert shortened("slalom-12", 7, len) == "sla…-12"
    assert shortened("slalom-12", 1, len) == "…"


@pytest.mark.parametrize(
    ("most", "marks"),
    [
        (1, [0, 1]),
        (4, [0, 1, 2, 3, 4]),
        (7, [0, 2, 4, 6]),
        (29, [0, 5, 10, 15, 20, 25]),
        (61, [0, 20, 40, 60]),
    ],
)
def test_the_axis_of_cones_has_round_numbers(most, marks):
    assert ticks(most) == marks


def test_the_map_tells_good_from_bad_and_draws_deviations_longer(qgis_app):
    given = cones((0.03, 0.04), (0.0, 0.2), (-0.3, 0.0))
    factor = factor_of(given, 40.0)
    assert factor == 10
    lines, planned, beyond, within = map_layers(given, QgsCoordinateReferenceSystem(UTM), 0.2, factor)
    assert [layer.featureCount() for layer in (lines, planned, beyond, within)] == [3, 3, 1, 2]
    ends = [f.geometry().asPolyline()[-1] for f in lines.getFeatures()]
    assert [(round(p.x() - E - 5 * k, 6), round(p.y() - N, 6)) for k, p in enumerate(ends)] == [
        (0.3, 0.4),
        (0, 2),
        (-3, 0),
    ]
    assert factor_of(cones((0.0, 0.0)), 40.0) == 1


def test_bars_end_at_the_tolerance_and_count_every_cone_once():
    for values in ([0.05, 0.2, 0.2, 0.21], [0.0], [3.0, 0.1], [500.0, 0.1]):
        counts, edges = bars(np.array(values), 0.2)
        assert counts.sum() == len(values)
        assert np.isclose(edges, 0.2).any()
        within = int(counts[edges[1:] <= 0.2 + 1e-9].sum())
        assert within == sum(value <= 0.2 for value in values)
    assert "last bar: up to 500.00 m" in histogram(np.array([500.0, 0.1]), 0.2)


def test_many_cones_take_more_pages_with_the_window_at_work_between_them(run, make_layer, listener):
    """QGIS's dialog handles events, F10 and Cancel among them, at each progress."""
    progress = []
    listener.progressChanged.connect(progress.append)
    layer = make_layer("placed", "Point", FIELDS, rows(*[(0.01, 0.0)] * 200), crs=UTM)
    pages = run(INPUT=layer)["PAGE_COUNT"]
    assert pages >= 4
    assert len([percent for percent in progress if 50 <= percent < 100]) >= pages


def test_a_report_is_cancelled_between_two_pages(provider, cancels_at, make_layer, tmp_path):
    import processing

    layer = make_layer("placed", "Point", FIELDS, rows(*[(0.01, 0.0)] * 200), crs=UTM)
    parameters = {"INPUT": layer, "OUTPUT": str(tmp_path / "report.pdf")}
    made = processing.run("fleet:asplacedreport", parameters, feedback=cancels_at(70))
    assert "PAGE_COUNT" not in made and list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("fields", "features", "more", "text"),
    [
        (FIELDS, [], {}, "no placed cones to report on"),
        ("&field=name:string", [("Point(0 0)", "c")], {}, "no field planned_easting.*placements export"),
        (
            FIELDS,
            rows((0, 0)),
            {"OUTPUT": "/nowhere/report.pdf"},
            "The report .* no folder /nowhere",
        ),
        (FIELDS, rows((0, 0)), {"CRS": "EPSG:4326"}, "EPSG:4326 .* cannot carry a site"),
    ],
    ids=["nothing", "other layer", "no folder", "degrees"],
)
def test_what_cannot_be_reported_is_said(run, make_layer, fields, features, more, text):
    layer = make_layer("placed", "Point", fields, features, crs=UTM)
    with pytest.raises(QgsProcessingException, match=text):
        run(INPUT=layer, **more)


def test_features_without_places_are_left_out_and_counted(run, make_layer, listener):
    odd = (None, None, N, E, N, "c9", "r1", "slalom", None)
    told = run(INPUT=make_layer("placed", "Point", FIELDS, [*rows((0.1, 0)), odd], crs=UTM))
    assert (told["CONE_COUNT"], told["WARNING_COUNT"]) == (1, 1)
    assert "1 feature has no planned or no placed position" in listener.warnings[0]


@pytest.fixture
def exported(root, tmp_path):
    """Return how a gateway's placed cones, one of them far off, are exported under a name."""
    database = f"sqlite:///{tmp_path}/fleet.db"
    run_once(database, revisions.create)
    for n, off in enumerate((0.05, 0.1, 0.5)):
        x = 40.0 + 4 * n
        where = {"planned_x": x, "planned_y": 8.0, "x": x, "y": 8.0 + off, "theta": 0.0, "deviation": off}
        known = {"task": f"task-{n}", "robot": "r1", "command": f"command-{n}", "cone": f"c{n}"}
        placement = NewPlacement(**where, **known, layout="slalom", placed_at=1_790_000_000.0 + n)
        run_once(database, records.add_placed_cones, placement)

    def export(name):
        site = root / "resources" / "sample_site"
        done = run_command("placements", "export", tmp_path / name, "--site", site, "--database", database)
        assert done.returncode == 0, done.stderr
        return tmp_path / name

    return export


@pytest.mark.parametrize("name", ["cones.gpkg", "cones.csv"])
def test_a_gateways_export_becomes_a_report_by_a_script(by_words, exported, root, tmp_path, name):
    file, made = exported(name), tmp_path / "made.pdf"
    given = [f"INPUT={file}|layername=placed"] if name.endswith("gpkg") else [f"INPUT={file}", f"CRS={UTM}"]
    photo = root / "resources" / "sample_site" / "orthophoto.tif"
    done = by_words("run", "fleet:asplacedreport", "--", *given, f"BACKGROUND={photo}", f"OUTPUT={made}")
    assert done.status == 0, done.said
    assert (done.result("CONE_COUNT"), done.result("WITHIN_COUNT")) == (3, 2)
    assert done.result("MAX") == pytest.approx(0.5)
    content = made.read_bytes()
    assert content.startswith(b"%PDF-")
    assert re.search(rb"/Count 2\b", content)
    # The photo lies beneath the cones.
    assert re.search(rb"/Subtype\s*/Image", content)


def test_a_csv_without_a_crs_is_refused_with_what_to_give(by_words, exported, tmp_path):
    done = by_words(
        "run",
        "fleet:asplacedreport",
        "--",
        f"INPUT={exported('cones.csv')}",
        f"OUTPUT={tmp_path / 'made.pdf'}",
    )
    assert done.status != 0
    assert "give CRS, the site's, such as EPSG:32633" in done.said


def test_the_window_is_told_where_the_report_is(qgis_app, run, make_layer, monkeypatch, tmp_path):
    bar = QgsMessageBar()
    monkeypatch.setattr(as_placed_report, "iface", SimpleNamespace(messageBar=lambda: bar))
    run(INPUT=make_layer("placed", "Point", FIELDS, rows((0.1, 0)), crs=UTM), OUTPUT=f"{tmp_path}/a & b.pdf")
    (item,) = bar.items()
    assert f'<a href="file://{tmp_path}/a%20%26%20b.pdf">{tmp_path}/a &amp; b.pdf</a>' in item.text()


def test_without_a_window_nothing_is_told(run, make_layer, monkeypatch):
    monkeypatch.setattr(as_placed_report, "iface", None)
    assert run(INPUT=make_layer("placed", "Point", FIELDS, rows((0.1, 0)), crs=UTM))["PAGE_COUNT"] == 2
