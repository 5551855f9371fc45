"""The dialog Layer roles, and its menu entry."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from qgis.core import (
    QgsApplication,
    QgsCoordinateReferenceSystem,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsProject,
    QgsTask,
)
from qgis.gui import QgisInterface, QgsMessageBar
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QObject, QSize, Qt, QTimer, pyqtSignal
from qgis.PyQt.QtGui import QIcon, QImage
from qgis.PyQt.QtWidgets import (
    QAbstractItemView,
    QAction,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QPushButton,
    QSplitter,
    QTableView,
    QVBoxLayout,
    QWidget,
)

from ....robot_bridge.core.sites.frame import SiteFrame
from ...ui.dialogs import file_to_read
from ...ui.errors import FleetError
from ...ui.language import tr, tr_count
from ...ui.tables import fit_headers
from .. import roles
from ..crs import frame_in_project, site_crs_for, stated_crs
from ..layer_source import ObstacleSource, obstacle_sources
from ..site_transform import SiteGeoreference
from . import role_table
from .preview import LayerMeasure, PreviewTask, PreviewView, measure_summary

# --- Updates of the counts and the picture with the table, without blocking the GUI thread ---

DELAY_MS = 250
"""Time without edits of the table before layers are read again."""

GIVE_UP_S = 0.25


class LivePreview(QObject):
    """Measures the layers of ``rows`` with their present setup; results are cached.

    ``measured`` signals a layer's id and its measure, None as long as it is not known.
    """

    measured = pyqtSignal(str, object)
    drawn = pyqtSignal(QImage)
    summed = pyqtSignal(str)
    _ended_last: PreviewTask | None = None
    """The task ended last, of this dialog or an earlier one, in which a thread may be still.

    Without Python's part of it QGIS may not run it to its end.
    """

    def __init__(self, project: QgsProject, rows: Sequence[role_table.RoleRow], parent: QObject):
        super().__init__(parent)
        self._project, self._rows = project, rows
        self._known: dict[object, LayerMeasure] = {}
        self._size, self._ratio = QSize(400, 300), 1.0
        self._task: PreviewTask | None = None
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(DELAY_MS)
        self._timer.timeout.connect(self._start)

    @property
    def busy(self) -> bool:
        """Whether counts or picture are out of date."""
        return self._timer.isActive() or self._task is not None

    def resize(self, size: QSize, ratio: float) -> None:
        """Draw for a widget of ``size`` from now on."""
        if (size, ratio) != (self._size, self._ratio) and not size.isEmpty():
            self._size, self._ratio = QSize(size), ratio
            self.refresh()

    def refresh(self) -> None:
        """Schedule an update to the rows."""
        for row in self._rows:
            self.measured.emit(row.layer_id, self._known.get(_key(row)))
        if self._task is not None:
            self._task.cancel()
        self._timer.start()

    def stop(self) -> None:
        """Cancel the computation under way for good; its thread may remain in a layer that hangs."""
        self._timer.stop()
        task, self._task = self._task, None
        if task is None:
            return
        task.measured.disconnect(self._keep)
        task.drawn.disconnect(self.drawn)
        if task.status() == QgsTask.TaskStatus.Running:
            type(self)._ended_last = task
        task.cancel()

    def wait_for_end(self) -> None:
        """Wait, with a time limit, until no thread is in the task ended by :meth:`stop`."""
        if self._ended_last is not None:
            self._ended_last.left.wait(GIVE_UP_S)

    def _start(self) -> None:
        if self._task is not None:
            # The cancelled one ends soon, and starts this again.
            return
        if self._ended_last is not None and not self._ended_last.left.is_set():
            # Otherwise a layer that hangs would block one more thread of the map's pool for each dialog.
            self._timer.start()
            return
        rows = [row for row in self._rows if row.setup.role in roles.PUBLISHED_ROLES]
        missing = [row for row in rows if _key(row) not in self._known]
        try:
            site = self._site(rows)
        except FleetError as error:
            self.summed.emit(str(error))
            return
        sources = {_key(row): source for row in missing if (source := self._source(row)) is not None}
        known = {_key(row): self._known[_key(row)] for row in rows if _key(row) in self._known}
        self.summed.emit(
            tr_count(len(sources), "Reading 1 layer …", "Reading %n layers …")
            if sources
            else measure_summary(list(known.values()))
        )
        self._task = PreviewTask(sources, known, site, self._size, self._ratio)
        self._task.measured.connect(self._keep)
        self._task.drawn.connect(self.drawn)
        self._task.taskCompleted.connect(self._ended)
        self._task.taskTerminated.connect(self._ended)
        QgsApplication.taskManager().addTask(self._task)

    def _source(self, row: role_table.RoleRow) -> ObstacleSource | None:
        context = QgsExpressionContext()
        context.appendScope(QgsExpressionContextUtils.globalScope())
        context.appendScope(QgsExpressionContextUtils.projectScope(self._project))
        try:
            (source,) = obstacle_sources([row.layer], roles.LayerExpressions(), context, lambda _: row.setup)
        except FleetError as error:
            self._keep(_key(row), LayerMeasure(row.setup.role, refused=str(error)))
            return None
        return source

    def _site(self, rows: Sequence[role_table.RoleRow]) -> SiteGeoreference:
        layers = [stated_crs(row.layer.crs()) for row in rows]
        crs = site_crs_for(QgsCoordinateReferenceSystem(), self._project.crs(), layers)
        frame = frame_in_project(self._project, crs) or SiteFrame(crs.authid(), (0.0, 0.0))
        return SiteGeoreference(crs, frame, self._project.transformContext())

    def _keep(self, key: object, found: LayerMeasure) -> None:
        self._known[key] = found
        layer_id, setup = key
        if any(row.layer_id == layer_id and row.setup == setup for row in self._rows):
            self.measured.emit(layer_id, found)

    def _ended(self) -> None:
        if self._task is None:
            return
        cancelled, self._task = self._task.isCanceled(), None
        if cancelled:
            self._timer.start()
            return
        keys = [_key(row) for row in self._rows if row.setup.role in roles.PUBLISHED_ROLES]
        self.summed.emit(measure_summary([self._known[key] for key in keys if key in self._known]))


def _key(row: role_table.RoleRow) -> object:
    return row.layer_id, row.setup


# --- The dialog *Layer roles*: the role of each layer of the project, with a live preview ---

WIDTHS = {
    role_table.LAYER: 140,
    role_table.ROLE: 130,
    role_table.FILTER: 70,
    role_table.HEIGHT: 80,
    role_table.ESTIMATE: 90,
    role_table.BASE: 65,
    role_table.SEMANTICS: 110,
    role_table.OUTDOOR: 70,
    role_table.WIDTH: 75,
    role_table.TEMPLATE: 75,
    role_table.ROTATION: 75,
    role_table.RESULT: 200,
}
WIDEST_NAME = 320
"""Greatest width in pixels of layers' names; longer ones are cut in the middle, with a tool tip."""
WIDE = 1280
"""Width in pixels of the dialog with short names."""

