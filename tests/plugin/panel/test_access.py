"""Token, CA file and TLS at the desk: a real gateway process, real certificates, the panel's own fields."""

from __future__ import annotations

import contextlib
import os
import ssl
import threading
from pathlib import Path

import pytest
from fleet_supervisor.plugin.gateway_client import connection as connection_module
from fleet_supervisor.plugin.gateway_client.connection import ConnectionThread
from fleet_supervisor.plugin.gateway_client.connection_status import (
    ROLES,
    ConnectionPhase,
    ConnectionStatus,
    OperatorCredentials,
)
from fleet_supervisor.plugin.panel.connection_panel import AccessFields
from fleet_supervisor.plugin.settings.profile import TokenStore
from fleet_supervisor.plugin.ui.errors import AddressError
from fleet_supervisor.robot_bridge.core.messages.base import Role
from fleet_supervisor.robot_bridge.core.messages.commands import AbortAll, Send
from fleet_supervisor.robot_bridge.core.messages.safety import ClearEmergencyStop, EmergencyStop
from qgis.core import QgsApplication, QgsSettings
from qgis.gui import QgsFileWidget
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QCheckBox, QLabel, QLineEdit, QToolButton

from tests.support.bridge.command_line import run_command
from tests.support.processes import Processes

SECRET = "fleet_op_0123456789abcdefghijklmnopqrstuvwxyzABCDEFG"


@pytest.fixture(scope="module")
def bridge(root, tmp_path_factory):
    """A real gateway with TLS and Ada's account: its URL, its CA file, her token, and its command line."""
    folder = tmp_path_factory.mktemp("secure")
    database = f"sqlite:///{folder}/fleet.db"

    class Gateway:
        ca = folder / "tls" / "ca.pem"
        files = folder / "tls"

        @staticmethod
        def run(*words, on_database=True):
            ending = ["--database", database] if on_database else []
            done = run_command(*words, *ending)
            assert done.returncode == 0, done.stderr
            return done.stdout.strip()

    Gateway.run("tls", "create", Gateway.files, "--name", "localhost", on_database=False)
    Gateway.token = Gateway.run("operators", "add", "Ada", "--role", "operator")
    with Processes(folder / "logs") as processes:
        options = ["--certificate", Gateway.files / "server.pem", "--key", Gateway.files / "server-key.pem"]
        serve = ["serve", "--site", root / "resources" / "sample_site", "--port", "0", "--database", database]
        processes.start_bridge("gateway", [*serve, *options])
        found = processes.wait_for_line("gateway", r"listening on wss://127\.0\.0\.1:(\d+)", 20)
        Gateway.port = int(found.group(1))
        Gateway.url = f"wss://localhost:{Gateway.port}/desk"
        yield Gateway


@pytest.fixture
def connection():
    connection = ConnectionThread()
    yield connection
    connection.shut_down()


def link_when(connection, wait, phase):
    links = []
    wait(
        lambda: links.append(connection.collect_updates().link) or links[-1].phase is phase,
        10,
        what=str(phase),
    )
    return links[-1]


def test_a_desk_connects_over_tls_with_its_token(connection, bridge, wait):
    connection.open(bridge.url, "Ada", OperatorCredentials(bridge.token, str(bridge.ca)))
    link_when(connection, wait, ConnectionPhase.CONNECTED)


def failure(connection, bridge, wait, token, ca, url=None):
    connection.open(url or bridge.url, "Ada", OperatorCredentials(token, str(ca or "")))
    return link_when(connection, wait, ConnectionPhase.FAILED)


def test_without_a_token_the_desk_says_that_it_needs_one(connection, bridge, wait):
    link = failure(connection, bridge, wait, "", bridge.ca)
    assert "No token came with the request" in link.reason
    assert "Enter the operator's token under Access." in link.reason
    assert link.wants_token


def test_a_wrong_token_is_told_from_none(connection, bridge, wait):
    link = failure(connection, bridge, wait, SECRET, bridge.ca)
    assert "This token is not known" in link.reason
    assert link.wants_token
    assert SECRET not in link.reason


