"""The dialog *Layer roles*: what it shows, what it keeps and when, and that it never makes one wait."""

from __future__ import annotations

import threading
import time

import pytest
from fleet_supervisor.plugin.layers.role_editor import roles_dialog
from fleet_supervisor.plugin.layers.role_editor.preview import COLOURS, GROUND, PreviewView
from fleet_supervisor.plugin.layers.role_editor.role_table import (
    BASE,
    ESTIMATE,
    FILTER,
    HEIGHT,
    LAYER,
    OUTDOOR,
    RESULT,
    ROLE,
    ROTATION,
    SEMANTICS,
    TEMPLATE,
    WIDTH,
)
from fleet_supervisor.plugin.layers.role_editor.roles_dialog import WIDEST_NAME, RolesAction, RolesDialog
from fleet_supervisor.plugin.layers.roles import (
    PROFILES,
    LayerExpressions,
    LayerSetup,
    find_profile,
    setup_of,
)
from qgis.core import QgsApplication, QgsCoordinateReferenceSystem, QgsTask, QgsVectorLayer
from qgis.gui import QgsFieldExpressionWidget, QgsMessageBar
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QCoreApplication, QEvent, Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import (
    QApplication,
    QComboBox,
    QDialogButtonBox,
    QLabel,
    QMainWindow,
    QPushButton,
    QTableView,
)

from tests.support.databases.frozen_layer import frozen_for_layers, layer_in_database
from tests.support.patience import BUSY

LEFT = Qt.MouseButton.LeftButton
BUTTONS = QDialogButtonBox.StandardButton


def cell(dialog, layer, column):
    """Return the index of a cell."""
    (row,) = (k for k, row in enumerate(dialog.model.rows) if row.name == layer)
    return dialog.model.index(row, column)


def put(dialog, layer, column, text):
    assert dialog.model.setData(cell(dialog, layer, column), text)


def press(dialog, button):
    QTest.mouseClick(dialog.findChild(QDialogButtonBox).button(button), LEFT)


def said(dialog):
    return dialog.findChild(QLabel, "fleet_roles_summary").text()


def message(dialog):
    return dialog.findChild(QgsMessageBar).currentItem().text()


def of_layer(project, name):
    (layer,) = project.mapLayersByName(name)
    return setup_of(layer)


def edit(dialog, layer, column, kind):
    """Open the editor of a cell as a double click does, and return it."""
    table = dialog.findChild(QTableView, "fleet_roles_table")
    place = table.visualRect(cell(dialog, layer, column)).center()
    QTest.mouseClick(table.viewport(), LEFT, Qt.KeyboardModifier.NoModifier, place)
    QTest.mouseDClick(table.viewport(), LEFT, Qt.KeyboardModifier.NoModifier, place)
    (editor,) = (found for found in table.findChildren(kind) if not sip.isdeleted(found))
    return editor


def shows(image, colour):
    """Tell whether a pixel has about this colour; smooth lines seldom have it exactly."""
    wanted = colour.getRgb()[:3]
    pixels = (image.pixelColor(x, y).getRgb() for x in range(image.width()) for y in range(image.height()))
    return any(all(abs(a - b) < 25 for a, b in zip(pixel, wanted, strict=False)) for pixel in pixels)


def test_the_table_shows_each_layer_and_what_it_comes_to(dialog):
    names = [dialog.model.index(k, LAYER).data() for k in range(dialog.model.rowCount())]
    assert names == ["barriers", "buildings", "roads", "trees"]
    assert cell(dialog, "buildings", RESULT).data() == "2 obstacles, 6 segments, 1 warning"
    assert "1 height is not known" in cell(dialog, "buildings", RESULT).data(Qt.ItemDataRole.ToolTipRole)
    assert cell(dialog, "barriers", RESULT).data() == ""
    assert said(dialog) == "2 obstacles of 6 segments, 0 roads, 0 surfaces, 0 keepouts, 1 warning"


