"""The desk without a mouse: the menu's letters and keys, and every dialog by Tab, Enter and Esc."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from fleet_supervisor.plugin.ui.actions import KEYS, with_letters
from fleet_supervisor.plugin.ui.language import CONTEXT, FOLDER
from qgis.gui import QgsGui
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QEvent, Qt, QTranslator
from qgis.PyQt.QtGui import QFocusEvent, QImage
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import (
    QAbstractButton,
    QApplication,
    QDialogButtonBox,
    QLabel,
    QMenu,
    QPushButton,
    QWidget,
)

ROW = 12
"""Pixels that parts of one row may be apart in height."""

FUNCTION_KEYS_OF_QGIS = {"F1", "Shift+F1", "F5", "F6", "Shift+F6", "Ctrl+F6", "F7", "F11", "F12"}
"""As its window comes: help, what is this, refresh, attribute tables, styling, full screen, development."""


# --- the menu ---


def letter_of(text):
    return text[text.index("&") + 1].casefold() if "&" in text else None


def drafts_in(iface):
    """The menu of what makes, changes and sends drafts."""
    return iface.mainWindow().findChild(QMenu, "fleet_draft_menu")


def menus(plugin, iface):
    """The entries of the plugin's menu that do something, and those of its menu of drafts."""
    drafts = drafts_in(iface)
    return [one for one in iface.plugins.actions() if one.menu() is not drafts], drafts.actions()


def test_every_action_is_in_the_menu_and_in_qgis_list_of_shortcuts(plugin, iface):
    listed = {action.objectName() for action in QgsGui.shortcutsManager().listActions()}
    entries = {action.objectName() for menu in menus(plugin, iface) for action in menu}
    assert {action.objectName() for action in plugin.window.actions.all()} <= entries
    assert plugin.window.actions.clear_emergency.objectName() in entries
    # Its keys are its own: nobody can take them away.
    assert entries - listed == {"fleet_emergency_stop"}
    assert set(KEYS) <= entries
    assert all(action.toolTip() for menu in menus(plugin, iface) for action in menu)


def test_no_two_entries_have_the_same_letter_key_or_name(plugin, iface):
    for menu in menus(plugin, iface):
        letters = [letter for letter in (letter_of(action.text()) for action in menu) if letter]
        assert len(letters) == len(set(letters)) >= 12
    actions = [action for menu in menus(plugin, iface) for action in menu]
    assert len({action.text().replace("&", "") for action in actions}) == len(actions) >= 30
    keys = [key.toString() for action in actions for key in action.shortcuts()]
    assert len(keys) == len(set(keys)) >= len(KEYS)


def test_each_menu_stands_in_one_column_on_a_low_screen_with_a_large_font(plugin, iface):
    for menu in (iface.plugins, drafts_in(iface)):
        font = menu.font()
        font.setPointSize(12)
        menu.setFont(font)
        assert menu.sizeHint().height() <= 700


def test_qgis_itself_has_none_of_the_keys():
    assert not set(KEYS.values()) & FUNCTION_KEYS_OF_QGIS


def test_what_has_no_key_has_a_letter(plugin, iface):
    entries = [action for menu in menus(plugin, iface) for action in menu]
    without_key = [one.text() for one in entries if one.shortcut().isEmpty()]
    assert [text for text in without_key if "&" not in text] == []


def test_letters_stay_unique_when_an_entry_changes_its_text(plugin, iface):
    connect = plugin.window.actions.connect
    connect.setText("Disconnect")
    letters = [letter_of(one.text()) for one in iface.plugins.actions() if "&" in one.text()]
    assert len(letters) == len(set(letters))
    assert connect.text().replace("&", "") == "Disconnect"


def test_buttons_show_no_letters(plugin):
    dock = plugin.window.dock
    for name in ("fleet_abort_all_button", "fleet_emergency_stop_button", "fleet_connect_button"):
        assert "&" not in dock.findChild(QWidget, name).text()


@pytest.mark.parametrize("name", ["fleet_abort_all_button", "fleet_emergency_stop_button"])
def test_it_is_plainly_seen_which_stop_has_the_keyboard(plugin, wait, name):
    """On their colours the style's own line round the text is lost."""
    dock = plugin.window.dock
    dock.show()
    dock.activateWindow()
    button = dock.findChild(QPushButton, name)
    dock.table.setFocus()
    without, place = lightness(button), button.geometry()
    button.setFocus(Qt.FocusReason.TabFocusReason)
    wait(button.hasFocus, what="the keyboard")
    changed = np.count_nonzero(np.abs(lightness(button) - without) > 60)
    assert changed > button.width() + button.height()
    assert button.geometry() == place