MOST_OF_TABLE = 370
"""Initial height of the table in pixels when it has many rows."""


class RolesDialog(QDialog):
    """The dialog; nothing changes in the project before *Apply* or *OK*."""

    def __init__(self, project: QgsProject, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_roles_dialog")
        self.setWindowTitle(tr("Layer roles"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._project = project
        self.model = role_table.RoleTableModel(role_table.role_rows(project), self)
        self.preview = LivePreview(project, self.model.rows, self)
        self._bar = QgsMessageBar(self)
        self._table = self._make_table()
        self._view = PreviewView(self)
        self._summary = QLabel(self)
        self._summary.setObjectName("fleet_roles_summary")
        self._summary.setWordWrap(True)
        self._buttons = self._make_buttons()
        self._lay_out()
        self._wire()
        long_names = self._table.columnWidth(role_table.LAYER) - WIDTHS[role_table.LAYER]
        self.resize(max(WIDE, min(WIDE + long_names, self.screen().availableGeometry().width())), 760)
        self.preview.refresh()

    def apply(self) -> None:
        """Store the table's settings in the layers."""
        changed = [row for row in self.model.rows if row.setup != roles.setup_of(row.layer)]
        for row in changed:
            roles.keep_setup(row.layer, row.setup)
        if changed:
            self._project.setDirty(True)
        self._show_changed()

    def apply_profile(self, file: Path) -> None:
        """Apply the profile in ``file`` to the layers that it matches; show their number, or the error."""
        try:
            profile = roles.read_profile(file)
        except FleetError as error:
            self._bar.pushWarning("", str(error))
            return
        setups = {row.layer_id: profile.setup_for(row.layer) for row in self.model.rows}
        known = {layer_id: setup for layer_id, setup in setups.items() if setup is not None}
        self.model.set_up(known)
        self._bar.clearWidgets()
        if known:
            self._bar.pushInfo(
                "",
                tr_count(
                    len(setups),
                    "{name}: {known} of 1 layer set up.",
                    "{name}: {known} of %n layers set up.",
                    name=profile.name,
                    known=len(known),
                ),
            )
        else:
            self._bar.pushWarning(
                "",
                tr(
                    "{name} knows none of these layers. It looks for layers that are named, in their source "
                    "or in the project: {sought}.",
                    name=profile.name,
                    sought=profile.sought(),
                ),
            )

    def done(self, result: int) -> None:
        """End the preview whichever way the dialog closes."""
        self.preview.stop()
        super().done(result)

    # --- Layout ---

    def _make_table(self) -> QTableView:
        table = QTableView(self)
        table.setObjectName("fleet_roles_table")
        table.setModel(self.model)
        table.setItemDelegateForColumn(role_table.ROLE, role_table.RoleDelegate(table))
        for column in role_table.WHAT.keys() - {role_table.ROLE}:
            table.setItemDelegateForColumn(column, role_table.ExpressionDelegate(table))
        triggers = QAbstractItemView.EditTrigger
        table.setEditTriggers(
            triggers.SelectedClicked
            | triggers.DoubleClicked
            | triggers.EditKeyPressed
            | triggers.AnyKeyPressed
        )
        table.verticalHeader().hide()
        table.verticalHeader().setDefaultSectionSize(26)
        table.setAlternatingRowColors(True)
        table.setWordWrap(False)
        # Layers of one file differ at their ends, as in "campus — buildings".
        table.setTextElideMode(Qt.TextElideMode.ElideMiddle)
        header = table.horizontalHeader()
        for column, width in WIDTHS.items():
            table.setColumnWidth(column, width)
        name_width = min(table.sizeHintForColumn(role_table.LAYER), WIDEST_NAME)
        table.setColumnWidth(role_table.LAYER, max(name_width, WIDTHS[role_table.LAYER]))
        fit_headers(table)
        # The last column, which takes the rest, keeps room for its head.
        header.setMinimumSectionSize(
            header.fontMetrics().horizontalAdvance(role_table.TITLES[role_table.RESULT]) + 8
        )
        header.setSectionResizeMode(role_table.RESULT, QHeaderView.ResizeMode.Stretch)
        return table

    def _make_buttons(self) -> QDialogButtonBox:
        standard = QDialogButtonBox.StandardButton
        return QDialogButtonBox(standard.Ok | standard.Apply | standard.Cancel, self)

    def _lay_out(self) -> None:
        layout = QVBoxLayout(self)
        layout.addWidget(self._bar)
        layout.addLayout(self._profile_line())
        splitter = QSplitter(Qt.Orientation.Vertical, self)
        splitter.addWidget(self._table)
        splitter.addWidget(self._view)
        splitter.setStretchFactor(0, 1)
        splitter.setStretchFactor(1, 1)
        rows = self._table.verticalHeader().length() + self._table.horizontalHeader().height()
        splitter.setSizes([min(rows + 10, MOST_OF_TABLE), 300])
        layout.addWidget(splitter, 1)
        layout.addWidget(self._summary)
        layout.addWidget(self._buttons)

    def _profile_line(self) -> QHBoxLayout:
        self._profiles = QComboBox(self)
        self._profiles.setObjectName("fleet_roles_profile")
        for file in roles.shipped_profiles():
            try:
                profile = roles.read_profile(file)
            except FleetError as error:
                self._bar.pushWarning("", str(error))
                continue
            self._profiles.addItem(profile.name, str(file))
            self._profiles.setItemData(self._profiles.count() - 1, profile.about, Qt.ItemDataRole.ToolTipRole)
        self._apply_profile = QPushButton(tr("Apply profile"), self)
        self._apply_profile.setObjectName("fleet_roles_apply_profile")
        self._from_file = QPushButton(tr("Profile from file…"), self)
        self._apply_profile.setEnabled(self._profiles.count() > 0)
        line = QHBoxLayout()
        line.addWidget(QLabel(tr("Map profile:"), self))
        for widget in (self._profiles, self._apply_profile, self._from_file):
            line.addWidget(widget)
        line.addStretch(1)
        return line

    # --- Actions ---

    def _wire(self) -> None:
        self._buttons.accepted.connect(self._accept)
        self._buttons.rejected.connect(self.reject)
        self._buttons.button(QDialogButtonBox.StandardButton.Apply).clicked.connect(self.apply)
        self._apply_profile.clicked.connect(lambda: self.apply_profile(Path(self._profiles.currentData())))
        self._from_file.clicked.connect(self._choose_profile)
        self.model.edited.connect(self.preview.refresh)
        self.model.edited.connect(self._show_changed)
        self.preview.measured.connect(self.model.show_result)
        self.preview.drawn.connect(self._view.show_image)
        self.preview.summed.connect(self._summary.setText)
        self._view.resized.connect(
            lambda: self.preview.resize(self._view.size(), self._view.devicePixelRatioF())
        )
        self._project.layersWillBeRemoved.connect(self._close_without)
        self._show_changed()

    def _accept(self) -> None:
        self.apply()
        self.accept()

    def _close_without(self, layer_ids: list[str]) -> None:
        # A row refers to its layer: without it there is nothing to show or to store.
        if any(row.layer_id in layer_ids for row in self.model.rows):
            self.reject()

    def _show_changed(self) -> None:
        changed = any(row.setup != roles.setup_of(row.layer) for row in self.model.rows)
        self._buttons.button(QDialogButtonBox.StandardButton.Apply).setEnabled(changed)

    def _choose_profile(self) -> None:
        kinds = " ".join(f"*{suffix}" for suffix in roles.SUFFIXES)
        name = file_to_read(
            self,
            tr("Map profile"),
            "",
            tr(
                "Map profile ({kinds})",
                kinds=kinds,
            ),
        )
        if name:
            self.apply_profile(Path(name))


# --- The menu entry that opens the dialog *Layer roles*, and its removal ---

ICON = Path(__file__).parents[3] / "resources" / "icons" / "layer_roles.svg"


class RolesAction:
    """An entry of ``menu``. :meth:`remove` undoes the constructor and closes the dialog."""

    def __init__(self, iface: QgisInterface, menu: str):
        self._iface, self._menu = iface, menu
        self._dialog: RolesDialog | None = None
        self.action = QAction(QIcon(str(ICON)), tr("Layer roles…"), iface.mainWindow())
        self.action.setObjectName("fleet_layer_roles")
        self.action.setToolTip(tr("Say what each layer of the project is to robots"))
        self.action.triggered.connect(self.open)
        iface.addPluginToMenu(menu, self.action)

    def open(self) -> None:
        """Open the dialog, or bring it to the front."""
        if self._dialog is None or sip.isdeleted(self._dialog) or not self._dialog.isVisible():
            self._dialog = RolesDialog(QgsProject.instance(), self._iface.mainWindow())
            self._dialog.open()
        self._dialog.raise_()

    def remove(self) -> None:
        """Close the dialog without storing anything, and remove the entry from the menu."""
        if self._dialog is not None:
            if not sip.isdeleted(self._dialog):
                self._dialog.reject()
                self._dialog.deleteLater()
            self._dialog.preview.wait_for_end()
        self._dialog = None
        self._iface.removePluginMenu(self._menu, self.action)
        self.action.deleteLater()
