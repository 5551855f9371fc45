"""A cone plan is changed by keys and by dragging."""

from __future__ import annotations

import pytest
from qgis.PyQt.QtCore import Qt

from tests.plugin.planning.panel_parts import ABOARD, child, cones_of, drop, key, planned, write


def test_a_cone_is_moved_by_keys_and_the_times_are_made_anew(panel, wait):
    before = planned(panel, wait)
    first = cones_of(before)["r1"]
    key(panel, child(panel, "r1", first[0]), Qt.Key.Key_Down, Qt.KeyboardModifier.AltModifier)
    wait(lambda: panel.drafts.draft.plan is not before and not panel.drafts.busy, 10, "the change")
    after = panel.drafts.draft.plan
    assert cones_of(after)["r1"] == [first[1], first[0], first[2]]
    assert after.robot("r1").end_s != pytest.approx(before.robot("r1").end_s)
    assert panel.tree.currentItem().text(0).endswith(first[0]), "what was moved stays selected"


def test_a_cone_is_dragged_to_another_robot(panel, wait):
    before = planned(panel, wait)
    moved = cones_of(before)["r1"][-1]
    drop(panel, child(panel, "r1", moved), panel.tree.topLevelItem(1))
    wait(lambda: panel.drafts.draft.plan is not before and not panel.drafts.busy, 10, "the change")
    after = cones_of(panel.drafts.draft.plan)
    assert moved not in after["r1"] and after["r2"][-1] == moved
    other = after["r2"][0]
    drop(panel, child(panel, "r2", moved), child(panel, "r2", other))
    now = panel.drafts.draft.plan
    wait(lambda: panel.drafts.draft.plan is not now and not panel.drafts.busy, 10, "the change")
    assert cones_of(panel.drafts.draft.plan)["r2"][:2] == [other, moved]


def test_a_cone_is_taken_out_and_named_as_left_out(panel, wait):
    before = planned(panel, wait)
    gone = cones_of(before)["r2"][0]
    key(panel, child(panel, "r2", gone), Qt.Key.Key_Delete)
    wait(lambda: panel.drafts.draft.plan is not before and not panel.drafts.busy, 10, "the change")
    assert gone not in str(cones_of(panel.drafts.draft.plan))
    assert f"Left out: {gone} (taken out by hand)" in panel.bar.text.text()


def test_what_cannot_be_driven_is_told_and_the_plan_stays(panel, wait, iface):
    for row in range(2):
        write(panel, row, ABOARD, "3")
    before = planned(panel, wait)
    drop(panel, child(panel, "r1", cones_of(before)["r1"][0]), panel.tree.topLevelItem(1))
    wait(lambda: any("r2 cannot serve" in text for text in iface.texts()), 10, "the refusal")
    assert panel.drafts.draft.plan is before