def test_an_authority_that_is_not_trusted_is_named_with_what_to_do(connection, bridge, wait, tmp_path):
    bridge.run("tls", "create", tmp_path / "other", "--name", "localhost", on_database=False)
    for ca in ("", tmp_path / "other" / "ca.pem"):
        link = failure(connection, bridge, wait, bridge.token, ca)
        assert "is from an authority that this desk does not trust" in link.reason
        assert "ca.pem" in link.reason
        assert link.wants_token


def test_another_name_than_the_certificates_is_named(connection, bridge, wait):
    url = f"wss://127.0.0.1:{bridge.port}/desk"
    link = failure(connection, bridge, wait, bridge.token, bridge.ca, url)
    assert "is for another name" in link.reason


def test_a_link_without_tls_says_that_the_other_may_be_meant(connection, bridge, wait):
    connection.open(f"ws://127.0.0.1:{bridge.port}/desk", "Ada")
    assert "ws:// or wss://" in link_when(connection, wait, ConnectionPhase.RETRYING).reason


def test_tls_to_a_gateway_without_it_says_so(connection, gateway, bridge, wait):
    connection.open(gateway.url.replace("ws://", "wss://"), "Ada", OperatorCredentials("", str(bridge.ca)))
    reason = link_when(connection, wait, ConnectionPhase.RETRYING).reason
    assert "If the gateway has no TLS, write ws:// instead of wss://." in reason


@pytest.mark.parametrize(
    ("url", "credentials", "says"),
    [
        (
            "ws://gateway.example.org:8765/desk",
            OperatorCredentials(SECRET),
            "everybody on the way could read",
        ),
        ("ws://127.0.0.1:8765/desk", OperatorCredentials("two words"), "it is one word"),
    ],
)
def test_what_cannot_be_right_is_refused_before_anything_is_sent(connection, url, credentials, says):
    with pytest.raises(AddressError, match=says):
        connection.open(url, "Ada", credentials)
    assert not connection.is_open


def test_an_unusable_ca_file_is_named_and_read_outside_the_windows_thread(connection, wait, monkeypatch):
    made_in, create = [], ssl.create_default_context

    def note_thread(**options):
        made_in.append(threading.get_ident())
        return create(**options)

    monkeypatch.setattr(ssl, "create_default_context", note_thread)
    connection.open("wss://127.0.0.1:9/desk", "Ada", OperatorCredentials("", "/nowhere/ca.pem"))
    link = link_when(connection, wait, ConnectionPhase.FAILED)
    assert "The CA file /nowhere/ca.pem cannot be used: No such file or directory." in link.reason
    assert link.wants_token
    assert made_in and threading.get_ident() not in made_in


def test_a_link_is_given_up_while_its_ca_file_does_not_answer(connection, wait, tmp_path):
    ca = tmp_path / "ca.pem"
    os.mkfifo(ca)
    writers = []

    def is_read():
        # Refused as long as nobody reads.
        with contextlib.suppress(OSError):
            writers.append(os.open(ca, os.O_WRONLY | os.O_NONBLOCK))
        return bool(writers)

    connection.open("wss://127.0.0.1:9/desk", "Ada", OperatorCredentials("", str(ca)))
    wait(is_read, what="the reading of the CA file")
    try:
        connection.close()
        wait(lambda: connection.collect_updates() and not connection.is_ending, what="the end of the link")
    finally:
        os.close(writers.pop())


def test_a_ca_file_that_does_not_answer_is_named_and_waited_for(connection, wait, tmp_path, monkeypatch):
    monkeypatch.setattr(connection_module, "CA_PATIENCE", 0.05)
    ca = tmp_path / "ca.pem"
    os.mkfifo(ca)
    connection.open("wss://127.0.0.1:9/desk", "Ada", OperatorCredentials("", str(ca)))
    link = link_when(connection, wait, ConnectionPhase.RETRYING)
    assert f"The CA file {ca} has not answered" in link.reason and "127.0.0.1:9" in link.reason
    assert "choose a copy of the file on this computer" in link.reason
    # It answers: here with nothing that a CA file could have.
    ca.write_bytes(b"")
    assert "cannot be used" in link_when(connection, wait, ConnectionPhase.FAILED).reason


