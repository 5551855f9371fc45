"""The site is published anew, another is chosen, or another gateway answers: what stays and what goes."""

from __future__ import annotations

from dataclasses import replace

import pytest
from fleet_supervisor.plugin.ui import scheduling
from fleet_supervisor.robot_bridge.core.messages.base import to_json
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QLabel


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
    at_desk.desk.settled.connect(over.append)
    tell(gateway, replace(site, problem="site south cannot be read"), wait, at_desk)
    text = "This gateway serves another site than the rest of the fleet: site south cannot be read."
    assert began == [text] and over == []
    tell(gateway, site, wait, at_desk)
    assert over == [text]
