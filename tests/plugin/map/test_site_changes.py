"""The site is published anew, another is chosen, or another gateway answers: what stays and what goes."""

from __future__ import annotations

from dataclasses import replace

import pytest
from fleet_supervisor.plugin.ui import scheduling
from fleet_supervisor.robot_bridge.core.messages.base import to_json
from qgis.PyQt import sip
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QDialog, QLabel

from tests.support.bridge.bridge_programs import wait_until


@pytest.fixture
def drawn(at_desk, iface):
    """A desk with a cone target for r1 as a draft."""
    at_desk.desk.selection.select("r1")
    at_desk.actions.cone.trigger()
    iface.click(70, 55)
    assert at_desk.desk.drafts.draft is not None
    return at_desk


def tell(gateway, site, wait, window):
    gateway.tell("site", to_json(site))
    wait(lambda: window.desk.state.site == site, what="the news of the site")


@pytest.mark.parametrize("how", [{"version": "2"}, {"id": "chosen", "name": "Chosen"}])
def test_robots_commands_and_a_stop_outlast_a_site_that_is_published_anew_or_chosen(
    drawn, gateway, site, wait, how
):
    desk = drawn.desk
    desk.abort_selected()
    desk.emergency_stop()
    wait(
        lambda: len(desk.state.commands) == 1 and desk.state.emergency.in_force, what="the abort and the stop"
    )
    stop = desk.state.emergency
    tell(gateway, replace(site, **how), wait, drawn)
    assert desk.state.emergency == stop and drawn.dock.banner.isVisible()
    assert len(desk.state.commands) == 1 and len(desk.state.robots) == 2
    assert desk.selection.robots == ("r1",)


def test_a_draft_is_held_against_the_site_that_was_published_anew(drawn, gateway, site, wait, iface):
    tell(gateway, replace(site, version="2", bounds=(0.0, 0.0, 60.0, 160.0)), wait, drawn)
    wait(lambda: drawn.desk.drafts.draft.findings.refused, what="the check of the draft")
    assert "is outside the site Yard" in drawn.dock.findChild(QLabel, "fleet_draft_text").text()
    QTest.keyClick(iface.canvas, Qt.Key.Key_Return)
    QTest.qWait(100)
    assert gateway.requests_of("send") == []


def test_an_order_to_send_outlasts_it(drawn, gateway, site, wait, monkeypatch):
    monkeypatch.setattr(scheduling, "SLICE_SECONDS", 0.0)
    drawn.desk.sending.send()
    drawn.desk.connection._buffer.add(site=replace(site, version="2"))
    drawn.desk.state.pull()
    assert drawn.desk.state.site.version == "2" and drawn.desk.checks.has_order
    wait(lambda: gateway.requests_of("send"), what="the command")
    assert len(gateway.requests_of("send")) == 1


@pytest.mark.parametrize("is_chosen", [True, False])
def test_another_site_is_told_whoever_had_it_served(at_desk, gateway, site, wait, iface, is_chosen):
    other = replace(site, id="other", name="Other")
    if is_chosen:
        tell(gateway, other, wait, at_desk)
    else:
        gateway.stop()
        wait(lambda: at_desk.desk.state.link.phase.value == "retrying", what="the loss of the link")
        gateway.site = other
        gateway.start()
        wait(lambda: at_desk.desk.state.site == other, 10, "the other site")
    assert [text for text in iface.texts() if "Other, no longer Yard" in text]


def test_the_same_site_published_anew_is_no_other(at_desk, gateway, site, wait, iface):
    tell(gateway, replace(site, version="2", name="Renamed"), wait, at_desk)
    assert not [text for text in iface.texts() if "no longer" in text]


@pytest.mark.parametrize("how", ["frame", "gateway"])
def test_a_draft_for_other_robots_is_taken_away_and_that_is_said(drawn, gateway, site, wait, iface, how):
    if how == "frame":
        tell(gateway, replace(site, origin=(1.0, 2.0)), wait, drawn)
    else:
        gateway.stop()
        wait(lambda: drawn.desk.state.link.phase.value == "retrying", what="the loss of the link")
        gateway.site = replace(site, id="other")
        gateway.start()
        wait(lambda: drawn.desk.state.site.id == "other", 10, "the other gateway")
    assert drawn.desk.drafts.draft is None
    assert any("was not sent: another site is served now" in text for text in iface.texts())


def test_a_gateway_that_does_not_serve_what_was_chosen_is_named_until_it_does(at_desk, gateway, site, wait):
    began, over = [], []
    at_desk.desk.failed.connect(began.append)
    at_desk.desk.resolved.connect(over.append)
    tell(gateway, replace(site, problem="site south cannot be read"), wait, at_desk)
    text = "This gateway serves another site than the rest of the fleet: site south cannot be read."
    assert began == [text] and over == []
    tell(gateway, site, wait, at_desk)
    assert over == [text]


