"""The dialog *Layer roles*: what each layer of the project is to robots, with a live preview."""

from __future__ import annotations

from pathlib import Path

from qgis.core import QgsProject
from qgis.gui import QgsMessageBar
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import (
    QAbstractItemView,
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

from ..desk.column_heads import fit_heads
from ..errors import FleetError
from ..file_dialogs import file_to_read
from ..language import tr, tr_count
from ..sites.profile_file import SUFFIXES, read_profile, shipped_profiles
from ..sites.roles import keep_setup, setup_of
from .delegates import ExpressionDelegate, RoleDelegate
from .live_preview import LivePreview
from .preview_view import PreviewView
from .rows import rows_of
from .table_model import (
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
    TITLES,
    WHAT,
    WIDTH,
    RoleTableModel,
)

WIDTHS = {
    LAYER: 140,
    ROLE: 130,
    FILTER: 70,
    HEIGHT: 80,
    ESTIMATE: 90,
    BASE: 65,
    SEMANTICS: 110,
    OUTDOOR: 70,
    WIDTH: 75,
    TEMPLATE: 75,
    ROTATION: 75,
    RESULT: 200,
}
WIDEST_NAME = 320
"""Pixels that names of layers get at most; longer ones are cut in the middle, and whole in a tool tip."""
WIDE = 1280
"""Pixels that the dialog is wide with short names."""

MOST_OF_TABLE = 370
"""How high the table is at first when it has many rows, pixels."""


class RolesDialog(QDialog):
    """Nothing changes in the project before *Apply* or *OK*."""

    def __init__(self, project: QgsProject, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_roles_dialog")
        self.setWindowTitle(tr("Layer roles"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._project = project
        self.model = RoleTableModel(rows_of(project), self)
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
        long_names = self._table.columnWidth(LAYER) - WIDTHS[LAYER]
        self.resize(max(WIDE, min(WIDE + long_names, self.screen().availableGeometry().width())), 760)
        self.preview.refresh()

    def apply(self) -> None:
        """Keep what the table says in the layers."""
        changed = [row for row in self.model.rows if row.setup != setup_of(row.layer)]
        for row in changed:
            keep_setup(row.layer, row.setup)
        if changed:
            self._project.setDirty(True)
        self._show_changed()

    def apply_profile(self, file: Path) -> None:
        """Set the layers up that the profile in ``file`` knows; say how many those were, or what is wrong."""
        try:
            profile = read_profile(file)
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

    # --- how it looks ---

    def _make_table(self) -> QTableView:
        table = QTableView(self)
        table.setObjectName("fleet_roles_table")
        table.setModel(self.model)
        table.setItemDelegateForColumn(ROLE, RoleDelegate(table))
        for column in WHAT.keys() - {ROLE}:
            table.setItemDelegateForColumn(column, ExpressionDelegate(table))
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
        name_width = min(table.sizeHintForColumn(LAYER), WIDEST_NAME)
        table.setColumnWidth(LAYER, max(name_width, WIDTHS[LAYER]))
        fit_heads(table)
        # The column that takes what is left keeps room for its head.
        header.setMinimumSectionSize(header.fontMetrics().horizontalAdvance(TITLES[RESULT]) + 8)
        header.setSectionResizeMode(RESULT, QHeaderView.ResizeMode.Stretch)
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
        for file in shipped_profiles():
            try:
                profile = read_profile(file)
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

    # --- what it does ---

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
        # A row speaks of its layer: without it the dialog has nothing to show or to keep.
        if any(row.layer_id in layer_ids for row in self.model.rows):
            self.reject()

    def _show_changed(self) -> None:
        changed = any(row.setup != setup_of(row.layer) for row in self.model.rows)
        self._buttons.button(QDialogButtonBox.StandardButton.Apply).setEnabled(changed)

    def _choose_profile(self) -> None:
        kinds = " ".join(f"*{suffix}" for suffix in SUFFIXES)
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