def lightness(widget):
    """How light each pixel of a widget is, as it is drawn now: 0 to 255."""
    image = widget.grab().toImage().convertToFormat(QImage.Format.Format_Grayscale8)
    pixels = image.constBits().asstring(image.sizeInBytes())
    return np.frombuffer(pixels, np.uint8).reshape(image.height(), -1).astype(int)


def test_whoever_hears_the_screen_hears_what_each_part_of_the_fleet_panel_is(plugin):
    """A reader says the name of what has the keyboard: its own, its text, or that of the label before it."""
    assert " ".join(parts_without_a_name(plugin.window.dock)) == ""


@pytest.mark.parametrize("question", ["clear", "override"])
def test_a_line_for_a_reason_has_its_question_as_its_name(dialogs, question):
    (left,) = [list(parts_without_a_name(dialog)) for name, dialog in dialogs() if name == question]
    assert not left


def parts_without_a_name(window):
    """Names of the plugin's objects that Tab leads to and that would be read as a kind alone."""
    labelled = {label.buddy() for label in window.findChildren(QLabel)}
    for part in window.findChildren(QWidget):
        reached = part.focusPolicy() & Qt.FocusPolicy.TabFocus and part.focusProxy() is None
        text = part.text() if isinstance(part, QAbstractButton) else ""
        named = part in labelled or part.accessibleName() or text
        if reached and part.objectName().startswith("fleet_") and not named:
            yield part.objectName()


DOCKS = ("fleet_observation_dock", "fleet_plan_dock", "fleet_replay_dock")
PANELS = ("fleet_alarm_panel", *DOCKS)


def test_panels_leave_alt_and_letters_to_the_menus_of_qgis(plugin, iface):
    """Qt would do neither: of two parts of one window with one letter it only shows the first."""
    for name in PANELS:
        panel = iface.findChild(QWidget, name)
        if name in DOCKS:
            panel.build()
        buttons = [one for one in panel.findChildren(QAbstractButton) if one.text()]
        assert buttons, name
        assert [one.text() for one in buttons if letter_of(one.text())] == [], name


def test_the_fleet_panel_has_one_letter_which_leads_into_it(plugin):
    panel = plugin.window.dock.connection_panel
    parts = [*panel.findChildren(QAbstractButton), *panel.findChildren(QLabel)]
    assert [one.text() for one in parts if letter_of(one.text())] == ["&Gateway"]


def test_tab_leads_from_the_gateways_address_to_the_connections(plugin):
    panel = plugin.window.dock.connection_panel
    widget = panel.findChild(QWidget, "fleet_url")
    visited = []
    while "fleet_connections_button" not in visited:
        widget = widget.nextInFocusChain()
        assert widget.objectName() != "fleet_url", f"it leads round by {visited}"
        if widget.focusPolicy() & Qt.FocusPolicy.TabFocus and widget.isVisibleTo(panel):
            visited.append(widget.objectName())
    before = ["fleet_access_button", "fleet_operator", "fleet_connect_button"]
    assert visited == [*before, "fleet_connections_button"]


MENUS_OF_QGIS = (
    "Pro&ject", "&Edit", "&View", "&Layer", "&Settings", "&Plugins", "Vect&or", "&Raster", "&Database",
    "&Web", "&Mesh", "Pro&cessing", "&Help",
)  # fmt: skip


@pytest.mark.parametrize("language", ["en", "hu", "ca", "es"])
def test_no_menu_of_qgis_has_the_letter_of_the_fleet_panel(qgis_app, language):
    qgis, ours = QTranslator(), QTranslator()
    if language != "en":
        assert ours.load(str(FOLDER / f"fleet_supervisor_{language}.qm"))
        if not qgis.load(f"qgis_{language}", qgis_app.i18nPath()):
            pytest.skip(f"this QGIS does not come in the language {language}")
    menus = [qgis.translate("MainWindow", text) or text for text in MENUS_OF_QGIS]
    assert "v" in map(letter_of, menus)
    own = letter_of(ours.translate(CONTEXT, "&Gateway") or "&Gateway")
    assert own not in map(letter_of, menus)


