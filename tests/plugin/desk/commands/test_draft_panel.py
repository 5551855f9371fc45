"""The part of the panel about the draft takes the room that it needs, and gives it back to the robots."""

from __future__ import annotations

from fleet_supervisor.plugin.desk.drafts import CONE, Draft, Findings


def test_the_buttons_for_changes_go_with_the_draft(at_desk):
    drafts, changes = at_desk.desk.drafts, at_desk.dock.draft_panel._changes
    assert changes.isHidden()
    for x in (60.0, 61.0):
        drafts.put(Draft("r1", CONE, ((x, 50.0),), Findings()))
    assert not changes.isHidden()
    drafts.done()
    assert changes.isHidden()
