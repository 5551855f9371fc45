"""The site is chosen among its neighbours by a supervisor, who reads first what that means for robots."""

from __future__ import annotations

from dataclasses import replace

import pytest
from fleet_supervisor.robot_bridge.core.messages.administration import SiteOffer, Sites
from fleet_supervisor.robot_bridge.core.messages.base import to_json
from qgis.PyQt import sip
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QAction, QDialog, QLabel, QLineEdit, QPushButton

OTHER_FRAME = "far has another frame (EPSG:32634), and positions of the one are wrong in the other"


class Choice:
    """A gateway's sites, and what an operator sees of them."""

    def __init__(self, plugin, iface, gateway, wait):
        self._plugin, self._iface, self._gateway, self.wait = plugin, iface, gateway, wait
        self.offers = [
            SiteOffer("far", False, "far", "Far field", 1, OTHER_FRAME),
            SiteOffer("south", False, "south", "South field", 4),
            SiteOffer("yard", True, "yard", "Yard", 1),
        ]
        gateway.answers["get_sites"] = lambda _: {"result": to_json(Sites(self.offers))}
        gateway.answers["choose_site"] = self._serve

    def _serve(self, params: dict) -> dict:
        self.offers = [replace(one, served=one.site == params["site"]) for one in self.offers]
        return {"result": to_json(self._gateway.site)}

    def connect(self) -> None:
        panel = self._plugin.window.dock.connection_panel
        panel.findChild(QLineEdit, "fleet_url").setText(self._gateway.url)
        self._plugin.window.actions.connect.trigger()
        desk = self._plugin.window.desk
        self.wait(
            lambda: desk.state.link.phase.value == "connected" and desk.state.site is not None,
            what="the link",
        )

    def open(self) -> None:
        self._iface.findChild(QAction, "fleet_site_choice").trigger()

    def window(self):
        return self._iface.findChild(QDialog, "fleet_sites_dialog")

    def rows(self) -> list[tuple]:
        model = self.window().model
        return [
            tuple(model.data(model.index(row, column)) for column in range(model.columnCount()))
            for row in range(model.rowCount())
        ]

    def states(self) -> dict[str, str]:
        return {row[1]: row[3] for row in self.rows()}

    def choose(self, folder: str) -> None:
        view = self.window().view
        at = next(row for row, offer in enumerate(self.window().model.rows) if offer.site == folder)
        place = view.visualRect(view.model().index(at, 0)).center()
        QTest.mouseClick(view.viewport(), Qt.MouseButton.LeftButton, pos=place)

    def serve(self) -> QPushButton:
        return self.window().findChild(QPushButton, "fleet_site_serve")

    def question(self) -> QDialog:
        QTest.mouseClick(self.serve(), Qt.MouseButton.LeftButton)
        return next(
            one for one in self.window().findChildren(QDialog, "fleet_site_question") if one.isVisible()
        )

    def wait_for_status(self, text: str) -> None:
        said = self.window().status
        self.wait(lambda: text in said.text(), what=f"{text!r} in place of {said.text()!r}")


@pytest.fixture
def choice(plugin, iface, gateway, wait):
    gateway.who = {"operator": "Ada", "role": "supervisor"}
    return Choice(plugin, iface, gateway, wait)


@pytest.fixture
def at_choice(choice):
    """Connected, with the window open and the sites listed."""
    choice.connect()
    choice.open()
    choice.wait(lambda: len(choice.rows()) == 3, what="the sites")
    return choice


def confirm(question: QDialog) -> None:
    QTest.mouseClick(question.findChild(QPushButton, "fleet_site_confirm"), Qt.MouseButton.LeftButton)


def test_the_sites_are_listed_with_what_keeps_them_from_being_chosen(at_choice):
    assert at_choice.rows() == [
        ("Far field", "far", "1", OTHER_FRAME),
        ("South field", "south", "4", "can be chosen"),
        ("Yard", "yard", "1", "served now"),
    ]
    at_choice.wait_for_status("3 sites")
    view = at_choice.window().view
    assert view.rowHeight(0) > view.rowHeight(1), "why it cannot be chosen takes more than a line"


@pytest.mark.parametrize(("folder", "can"), [("far", False), ("south", True), ("yard", False)])
def test_only_what_can_be_served_can_be_chosen(at_choice, folder, can):
    assert not at_choice.serve().isEnabled()
    at_choice.choose(folder)
    assert at_choice.serve().isEnabled() is can


def test_a_site_is_served_once_that_is_confirmed(at_choice, gateway):
    at_choice.choose("south")
    question = at_choice.question()
    words = " ".join(label.text() for label in question.findChildren(QLabel))
    assert "Every robot is sent the map of South field" in words and "No robot is stopped" in words
    confirm(question)
    at_choice.wait_for_status("South field is served now.")
    assert gateway.requests_of("choose_site") == [{"site": "south"}]
    at_choice.wait(lambda: at_choice.states()["south"] == "served now")
    assert at_choice.states()["yard"] == "can be chosen"
    assert not at_choice.serve().isEnabled()
    assert at_choice.window().status.text() == "South field is served now."


def test_enter_changes_no_site(at_choice, gateway):
    at_choice.choose("south")
    question = at_choice.question()
    QTest.keyClick(question, Qt.Key.Key_Return)
    assert sip.isdeleted(question) or not question.isVisible()
    asked = len(gateway.requests_of("get_sites"))
    QTest.mouseClick(
        at_choice.window().findChild(QPushButton, "fleet_sites_refresh"), Qt.MouseButton.LeftButton
    )
    at_choice.wait(lambda: len(gateway.requests_of("get_sites")) > asked)
    assert gateway.requests_of("choose_site") == []


def test_a_refusal_is_shown_in_the_gateways_words(at_choice, gateway):
    gateway.refuse["choose_site"] = "south/site.gpkg cannot be read; yard is served on"
    at_choice.choose("south")
    confirm(at_choice.question())
    at_choice.wait_for_status("Serve South field: south/site.gpkg cannot be read; yard is served on")
    assert at_choice.states()["yard"] == "served now"


def test_what_another_supervisor_chose_is_seen(at_choice, gateway):
    at_choice._serve({"site": "south"})
    gateway.site = replace(gateway.site, id="south", name="South field")
    gateway.tell("site", to_json(gateway.site))
    at_choice.wait(lambda: at_choice.states()["south"] == "served now")


def test_who_is_no_supervisor_reads_why_and_nothing_is_asked(choice, gateway):
    gateway.who = {"operator": "Ben", "role": "operator"}
    choice.connect()
    choice.open()
    choice.wait_for_status("takes a supervisor, and Ben is operator here")
    assert choice.rows() == [] and not choice.serve().isEnabled()
    assert gateway.requests_of("get_sites") == []


def test_when_the_link_goes_the_question_and_the_sites_go_too(at_choice, gateway):
    at_choice.choose("south")
    question = at_choice.question()
    gateway.stop()
    at_choice.wait_for_status("not connected")
    assert sip.isdeleted(question) or not question.isVisible()
    assert at_choice.rows() == [] and not at_choice.serve().isEnabled()


def test_unloading_closes_it(at_choice, plugin, iface):
    from qgis.PyQt.QtCore import QCoreApplication, QEvent

    at_choice.choose("south")
    at_choice.question()
    plugin.unload()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    assert iface.findChild(QDialog, "fleet_sites_dialog") is None
    assert iface.findChild(QDialog, "fleet_site_question") is None
    assert iface.findChild(QAction, "fleet_site_choice") is None
