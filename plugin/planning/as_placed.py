"""The as-placed report: figures, table, CSV file, and the dialog that makes its PDF."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime, timezone

from qgis.core import QgsProject
from qgis.PyQt.QtCore import QModelIndex, QObject, Qt, pyqtSignal
from qgis.PyQt.QtWidgets import (
    QAbstractItemView,
    QComboBox,
    QHBoxLayout,
    QTableView,
    QVBoxLayout,
    QWidget,
)

from ...robot_bridge.core.messages.records import PlacementReport
from ..control.fleet_controller import FleetController
from ..control.messages import file_topic
from ..layers.live_layers import MARK, live_layers
from ..settings.profile import export_path
from ..ui.dialogs import file_to_write, push_button
from ..ui.errors import FleetError
from ..ui.language import time_of_day, tr, tr_count
from ..ui.steady_widgets import ScrollingText
from ..ui.tables import EDGES, RowModel, fit_headers, write_csv

# --- The as-placed report: planned and actual position of each cone, deviation, robot and time ---

COLUMNS = (
    "cone", "layout", "planned_x", "planned_y", "x", "y", "deviation", "robot", "placed_at", "collected_at",
)  # fmt: skip


@dataclass(frozen=True)
class DeviationSummary:
    """The summary of the report; metres."""

    cones: int
    collected: int
    largest: float
    mean: float

    def in_words(self, expected: int | None = None) -> str:
        """Return the figures as text, with the number of cones in the plan if known."""
        if not self.cones:
            return tr("No cone was put down yet.")
        placed = (
            tr_count(expected, "{cones} of 1 cone placed", "{cones} of %n cones placed", cones=self.cones)
            if expected
            else tr_count(self.cones, "1 cone placed", "%n cones placed")
        )
        gone = tr(", {collected} collected again", collected=self.collected) if self.collected else ""
        off = tr(
            "off by {mean:.3f} m on average, at most {largest:.3f} m",
            mean=self.mean,
            largest=self.largest,
        )
        return tr("{placed}{gone}; {off}", placed=placed, gone=gone, off=off)


def select_placed_cones(
    placements: Iterable[PlacementReport], *, plan: str | None = None, layout: str | None = None
) -> list[PlacementReport]:
    """Return the placed cones of a plan, of a layout, or of all, in the order of placing."""
    found = [
        one
        for one in placements
        if (plan is None or one.plan == plan) and (layout is None or one.layout == layout)
    ]
    return sorted(found, key=lambda one: (one.placed_at, one.placement))


def deviation_summary(placements: list[PlacementReport]) -> DeviationSummary:
    """Return the summary of the report."""
    off = [one.deviation for one in placements]
    collected = sum(one.collected_at is not None for one in placements)
    return DeviationSummary(len(off), collected, max(off, default=0.0), sum(off) / len(off) if off else 0.0)


def csv_row(one: PlacementReport) -> list[object]:
    """Return the values of ``COLUMNS``; metres in the site frame, times in UTC."""
    return [
        one.cone or one.label or "",
        one.layout or "",
        *(round(value, 3) for value in (one.planned_x, one.planned_y, one.x, one.y, one.deviation)),
        one.robot,
        utc_in_words(one.placed_at),
        utc_in_words(one.collected_at),
    ]


def utc_in_words(at: float | None) -> str:
    """Return seconds since 1970 as ISO 8601 in UTC, empty for None."""
    if at is None:
        return ""
    return datetime.fromtimestamp(at, timezone.utc).isoformat(timespec="seconds").replace("+00:00", "Z")


# --- From the cones known to the desk to their report: QGIS's dialog of the algorithm ---

PLACED = "cones_as_placed"
"""The key that marks the layer of placed cones."""


class AsPlacedReportError(FleetError):
    """The report cannot be made: the text gives the remedy."""


def open_report_dialog(project: QgsProject) -> None:
    """Open the dialog of ``fleet:asplacedreport`` on the layer of placed cones, which is in ``project``.

    :raises AsPlacedReportError: when QGIS's Processing is switched off.
    """
    try:
        from processing import createAlgorithmDialog
    except ImportError as error:
        raise AsPlacedReportError(
            tr(
                "The report is made by QGIS's Processing: switch that on in Plugins > Manage and Install "
                "Plugins."
            )
        ) from error
    layer = next(one for one in live_layers(project) if one.customProperty(MARK) == PLACED)
    dialog = createAlgorithmDialog("fleet:asplacedreport", {"INPUT": layer.id()})
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    dialog.show()


# --- The page of the as-placed report: table, figures, layer, CSV, PDF; and collecting a layout again ---

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


WIDEST = ("constant-radius-00", "0.000", "robot-000", "2000-00-00 00:00:00", *["00000.00, 00000.00"] * 2, "")
"""Texts for which the columns have room at first: they keep their width, whatever comes in."""


class PlacedModel(RowModel):
    """The rows of the table, the oldest first."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(HEADS, parent)

    def data(self, index: QModelIndex, role: int = 0) -> object:
        return _texts(self.rows[index.row()])[index.column()] if role == Qt.ItemDataRole.DisplayRole else None

    def show_placed(self, rows: list[PlacementReport]) -> None:
        """Show these cones; those that only follow the ones before are appended: a selection stays."""
        gone = self.rows.index(rows[0]) if rows and rows[0] in self.rows else 0
        kept = self.rows[gone:]
        if not kept or rows[: len(kept)] != kept:
            self.show_rows(rows, key=lambda one: one.placement)
            return
        if gone:
            self.beginRemoveRows(QModelIndex(), 0, gone - 1)
            self.rows = kept
            self.endRemoveRows()
        if len(rows) > len(kept):
            self.beginInsertRows(QModelIndex(), len(kept), len(rows) - 1)
            self.rows = rows
            self.endInsertRows()


