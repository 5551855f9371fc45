"""The table sorts, filters and searches on real widgets, and keeps the selection while it does."""

import numpy as np
import pytest
from fleet_supervisor.plugin.gateway_client.command_cache import (
    CommandCache,
    PathDeviations,
    distance_to_line,
)
from fleet_supervisor.plugin.gateway_client.state_words import ROBOT_STATES
from fleet_supervisor.plugin.panel.robot_model import COLUMNS, TITLES, RobotChoice, number_in_words
from fleet_supervisor.plugin.panel.robot_table import AROUND_SEARCH, ROBOT_CHOICES, WIDEST_NAME
from fleet_supervisor.plugin.ui.glyphs import UNSURE_COLOUR, for_letters
from fleet_supervisor.robot_bridge.core.messages.commands import CommandReport, CommandState, CommandStep
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsPointXY,
    QgsProject,
    QgsSettings,
)
from qgis.PyQt.QtCore import QEvent, QPoint, QPointF, Qt
from qgis.PyQt.QtGui import QMouseEvent
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import (
    QApplication,
    QComboBox,
    QLabel,
    QLineEdit,
    QStyle,
    QStyleOptionViewItem,
    QToolButton,
)

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def table(at_desk, gateway, make_robot, wait):
    gateway.show(
        make_robot("r1", 50, 40, v=0.5, battery=0.8, latency=0.030),
        make_robot("r2", 80, 60, v=1.5, battery=None, latency=0.002),
        make_robot("r3", None, None, v=None, battery=0.25, link="sql", status="charging"),
        make_robot("a9", 10, 10, v=0.0, battery=0.5, age=20.0, state=RobotState.LOST),
    )
    wait(lambda: len(at_desk.desk.state.robots) == 4)
    at_desk.dock.table.refresh()
    return at_desk.dock.table


def column(table, title):
    model = table.model()
    return [model.index(row, TITLES.index(title)).data() for row in range(model.rowCount())]


