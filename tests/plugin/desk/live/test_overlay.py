"""Robots are painted where they are, pointing where they point, whatever the map's CRS and rotation."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from fleet_supervisor.plugin.desk.colours import CONE as CONE_COLOUR
from fleet_supervisor.plugin.desk.colours import REFUSED, SELECTED, STATE_COLOURS, TRAIL
from fleet_supervisor.plugin.desk.drafts import CONE, ROUTE, TARGETS, Draft, Findings
from fleet_supervisor.plugin.desk.live.in_view import in_view
from fleet_supervisor.plugin.desk.live.overlay import FleetOverlay
from fleet_supervisor.plugin.desk.live.plans import Plan
from fleet_supervisor.plugin.desk.live.scene import Placer, Scene
from fleet_supervisor.plugin.desk.live.trails import Trails
from fleet_supervisor.plugin.desk.picture import STATES, RobotArrays
from fleet_supervisor.plugin.desk.placement import Placement
from fleet_supervisor.plugin.errors import PlacementError
from fleet_supervisor.robot_bridge.messages import RobotState
from qgis.core import QgsCoordinateReferenceSystem, QgsPointXY, QgsProject, QgsRectangle
from qgis.gui import QgsMapCanvas
from qgis.PyQt.QtCore import QRectF, QSize
from qgis.PyQt.QtGui import QColor, QImage, QPainter
from qgis.PyQt.QtWidgets import QApplication

BLUE = STATE_COLOURS[RobotState.FRESH]


@pytest.fixture
def canvas(qgis_app):
    made = QgsMapCanvas()
    made.resize(600, 500)
    made.show()
    QApplication.processEvents()
    yield made
    made.stopRendering()
    made.close()
    made.deleteLater()


def arrays(*robots, v=np.nan, accuracy=np.nan, age=0.0) -> RobotArrays:
    number = len(robots)
    return RobotArrays(
        names=[f"r{k}" for k in range(1, number + 1)],
        xy=np.array([(x, y) for x, y, _, _ in robots], dtype=float).reshape(-1, 2),
        theta=np.array([theta for _, _, theta, _ in robots], dtype=float),
        v=np.full(number, v),
        accuracy=np.full(number, accuracy),
        state=np.array([STATES.index(state) for _, _, _, state in robots], dtype=np.intp),
        age=np.full(number, age),
    )


def scene_of(*robots, chosen=(), plans=(), draft=None, now=100.0, **more) -> Scene:
    known = arrays(*robots, **more)
    rows = {name: row for row, name in enumerate(known.names)}
    return Scene(known, now=now, chosen=chosen, plans=list(plans), draft=draft, rows=rows)


def plan(robot, *points, cone=False) -> Plan:
    points = np.array(points, dtype=float)
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    return Plan(f"command-{robot}", robot, points, along, cone)


def placement_of(canvas, site) -> Placement:
    return Placement(site, canvas.mapSettings().destinationCrs(), QgsProject.instance().transformContext())


def show(canvas, site, scene, crs="EPSG:32633", rotation=0.0, trails=None) -> FleetOverlay:
    canvas.setDestinationCrs(QgsCoordinateReferenceSystem(crs))
    placement = placement_of(canvas, site)
    canvas.setRotation(rotation)
    corners = placement.to_map(np.array([(0, 0), (120, 0), (120, 100), (0, 100)], dtype=float))
    canvas.setExtent(QgsRectangle(*corners.min(axis=0), *corners.max(axis=0)))
    QApplication.processEvents()
    overlay = FleetOverlay(canvas, trails)
    overlay.show_scene(Placer().placed(scene, placement))
    QApplication.processEvents()
    return overlay


def spots(canvas, colour: QColor, tolerance: int = 12) -> np.ndarray:
    """Return the (n, 2) pixels of the canvas that have ``colour``."""
    image = canvas.grab().toImage().convertToFormat(QImage.Format.Format_RGB32)
    return where(image, colour, tolerance)


def where(image: QImage, colour: QColor, tolerance: int = 12) -> np.ndarray:
    bits = image.bits()
    bits.setsize(image.sizeInBytes())
    pixels = np.frombuffer(bits, np.uint8).reshape(image.height(), image.bytesPerLine() // 4, 4)
    wanted = np.array([colour.blue(), colour.green(), colour.red()], dtype=int)
    y, x = np.nonzero((np.abs(pixels[:, : image.width(), :3].astype(int) - wanted) <= tolerance).all(axis=2))
    return np.column_stack([x, y])


def expected(canvas, site, x, y) -> np.ndarray:
    """Return the pixel of a place in the site frame, by a way of its own through QGIS point by point."""
    from qgis.core import QgsCoordinateTransform

    c, s = math.cos(site.rotation), math.sin(site.rotation)
    east, north = site.origin[0] + c * x - s * y, site.origin[1] + s * x + c * y
    to_map = QgsCoordinateTransform(
        QgsCoordinateReferenceSystem(site.crs), canvas.mapSettings().destinationCrs(), QgsProject.instance()
    )
    at = canvas.getCoordinateTransform().transform(to_map.transform(QgsPointXY(east, north)))
    return np.array([at.x(), at.y()])


@pytest.mark.parametrize("site_rotation", [0.0, 0.7])
@pytest.mark.parametrize("map_rotation", [0.0, 35.0, 180.0])
@pytest.mark.parametrize("crs", ["EPSG:32633", "EPSG:3857", "EPSG:4326"])
def test_a_robot_is_painted_where_it_is_and_points_where_it_points(
    canvas, site, crs, map_rotation, site_rotation
):
    site = dataclasses.replace(site, rotation=site_rotation)
    theta = 0.4
    show(canvas, site, scene_of((60, 50, theta, RobotState.FRESH)), crs, map_rotation)
    blue = spots(canvas, BLUE)
    assert len(blue) > 60
    at = expected(canvas, site, 60, 50)
    assert np.hypot(*(blue - at).T).max() < 16.0
    # The arrow's point is the blue farthest ahead of the robot's place; its last pixels are blended.
    ahead = expected(canvas, site, 60 + 5 * math.cos(theta), 50 + 5 * math.sin(theta)) - at
    tip = blue[np.argmax((blue - at) @ ahead)] - at
    turn = math.degrees(math.atan2(tip[1], tip[0]) - math.atan2(ahead[1], ahead[0]))
    assert abs((turn + 180) % 360 - 180) < 8.0
    assert np.hypot(*tip) == pytest.approx(10.5, abs=2.0)
    assert ((blue - at) @ ahead).min() / np.hypot(*ahead) > -11.0


@pytest.mark.parametrize("state", STATES)
def test_each_state_has_its_colour_and_its_own_shape(canvas, site, state):
    show(canvas, site, scene_of((60, 50, 0.0, state), age=5.0))
    assert len(spots(canvas, STATE_COLOURS[state])) > 20


def test_states_differ_without_their_colours(qgis_app):
    from fleet_supervisor.plugin.desk.glyphs import CELL
    from fleet_supervisor.plugin.desk.live.atlases import robot_atlas

    grey = QImage.Format.Format_Grayscale8
    atlases = [robot_atlas(1.0, 1.0, state).toImage().convertToFormat(grey) for state in STATES]
    cells = [atlas.copy(0, 0, CELL, CELL) for atlas in atlases]
    tables = [np.frombuffer(as_bytes(cell), np.uint8) for cell in cells]
    for first in range(len(tables)):
        for second in range(first):
            assert (np.abs(tables[first].astype(int) - tables[second]) > 40).sum() > 60


def as_bytes(image: QImage) -> bytes:
    bits = image.constBits()
    bits.setsize(image.sizeInBytes())
    return bytes(bits)


def test_what_is_gone_is_painted_no_more(canvas, site):
    overlay = show(canvas, site, scene_of(*[(20 + 20 * i, 50, 0, RobotState.FRESH) for i in range(4)]))
    many = len(spots(canvas, BLUE))
    overlay.show_scene(Placer().placed(scene_of((20, 50, 0, RobotState.FRESH)), placement_of(canvas, site)))
    QApplication.processEvents()
    assert len(spots(canvas, BLUE)) == pytest.approx(many / 4, rel=0.2)
    overlay.show_scene(None)
    QApplication.processEvents()
    assert len(spots(canvas, BLUE)) == 0


def test_robots_stay_in_place_when_the_map_is_moved_and_zoomed(canvas, site):
    show(canvas, site, scene_of((60, 50, 0.0, RobotState.FRESH)))
    canvas.zoomByFactor(0.5)
    canvas.setCenter(QgsPointXY(site.origin[0] + 70, site.origin[1] + 45))
    QApplication.processEvents()
    blue = spots(canvas, BLUE)
    assert np.hypot(*(blue.mean(axis=0) - expected(canvas, site, 60, 50))) < 4.0


@pytest.mark.parametrize("ratio", [1.0, 1.5, 2.0])
def test_on_a_dense_screen_robots_have_the_same_size_and_place(canvas, site, ratio):
    overlay = show(canvas, site, scene_of((60, 50, 0.0, RobotState.FRESH)))
    image = QImage(QSize(600, 500) * ratio, QImage.Format.Format_RGB32)
    image.setDevicePixelRatio(ratio)
    image.fill(QColor("white"))
    painter = QPainter(image)
    overlay.paint(painter)
    painter.end()
    blue = where(image, BLUE) / ratio
    assert np.hypot(*(blue - expected(canvas, site, 60, 50)).T).max() < 16.0
    assert blue[:, 0].max() - blue[:, 0].min() == pytest.approx(20.0, abs=2.5)


def test_the_selected_robot_wears_a_ring(canvas, site):
    show(canvas, site, scene_of((60, 50, 0.0, RobotState.FRESH), chosen=("r1",)))
    ring = spots(canvas, SELECTED) - expected(canvas, site, 60, 50)
    assert len(ring) > 60
    assert np.hypot(*ring.T) == pytest.approx(18.0, abs=2.0)


def test_a_trail_fades_with_age(canvas, site):
    trails = Trails()
    for second in range(90):
        trails.extend(np.array([[10.0 + second, 20.0]]), float(second))
    scene = scene_of((99, 20, 0.0, RobotState.FRESH), now=89.0)
    overlay = show(canvas, site, scene, trails=trails)
    shown = Placer().placed(scene, placement_of(canvas, site))
    for _ in range(20):
        overlay.show_scene(shown)
    image = canvas.grab().toImage()

    def colour(x):
        at = expected(canvas, site, x, 20.0)
        return QColor(image.pixel(round(at[0]), round(at[1])))

    new, middle, old = colour(92), colour(55), colour(13)
    assert abs(new.red() - TRAIL.red()) < 30
    assert new.red() < middle.red() < old.red()


def test_a_cone_target_stands_on_its_spot(canvas, site):
    from fleet_supervisor.plugin.desk.colours import CONE as ORANGE

    show(canvas, site, scene_of(plans=[plan("r1", (40.0, 70.0), cone=True)]))
    foot = expected(canvas, site, 40, 70)
    orange = spots(canvas, ORANGE) - foot
    assert len(orange) > 40
    assert abs(orange[:, 0].mean()) < 1.5
    assert -22 < orange[:, 1].min() < -15
    assert orange[:, 1].max() < 3


def test_a_draft_is_painted_and_a_refused_one_is_red(canvas, site):
    from fleet_supervisor.plugin.desk.colours import REFUSED

    draft = Draft("r1", CONE, ((40.0, 70.0),), Findings(refused=("outside",)))
    show(canvas, site, scene_of((60, 50, 0.0, RobotState.FRESH), draft=draft))
    assert len(spots(canvas, REFUSED)) > 30


def test_a_draft_of_many_targets_is_painted_where_they_are_and_a_refused_one_is_red(canvas, site):
    places = tuple((10.0 + 10 * (k % 10), 10.0 + 10 * (k // 10)) for k in range(80))
    draft = Draft("r1", TARGETS, places, is_checked=True)
    show(canvas, site, scene_of(draft=draft))
    cones = spots(canvas, CONE_COLOUR)
    for x, y in places:
        away = cones - expected(canvas, site, x, y) - (0.0, -5.0)
        assert np.hypot(*away.T).min() < 4.0
    assert len(spots(canvas, REFUSED)) == 0
    wrong = dataclasses.replace(draft, findings=Findings(overridable=("in the way",)))
    show(canvas, site, scene_of(draft=wrong))
    assert len(spots(canvas, REFUSED)) > 200


def test_a_draft_of_many_points_is_drawn_once_and_anew_when_the_map_or_the_draft_has_changed(
    canvas, site, monkeypatch
):
    from fleet_supervisor.plugin.desk.live import draft_painting

    drawn, draw = [], draft_painting._drawn
    monkeypatch.setattr(draft_painting, "_drawn", lambda *given: drawn.append(1) or draw(*given))
    places = tuple((10.0 + k, 50.0) for k in range(80))
    draft = Draft("r1", ROUTE, places, legs=(1,) * 80, is_checked=True)
    overlay = show(canvas, site, scene_of(draft=draft))
    placer = Placer()
    for now in (101.0, 102.0, 103.0):
        overlay.show_scene(placer.placed(scene_of(draft=draft, now=now), placement_of(canvas, site)))
        canvas.grab()
    before = len(drawn)
    placement = placement_of(canvas, site)
    for now in (104.0, 105.0, 106.0):
        overlay.show_scene(placer.placed(scene_of(draft=draft, now=now), placement))
        canvas.grab()
    assert len(drawn) == before + 1
    moved = dataclasses.replace(draft, points=(*places[:-1], (90.0, 60.0)))
    overlay.show_scene(placer.placed(scene_of(draft=moved, now=107.0), placement))
    canvas.grab()
    assert len(drawn) == before + 2


def test_the_robot_under_the_mouse_is_found(canvas, site):
    overlay = show(
        canvas, site, scene_of((60, 50, 0, RobotState.FRESH), (70, 50, 0, RobotState.LOST), age=40.0)
    )
    assert overlay.robot_at(*expected(canvas, site, 70, 50)) == "r2"
    x, y = expected(canvas, site, 70, 50)
    assert overlay.robot_at(x, y + 30) is None


def test_a_site_crs_that_qgis_does_not_know_is_named(site):
    with pytest.raises(PlacementError, match="EPSG:999999"):
        Placement(
            dataclasses.replace(site, crs="EPSG:999999"),
            QgsCoordinateReferenceSystem("EPSG:4326"),
            QgsProject.instance().transformContext(),
        )


def test_a_position_beyond_the_map_projection_is_an_error_in_words(site):
    placement = Placement(
        site, QgsCoordinateReferenceSystem("EPSG:3857"), QgsProject.instance().transformContext()
    )
    with pytest.raises(PlacementError, match="Choose the site's CRS"):
        placement.to_map(np.array([(1e12, 1e12)]))


def test_points_come_back_from_every_crs(site):
    site = dataclasses.replace(site, rotation=-0.9)
    for crs in ("EPSG:32633", "EPSG:3857", "EPSG:4326", "EPSG:23700"):
        placement = Placement(
            site, QgsCoordinateReferenceSystem(crs), QgsProject.instance().transformContext()
        )
        ((x, y),) = placement.to_map(np.array([(12.5, 80.25)]))
        assert placement.to_site(QgsPointXY(x, y)) == pytest.approx((12.5, 80.25), abs=0.002)


def test_speed_is_a_line_to_where_the_robot_will_be_soon(canvas, site):
    show(canvas, site, scene_of((60, 50, 0.0, RobotState.FRESH), v=4.0), rotation=30.0)
    image = canvas.grab().toImage()

    def brightness(x, y):
        at = expected(canvas, site, x, y)
        return QColor(image.pixel(round(at[0]), round(at[1]))).lightness()

    # White on a casing that is darker than the white canvas, up to 2 s ahead and no farther.
    off = [brightness(67.2, 50 + side) for side in (-0.42, 0.42)]
    assert brightness(67.2, 50) > 240 and min(off) < 200
    assert brightness(70, 50.35) == brightness(50, 50.35) == 255


def test_a_robot_whose_heading_is_not_known_has_no_line_of_speed(canvas, site):
    show(canvas, site, scene_of((60, 50, 0.0, RobotState.FRESH), v=0.0))
    still = canvas.grab().toImage()
    show(canvas, site, scene_of((60, 50, np.nan, RobotState.FRESH), v=4.0))
    image = canvas.grab().toImage()
    ahead = expected(canvas, site, 67.2, 50).round().astype(int)
    around = [(ahead[0], ahead[1] + side) for side in (-2, -1, 0, 1, 2)]
    assert [image.pixel(x, y) for x, y in around] == [still.pixel(x, y) for x, y in around]


@pytest.mark.parametrize("crs", ["EPSG:32633", "EPSG:3857", "EPSG:4326"])
def test_accuracy_is_a_circle_of_so_many_metres_in_any_crs(canvas, site, crs):
    show(canvas, site, scene_of((60, 50, 0.0, RobotState.FRESH), accuracy=20.0), crs)
    image = canvas.grab().toImage()
    inside, outside = [], []
    for turn in np.linspace(0, 2 * np.pi, 16, endpoint=False):
        for metres, found in ((18.5, inside), (21.5, outside)):
            at = expected(canvas, site, 60 + metres * math.cos(turn), 50 + metres * math.sin(turn))
            found.append(QColor(image.pixel(round(at[0]), round(at[1]))).name())
    assert "#ffffff" not in inside
    assert set(outside) == {"#ffffff"}


def test_many_robots_are_drawn_small_and_those_to_be_noticed_larger(canvas, site):
    def width(colour, number):
        grid = [(3.0 * (k % 40), 3.0 * (k // 40), math.nan, RobotState.FRESH) for k in range(number)]
        overlay = show(canvas, site, scene_of(*grid, (60, 95, math.nan, RobotState.LOST)))
        found = spots(canvas, colour)
        canvas.scene().removeItem(overlay)
        at = expected(canvas, site, 60, 95)
        near = found[np.hypot(*(found - at).T) < 16]
        return np.ptp(near[:, 0])

    red = STATE_COLOURS[RobotState.LOST]
    assert width(red, 10) > width(red, 1240) > 8


def test_a_lost_robot_lies_over_a_fresh_one_and_a_selected_one_over_both(canvas, site):
    def colours(*states, chosen=()):
        overlay = show(canvas, site, scene_of(*[(60, 50, 0.0, state) for state in states], chosen=chosen))
        counts = [len(spots(canvas, STATE_COLOURS[state])) for state in (RobotState.FRESH, RobotState.LOST)]
        canvas.scene().removeItem(overlay)
        return counts

    lost, fresh = RobotState.LOST, RobotState.FRESH
    (_, red), (blue, _) = colours(lost), colours(fresh)
    assert colours(lost, fresh)[1] == colours(fresh, lost)[1] == red > 20
    assert colours(lost, fresh, chosen=("r2",))[0] == blue > 20
    assert colours(fresh, lost, chosen=("r1",))[0] == blue


def test_robots_are_painted_layer_after_layer_from_the_top_and_those_side_by_side_in_their_order(qgis_app):
    from fleet_supervisor.plugin.desk.live.robots_painting import STRIP, _from_the_top

    y = np.array([790.0, 3.0, 2.0, -9.0, 5000.0, 790.0 - STRIP])
    assert _from_the_top(np.array([0, 0, 0, 0, 0, 0]), y).tolist() == [1, 2, 3, 5, 0, 4]
    assert _from_the_top(np.array([0, 7, 0, 7, 2, 0]), y).tolist() == [2, 5, 0, 4, 1, 3]
    in_a_strip = np.random.default_rng(1).uniform(STRIP, 2 * STRIP, 300)
    assert _from_the_top(np.ones(300, dtype=np.intp), in_a_strip).tolist() == list(range(300))
    assert _from_the_top(np.array([], dtype=np.intp), y[:0]).tolist() == []


def test_the_names_of_a_crowd_do_not_cover_each_other_and_the_lost_are_named_first(canvas, site):
    from fleet_supervisor.plugin.desk.live.labels import HEIGHT, Labels
    from fleet_supervisor.plugin.desk.live.names_painting import BESIDE, NamesPainter

    spread = np.random.default_rng(3).uniform(5, 95, (200, 2)).tolist()
    crowd = [(x, y, 0.0, RobotState.FRESH) for x, y in spread]
    scene = scene_of(*crowd, (51, 51, 0.0, RobotState.LOST), age=75.0)
    overlay = show(canvas, site, scene)
    names = NamesPainter(Labels())
    screen = overlay.screen()
    pixels = screen.pixels(overlay._placed.robots)
    chosen = names._chosen(overlay._placed, in_view(overlay._placed, screen), screen)
    assert chosen[0] == 200
    assert 20 < len(chosen) < 200
    boxes = [QRectF(*(pixels[row] + BESIDE), 8 * len(f"r{row + 1}"), HEIGHT - 1) for row in chosen[1:]]
    assert not [1 for k, box in enumerate(boxes) for other in boxes[:k] if box.intersects(other)]


def test_the_age_of_the_last_message_is_written_beside_a_lost_robot(qgis_app):
    from fleet_supervisor.plugin.desk.live.names_painting import texts

    known = arrays((0, 0, 0, RobotState.LOST), (1, 1, 0, RobotState.FRESH), age=75.0)
    assert texts(known, 0) == ["r1", "· lost 1 min"]
    assert texts(known, 1) == ["r2"]


def written_after(canvas, site, first, second):
    """Return what is written beside robots, painted as ``first`` and then as ``second``."""
    from fleet_supervisor.plugin.desk.live.labels import Labels
    from fleet_supervisor.plugin.desk.live.names_painting import NamesPainter

    names = NamesPainter(Labels())
    image = QImage(canvas.size(), QImage.Format.Format_ARGB32_Premultiplied)
    for scene in (first, second):
        overlay = show(canvas, site, scene)
        screen = overlay.screen()
        painter = QPainter(image)
        names.paint(painter, overlay._placed, in_view(overlay._placed, screen), screen)
        painter.end()
    return names._written


def test_what_is_written_follows_what_becomes_of_a_robot(canvas, site):
    fresh = scene_of((60, 50, 0.0, RobotState.FRESH))
    lost = (60, 50, 0.0, RobotState.LOST)
    later = scene_of(lost, age=75.0, now=100.3)
    assert written_after(canvas, site, fresh, later) == [["r1", "· lost 1 min"]]


def test_what_is_written_beside_a_robot_is_never_that_of_another(canvas, site):
    two = scene_of((60, 50, 0.0, RobotState.FRESH), (20, 20, 0.0, RobotState.FRESH))
    others = scene_of((60, 50, 0.0, RobotState.FRESH), now=100.01)
    assert written_after(canvas, site, two, others) == [["r1"]]
    renamed = dataclasses.replace(two.robots, names=["a", "b"])
    written = written_after(canvas, site, two, dataclasses.replace(two, robots=renamed))
    assert sorted(written) == [["a"], ["b"]]


@pytest.mark.parametrize("rotation", [0.0, 90.0])
def test_robots_beyond_the_border_are_pointed_to(canvas, site, rotation):
    scene = scene_of((600, 50, 0.0, RobotState.FRESH), (602, 50, 0.0, RobotState.LOST))
    overlay = show(canvas, site, scene, rotation=rotation)
    canvas.grab()
    (hint,) = overlay._painter.hints
    assert sorted(hint.rows.tolist()) == [0, 1]
    away = expected(canvas, site, 600, 50) - (canvas.width() / 2, canvas.height() / 2)
    assert math.cos(hint.turn - math.atan2(away[1], away[0])) > 0.98
    assert overlay.robots_beyond(hint.x, hint.y) == ["r1", "r2"]
    assert 0 < hint.x < canvas.width() and 0 < hint.y < canvas.height()
    red = spots(canvas, STATE_COLOURS[RobotState.LOST])
    assert np.hypot(*(red - (hint.x, hint.y)).T).max() < 14


def test_the_distance_still_to_go_stands_at_the_target(canvas, site):
    import dataclasses as classes

    target = plan("r1", (40.0, 70.0))
    scene = scene_of((60, 50, 0.0, RobotState.FRESH), plans=[target])
    without = show(canvas, site, scene)
    before = canvas.grab().toImage()
    canvas.scene().removeItem(without)
    show(canvas, site, classes.replace(scene, remaining={target.command: 28.3}))
    after = canvas.grab().toImage()
    changed = [
        (x, y)
        for x in range(0, after.width(), 2)
        for y in range(0, after.height(), 2)
        if after.pixel(x, y) != before.pixel(x, y)
    ]
    foot = expected(canvas, site, 40, 70)
    assert len(changed) > 20
    assert np.hypot(*(np.array(changed) - foot).T).max() < 40


def test_ways_are_painted_where_they_lead_and_move_with_the_map(canvas, site):
    from fleet_supervisor.plugin.desk.colours import ROUTE

    way = plan("r1", (20.0, 20.0), (100.0, 20.0), (100.0, 80.0))
    show(canvas, site, scene_of((20, 20, 0.0, RobotState.FRESH), plans=[way]))
    for _ in range(2):
        found = spots(canvas, ROUTE)
        for x, y in ((60, 20), (100, 50)):
            assert np.hypot(*(found - expected(canvas, site, x, y)).T).min() < 2
        canvas.setCenter(QgsPointXY(site.origin[0] + 70, site.origin[1] + 40))
        QApplication.processEvents()


def test_an_hour_of_updates_takes_no_more_memory(canvas, site):
    from pathlib import Path

    from fleet_supervisor.plugin.desk.desk import Desk
    from fleet_supervisor.plugin.desk.live.live_view import LiveView
    from fleet_supervisor.plugin.wire.position_rows import sightings

    now = [1000.0]
    canvas.setDestinationCrs(QgsCoordinateReferenceSystem("EPSG:32633"))
    canvas.setExtent(QgsRectangle(*site.origin, site.origin[0] + 120, site.origin[1] + 100))
    desk = Desk(canvas, QgsProject.instance(), clock=lambda: now[0])
    view = LiveView(desk)
    desk._take_site(site, is_greeting=True)
    used = []
    for step in range(1200):
        now[0] += 3.0
        told = [
            {
                "robot": f"r{k}",
                "state": "fresh",
                "age": 0.1 if k % 9 else 3.0 * step,
                "link": "sql",
                "x": (k * 7 + step) % 120,
                "y": k % 100,
                "theta": step / 9,
                "v": 1.0,
                "accuracy": 0.5 + k % 5,
            }
            for k in range(100)
        ]
        desk.picture.merge(sightings(told, now[0]))
        view.show_now()
        canvas.viewport().repaint()
        view.layer.begin(100)
        view.layer.go_on(desk.picture, now[0])
        if step % 100 == 99:
            QApplication.processEvents()
            used.append(int(Path("/proc/self/statm").read_text().split()[1]) * 4096 / 1e6)
    view.remove()
    desk.shut_down()
    assert used[-1] - used[3] < 6.0