def test_a_role_chosen_by_the_mouse_is_counted_and_drawn(dialog, wait):
    roles = edit(dialog, "roads", ROLE, QComboBox)
    assert [roles.itemText(k) for k in range(roles.count())] == [
        "–",
        "obstacle",
        "stairs",
        "furniture",
        "road centreline",
    ]
    roles.setCurrentIndex(4)
    roles.activated.emit(4)
    wait(lambda: cell(dialog, "roads", RESULT).data() == "1 road, 1 segment, 1 warning")
    wait(lambda: not dialog.preview.busy)
    assert "1 road," in said(dialog)
    image = dialog.findChild(PreviewView, "fleet_roles_preview").image
    assert image.pixelColor(1, 1) == GROUND
    assert all(shows(image, COLOURS[role]) for role in ("obstacle", "road_centreline"))
    assert not shows(image, COLOURS["keepout"])


def test_an_expression_is_chosen_in_qgis_own_widget(dialog, wait):
    editor = edit(dialog, "buildings", HEIGHT, QgsFieldExpressionWidget)
    assert editor.layer().name() == "buildings"
    editor.setExpression("7 + 1")
    dialog.findChild(QTableView).setFocus()
    table = dialog.findChild(QTableView)
    table.commitData(editor)
    assert cell(dialog, "buildings", HEIGHT).data() == "7 + 1"
    wait(lambda: cell(dialog, "buildings", RESULT).data() == "2 obstacles, 6 segments")


def test_points_can_be_furniture_of_a_width(dialog, wait):
    assert dialog.model.rows[3].roles == ("", "furniture")
    put(dialog, "trees", ROLE, "furniture")
    assert cell(dialog, "trees", WIDTH).flags() & Qt.ItemFlag.ItemIsEditable
    wait(lambda: cell(dialog, "trees", RESULT).data() == "1 obstacle, 8 segments, 1 warning")


def test_an_expression_that_is_none_is_told_in_its_row(dialog, wait):
    put(dialog, "buildings", HEIGHT, "7 +")
    wait(lambda: cell(dialog, "buildings", RESULT).data() == "refused")
    assert "'7 +' for the layer buildings is not one" in cell(dialog, "buildings", RESULT).data(
        Qt.ItemDataRole.ToolTipRole
    )
    wait(lambda: "1 layer refused" in said(dialog))


@pytest.mark.parametrize(
    ("layer", "role", "columns"),
    [
        ("roads", "road_centreline", {ROLE, FILTER, SEMANTICS, WIDTH}),
        ("buildings", "keepout", {ROLE, FILTER, SEMANTICS}),
        ("buildings", "obstacle", {ROLE, FILTER, HEIGHT, ESTIMATE, BASE, SEMANTICS, OUTDOOR}),
        (
            "trees",
            "furniture",
            {ROLE, FILTER, HEIGHT, ESTIMATE, BASE, SEMANTICS, OUTDOOR, WIDTH, TEMPLATE, ROTATION},
        ),
        ("roads", "", {ROLE}),
    ],
)
def test_only_expressions_that_count_can_be_edited(dialog, layer, role, columns):
    put(dialog, layer, ROLE, role)
    editable = {
        column
        for column in range(LAYER, RESULT + 1)
        if cell(dialog, layer, column).flags() & Qt.ItemFlag.ItemIsEditable
    }
    assert editable == columns


def test_the_count_follows_the_filter(dialog, project, wait):
    editor = edit(dialog, "buildings", FILTER, QgsFieldExpressionWidget)
    editor.setExpression('"height" is not null')
    dialog.findChild(QTableView).commitData(editor)
    wait(lambda: cell(dialog, "buildings", RESULT).data() == "1 obstacle, 3 segments")
    wait(lambda: said(dialog).startswith("1 obstacle of 3 segments,"))
    put(dialog, "buildings", FILTER, '"levels" > 2')
    wait(lambda: cell(dialog, "buildings", RESULT).data() == "refused")
    reason = cell(dialog, "buildings", RESULT).data(Qt.ItemDataRole.ToolTipRole)
    assert "The filter expression '\"levels\" > 2' for the layer buildings reads the field levels" in reason
    put(dialog, "buildings", FILTER, "")
    wait(lambda: cell(dialog, "buildings", RESULT).data() == "2 obstacles, 6 segments, 1 warning")


