"""A connection in QGIS's options: made, tested, handed on by a file, and edited."""

from __future__ import annotations

import json

from tests.support.errors import StageError
from tools.walkthrough.scene import NAME, Scene

CONNECTION = "Proving ground"
AUTHENTICATION = f"Fleet Supervisor: {CONNECTION} (Basic)"
MASTER_PASSWORD = "kept in nobody's head"


def keep_connection(scene: Scene) -> None:
    """Make a connection, export, remove and import it, and give it the token that QGIS has kept."""
    open_options(scene)
    make(scene)
    hand_on(scene)
    close_options(scene)
    # Opened anew it says no more where this computer has the file.
    open_options(scene)
    edit(scene)
    close_options(scene)


def open_options(scene: Scene) -> None:
    operator = scene.operator
    operator.choose_from_menu("Settings", "Options…")
    operator.wait_for_dialog("mOptionsTreeView")
    operator.click_row("mOptionsTreeView", "Fleet Supervisor")


def close_options(scene: Scene) -> None:
    scene.operator.press("Enter")
    scene.operator.wait_for_no_dialog()


def make(scene: Scene) -> None:
    """Make it with its token; QGIS asks for the master password under which it keeps that."""
    operator = scene.operator
    operator.click("fleet_connections_new")
    operator.wait_for_dialog("fleet_connection_dialog")
    operator.write("fleet_connection_name", CONNECTION)
    operator.write("fleet_connection_url", f"{scene.gateway.address}/desk")
    operator.write("fleet_connection_operator", NAME)
    operator.write("fleet_connection_token", scene.gateway.token)
    operator.press("Enter")
    operator.wait_for_dialog("leMasterPass")
    operator.write("leMasterPass", MASTER_PASSWORD)
    operator.write("leMasterPassVerify", MASTER_PASSWORD)
    operator.press("Enter")
    operator.wait_for_dialog("fleet_connections_test")
    operator.click("fleet_connections_test")
    operator.wait_for_text("fleet_verdict", f"answers, as {NAME}, supervisor")
    scene.film.shoot("options", "a connection in QGIS's options, tested")


def hand_on(scene: Scene) -> None:
    """Write the connection to a file, remove it, and read it from there."""
    operator, file = scene.operator, scene.home / "Documents" / "connections.json"
    operator.click("fleet_connections_export")
    operator.wait_for_dialog("fileNameEdit")
    operator.press("Enter")
    operator.wait("the file being written", file.exists)
    operator.wait_for_dialog("fleet_connections_remove")
    text = file.read_text(encoding="utf-8")
    if scene.gateway.token in text or [one["name"] for one in json.loads(text)["connections"]] != [
        CONNECTION
    ]:
        raise StageError(f"this is not the connection without its token: {text}")
    operator.click("fleet_connections_remove")
    operator.wait_for_text("fleet_verdict", "Removed")
    operator.click("fleet_connections_import")
    operator.wait_for_dialog("fileNameEdit")
    operator.write("fileNameEdit", str(file))
    operator.press("Enter")
    operator.wait_for_dialog("fleet_connections")
    operator.wait_for_text("fleet_verdict", "connections.json")


def edit(scene: Scene) -> None:
    """Give the connection the authentication that QGIS keeps, and test that."""
    operator = scene.operator
    operator.click_row("fleet_connections", CONNECTION)
    operator.click("fleet_connections_edit")
    operator.wait_for_dialog("fleet_connection_dialog")
    operator.click("cmbConfigSelect")
    operator.click_row("cmbConfigSelect", AUTHENTICATION)
    operator.click("fleet_connection_test")
    operator.wait_for_text("fleet_verdict", f"answers, as {NAME}, supervisor")
    scene.film.shoot("connection", "the connection with one of QGIS's authentication configurations")
    operator.click("fleet_connection_name")
    operator.press("Enter")
    operator.wait_for_dialog("fleet_connections")