class AsPlacedPage(QWidget):
    """Shows the cones placed of a plan, a layout or all, as known to the desk."""

    refresh_requested = pyqtSignal()
    collect_requested = pyqtSignal(object, object)
    """Request a plan that collects a layout (its name), or all standing cones (None); and of those only the
    placed cones of these numbers, a frozenset, or None for all."""
    shown = pyqtSignal()
    layer_requested = pyqtSignal()
    """The layer of the cones shown is about to be used, and must be complete."""
    place_requested = pyqtSignal(float, float)

    def __init__(self, desk: FleetController, parent: QWidget | None = None):
        super().__init__(parent)
        self._desk = desk
        self._plan: str | None = None
        self._expected: int | None = None
        self.which = QComboBox()
        self.which.setObjectName("fleet_placed_which")
        self.which.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.which.setMinimumContentsLength(8)
        self.figures = ScrollingText("fleet_placed_figures", lines=3)
        self.rows = PlacedModel(self)
        self.table = QTableView()
        self.table.setObjectName("fleet_placed_table")
        self.table.setModel(self.rows)
        self.table.verticalHeader().hide()
        self.table.verticalHeader().setDefaultSectionSize(20)
        self.table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        letters = self.table.fontMetrics()
        for column, widest in enumerate(WIDEST):
            self.table.setColumnWidth(column, letters.horizontalAdvance(widest) + 2 * EDGES)
        fit_headers(self.table)
        self.table.doubleClicked.connect(self._go_there)
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
        """Set the plan being driven, and the number of cones that it places."""
        if (plan, expected) != (self._plan, self._expected):
            self._plan, self._expected = plan, expected
            self.show_placed()

    def show_placed(self, *_: object) -> None:
        """Show the cones known now."""
        self._fill_choices()
        self.placements = self._chosen()
        expected = self._expected if self.which.currentData() == THIS_PLAN else None
        self.figures.setText(deviation_summary(self.placements).in_words(expected))
        self.rows.show_placed(self.placements[-MANY:])
        self.report.setEnabled(bool(self.placements))
        self.shown.emit()

    def save(self, path: str) -> None:
        """Write the report to ``path`` as CSV and report it."""
        self._desk.messages.end(FILE)
        try:
            count = write_csv(path, COLUMNS, map(csv_row, self.placements))
        except FleetError as error:
            self._desk.report_failure(str(error), FILE)
            return
        cones = tr_count(count, "1 cone", "%n cones")
        self._desk.info.emit(tr("{cones} written to {path}", cones=cones, path=path))

    def _chosen(self) -> list[PlacementReport]:
        what = self.which.currentData()
        if what == THIS_PLAN:
            return select_placed_cones(self._desk.state.placed_cones, plan=self._plan or "")
        return select_placed_cones(
            self._desk.state.placed_cones, layout=None if what == EVERYTHING else what[1]
        )

    def _fill_choices(self) -> None:
        layouts = sorted({one.layout for one in self._desk.state.placed_cones if one.layout})
        choices = [(tr("the plan that is driven"), THIS_PLAN), (tr("everything"), EVERYTHING)]
        choices += [(tr("layout {name}", name=name), ("layout", name)) for name in layouts]
        if [self.which.itemData(k) for k in range(self.which.count())] == [data for _, data in choices]:
            return
        now = self.which.currentData()
        self.which.blockSignals(True)
        self.which.clear()
        for text, data in choices:
            self.which.addItem(text, data)
        names = [data for _, data in choices]
        self.which.setCurrentIndex(names.index(now) if now in names else 0)
        self.which.blockSignals(False)

    def _collect(self) -> None:
        what = self.which.currentData()
        # A layout may be in several plans, and a plan may have several layouts, or none.
        only = frozenset(one.placement for one in self.placements) if what == THIS_PLAN else None
        self.collect_requested.emit(what[1] if isinstance(what, tuple) else None, only)

    def _save_as(self) -> None:
        path = file_to_write(self, tr("As-placed report"), export_path("as-placed.csv"), tr("CSV (*.csv)"))
        if path:
            self.save(path)

    def _open_report(self) -> None:
        # The user may have removed the layer from the project.
        self.show_placed()
        self.layer_requested.emit()
        self._desk.messages.end(REPORT)
        try:
            open_report_dialog(self._desk.project)
        except AsPlacedReportError as error:
            self._desk.report_failure(str(error), REPORT)

    def _go_there(self, index: QModelIndex) -> None:
        one = self.rows.rows[index.row()]
        self.place_requested.emit(one.x, one.y)

    def _lay_out(self) -> None:
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 4, 0, 0)
        files, foot = QHBoxLayout(), QHBoxLayout()
        self.report.setEnabled(False)
        files.addWidget(self.report)
        for row, text, name, action in (
            (foot, tr("Refresh"), "fleet_placed_refresh", self.refresh_requested.emit),
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
