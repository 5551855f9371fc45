"""Accepted objects on a map: where they are, what they are called, and under which ids."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_bridge.core.messages.records import ObservationReport, ObservationState
from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import ShapeType, Window
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.core.robotmap.text_format import read_text, write_text
from robot_bridge.gateway.site.site_maps import FIRST_ID, ObservedObjects

WINDOW = Window(0.0, 0.0, 40.0, 40.0)


def seen(number, x, y, **fields):
    return ObservationReport(
        number, "r1", "SetObject", f"thing-{number}", x, y, 0.0, ObservationState.ACCEPTED, **fields
    )


def wall(semantics):
    points = np.array([(-5.0, -15.0), (5.0, -15.0)])
    return OutlineRow(points, ShapeType.OPEN_POLYGON, 2.0, semantics, f"walls:{semantics}")


def site_map(*semantics, window=WINDOW):
    return build_map(Outlines.from_rows([wall(word) for word in semantics]), window)


def joined(*objects, site=None, radius=0.25):
    return ObservedObjects(objects, radius).join(site or site_map("wall"))


def test_without_objects_the_map_is_the_sites_own():
    site = site_map("wall")
    assert ObservedObjects([], 0.25).join(site) is site
    assert joined(seen(1, 500.0, 0.0), site=site) is site


def test_an_object_is_a_ring_of_its_radius_and_height():
    (ring,) = [o for o in joined(seen(12, 3.0, 4.0, radius=0.4, height=0.75)).obstacles if o.id >= FIRST_ID]
    assert ring.shape_type is ShapeType.CLOSED_POLYGON
    assert set(ring.height) == {0.75}
    assert ring.a.mean(axis=0) == pytest.approx((3.0, 4.0), abs=0.01)
    distances = np.hypot(*(ring.a - (3.0, 4.0)).T)
    assert 0.4 <= distances.min() <= distances.max() < 0.45
    assert ring.id == FIRST_ID + 96
    assert ring.ext == {"src": "observation:12", "id": "thing-12"}


def test_what_nobody_said_is_the_sites_radius_a_marked_height_and_a_plain_word():
    (ring,) = [o for o in joined(seen(1, 0.0, 0.0), radius=0.5).obstacles if o.id >= FIRST_ID]
    assert np.ptp(ring.a[:, 0]) == pytest.approx(1.0, abs=0.02)
    assert set(ring.height) == {1.0}
    assert (ring.ext["h"], ring.semantics) == ("est", "object")


@pytest.mark.parametrize(
    ("said", "word"),
    [({"label": "cone"}, "cone"), ({"label": "cone", "semantics": "barrier,A5"}, "barrier,A5")],
)
def test_the_operators_word_counts_before_the_robots(said, word):
    (ring,) = [o for o in joined(seen(1, 0.0, 0.0, **said)).obstacles if o.id >= FIRST_ID]
    assert ring.semantics == word


def test_objects_stand_among_obstacles_of_their_group():
    site = site_map("building", "cone", "wall")
    words = [o.semantics for o in joined(seen(1, 0.0, 0.0, label="cone"), site=site).obstacles]
    assert words == ["building", "cone", "cone", "wall"]


def test_an_object_that_the_window_cuts_keeps_its_number_in_every_chain():
    corner = seen(3, 20.0, 20.0, radius=1.0)
    cut = [o for o in joined(corner, seen(4, 0.0, 20.0, radius=1.0)).obstacles if o.id >= FIRST_ID]
    assert {o.shape_type for o in cut} == {ShapeType.OPEN_POLYGON}
    assert {(o.id - FIRST_ID) // 8 for o in cut} == {3, 4}
    assert len({o.id for o in cut}) == len(cut)
    assert all(abs(o.a).max() <= 20.0 for o in cut)


def test_an_object_that_is_wider_than_the_window_has_a_chain_in_each_corner():
    chains = [o for o in joined(seen(5, 0.0, 0.0, radius=23.0)).obstacles if o.id >= FIRST_ID]
    assert [o.id - FIRST_ID for o in chains] == [40, 41, 42, 43]
    assert {o.ext["src"] for o in chains} == {"observation:5"}


def test_a_robots_words_do_not_break_the_text_format():
    nasty = seen(1, 0.0, 0.0, label="a;b%c#d,e")
    report = ObservationReport(**{**vars(nasty), "object": "x=1;y,z%#\\"})
    again = read_text(write_text(joined(report)))
    (ring,) = [o for o in again.obstacles if o.id >= FIRST_ID]
    assert (ring.ext["id"], ring.semantics) == ("x=1;y,z%#\\", "a;b%c#d,e")


@settings(max_examples=50, deadline=None)
@given(
    st.lists(st.tuples(st.floats(-25, 25), st.floats(-25, 25), st.floats(0.05, 30)), max_size=12),
)
def test_wherever_objects_are_ids_are_unique_and_nothing_lies_outside(places):
    objects = [seen(n, x, y, radius=radius) for n, (x, y, radius) in enumerate(places, 1)]
    ids = [o.id for o in joined(*objects).obstacles]
    assert len(set(ids)) == len(ids)
    for obstacle in joined(*objects).obstacles:
        assert abs(np.concatenate([obstacle.a, obstacle.b])).max() <= 20.0


def test_an_object_that_cannot_be_drawn_keeps_no_other_from_the_map(caplog):
    found = joined(seen(1, 5.0, 5.0), seen(2, "east", 7.0), seen(3, 8.0, 8.0))
    drawn = [obstacle.ext["src"] for obstacle in found.obstacles if obstacle.id >= FIRST_ID]
    assert drawn == ["observation:1", "observation:3"]
    assert "observation 2 is not drawn" in caplog.text


def test_what_is_missing_is_left_out_where_it_was():
    site = site_map("wall", "bench")
    left = joined(seen(1, 0.0, -15.0, radius=5.0, doubts="walls:bench"), site=site)
    assert [one.semantics for one in left.obstacles] == ["wall"]
    # In another publication the same name may be another thing.
    for other in (
        seen(1, 0.0, 0.0, radius=5.0, doubts="walls:bench"),
        seen(1, 0.0, -15.0, radius=5.0, doubts="walls:other"),
    ):
        assert list(joined(other, site=site).obstacles) == list(site.obstacles)


def test_what_is_missing_is_no_object_itself():
    objects = ObservedObjects([seen(1, 0.0, 0.0, radius=0.4, doubts="walls:wall")], 0.25)
    assert len(objects) == 0 and objects.areas() == []
