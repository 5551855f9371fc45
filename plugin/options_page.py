"""The plugin's page in QGIS's options: connections, map display, alarms."""

from __future__ import annotations

from qgis.gui import (
    QgisInterface,
    QgsFileWidget,
    QgsOptionsPageWidget,
    QgsOptionsWidgetFactory,
    QgsScrollArea,
)
from qgis.PyQt.QtCore import QSize, Qt, pyqtSignal
from qgis.PyQt.QtGui import QIcon
from qgis.PyQt.QtWidgets import (
    QComboBox,
    QDoubleSpinBox,
    QFormLayout,
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from .help import OPTIONS, show_help
from .panel.alarms.alarm_panel import ThresholdsForm
from .panel.alarms.rules import Thresholds, read_thresholds
from .panel.alarms.watch import AlarmWatch
from .panel.window import FleetWindow
from .settings.connections_widget import ConnectionsWidget
from .settings.profile import RANGES, Preferences, read_preferences, write_preferences
from .ui.actions import ICONS
from .ui.dialogs import file_field
from .ui.language import tr
from .ui.scheduling import PULL_EVERY_MS

# --- Map display, and the folder for files ---

SPINS = (
    ("robot_size", tr("&Size of robots on the map"), " ×", 0.1, 1, tr("1 is as they come")),
    (
        "positions_rate",
        tr("Positions asked for, &times a second"),
        " /s",
        1.0,
        0,
        tr("At most; from the next connection on. Fewer spare a slow network"),
    ),
    (
        "layer_seconds",
        tr("Layer of robots written anew &every"),
        " s",
        1.0,
        0,
        tr("The layer Robots (live): attribute table, labels, expressions. The live map goes its own way"),
    ),
)
DRAWN_BY = {False: tr("the live map: arrows"), True: tr("the layer Robots (live), in its style")}
WIDTH = 90
"""Width in pixels of a number field, so that all are equal."""


class PreferencesForm(QWidget):
    """A field for each of the preferences."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        form = QFormLayout(self)
        form.setContentsMargins(0, 0, 0, 0)
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.ExpandingFieldsGrow)
        self._spins: dict[str, QDoubleSpinBox] = {}
        for name, text, unit, step, decimals, tip in SPINS:
            spin = QDoubleSpinBox()
            spin.setObjectName(f"fleet_{name}")
            spin.setRange(*RANGES[name])
            spin.setSingleStep(step)
            spin.setDecimals(decimals)
            spin.setSuffix(unit)
            spin.setToolTip(tip)
            spin.setMinimumWidth(WIDTH)
            self._spins[name] = spin
            _add(form, text, spin)
        self._drawn_by = QComboBox()
        self._drawn_by.setObjectName("fleet_drawn_by_layer")
        for by_layer, text in DRAWN_BY.items():
            self._drawn_by.addItem(text, by_layer)
        self._drawn_by.setToolTip(
            tr(
                "Arrows show how each robot is, and move with every position. The layer shows what its style "
                "says, as often as it is written anew; while it is not on the map there are arrows"
            )
        )
        _add(form, tr("Robots are &drawn by"), self._drawn_by)
        self._folder = file_field()
        self._folder.setObjectName("fleet_folder")
        self._folder.setStorageMode(QgsFileWidget.StorageMode.GetDirectory)
        self._folder.lineEdit().setPlaceholderText(tr("your documents"))
        _add(form, tr("&Folder for files that are written"), self._folder)

    def show_preferences(self, preferences: Preferences) -> None:
        """Show these values."""
        for name, spin in self._spins.items():
            spin.setValue(getattr(preferences, name))
        self._drawn_by.setCurrentIndex(self._drawn_by.findData(preferences.drawn_by_layer))
        self._folder.setFilePath(preferences.folder)

    def preferences(self) -> Preferences:
        """Return the preferences in the fields."""
        numbers = {name: spin.value() for name, spin in self._spins.items()}
        return Preferences(
            **numbers,
            drawn_by_layer=self._drawn_by.currentData(),
            folder=self._folder.filePath().strip(),
        )


def _add(form: QFormLayout, text: str, field: QWidget) -> None:
    label = QLabel(text)
    label.setBuddy(field)
    form.addRow(label, field)


# --- The page, and its place in the options ---


class OptionsPage(QgsOptionsPageWidget):
    """Shows the stored values; OK and Apply of the options store those in the fields.

    Connections are stored at once, as elsewhere in QGIS.
    """

    kept = pyqtSignal(object, object)
    """The stored Preferences and Thresholds."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_options")
        self.connections = ConnectionsWidget()
        self.preferences = PreferencesForm()
        self.alarms = ThresholdsForm()
        self.preferences.show_preferences(read_preferences())
        self.alarms.show_limits(read_thresholds())
        tabs = QTabWidget()
        tabs.setObjectName("fleet_options_tabs")
        tabs.addTab(_page(self.connections, stretch=False), tr("Connections"))
        tabs.addTab(_page(self.preferences), tr("Map and files"))
        tabs.addTab(_ScrolledPage(_page(self.alarms)), tr("Alarms"))
        self._help = QPushButton(tr("Fleet Supervisor &help"))
        self._help.setObjectName("fleet_options_help")
        self._help.setAutoDefault(False)
        self._help.clicked.connect(lambda: show_help(OPTIONS, self))
        foot = QHBoxLayout()
        foot.addStretch()
        foot.addWidget(self._help)
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.addWidget(tabs)
        rows.addLayout(foot)
        self.destroyed.connect(self.connections.end)

    def apply(self) -> None:
        """Store the values in the fields; QGIS calls this on OK and on Apply."""
        preferences, limits = self.preferences.preferences(), self.alarms.limits()
        write_preferences(preferences)
        self.kept.emit(preferences, limits)

    def isValid(self) -> bool:
        return True


