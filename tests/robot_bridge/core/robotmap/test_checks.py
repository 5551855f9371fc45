"""What the checks of a robot map find, and what they leave in peace."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.checks import check_map
from robot_bridge.core.robotmap.findings import MapCheckLimits, MapFindingKind, Severity
from robot_bridge.core.robotmap.model import Border, Obstacle, RobotMap, ShapeType, Window
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.core.robotmap.text_format import read_text

BORDER = Border(0.0, 0.0, 40.0, 40.0)


def shape(points, kind=ShapeType.CLOSED_POLYGON, *, id=1, height=3.0, source="", ring=True):
    """Return an obstacle along ``points``; a ring goes back to the first one."""
    points = np.asarray(points, dtype=float)
    a, b = (points, np.roll(points, -1, axis=0)) if ring else (points[:-1], points[1:])
    return obstacle(a, b, kind, id=id, height=height, source=source)


def obstacle(a, b, kind, *, id=1, height=3.0, source=""):
    count = len(a)
    return Obstacle(
        id=id,
        shape_type=kind,
        semantics="thing",
        a=np.asarray(a, dtype=float),
        b=np.asarray(b, dtype=float),
        height=np.broadcast_to(np.asarray(height, dtype=float), count).copy(),
        outdoor=np.ones(count, dtype=bool),
        segment_semantics=("",) * count,
        ext={"src": source} if source else {},
    )


def wall(*points, id=1, **more):
    return shape(points, ShapeType.OPEN_POLYGON, id=id, ring=False, **more)


def square(x, y, side=4.0, **more):
    """Return a building that runs counter-clockwise."""
    return shape([(x, y), (x + side, y), (x + side, y + side), (x, y + side)], **more)


def turned(thing: Obstacle) -> Obstacle:
    return replace(thing, a=thing.b[::-1], b=thing.a[::-1])


def found(*obstacles, kind=None, limits=None, border=BORDER):
    """Return the findings, of one ``kind`` where given."""
    findings = check_map(RobotMap(border, obstacles), limits)
    assert all(len(f.segments) and f.segments.shape[1:] == (2, 2) for f in findings)
    return [f for f in findings if kind is None or f.kind is kind]


def test_a_sound_map_has_no_finding():
    courtyard = turned(square(12, 12, 6, id=2, source="b:1"))
    stairs = obstacle(
        [(30, 10), (30, 10.3), (30, 10.6)],
        [(34, 10), (34, 10.3), (34, 10.6)],
        ShapeType.STAIRS,
        id=4,
        height=(0.16, 0.16, 0.0),
    )
    ramp = square(30, 20, id=5, height=0.0)
    house = square(10, 10, 10, id=1, source="b:1")
    sound = (house, courtyard, wall((2, 2), (8, 2), id=3), stairs, replace(ramp, shape_type=ShapeType.RAMP))
    assert [f for f in found(*sound) if f.kind is not MapFindingKind.POCKET] == []
    assert [f.severity for f in found(*sound)] == [Severity.INFO]


def test_an_empty_map_has_no_finding():
    assert found() == []


def test_a_building_that_runs_clockwise_is_an_error_at_its_outline():
    (finding,) = found(turned(square(10, 10, id=7)), kind=MapFindingKind.ORIENTATION)
    assert (finding.severity, finding.obstacle) == (Severity.ERROR, 7)
    assert finding.segments.min() == 10 and finding.segments.max() == 14
    assert "turn it round" in finding.text


def test_a_courtyard_that_runs_counter_clockwise_is_an_error():
    house, yard = square(10, 10, 10, id=1, source="b:1"), square(12, 12, id=2, source="b:1")
    (finding,) = found(house, yard, kind=MapFindingKind.ORIENTATION)
    assert finding.obstacle == 2 and "courtyard of obstacle 1" in finding.text
    assert found(house, turned(yard), kind=MapFindingKind.ORIENTATION) == []


def test_a_building_in_a_courtyard_is_sound():
    house, hut = square(10, 10, 20, id=1, source="b:1"), square(18, 18, id=3, source="b:2")
    assert (
        found(house, turned(square(14, 14, 12, id=2, source="b:1")), hut, kind=MapFindingKind.OVERLAP) == []
    )
    (finding,) = found(house, hut, kind=MapFindingKind.OVERLAP)
    assert finding.obstacle == 3 and "lies inside obstacle 1" in finding.text


def test_the_courtyard_of_a_building_that_the_border_cuts_is_sound():
    def ring(low, high):
        return [(low, low), (high, low), (high, high), (low, high), (low, low)]

    rows = [
        OutlineRow(
            np.array(ring(*span), float), ShapeType.CLOSED_POLYGON, 3.0, "house", "b:1", courtyard=yard
        )
        for span, yard in (((5.0, 60.0), False), ((10.0, 20.0), True))
    ]
    cut = build_map(Outlines.from_rows(rows), Window(20, 20, 40, 40))
    assert [f for f in check_map(cut) if f.kind is MapFindingKind.ORIENTATION] == []
    nameless = replace(cut, obstacles=tuple(replace(o, ext={}) for o in cut.obstacles))
    (finding,) = [f for f in check_map(nameless) if f.kind is MapFindingKind.ORIENTATION]
    assert finding.severity is Severity.WARNING and "unless the border cuts" in finding.text


def test_a_segment_turned_round_in_an_outline_is_named_and_no_gap():
    house = square(10, 10, id=3)
    a, b = house.a.copy(), house.b.copy()
    a[1], b[1] = house.b[1], house.a[1]
    findings = found(replace(house, a=a, b=b))
    (finding,) = [f for f in findings if f.kind in (MapFindingKind.ORIENTATION, MapFindingKind.GAP)]
    assert finding.kind is MapFindingKind.ORIENTATION and finding.obstacle == 3
    assert finding.segments.tolist() == [[[14, 14], [14, 10]]]


def test_risers_that_run_from_right_to_left_are_an_error():
    a, b = [(30, 10), (30, 10.3)], [(34, 10), (34, 10.3)]
    sound = obstacle(a, b, ShapeType.STAIRS, height=(0.16, 0.0))
    assert found(sound) == []
    (finding,) = found(replace(sound, a=sound.b, b=sound.a))
    assert finding.kind is MapFindingKind.ORIENTATION and "2 of 2 risers" in finding.text


def test_a_ring_that_does_not_close_has_a_gap_with_its_width():
    house = square(10, 10, id=2)
    (finding,) = found(
        replace(house, a=house.a[:3], b=house.b[:3], height=house.height[:3]), kind=MapFindingKind.GAP
    )
    assert finding.severity is Severity.ERROR and "a gap of 4.00 m after (10.00, 14.00)" in finding.text
    assert finding.segments.tolist() == [[[10, 14], [10, 10]]]


def test_the_papers_sample_lacks_three_of_its_four_faces(fig_2):
    gaps = [f for f in check_map(read_text(fig_2)) if f.kind is MapFindingKind.GAP]
    assert [(f.obstacle, f.severity) for f in gaps] == [(1, Severity.ERROR)]
    assert "a gap of 2.76 m" in gaps[0].text


@pytest.mark.parametrize(("end", "count"), [(9.0, 0), (9.93, 1), (9.99, 0), (10.0, 0)])
def test_a_wall_that_ends_just_short_of_a_house_is_a_gap(end, count):
    house, line, far = square(10, 10, id=1), wall((2, 12), (end, 12), id=2), wall((30, 2), (35, 2), id=3)
    findings = found(house, line, far, kind=MapFindingKind.GAP)
    assert [finding.obstacle for finding in findings] == [2] * count
    if count:
        assert findings[0].segments.tolist() == [[[9.93, 12.0], [10.0, 12.0]]]
        assert "0.07 m short of obstacle 1" in findings[0].text


def test_a_wall_that_the_border_cuts_does_not_end_there():
    along = wall((39.95, 0), (39.95, 40), id=2)
    assert found(wall((2, 12), (40, 12)), along, kind=MapFindingKind.GAP) == []


def test_a_thin_ring_is_a_sliver_and_nothing_else():
    thin = turned(shape([(10, 10), (20, 10), (20, 10.03), (10, 10.03)], id=6))
    findings = found(thin)
    assert [(f.kind, f.obstacle) for f in findings] == [(MapFindingKind.SLIVER, 6)]
    assert found(thin, kind=MapFindingKind.SLIVER, limits=MapCheckLimits(sliver=0.01)) == []


def test_a_segment_without_length_is_found():
    (finding,) = found(wall((2, 2), (2, 2), (9, 2), id=4), kind=MapFindingKind.SLIVER)
    assert "1 segment without length, the first at (2.00, 2.00)" in finding.text


def test_an_obstacle_that_is_there_twice_is_a_duplicate():
    (finding,) = found(square(10, 10, id=1), square(10, 10, id=2))
    assert (finding.kind, finding.obstacle) == (MapFindingKind.DUPLICATE, 2)
    assert "is all in obstacle 1" in finding.text
    assert len(finding.segments) == 4


def test_a_shared_wall_is_worth_knowing_and_no_overlap():
    findings = found(square(10, 10, id=1), square(14, 8, 8, id=2))
    assert [(f.kind, f.severity) for f in findings] == [(MapFindingKind.SHARED_WALL, Severity.INFO)]
    assert findings[0].segments.tolist() == [[[14, 14], [14, 10]]]
    assert "for 4.00 m in the opposite direction" in findings[0].text


def test_outlines_that_cross_or_cover_each_other_overlap():
    (crossing,) = found(square(10, 10, id=1), wall((12, 5), (12, 12), id=2), kind=MapFindingKind.OVERLAP)
    assert "crosses obstacle 1 in 1 place" in crossing.text
    assert np.abs(crossing.segments.mean(axis=(0, 1)) - (12, 10)).max() < 1e-9
    (covering,) = found(square(10, 10, id=1), wall((11, 10), (13, 10), id=2), kind=MapFindingKind.OVERLAP)
    assert "for 2.00 m in the same direction" in covering.text


def test_touching_within_a_centimetre_is_no_overlap():
    assert found(square(10, 10, id=1), wall((12, 5), (12, 10.01), id=2), kind=MapFindingKind.OVERLAP) == []


def test_a_ring_that_crosses_itself_is_found():
    bow = shape([(10, 10), (16, 16), (16, 10), (10, 17)], id=5)
    (finding,) = found(bow, kind=MapFindingKind.OVERLAP)
    assert finding.obstacle == 5 and "crosses itself in 1 place" in finding.text


def test_a_room_of_walls_is_a_pocket_until_it_has_a_door():
    room = wall((10, 10), (20, 10), (20, 20), (10, 20), (10, 10), id=1)
    (finding,) = found(room, kind=MapFindingKind.POCKET)
    # A robot 0.6 m wide keeps 0.3 m from the walls: 9.4 m x 9.4 m for its middle, to a cell of 0.15 m.
    area = float(finding.text.split(" m²")[0])
    assert area == pytest.approx(9.4**2, abs=4 * 9.4 * 0.3)
    assert finding.segments.min() > 10 and finding.segments.max() < 20
    door = wall((10, 10), (14, 10), id=1), wall((15.2, 10), (20, 10), (20, 20), (10, 20), (10, 10), id=2)
    assert found(*door, kind=MapFindingKind.POCKET) == []
    assert len(found(*door, kind=MapFindingKind.POCKET, limits=MapCheckLimits(robot_width=1.6))) == 1


def test_the_inside_of_a_house_is_no_pocket_and_its_courtyard_is_one():
    house = square(10, 10, 20, source="b:1")
    assert found(house, kind=MapFindingKind.POCKET) == []
    (finding,) = found(house, turned(square(15, 15, 10, id=2, source="b:1")), kind=MapFindingKind.POCKET)
    assert finding.segments.min() > 15 and finding.segments.max() < 25


def test_a_ramp_shuts_nothing_in():
    ring = [(10, 10), (20, 10), (20, 20), (10, 20)]
    assert found(shape(ring, ShapeType.RAMP, height=0.0)) == []


def test_a_map_too_large_for_pockets_says_so():
    (finding,) = found(wall((1, 1), (9000, 9000)), border=Border(0, 0, 10_000, 10_000))
    assert finding.kind is MapFindingKind.POCKET and "pockets were not looked for" in finding.text


def test_heights_that_a_shape_cannot_have_are_found():
    (flat,) = found(wall((2, 2), (9, 2), (9, 4), id=3, height=(0.0, 2.0)))
    assert (flat.kind, flat.obstacle) == (
        MapFindingKind.HEIGHT,
        3,
    ) and "1 segment with a height of 0" in flat.text
    assert flat.segments.tolist() == [[[2, 2], [9, 2]]]
    (ramp,) = found(shape([(2, 2), (9, 2), (9, 4)], ShapeType.RAMP, height=1.0))
    assert "a ramp has height 0" in ramp.text
    rising = obstacle([(2, 2), (2, 3)], [(6, 2), (6, 3)], ShapeType.STAIRS, height=0.16)
    assert "the last riser of stairs has height 0" in found(rising)[0].text


def test_segments_outside_the_border_are_an_error():
    (finding,) = found(wall((30, 30), (41, 30), (41, 45), id=2))
    assert (finding.kind, finding.severity) == (MapFindingKind.OUTSIDE, Severity.ERROR)
    assert "2 segments outside the border" in finding.text
    assert found(wall((0, 0), (40, 40))) == []


def test_an_id_that_two_obstacles_have_is_an_error():
    (finding,) = found(wall((2, 2), (9, 2), id=5), wall((2, 8), (9, 8), id=5))
    assert (finding.kind, finding.severity, finding.obstacle) == (MapFindingKind.ID, Severity.ERROR, 5)
    assert len(finding.segments) == 2


def test_what_the_builder_makes_of_a_thousand_houses_has_no_error():
    rng = np.random.default_rng(7)
    rows = []
    for k, (x, y) in enumerate(rng.uniform(5, 595, (1000, 2))):
        angle, size = rng.uniform(0, np.pi), rng.uniform(2, 6)
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        corners = np.array([(0, 0), (size, 0), (size, size), (0, size), (0, 0)]) @ turn + (x, y)
        rows.append(OutlineRow(corners, ShapeType.CLOSED_POLYGON, 3.0, "house", f"houses:{k}"))
    built = build_map(Outlines.from_rows(rows), Window(300, 300, 600, 600))
    findings = check_map(built)
    assert [f for f in findings if f.severity is Severity.ERROR] == []
    assert sum(f.kind is MapFindingKind.OVERLAP for f in findings) > 10