def click_head(table, title):
    head = table.horizontalHeader()
    section = TITLES.index(title)
    x = head.sectionViewportPosition(section) + head.sectionSize(section) // 2
    QTest.mouseClick(head.viewport(), LEFT, pos=QPoint(x, head.height() // 2))


def type_search(window, text):
    field = window.dock.findChild(QLineEdit, "fleet_robot_search")
    field.clear()
    QTest.keyClicks(field, text)


# --- what stands in it ---


def test_every_column_of_a_robot(table, at_desk):
    row = column(table, "Robot").index("r1")
    told = {title: column(table, title)[row] for title in TITLES}
    age = told.pop("Age")
    assert age.endswith(" s")
    assert told == {
        "Robot": "r1",
        "State": "fresh",
        "Task": "",
        "Speed": "0.5 m/s",
        "Batt.": "80%",
        "Ping": "30 ms",
        "Off": "",
        "Link": "ws",
        "Position": "50.00, 40.00",
    }
    third = column(table, "Robot").index("r3")
    assert [column(table, title)[third] for title in ("Task", "Speed", "Link", "Position")] == [
        "charging",
        "",
        "sql",
        "",
    ]


def test_the_gateway_of_a_robot_elsewhere_fits_into_its_column(table, at_desk, gateway, make_robot, wait):
    gateway.show(make_robot("r1", 50, 40, link="gateway north"), make_robot("r2", 60, 40, link="gateway b"))
    wait(lambda: {"@b", "@north"} <= set(column(table, "Link")))


def test_a_larger_font_that_is_chosen_meanwhile_cuts_nothing_off(table, at_desk, wait):
    """QGIS gives the font of its options to all of its windows by a style sheet."""

    def cut_off():
        metrics, heads = table.fontMetrics(), table.horizontalHeader()
        for number, one in enumerate(COLUMNS):
            if heads.sectionSize(number) < metrics.horizontalAdvance(one.widest) and one.title != "Task":
                yield one.title
            if heads.sectionSize(number) < heads.fontMetrics().horizontalAdvance(one.head):
                yield f"{one.title}'s head"

    def cut_of_shown():
        hidden = {TITLES[n] for n in range(len(TITLES)) if table.isColumnHidden(n)}
        return {title for title in cut_off() if title.partition("'")[0] not in hidden}

    assert cut_of_shown() == set()
    before = table.fontMetrics().height()
    at_desk.dock.window().setStyleSheet("QWidget { font-size: 16pt; }")
    wait(lambda: table.fontMetrics().height() > before, what="the larger font")
    wait(lambda: cut_of_shown() == set(), what="room for it")
    assert table.rowHeight(0) >= table.fontMetrics().height()


def test_what_a_narrow_panel_cuts_of_a_task_is_in_its_tool_tip(table, at_desk, gateway, make_robot, wait):
    gateway.show(make_robot("r1", 50, 40, stopped=True))
    wait(lambda: "stopped" in column(table, "Task"))
    for row, task in enumerate(column(table, "Task")):
        tip = table.model().index(row, TITLES.index("Task")).data(Qt.ItemDataRole.ToolTipRole)
        assert tip.count(task) == 1 or not task


def test_how_far_a_robot_is_off_its_path_then_off_its_target(table, at_desk, gateway, make_robot, wait):
    path = {"points": [[50.0, 40.5], [50.0, 60.0]]}
    gateway._queue("command-1", "r1", "SetPath", path)
    gateway.step("command-1", CommandState.ACKNOWLEDGED, "r1")
    wait(lambda: column(table, "Off")[1] == "0.50 m")
    assert column(table, "Task")[1] == "on route"
    gateway.show(make_robot("r1", 52, 50))
    wait(lambda: column(table, "Off")[1] == "2.00 m")
    gateway.step("command-1", CommandState.REACHED, "r1", deviation=0.07)
    wait(lambda: column(table, "Off")[1] == "0.07 m")


def test_how_far_beside_a_line():
    line = np.array([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)])
    assert distance_to_line(line, np.array((5.0, 3.0))) == pytest.approx(3.0)
    assert distance_to_line(line, np.array((12.0, 5.0))) == pytest.approx(2.0)
    assert distance_to_line(line, np.array((-3.0, 4.0))) == pytest.approx(5.0)
    assert distance_to_line(line[:1], np.array((3.0, 4.0))) == pytest.approx(5.0)


PATH = [[100.0, 0.0], [0.0, 0.0], [0.0, 50.0]]


def on_path(command, points, at):
    steps = [CommandStep(CommandState.ACKNOWLEDGED, at, "r1")]
    return CommandReport(command, "r1", "SetPath", {"points": points}, "anna", steps[-1].state, steps)


@pytest.fixture
def book():
    made = CommandCache()
    made.merge([on_path("command-1", PATH, 1.0)])
    return made


@pytest.fixture
def off(book):
    """How far r1 is off a path that it was told to drive, by where it is."""
    deviations = PathDeviations(book)
    return lambda x, y: deviations.of("r1", (x, y))


def test_on_its_way_to_a_paths_first_point_a_robot_is_not_off_it(off):
    # Nearer to the middle of the path than to its beginning.
    assert [off(x, 20.0 - x / 5) for x in (10.0, 40.0, 70.0, 90.0)] == [None] * 4
    assert off(99.5, 0.1) == pytest.approx(0.1)
    assert off(60.0, 4.0) == pytest.approx(4.0)


def test_a_robot_that_passes_the_first_point_far_beside_is_off_its_path(off):
    assert [off(x, 5.0) for x in (90.0, 99.0, 99.5)] == [None] * 3
    assert off(80.0, 5.0) == pytest.approx(5.0)
    # Nor does it become a way to the path again.
    assert off(99.0, 5.0) == pytest.approx(5.0)


def test_a_robot_that_is_seen_on_its_path_first_has_come_to_it(off):
    assert off(0.5, 20.0) == pytest.approx(0.5)
    assert off(3.0, 20.0) == pytest.approx(3.0)


def test_a_robot_that_was_removed_leaves_nothing_behind(table, at_desk, gateway, make_robot, wait):
    for name in ("r1", "r2"):
        gateway._queue(f"command-{name}", name, "SetPath", {"points": [[50.0, 40.5], [50.0, 60.0]]})
        gateway.step(f"command-{name}", CommandState.ACKNOWLEDGED, name)
    ways = table.robots.deviations._ways
    table.sortByColumn(TITLES.index("Off"), Qt.SortOrder.AscendingOrder)
    wait(lambda: set(ways) == {"r1", "r2"}, what="both robots on their paths")
    del gateway.robots["r1"]
    gateway.tell("positions", {"t": 1.0, "robots": [], "removed": ["r1"]})
    wait(lambda: set(ways) == {"r2"}, what="the removed robot forgotten")


def test_each_path_has_a_way_to_it_of_its_own(off, book):
    assert off(50.0, 0.0) == pytest.approx(0.0)
    book.merge([on_path("command-2", [[200.0, 0.0], [200.0, 9.0]], 2.0)])
    assert off(50.0, 0.0) is None


def test_positions_are_shown_in_the_crs_of_choice_and_that_is_kept(table, at_desk):
    site, earth = (QgsCoordinateReferenceSystem(crs) for crs in ("EPSG:32633", "EPSG:4326"))
    point = QgsCoordinateTransform(site, earth, QgsProject.instance()).transform(QgsPointXY(488050, 5190040))
    for crs, text in (
        ("EPSG:32633", "488050.00, 5190040.00"),
        ("EPSG:4326", f"{point.y():.7f}, {point.x():.7f}"),
        ("", "50.00, 40.00"),
    ):
        table.positions.choose(QgsCoordinateReferenceSystem(crs))
        assert column(table, "Position")[1] == text
        assert QgsSettings().value("fleet_supervisor/position_crs") == crs


# --- in which order ---


def test_a_click_on_a_head_sorts_and_unknown_comes_last_both_ways(table):
    table.resize(900, 300)
    for title, up in (
        ("Speed", ["a9", "r1", "r2", "r3"]),
        ("Batt.", ["r3", "a9", "r1", "r2"]),
        ("Ping", ["r2", "r1", "a9", "r3"]),
        ("State", ["r1", "r2", "r3", "a9"]),
        ("Link", ["r3", "a9", "r1", "r2"]),
        ("Task", ["r3", "a9", "r1", "r2"]),
        ("Position", ["a9", "r1", "r2", "r3"]),
    ):
        table.setColumnHidden(TITLES.index(title), False)
        QTest.qWait(20)
        known = [name for name in up if name not in unknown(title)]
        click_head(table, title)
        assert column(table, "Robot") == up, title
        click_head(table, title)
        found = column(table, "Robot")
        assert found[len(known) :] == up[len(known) :], title
        if title not in ("State", "Link"):
            assert found[: len(known)] == known[::-1], title


def unknown(title):
    return {
        "Speed": {"r3"},
        "Batt.": {"r2"},
        "Ping": {"a9", "r3"},
        "Task": {"a9", "r1", "r2"},
        "Position": {"r3"},
    }.get(title, set())


def test_names_are_sorted_by_their_numbers_and_newcomers_among_them(
    table, at_desk, gateway, make_robot, wait
):
    gateway.show(*[make_robot(name, 1, 1) for name in ("r10", "R3", "r2b", "Ö1")])
    wait(lambda: len(at_desk.desk.state.robots) == 8)
    table.refresh()
    assert column(table, "Robot") == ["a9", "r1", "r2", "r2b", "R3", "r3", "r10", "Ö1"]
    gateway.show(make_robot("r9", 1, 1), make_robot("r100", 1, 1))
    wait(lambda: len(at_desk.desk.state.robots) == 10)
    table.refresh()
    assert column(table, "Robot")[6:9] == ["r9", "r10", "r100"]
    click_head(table, "Robot")
    assert column(table, "Robot")[1:4] == ["r100", "r10", "r9"]


def test_what_changes_is_put_in_order_again_and_stays_selected(table, at_desk, gateway, make_robot, wait):
    table.sortByColumn(TITLES.index("Speed"), Qt.SortOrder.DescendingOrder)
    assert column(table, "Robot") == ["r2", "r1", "a9", "r3"]
    view_row = column(table, "Robot").index("r1")
    QTest.mouseClick(table.viewport(), LEFT, pos=table.visualRect(table.model().index(view_row, 0)).center())
    assert at_desk.desk.selection.robots == ("r1",)
    gateway.show(make_robot("r1", 50, 40, v=2.5))
    wait(lambda: column(table, "Robot") == ["r1", "r2", "a9", "r3"])
    assert [index.row() for index in table.selectionModel().selectedRows()] == [0]
    assert table.currentIndex().row() == 0
    assert at_desk.desk.selection.robots == ("r1",)


# --- which ---


def test_the_field_can_be_read_however_little_room_its_neighbours_leave(table, at_desk, wait):
    field = at_desk.dock.findChild(QLineEdit, "fleet_robot_search")
    which = at_desk.dock.findChild(QComboBox, "fleet_robot_filter")
    which.setMinimumWidth(300)
    wait(lambda: which.width() >= 300, what="the room that its neighbour takes")
    words = field.fontMetrics().horizontalAdvance(field.placeholderText())
    assert field.width() >= words + AROUND_SEARCH


def test_what_is_typed_narrows_the_list_at_once(table, at_desk):
    for text, names in (
        ("r", ["r1", "r2", "r3"]),
        ("R2", ["r2"]),
        ("lost", ["a9"]),
        ("sql", ["r3"]),
        ("charg r3", ["r3"]),
        ("charg r1", []),
    ):
        type_search(at_desk, text)
        assert (text, column(table, "Robot")) == (text, names)
    assert at_desk.dock.findChild(QLabel, "fleet_robot_count").text() == "0 of 4"
    type_search(at_desk, "")
    assert column(table, "Robot") == ["a9", "r1", "r2", "r3"]
    assert at_desk.dock.findChild(QLabel, "fleet_robot_count").text() == "4"


@pytest.mark.parametrize(
    ("which", "names"),
    [
        (RobotChoice.TROUBLED, ["a9", "r3"]),
        (RobotChoice.BUSY, ["r1"]),
        (RobotChoice.IDLE, ["a9", "r2", "r3"]),
    ],
)
def test_only_some_are_listed(table, at_desk, gateway, wait, which, names):
    gateway._queue("command-1", "r1", "SetPosEnd", {"x": 70.0, "y": 40.0})
    gateway.step("command-1", CommandState.ACKNOWLEDGED, "r1")
    wait(lambda: at_desk.desk.state.commands.task_of("r1") is not None)
    at_desk.dock.robots.mark_troubled({"r3"})
    box = at_desk.dock.findChild(QComboBox, "fleet_robot_filter")
    for _ in range(list(RobotChoice).index(which)):
        QTest.keyClick(box, Qt.Key.Key_Down)
    assert box.currentText() == ROBOT_CHOICES[which]
    assert column(table, "Robot") == names


def test_a_selected_robot_that_the_filter_hides_stays_selected(table, at_desk):
    at_desk.desk.selection.select("r2")
    type_search(at_desk, "r1")
    assert at_desk.desk.selection.robots == ("r2",)
    assert table.selectionModel().selectedRows() == []
    type_search(at_desk, "")
    assert [table.model().name_at(i.row()) for i in table.selectionModel().selectedRows()] == ["r2"]


def click_row(table, name, held=Qt.KeyboardModifier.NoModifier):
    index = table.model().index(column(table, "Robot").index(name), 0)
    QTest.mouseClick(table.viewport(), LEFT, held, table.visualRect(index).center())


CTRL, SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier


def test_a_click_selects_one_robot_alone_even_if_others_are_hidden(table, at_desk):
    at_desk.desk.selection.select_all(["r2", "r1"])
    type_search(at_desk, "r2")
    click_row(table, "r2")
    assert at_desk.desk.selection.robots == ("r2",)


@pytest.mark.parametrize("held", [CTRL, SHIFT], ids=["Ctrl", "Shift"])
def test_what_adds_to_the_selection_keeps_hidden_robots_in_it(table, at_desk, held):
    at_desk.desk.selection.select("r1")
    type_search(at_desk, "r2")
    click_row(table, "r2", held)
    assert at_desk.desk.selection.robots == ("r1", "r2")


def test_what_takes_away_from_the_selection_keeps_hidden_robots_in_it(table, at_desk):
    at_desk.desk.selection.select_all(["r1", "r2"])
    type_search(at_desk, "r2")
    click_row(table, "r2", CTRL)
    assert at_desk.desk.selection.robots == ("r1",)


def test_the_last_robot_can_be_taken_out_of_the_selection(table, at_desk):
    click_row(table, "r1")
    click_row(table, "r1", CTRL)
    assert at_desk.desk.selection.robots == ()
    assert table.selectionModel().selectedRows() == []
    QTest.keyClick(table, Qt.Key.Key_Space, CTRL)
    assert at_desk.desk.selection.robots == ("r1",)


def test_keys_move_the_selection(table, at_desk):
    at_desk.desk.selection.select("r1")
    QTest.keyClick(table, Qt.Key.Key_Down)
    assert at_desk.desk.selection.robots == ("r2",)
    QTest.keyClick(table, Qt.Key.Key_Down, Qt.KeyboardModifier.ShiftModifier)
    assert set(at_desk.desk.selection.robots) == {"r2", "r3"}


# --- columns ---


def test_columns_are_chosen_in_the_menu_and_kept(table, at_desk):
    button = at_desk.dock.findChild(QToolButton, "fleet_robot_columns")
    menu = button.menu()
    menu.aboutToShow.emit()
    ping = next(action for action in menu.actions() if action.text().startswith("Ping"))
    assert ping.isChecked()
    ping.trigger()
    assert table.isColumnHidden(TITLES.index("Ping"))
    assert "Ping" in QgsSettings().value("fleet_supervisor/robot_table/hidden")
    place = next(action for action in menu.actions() if action.text().startswith("Latitude"))
    place.trigger()
    assert not table.isColumnHidden(TITLES.index("Position"))
    assert table.positions.name == "EPSG:4326"


def test_the_first_columns_fit_into_the_panel(table, at_desk):
    shown = [c for c in range(len(COLUMNS)) if not table.isColumnHidden(c)]
    assert sum(table.columnWidth(c) for c in shown) <= table.viewport().width()
    assert not table.horizontalScrollBar().isVisible()


def test_states_stand_in_the_operators_words(table, monkeypatch):
    monkeypatch.setitem(ROBOT_STATES, RobotState.LOST, "elveszett")
    row = column(table, "State").index("elveszett")
    tip = table.model().index(row, 0).data(Qt.ItemDataRole.ToolTipRole)
    assert tip.startswith("a9: elveszett, last heard")


def test_a_robot_that_may_be_elsewhere_is_not_fresh_in_the_table(table, at_desk, gateway, make_robot, wait):
    why = "its position was 6 s old when it came"
    gateway.show(make_robot("r2", 80, 60, status="docking", doubt=why))
    wait(lambda: column(table, "State")[column(table, "Robot").index("r2")] == "unsure")
    index = table.model().index(column(table, "Robot").index("r2"), TITLES.index("State"))
    assert index.data(Qt.ItemDataRole.ForegroundRole) == for_letters(UNSURE_COLOUR)
    tip = index.data(Qt.ItemDataRole.ToolTipRole)
    assert tip.startswith("r2: fresh, may be elsewhere, last heard")
    assert why in tip.splitlines() and "it says: docking" in tip.splitlines()
    icons = [table.model().index(row, 0).data(Qt.ItemDataRole.DecorationRole).cacheKey() for row in range(4)]
    assert len({*icons}) == 3
    click_head(table, "State")
    assert column(table, "State") == ["fresh", "fresh", "unsure", "lost"]
    type_search(at_desk, "unsure")
    assert column(table, "Robot") == ["r2"]
    type_search(at_desk, "")
    box = at_desk.dock.findChild(QComboBox, "fleet_robot_filter")
    for _ in range(list(RobotChoice).index(RobotChoice.TROUBLED)):
        QTest.keyClick(box, Qt.Key.Key_Down)
    assert sorted(column(table, "Robot")) == ["a9", "r2"]


def test_the_tip_tells_hours_of_what_was_not_heard_for_hours(table, at_desk):
    row = column(table, "Robot").index("a9")
    index = table.model().index(row, 0)
    table.model().show(at_desk.desk.clock.steady() + 7215.3)
    assert "last heard 2.0 h ago over" in index.data(Qt.ItemDataRole.ToolTipRole)


# --- many ---


def test_ten_thousand_are_sorted_and_searched(table, at_desk, gateway, make_robot, wait):
    rng = np.random.default_rng(1)
    speeds = rng.uniform(0.1, 9.0, 10_000)
    gateway.show(*[make_robot(f"n{k:05}", k % 100, k // 100, v=float(speeds[k])) for k in range(10_000)])
    wait(lambda: len(at_desk.desk.state.robots) == 10_004, 30)
    table.refresh()
    table.sortByColumn(TITLES.index("Speed"), Qt.SortOrder.DescendingOrder)
    assert table.model().name_at(0) == f"n{int(speeds.argmax()):05}"
    type_search(at_desk, "n0777")
    assert sorted(column(table, "Robot")) == [f"n0777{k}" for k in range(10)]


def test_a_number_is_not_cut_off_in_its_column(table):
    for title, value, text in (
        ("Ping", 0.0004, "0 ms"),
        ("Ping", 0.9994, "999 ms"),
        ("Ping", 1.019, "1.0 s"),
        ("Off", 9.99, "9.99 m"),
        ("Off", 10.2, "10.2 m"),
        ("Age", 99.9, "99.9 s"),
        ("Age", 100.0, "2 min"),
        ("Age", 3569.0, "59 min"),
        ("Age", 3600.0, "1.0 h"),
        ("Age", 47.9 * 3600, "47.9 h"),
        ("Age", 72 * 3600, "3.0 d"),
        ("Age", float("nan"), ""),
    ):
        assert number_in_words(title, value) == text
        # Qt leaves three pixels free at either side.
        width = table.columnWidth(TITLES.index(title))
        assert table.fontMetrics().horizontalAdvance(text) + 6 <= width, (title, text)


# --- names have room first ---


def drag_head(table, column, pixels):
    """Drag the right edge of a column's head."""
    head = table.horizontalHeader()
    edge = QPoint(head.sectionViewportPosition(column) + head.sectionSize(column) - 1, head.height() // 2)
    QTest.mousePress(head.viewport(), LEFT, pos=edge)
    for step in (0.5, 1.0):
        at = edge + QPoint(round(step * pixels), 0)
        move = QMouseEvent(
            QEvent.Type.MouseMove, QPointF(at), QPointF(head.viewport().mapToGlobal(at)),
            Qt.MouseButton.NoButton, LEFT, Qt.KeyboardModifier.NoModifier,
        )  # fmt: skip
        QApplication.sendEvent(head.viewport(), move)
    QTest.mouseRelease(head.viewport(), LEFT, pos=edge + QPoint(pixels, 0))


def room_for_text(table, row=0):
    """Return the pixels that the style leaves a name beside its icon."""
    index = table.model().index(row, 0)
    option = QStyleOptionViewItem()
    option.initFrom(table)
    option.rect = table.visualRect(index)
    option.features |= QStyleOptionViewItem.ViewItemFeature.HasDecoration
    option.features |= QStyleOptionViewItem.ViewItemFeature.HasDisplay
    option.decorationSize = table.iconSize()
    option.text = index.data()
    return table.style().subElementRect(QStyle.SubElement.SE_ItemViewItemText, option, table).width()


def test_of_many_robots_each_name_is_read_whole(table, at_desk, gateway, make_robot, wait):
    names = [f"robot-north-{k:04}" for k in range(1000)]
    gateway.show(*(make_robot(name, k % 100, k // 100) for k, name in enumerate(names)))
    wait(lambda: table.model().rowCount() == 1004, what="the robots in the table")
    row = column(table, "Robot").index("robot-north-0777")
    wanted = table.fontMetrics().horizontalAdvance("robot-north-0777")
    # Where a text needs a fraction of a pixel more, Qt cuts it.
    assert room_for_text(table, row) >= wanted + 2
    assert table.columnViewportPosition(0) == 0


def test_a_very_long_name_is_cut_in_its_middle_and_leaves_room_for_the_others(
    table, gateway, make_robot, wait
):
    gateway.show(make_robot("a-name-that-nobody-can-want-to-read-" * 3 + "7", 10, 10))
    wait(lambda: table.model().rowCount() == 5, what="the robot in the table")
    assert table.columnWidth(0) == WIDEST_NAME
    assert table.textElideMode() == Qt.TextElideMode.ElideMiddle


def test_a_width_that_a_hand_gave_the_names_stays(table, gateway, make_robot, wait):
    drag_head(table, 0, 20)
    given = table.columnWidth(0)
    gateway.show(make_robot("a-robot-of-a-longer-name-than-the-others", 10, 10))
    wait(lambda: table.model().rowCount() == 5, what="the robot in the table")
    assert table.columnWidth(0) == given