def test_letters_go_round_by_giving_way():
    assert with_letters(["ab", "a", "b c"]) in (["a&b", "&a", "b &c"], ["&ab", "a", "&b c"])
    given = with_letters(["ab", "a", "b c"])
    assert sum("&" in text for text in given) == 3
    assert with_letters(["ő", "ő"]) == ["&ő", "ő"]
    assert with_letters(["…"]) == ["…"]


def test_an_emergency_stop_that_is_not_in_force_cannot_be_cleared_and_that_is_said(plugin, iface):
    plugin.window.actions.clear_emergency.trigger()
    assert any("No emergency stop is in force." in text for text in iface.texts())


# --- dialogs ---


@pytest.fixture
def dialogs(plugin, iface):
    """Every dialog of the plugin by its name, open one after the other."""
    from tests.plugin.language import every_dialog

    def opened():
        for name, dialog in every_dialog.dialogs(iface, plugin.window):
            dialog.open()
            QApplication.processEvents()
            yield name, dialog
            if not sip.isdeleted(dialog):
                dialog.close()
                dialog.deleteLater()

    return opened


def test_esc_closes_every_dialog(dialogs):
    for name, dialog in dialogs():
        QTest.keyClick(dialog.focusWidget() or dialog, Qt.Key.Key_Escape)
        assert sip.isdeleted(dialog) or not dialog.isVisible(), name


def defaults_of(dialog):
    return [button.objectName() for button in dialog.findChildren(QPushButton) if button.isDefault()]


def test_enter_has_one_meaning_in_every_dialog(dialogs):
    for name, dialog in dialogs():
        if dialog.findChildren(QPushButton):
            assert len(defaults_of(dialog)) == 1, (name, defaults_of(dialog))


def test_enter_keeps_its_meaning_when_the_keyboard_comes_back_from_a_button(dialogs):
    """A button that has the keyboard has Enter meanwhile; a field is given back what it had."""
    changed = []
    for name, dialog in dialogs():
        before = defaults_of(dialog)
        buttons = [button for button in dialog.findChildren(QPushButton) if button.isEnabled()]
        for button in filter(QPushButton.autoDefault, buttons):
            for event in (QEvent.Type.FocusIn, QEvent.Type.FocusOut):
                QApplication.sendEvent(button, QFocusEvent(event, Qt.FocusReason.TabFocusReason))
            if defaults_of(dialog) != before:
                changed.append((name, button.objectName() or button.text(), defaults_of(dialog), before))
                break
    assert not changed, repr(changed)


def test_enter_does_not_let_robots_go(dialogs):
    """What stops robots, lets them go or cuts an operator off by a slip of the hand is not behind Enter."""
    doing = {
        "revocation": "fleet_revocation_confirm",
        "new_token": "fleet_another_token_confirm",
        "role": "fleet_another_role_confirm",
        "site_question": "fleet_site_confirm",
    }
    found = dict.fromkeys(("clear", "override", *doing))
    for name, dialog in dialogs():
        if name in found:
            found[name] = defaults_of(dialog)[0]
            if name == "override":
                assert not dialog.findChild(QPushButton, "fleet_override_confirm").isEnabled()
    assert found["clear"] == "fleet_clear_keep"
    assert not [name for name, button in doing.items() if found[name] in (None, button)]


def test_tab_goes_through_every_dialog_from_top_to_bottom(dialogs):
    for name, dialog in dialogs():
        parts = tab_order(dialog)
        places = [part.mapTo(dialog, part.rect().center()) for part in parts]
        for k, (here, there) in enumerate(pairwise(places)):
            on = there.y() >= here.y() - ROW and (there.y() > here.y() + ROW or there.x() >= here.x())
            # The buttons at the foot are in the platform's order.
            at_foot = all(isinstance(part.parentWidget(), QDialogButtonBox) for part in parts[k : k + 2])
            assert on or at_foot, (name, called(parts[k]), called(parts[k + 1]))


def tab_order(dialog):
    """What Tab reaches, from the top, as the dialog leads through it."""
    chain, part = [], dialog.nextInFocusChain()
    while part is not dialog:
        reached = part.focusPolicy() & Qt.FocusPolicy.TabFocus and part.isVisible() and part.isEnabled()
        if reached and part.window() is dialog and part.focusProxy() is None:
            chain.append(part)
        part = part.nextInFocusChain()
    heights = [part.mapTo(dialog, part.rect().center()).y() for part in chain]
    top = heights.index(min(heights)) if heights else 0
    return chain[top:] + chain[:top]


def called(part):
    return part.objectName() or type(part).__name__