def test_a_template_is_drawn_and_kept(dialog, project, wait):
    for column, text in ((ROLE, "furniture"), (HEIGHT, "1"), (TEMPLATE, "'bench'"), (ROTATION, "30")):
        put(dialog, "trees", column, text)
    wait(lambda: cell(dialog, "trees", RESULT).data() == "1 obstacle, 4 segments")
    put(dialog, "trees", TEMPLATE, "'sofa'")
    wait(lambda: cell(dialog, "trees", RESULT).data() == "1 obstacle, 8 segments, 1 warning")
    press(dialog, BUTTONS.Apply)
    kept = LayerExpressions(height="1", template="'sofa'", rotation="30")
    assert of_layer(project, "trees") == LayerSetup("furniture", kept)


def test_the_table_fits_its_columns_into_the_dialog(dialog):
    table = dialog.findChild(QTableView, "fleet_roles_table")
    assert table.horizontalHeader().length() <= table.viewport().width()


def test_the_names_of_layers_of_one_file_are_read_whole(project):
    name = "UPC_Campus_Nord — buildings"
    project.mapLayersByName("buildings")[0].setName(name)
    dialog = RolesDialog(project)
    dialog.open()
    QApplication.processEvents()
    table = dialog.findChild(QTableView, "fleet_roles_table")
    assert table.columnWidth(LAYER) >= table.fontMetrics().horizontalAdvance(name) + 4
    project.mapLayersByName("roads")[0].setName(30 * "very long ")
    dialog.reject()
    again = RolesDialog(project)
    again.open()
    assert again.findChild(QTableView, "fleet_roles_table").columnWidth(LAYER) == WIDEST_NAME
    again.reject()


def test_nothing_is_kept_before_apply(dialog, project):
    apply = dialog.findChild(QDialogButtonBox).button(BUTTONS.Apply)
    assert not apply.isEnabled()
    put(dialog, "barriers", ROLE, "obstacle")
    put(dialog, "barriers", HEIGHT, "2")
    assert of_layer(project, "barriers") == LayerSetup() and not project.isDirty()
    press(dialog, BUTTONS.Apply)
    assert of_layer(project, "barriers") == LayerSetup("obstacle", LayerExpressions(height="2"))
    assert project.isDirty() and not apply.isEnabled() and dialog.isVisible()


def test_cancel_keeps_nothing_and_ok_everything(project, wait):
    for button, kept in ((BUTTONS.Cancel, ""), (BUTTONS.Ok, "obstacle")):
        dialog = RolesDialog(project)
        dialog.open()
        put(dialog, "barriers", ROLE, "obstacle")
        press(dialog, button)
        assert not dialog.isVisible()
        assert of_layer(project, "barriers").role == kept


def test_a_profile_sets_up_the_layers_it_knows(dialog, project, wait):
    profiles = dialog.findChild(QComboBox, "fleet_roles_profile")
    profiles.setCurrentIndex(profiles.findData(str(PROFILES / "openstreetmap.toml")))
    QTest.mouseClick(dialog.findChild(QPushButton, "fleet_roles_apply_profile"), LEFT)
    wait(lambda: not dialog.preview.busy)
    assert cell(dialog, "barriers", RESULT).data() == "1 obstacle, 2 segments, 1 warning"
    assert cell(dialog, "roads", ROLE).data() == "road centreline"
    assert of_layer(project, "roads") == LayerSetup()
    press(dialog, BUTTONS.Apply)
    assert of_layer(project, "roads").role == "road_centreline"


def test_a_broken_profile_changes_nothing_and_says_why(dialog, tmp_path):
    broken = tmp_path / "mine.toml"
    broken.write_text("[[layers]]\nnames = ['roads']\nrole = 'raod'\n")
    dialog.apply_profile(broken)
    assert "layers[0].role is 'raod'" in message(dialog)
    assert cell(dialog, "roads", ROLE).data() == "–"
    dialog.apply_profile(find_profile("upc_campus_nord"))
    assert "knows none of these layers" in message(dialog)
    assert "buildings with bid, z_roof; walls with z_min, z_max; step_edges" in message(dialog)