def test_a_revoked_token_ends_the_link_and_it_is_not_tried_again(connection, bridge, wait):
    token = bridge.run("operators", "add", "Bob", "--role", "viewer")
    connection.open(bridge.url, "Bob", OperatorCredentials(token, str(bridge.ca)))
    link_when(connection, wait, ConnectionPhase.CONNECTED)
    bridge.run("operators", "revoke", "Bob")
    link = link_when(connection, wait, ConnectionPhase.FAILED)
    assert "this token of Bob was revoked" in link.reason
    assert "new token" in link.reason
    assert link.wants_token


def test_a_session_that_was_ended_is_not_brought_back_by_itself(connection, bridge, wait):
    connection.open(bridge.url, "Ada", OperatorCredentials(bridge.token, str(bridge.ca)))
    link_when(connection, wait, ConnectionPhase.CONNECTED)
    wait(lambda: bridge.run("sessions", "list"))
    session = bridge.run("sessions", "list").split("\t")[0]
    bridge.run("sessions", "end", session, "--reason", "shift is over")
    link = link_when(connection, wait, ConnectionPhase.FAILED)
    assert "ended your session: shift is over" in link.reason
    assert not link.wants_token


# --- where the token is kept ----------------------------------------------------------------------------


@pytest.fixture
def master_password():
    """The authentication manager of the test's own profile, opened."""
    manager = QgsApplication.authManager()
    if manager.isDisabled():
        pytest.skip("this QGIS has no authentication manager (QCA is missing)")
    assert manager.setMasterPassword("a password for tests", False)
    yield
    for url in ("wss://one/desk", "wss://two/desk"):
        TokenStore().forget(url)


def test_a_token_is_kept_encrypted_for_its_gateway_alone(master_password):
    store = TokenStore()
    store.keep("wss://one/desk", SECRET)
    assert store.has("wss://one/desk")
    assert store.read("wss://one/desk") == SECRET
    assert store.read("wss://two/desk") == ""
    database = QgsApplication.authManager().authenticationDatabasePath()
    assert SECRET.encode() not in Path(database).read_bytes()
    store.forget("wss://one/desk")
    assert not store.has("wss://one/desk")


def fields_of(widget):
    return (
        widget.findChild(QLineEdit, "fleet_token"),
        widget.findChild(QCheckBox, "fleet_keep_token"),
        widget.findChild(QgsFileWidget, "fleet_ca_file"),
    )


def test_a_token_that_is_not_to_be_kept_is_gone_with_the_panel(master_password):
    widget = AccessFields()
    widget.show_kept("wss://one/desk")
    token, keep, _ = fields_of(widget)
    token.setText(SECRET)
    assert not keep.isChecked()
    assert widget.credentials("wss://one/desk").token == SECRET
    widget.remember("wss://one/desk")
    again = AccessFields()
    again.show_kept("wss://one/desk")
    assert again.credentials("wss://one/desk").token == ""


def test_a_token_that_is_kept_stands_in_no_field_and_no_settings_file(master_password):
    widget = AccessFields()
    widget.show_kept("wss://one/desk")
    token, keep, _ = fields_of(widget)
    token.setText(SECRET)
    keep.setChecked(True)
    widget.remember("wss://one/desk")
    assert token.text() == ""
    settings = QgsSettings()
    settings.sync()
    everything = {key: str(settings.value(key)) for key in settings.allKeys()}
    assert not [key for key, value in everything.items() if SECRET in value]
    again = AccessFields()
    again.show_kept("wss://one/desk")
    assert fields_of(again)[1].isChecked()
    assert again.credentials("wss://one/desk").token == SECRET
    again.show_kept("wss://two/desk")
    assert again.credentials("wss://two/desk").token == ""


def test_what_is_typed_is_not_shown_and_the_ca_file_is_remembered(tmp_path):
    widget = AccessFields()
    token, _, ca = fields_of(widget)
    assert token.echoMode() == QLineEdit.EchoMode.Password
    ca.setFilePath(str(tmp_path / "ca.pem"))
    widget.remember("ws://one/desk")
    assert AccessFields().credentials("ws://one/desk").ca_file == str(tmp_path / "ca.pem")
    QgsSettings().remove("fleet_supervisor/ca_file")


def test_credentials_do_not_show_the_token():
    assert SECRET not in repr(OperatorCredentials(SECRET))


