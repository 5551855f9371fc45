"""The page of the as-placed report: table, figures, layer, CSV, PDF; and collecting a layout again."""

from __future__ import annotations

from qgis.PyQt.QtCore import pyqtSignal
from qgis.PyQt.QtWidgets import (
    QAbstractItemView,
    QComboBox,
    QHBoxLayout,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from ....robot_bridge.messages import PlacementReport
from ...errors import FleetError
from ...file_dialogs import file_to_write
from ...language import tr, tr_count
from ...settings.preferences import export_path
from ..column_heads import fit_heads
from ..csv_files import write_csv
from ..desk import Desk
from ..fixed_size import ScrollingText
from ..messages import file_topic
from ..push_button import push_button
from ..wall_clock import time_of_day
from .as_placed import COLUMNS, chosen, csv_row, tally
from .as_placed_pdf import ReportError, open_report_dialog

HEADS = (
    tr("Cone"),
    tr("Off [m]"),
    tr("Robot"),
    tr("Placed"),
    tr("Planned x, y"),
    tr("Stands at x, y"),
    tr("Collected"),
)
THIS_PLAN, EVERYTHING = "plan", "all"
FILE, REPORT = file_topic("placed_cones"), file_topic("cone_report")
MANY = 2000
"""Rows that the table shows at most, the newest; the CSV file has all."""


class AsPlacedPage(QWidget):
    """Shows what was put down of a plan, a layout or all, as the desk knows it."""

    refresh_wanted = pyqtSignal()
    collect_wanted = pyqtSignal(object)
    """Ask for a plan that collects a layout (its name), or all that stands (None)."""
    shown = pyqtSignal()
    layer_wanted = pyqtSignal()
    """Somebody is about to take the layer of what is shown, and needs it whole."""
    place_wanted = pyqtSignal(float, float)

    def __init__(self, desk: Desk, parent: QWidget | None = None):
        super().__init__(parent)
        self._desk = desk
        self._plan: str | None = None
        self._expected: int | None = None
        self.which = QComboBox()
        self.which.setObjectName("fleet_placed_which")
        self.which.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.which.setMinimumContentsLength(8)
        self.figures = ScrollingText("fleet_placed_figures", lines=3)
        self.table = QTableWidget(0, len(HEADS))
        self.table.setObjectName("fleet_placed_table")
        self.table.setHorizontalHeaderLabels(HEADS)
        self.table.verticalHeader().hide()
        self.table.verticalHeader().setDefaultSectionSize(20)
        self.table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        fit_heads(self.table)
        self.table.cellDoubleClicked.connect(self._go_there)
        self.report = push_button(
            "fleet_placed_report",
            tr("Report…"),
            tr("Figures, histogram, map and table of these cones as a PDF"),
            self._open_report,
        )
        self.placements: list[PlacementReport] = []
        self._lay_out()
        self._fill_choices()
        self.which.currentIndexChanged.connect(self.show_placed)

    def show_plan(self, plan: str | None, expected: int | None) -> None:
        """Take the plan that is driven, of which so many cones are to be placed."""
        if (plan, expected) != (self._plan, self._expected):
            self._plan, self._expected = plan, expected
            self.show_placed()

    def show_placed(self, *_: object) -> None:
        """Show what is known now."""
        self._fill_choices()
        self.placements = self._chosen()
        expected = self._expected if self.which.currentData() == THIS_PLAN else None
        self.figures.setText(tally(self.placements).in_words(expected))
        rows = self.placements[-MANY:]
        self.table.setRowCount(len(rows))
        for k, one in enumerate(rows):
            for column, text in enumerate(_texts(one)):
                self.table.setItem(k, column, QTableWidgetItem(text))
        self.table.resizeColumnsToContents()
        self.report.setEnabled(bool(rows))
        self.shown.emit()

    def save(self, path: str) -> None:
        """Write the report to ``path`` as CSV and say so."""
        self._desk.messages.end(FILE)
        try:
            count = write_csv(path, COLUMNS, map(csv_row, self.placements))
        except FleetError as error:
            self._desk.report_failure(str(error), FILE)
            return
        cones = tr_count(count, "1 cone", "%n cones")
        self._desk.noted.emit(tr("{cones} written to {path}", cones=cones, path=path))

    def _chosen(self) -> list[PlacementReport]:
        what = self.which.currentData()
        if what == THIS_PLAN:
            return chosen(self._desk.placements, plan=self._plan or "")
        return chosen(self._desk.placements, layout=None if what == EVERYTHING else what[1])

    def _fill_choices(self) -> None:
        layouts = sorted({one.layout for one in self._desk.placements if one.layout})
        wanted = [(tr("the plan that is driven"), THIS_PLAN), (tr("everything"), EVERYTHING)]
        wanted += [(tr("layout {name}", name=name), ("layout", name)) for name in layouts]
        if [self.which.itemData(k) for k in range(self.which.count())] == [data for _, data in wanted]:
            return
        now = self.which.currentData()
        self.which.blockSignals(True)
        self.which.clear()
        for text, data in wanted:
            self.which.addItem(text, data)
        names = [data for _, data in wanted]
        self.which.setCurrentIndex(names.index(now) if now in names else 0)
        self.which.blockSignals(False)

    def _collect(self) -> None:
        what = self.which.currentData()
        layouts = {one.layout for one in self.placements if one.layout}
        if what == THIS_PLAN and len(layouts) == 1:
            self.collect_wanted.emit(layouts.pop())
        else:
            self.collect_wanted.emit(what[1] if isinstance(what, tuple) else None)

    def _save_as(self) -> None:
        path = file_to_write(self, tr("As-placed report"), export_path("as-placed.csv"), tr("CSV (*.csv)"))
        if path:
            self.save(path)

    def _open_report(self) -> None:
        # The user may have taken the layer out of the project.
        self.show_placed()
        self.layer_wanted.emit()
        self._desk.messages.end(REPORT)
        try:
            open_report_dialog(self._desk.project)
        except ReportError as error:
            self._desk.report_failure(str(error), REPORT)

    def _go_there(self, row: int, _: int) -> None:
        one = self.placements[-MANY:][row]
        self.place_wanted.emit(one.x, one.y)

    def _lay_out(self) -> None:
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 4, 0, 0)
        files, foot = QHBoxLayout(), QHBoxLayout()
        self.report.setEnabled(False)
        files.addWidget(self.report)
        for row, text, name, action in (
            (foot, tr("Refresh"), "fleet_placed_refresh", self.refresh_wanted.emit),
            (files, tr("Save as CSV…"), "fleet_placed_save", self._save_as),
            (foot, tr("Plan collecting"), "fleet_placed_collect", self._collect),
        ):
            row.addWidget(push_button(name, text, pressed=action))
        rows.addWidget(self.which)
        rows.addWidget(self.figures)
        rows.addWidget(self.table, 1)
        rows.addLayout(files)
        rows.addLayout(foot)


def _texts(one: PlacementReport) -> list[str]:
    return [
        one.cone or one.label or "",
        f"{one.deviation:.3f}",
        one.robot,
        time_of_day(one.placed_at),
        f"{one.planned_x:.2f}, {one.planned_y:.2f}",
        f"{one.x:.2f}, {one.y:.2f}",
        time_of_day(one.collected_at),
    ]