def _page(widget: QWidget, *, stretch: bool = True) -> QWidget:
    page = QWidget()
    rows = QVBoxLayout(page)
    rows.addWidget(widget)
    if stretch:
        rows.addStretch()
    return page


class _ScrolledPage(QgsScrollArea):
    """Scrolls ``page`` where it is too tall, and is as wide as it needs.

    QGIS's own scroll area keeps the wheel that scrolls from changing the fields that come under the mouse.
    """

    def __init__(self, page: QWidget):
        super().__init__()
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setWidgetResizable(True)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setWidget(page)

    def minimumSizeHint(self) -> QSize:
        bar = self.verticalScrollBar().sizeHint().width()
        width = self.widget().minimumSizeHint().width() + bar + 2 * self.frameWidth()
        return QSize(width, super().minimumSizeHint().height())

    def sizeHint(self) -> QSize:
        return self.widget().sizeHint()


TITLE = "Fleet Supervisor"


class OptionsFactory(QgsOptionsWidgetFactory):
    """Creates the page when the options are opened. :meth:`remove` undoes the constructor."""

    def __init__(
        self,
        iface: QgisInterface,
        window: FleetWindow,
        alarms: AlarmWatch,
    ):
        super().__init__()
        self.setTitle(TITLE)
        self.setIcon(QIcon(str(ICONS / "fleet.svg")))
        self._iface, self._window, self._alarms = iface, window, alarms
        iface.registerOptionsWidgetFactory(self)
        self._apply_preferences(read_preferences())

    def createWidget(self, parent: QWidget | None = None) -> OptionsPage:
        page = OptionsPage(parent)
        page.kept.connect(self._kept)
        return page

    def remove(self) -> None:
        """Remove the page from the options."""
        self._iface.unregisterOptionsWidgetFactory(self)

    def _kept(self, preferences: Preferences, limits: Thresholds) -> None:
        self._alarms.set_limits(limits)
        self._apply_preferences(preferences)

    def _apply_preferences(self, preferences: Preferences) -> None:
        view = self._window.view
        self._window.desk.connection.set_rate(preferences.positions_rate)
        view.layer_every = max(1, round(preferences.layer_seconds * 1000 / PULL_EVERY_MS))
        view.overlay.magnify(preferences.robot_size)
        view.draw_by_layer(preferences.drawn_by_layer)