def test_an_operator_connects_by_the_panel_alone_and_sees_what_is_missing(plugin, bridge, wait):
    window = plugin.window
    panel = window.dock.connection_panel
    token, _, ca = fields_of(panel)
    access = panel.findChild(AccessFields)
    assert not access.isVisibleTo(panel)
    url = panel.findChild(QLineEdit, "fleet_url")
    url.clear()
    QTest.keyClicks(url, bridge.url)
    assert access.isVisibleTo(panel)
    ca.setFilePath(str(bridge.ca))
    connect = panel.findChild(QToolButton, "fleet_connect_button")
    QTest.mouseClick(connect, Qt.MouseButton.LeftButton)
    label = panel.findChild(QLabel, "fleet_link_state")
    wait(lambda: "No token came with the request" in label.text(), 10)
    QTest.keyClicks(token, bridge.token)
    QTest.mouseClick(connect, Qt.MouseButton.LeftButton)
    wait(lambda: "Connected" in label.text(), 10)
    wait(lambda: "Ada, operator" in label.text())
    assert not access.isEnabled()
    assert SECRET not in label.text()
    picture = os.environ.get("FLEET_PICTURE")
    if picture:
        window.dock.grab().save(picture)


def test_the_role_stands_there_in_the_operators_words(plugin, site, monkeypatch):
    monkeypatch.setitem(ROLES, Role.SUPERVISOR, "felügyelő")
    panel = plugin.window.dock.connection_panel
    panel.show_link(ConnectionStatus(ConnectionPhase.CONNECTED, operator="Ada", role="supervisor"), site, 0.0)
    assert panel.findChild(QLabel, "fleet_link_state").text().endswith("Yard · Ada, felügyelő")


def test_the_fields_open_when_the_gateway_asks_for_a_token(plugin, bridge, wait):
    panel = plugin.window.dock.connection_panel
    button = panel.findChild(QToolButton, "fleet_access_button")
    panel.show_link(ConnectionStatus(ConnectionPhase.FAILED, "no", wants_token=True), None, 0.0)
    assert button.isChecked()
    button.setChecked(False)
    panel.show_link(ConnectionStatus(ConnectionPhase.FAILED, "no", wants_token=True), None, 0.0)
    assert not button.isChecked()


# --- what each role may -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("role", "stops", "clears"),
    [("viewer", False, False), ("operator", True, False), ("supervisor", True, True)],
)
def test_each_role_reaches_as_far_as_it_may_and_is_told_where_it_ends(
    plugin, iface, bridge, wait, role, stops, clears
):
    window, answers = plugin.window, []
    desk = window.desk
    token = bridge.run("operators", "add", role.title(), "--role", role)
    desk.open_link(bridge.url, role.title(), OperatorCredentials(token, str(bridge.ca)))
    wait(lambda: desk.state.link.phase is ConnectionPhase.CONNECTED and desk.state.site is not None, 10)
    desk.orders.answered.connect(answers.append)

    def error_of(request, action) -> str:
        # Questions that the desk asks by itself, such as for observations, are answered here as well.
        def to_request():
            return [answer for answer in answers if answer.order.method == request.method]

        action()
        wait(to_request, 10, what=f"the answer to {request.method}")
        return str(to_request()[-1].error or "")

    def draw_and_send():
        desk.selection.select("nobody")
        window.actions.cone.trigger()
        iface.canvas.mapTool().add_point((100.0, 80.0))
        wait(lambda: not desk.checks.is_under_way)
        window.actions.send.trigger()

    refused = f"{role.title()} is {role}, and this takes"
    assert (refused in error_of(Send, draw_and_send)) is not stops
    assert (refused in error_of(AbortAll, window.actions.abort_all.trigger)) is not stops
    assert (refused in error_of(EmergencyStop, window.actions.emergency.trigger)) is not stops
    assert (desk.state.emergency is not None and desk.state.emergency.in_force) is stops
    stop = desk.state.emergency.stop if stops else "none"
    error = error_of(ClearEmergencyStop, lambda: desk.clear_emergency(stop, "all is well again"))
    assert (f"{refused} supervisor" in error) is not clears
    wait(lambda: any(refused in text for text in iface.texts()) is not clears)
    if clears:
        wait(lambda: not desk.state.emergency.in_force)