def test_a_project_that_cannot_carry_a_site_is_told(project, wait):
    project.setCrs(QgsCoordinateReferenceSystem("EPSG:3857"))
    dialog = RolesDialog(project)
    dialog.open()
    wait(lambda: "its metres are not metres" in said(dialog))
    dialog.reject()


@pytest.fixture
def city(project, make_layer):
    """Enough buildings to read for a while."""
    squares = [
        (f"Polygon(({x} {y}, {x + 5} {y}, {x + 5} {y + 5}, {x} {y}))", "3")
        for x in range(0, 1000, 10)
        for y in range(0, 1000, 10)
    ]
    layer = make_layer("city buildings", "Polygon", "&field=height:string", squares)
    project.addMapLayer(layer)
    return layer


def test_the_window_goes_on_while_layers_are_read(dialog, project, city, wait):
    city.setCustomProperty("fleet/role", "obstacle")
    dialog = RolesDialog(project)
    dialog.open()
    turns = 0
    while dialog.preview.busy:
        QApplication.processEvents()
        turns += 1
        time.sleep(0.002)
    assert cell(dialog, "city buildings", RESULT).data() == "10000 obstacles, 30000 segments"
    assert turns > 20
    dialog.reject()


def test_closing_in_the_middle_leaves_no_thread_at_the_layers(project, city, wait):
    city.setCustomProperty("fleet/role", "obstacle")
    dialog = RolesDialog(project)
    dialog.open()
    # Laying out the window begins the preview anew, so the first one may be gone at once.
    wait(lambda: dialog.preview._task is not None and dialog.preview._task.isActive())
    before = time.monotonic()
    dialog.reject()
    assert time.monotonic() - before < 5.0 * BUSY
    assert not dialog.preview.busy
    # What the worker said last is still under way and must not speak of layers that are gone.
    project.clear()
    QgsApplication.taskManager().cancelAll()
    wait(lambda: not QgsApplication.taskManager().countActiveTasks())
    assert threading.active_count() < 50


def test_removing_a_layer_closes_the_dialog(dialog, project):
    project.removeMapLayer(project.mapLayersByName("roads")[0].id())
    assert not dialog.isVisible()


class Window:
    """What the menu entry needs of QGIS's window."""

    def __init__(self):
        self.main = QMainWindow()
        self.menu = []

    def mainWindow(self):
        return self.main

    def addPluginToMenu(self, menu, action):
        self.menu.append((menu, action))

    def removePluginMenu(self, menu, action):
        self.menu.remove((menu, action))


def test_the_menu_entry_opens_one_dialog_and_goes_without_a_trace(qgis_app):
    window = Window()
    entry = RolesAction(window, "Fleet Supervisor")
    assert [(menu, action.objectName()) for menu, action in window.menu] == [
        ("Fleet Supervisor", "fleet_layer_roles")
    ]
    entry.action.trigger()
    entry.action.trigger()
    (dialog,) = window.main.findChildren(RolesDialog)
    assert dialog.isVisible()
    entry.remove()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    assert window.menu == []
    assert window.main.findChildren(RolesDialog) == []
    assert sip.isdeleted(entry.action)


def is_held(task):
    return task.status() == QgsTask.TaskStatus.Running and task.elapsedTime() > 500


def test_a_layer_that_hangs_keeps_nobody_from_opening_and_closing_the_dialog(
    project, wait, postgis_server, monkeypatch
):
    monkeypatch.setattr(roles_dialog, "GIVE_UP_S", 600.0)
    uri = layer_in_database(postgis_server, "POLYGON((0 0,9 0,9 9,0 0))")
    layer = QgsVectorLayer(uri, "bays", "postgres")
    assert layer.isValid()
    layer.setCustomProperty("fleet/role", "keepout")
    project.addMapLayer(layer)
    with frozen_for_layers(postgis_server) as server:
        dialog = RolesDialog(project)
        dialog.open()
        # A task that no layer holds ends in a moment, and another one may follow it.
        wait(lambda: (task := dialog.preview._task) is not None and is_held(task))
        dialog.reject()
        assert server.is_frozen
    dialog.preview.wait_for_end()
    dialog.deleteLater()
