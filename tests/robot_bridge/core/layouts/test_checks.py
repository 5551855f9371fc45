"""Each cone that may not stand where it is is found, with the reason, and no other."""

from __future__ import annotations

import numpy as np

from robot_bridge.core.layouts.layout import Cone, ConeFindingKind, NamedGeometry, find_misplaced_cones


def cone(name: str, x: float, y: float) -> Cone:
    return Cone(name, 1, x, y, 0.0, "orange", "")


def box(x0: float, y0: float, x1: float, y1: float) -> np.ndarray:
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]], float)


ROAD = NamedGeometry((box(0, 0, 100, 10), box(40, 4, 60, 6)), "road")
HOUSE = NamedGeometry((box(20, 9, 30, 20),), "house 7")
WALL = NamedGeometry((np.array([[70.0, 5.0], [80.0, 5.0]]),), "wall 3", area=False)
POST = NamedGeometry((np.array([[90.0, 5.0]]),), "post 1", area=False)


def test_a_cone_beside_the_road_or_in_its_hole_is_found() -> None:
    cones = [cone("on", 10, 5), cone("beside", 10, 11), cone("in the hole", 50, 5)]
    found = find_misplaced_cones(cones, [ROAD], [], 0, 0)
    assert [(one.cone, one.kind) for one in found] == [
        ("beside", ConeFindingKind.SURFACE),
        ("in the hole", ConeFindingKind.SURFACE),
    ]
    assert "on no surface that is allowed" in found[0].text
    assert (found[0].x, found[0].y) == (10, 11)


def test_without_surfaces_given_every_place_is_allowed_and_with_none_no_place() -> None:
    assert find_misplaced_cones([cone("a", 500, 500)], None, [], 0, 0) == []
    assert len(find_misplaced_cones([cone("a", 10, 5)], [], [], 0, 0)) == 1


def test_two_surfaces_that_meet_are_one() -> None:
    halves = [NamedGeometry((box(0, 0, 50, 10),), "a"), NamedGeometry((box(50, 0, 100, 10),), "b")]
    assert (
        find_misplaced_cones([cone("a", 49.9, 5), cone("b", 50.1, 5), cone("c", 50, 5)], halves, [], 0, 0)
        == []
    )


def test_a_cone_near_an_obstacle_or_inside_one_is_found_with_the_distance() -> None:
    cones = [cone("far", 10, 5), cone("near", 25, 8.6), cone("inside", 25, 15), cone("wall", 75, 5.3)]
    found = find_misplaced_cones([*cones, cone("post", 90, 4.8)], None, [HOUSE, WALL, POST], 0.5, 0)
    assert [one.cone for one in found] == ["near", "inside", "wall", "post"]
    assert found[0].text == "Cone near is 0.40 m from house 7: keep 0.5 m from obstacles."
    assert "is inside house 7" in found[1].text
    assert "0.30 m from wall 3" in found[2].text
    assert "0.20 m from post 1" in found[3].text


def test_the_distance_itself_is_far_enough() -> None:
    assert find_misplaced_cones([cone("a", 75, 5.5)], None, [WALL], 0.5, 0) == []
    assert find_misplaced_cones([cone("a", 0, 0), cone("b", 0.5, 0)], None, [], 0, 0.5) == []


def test_a_cone_on_another_is_found_once_and_names_it() -> None:
    found = find_misplaced_cones([cone("a", 0, 0), cone("b", 5, 0), cone("c", 0.1, 0)], None, [], 0, 0.5)
    assert [one.cone for one in found] == ["c"]
    assert found[0].text == "Cone c is 0.10 m from a: keep 0.5 m between cones."


def test_no_cone_has_no_finding() -> None:
    assert find_misplaced_cones([], [ROAD], [HOUSE], 1, 1) == []
