"""A real gateway's first account, a second one and its end, and another site, all from the desk's windows."""

from __future__ import annotations

import shutil
from dataclasses import replace

import pytest
from fleet_supervisor.plugin.gateway_client.connection_status import ConnectionPhase, OperatorCredentials
from fleet_supervisor.robot_bridge.core.sites.site import read_site, write_site
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QAction, QDialog, QLineEdit, QPushButton

SECONDS = 15


@pytest.fixture
def sites(tmp_path, root):
    """The sample site in the folder north, and beside it the same ground under another name."""
    sample, folder = root / "resources" / "sample_site", tmp_path / "sites"
    (folder / "north").mkdir(parents=True)
    for name in ("site.toml", "site.gpkg"):
        shutil.copy(sample / name, folder / "north")
    site = read_site(sample)
    settings = replace(site.settings, id="south", name="South field")
    write_site(folder / "south", settings, site.outlines, site.centrelines, site.surfaces, site.keepouts)
    return folder


def shown(operator, iface, name):
    """Wait for a window of this name."""

    def visible():
        return [one for one in iface.findChildren(QDialog, name) if one.isVisible()]

    operator.wait(name, visible, SECONDS)
    return visible()[0]


def click(window, name):
    window.findChild(QPushButton, name).click()


def told(operator, window, text):
    operator.wait(f"{text!r}, not {window.status.text()!r}", lambda: text in window.status.text(), SECONDS)


def take_token(operator, iface):
    dialog = shown(operator, iface, "fleet_token_dialog")
    token = dialog.findChild(QLineEdit, "fleet_new_token").text()
    dialog.reject()
    return token


def make_account(operator, iface, window, name):
    click(window, "fleet_account_add")
    question = shown(operator, iface, "fleet_new_account")
    QTest.keyClicks(question.findChild(QLineEdit, "fleet_account_name"), name)
    click(question, "fleet_new_account_confirm")
    return take_token(operator, iface)


def choose(window, key):
    row = next(k for k, one in enumerate(window.model.rows) if window._key(one) == key)
    window.view.selectRow(row)


def test_accounts_and_site_are_kept_from_the_desk(start_loop, sites, operator, iface):
    loop, desk = start_loop(sites / "north"), operator.desk
    url = f"{loop.address}/desk"
    operator.connect(url, "anna")
    operator.wait("the site", lambda: desk.state.site is not None, SECONDS)
    iface.findChild(QAction, "fleet_accounts").trigger()
    window = shown(operator, iface, "fleet_accounts_dialog")
    told(operator, window, "has no accounts")
    # The first account closes the desk to everybody without a token.
    adas = make_account(operator, iface, window, "Ada")
    operator.wait("being cut off", lambda: desk.state.link.phase is ConnectionPhase.FAILED, SECONDS)
    desk.open_link(url, "somebody", OperatorCredentials(adas))
    told(operator, window, "1 account")
    bens = make_account(operator, iface, window, "Ben")
    assert adas != bens
    operator.wait("two accounts", lambda: len(window.model.rows) == 2, SECONDS)
    ada, ben = window.model.rows
    assert (ada.name, ada.is_own, ada.is_connected, ada.report.role.value) == (
        "Ada",
        True,
        True,
        "supervisor",
    )
    assert (ben.name, ben.is_own, ben.is_connected, ben.report.role.value) == ("Ben", False, False, "viewer")
    choose(window, "Ada")
    click(window, "fleet_account_revoke")
    click(shown(operator, iface, "fleet_revocation"), "fleet_revocation_confirm")
    told(operator, window, "would leave no supervisor")
    choose(window, "Ben")
    click(window, "fleet_account_revoke")
    click(shown(operator, iface, "fleet_revocation"), "fleet_revocation_confirm")
    told(operator, window, "The token of Ben is revoked.")
    choose_south(operator, iface, desk)
    desk.open_link(url, "Ben", OperatorCredentials(bens))
    operator.wait("being refused", lambda: desk.state.link.phase is ConnectionPhase.FAILED, SECONDS)
    assert "revoked" in desk.state.link.reason


def choose_south(operator, iface, desk):
    iface.findChild(QAction, "fleet_site_choice").trigger()
    window = shown(operator, iface, "fleet_sites_dialog")
    told(operator, window, "2 sites")
    choose(window, "south")
    click(window, "fleet_site_serve")
    click(shown(operator, iface, "fleet_site_question"), "fleet_site_confirm")
    told(operator, window, "South field is served now.")
    operator.wait("the desk's site", lambda: desk.state.site.id == "south", SECONDS)