# --- What is on its way when the gateway is started again where the same numbers are other places

ELSEWHERE = (488100.0, 5190000.0)


def start_elsewhere(gateway, wait, window, **how):
    """Have the gateway killed and started again where the same numbers are other places."""
    gateway.stop()
    wait(lambda: window.desk.state.link.phase.value == "retrying", what="the loss of the link")
    gateway.site, known = replace(gateway.site, **how), window.desk.state.robots.generation
    gateway.start()
    wait(lambda: window.desk.state.link.phase.value == "connected", 10, "the link")
    wait(lambda: window.desk.state.robots.generation != known, what="the news of other robots")


def send_unanswered(drawn, gateway, wait):
    gateway.mute.add("send")
    drawn.desk.sending.send()
    wait(lambda: gateway.requests_of("send"), what="the command")


@pytest.mark.parametrize("how", ["frame", "database"])
def test_a_target_that_was_not_answered_goes_to_no_other_site_or_fleet(drawn, gateway, wait, iface, how):
    if how == "database":
        gateway.database = "one"
        gateway.stop()
        wait(lambda: drawn.desk.state.link.phase.value == "retrying", what="the loss of the link")
        gateway.start()
        wait(lambda: drawn.desk.state.link.phase.value == "connected", 10, "the link")
        gateway.database = "two"
    send_unanswered(drawn, gateway, wait)
    start_elsewhere(gateway, wait, drawn, **({"origin": ELSEWHERE} if how == "frame" else {}))
    wait(lambda: any("other places there: it was not sent to it" in text for text in iface.texts()))
    # It is asked after the link: what would be repeated has been by then.
    drawn.desk.abort_selected()
    drawn.desk.abort_all()
    wait(lambda: gateway.requests_of("abort_all"), what="the abort")
    assert len(gateway.requests_of("send")) == 1
    assert drawn.desk.drafts.draft is None


def test_it_is_repeated_at_the_same_site_and_comes_back_to_the_map_where_it_is_refused(drawn, gateway, wait):
    send_unanswered(drawn, gateway, wait)
    gateway.stop()
    wait(lambda: drawn.desk.state.link.phase.value == "retrying", what="the loss of the link")
    gateway.mute.clear()
    gateway.refuse["send"] = "it rains"
    gateway.start()
    wait(lambda: drawn.desk.drafts.draft is not None, 10, "the draft that comes back")
    assert len(gateway.requests_of("send")) == 2


def test_what_is_pressed_before_the_window_knows_of_the_other_site_is_not_sent(drawn, gateway, wait):
    desk, greeted = drawn.desk, gateway.subscriptions
    # A window that stands still: it looks at nothing that comes in.
    desk.state._timer.stop()
    gateway.stop()
    gateway.site = replace(gateway.site, origin=ELSEWHERE)
    gateway.start()
    wait_until(lambda: gateway.subscriptions != greeted)
    assert desk.state.site.origin != ELSEWHERE and desk.state.link.phase.value == "connected"
    desk.sending.send()
    # What stops is right wherever it comes to.
    desk.emergency_stop()
    wait(lambda: gateway.requests_of("emergency_stop"), what="the stop")
    assert gateway.requests_of("send") == []
    desk.state.pull()
    assert desk.drafts.draft is None


def test_a_target_whose_way_is_sought_goes_out_to_no_other_site(at_desk, gateway, site, wait, iface):
    tell(gateway, replace(site, roads=True), wait, at_desk)
    gateway.mute.add("get_route")
    gateway.show(replace(gateway.robots["r1"], paths="cones"))
    desk = at_desk.desk
    wait(lambda: desk.state.report_of("r1").paths, what="what r1 takes")
    desk.selection.select("r1")
    at_desk.actions.cone.trigger()
    iface.click(70, 55)
    desk.sending.send()
    desk.selection.select("r2")
    iface.click(30, 30)
    assert len(desk.target_ways._beside) == 1
    tell(gateway, replace(site, roads=True, origin=ELSEWHERE), wait, at_desk)
    assert not desk.target_ways._beside and desk.drafts.draft is None
    assert [text for text in iface.texts() if "r1" in text and "another site is served now" in text]


def test_a_road_is_not_closed_on_another_site_than_it_was_clicked_on(at_desk, gateway, site, wait, iface):
    at_desk.actions.closures.trigger()
    iface.click(70, 55)
    dialog = iface.findChild(QDialog, "fleet_closure_dialog")
    assert dialog.isVisible()
    tell(gateway, replace(site, version="2"), wait, at_desk)
    assert dialog.isVisible()
    tell(gateway, replace(site, origin=ELSEWHERE), wait, at_desk)
    wait(lambda: sip.isdeleted(dialog) or not dialog.isVisible(), what="the end of the question")
    assert gateway.requests_of("close_road") == []
