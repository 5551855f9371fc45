"""Puts the filter for robots into QGIS's locator and takes it out again."""

from __future__ import annotations

from collections.abc import Callable

from qgis.core import Qgis, QgsSettings
from qgis.gui import QgisInterface, QgsLocatorWidget
from qgis.PyQt.QtGui import QIcon
from qgis.PyQt.QtWidgets import QLineEdit

from ..desk.glyphs import state_icon
from ..desk.picture import STATES
from ..expressions.robots_now import FleetNow
from .robot_filter import NAME, RobotFilter

PREFIX = "rb"
PREFIX_KEY = f"locator-filters/items/{NAME}/prefix"
"""Where QGIS keeps the prefix that the user has chosen."""
if Qgis.versionInt() < 33000:
    PREFIX_KEY = f"gui/locator_filters/prefix_{NAME}"


class RobotLocator:
    """The filter as long as the plugin is loaded. :meth:`remove` undoes the constructor."""

    def __init__(self, iface: QgisInterface, fleet: FleetNow, go: Callable[[str], None]):
        self._iface, self._filter = iface, RobotFilter(fleet, _icons(), go, self._typed)
        settings = QgsSettings()
        # As if the user had chosen it: of plugins themselves QGIS takes none of less than three letters.
        if not settings.value(PREFIX_KEY, ""):
            settings.setValue(PREFIX_KEY, PREFIX)
        iface.registerLocatorFilter(self._filter)

    def remove(self) -> None:
        """Take the filter out; QGIS deletes it. A prefix of the user's own stays."""
        self._iface.deregisterLocatorFilter(self._filter)
        settings = QgsSettings()
        if settings.value(PREFIX_KEY, "") == PREFIX:
            settings.remove(PREFIX_KEY)

    def _typed(self) -> str | None:
        """Return what stands in the locator's field of the window, None where the window has none."""
        locator = self._iface.mainWindow().findChild(QgsLocatorWidget)
        field = None if locator is None else locator.findChild(QLineEdit)
        return None if field is None else field.text()


def _icons() -> dict[str, QIcon]:
    # Made here: the filter looks in a thread, where pictures cannot be drawn.
    return {state.value: state_icon(state) for state in STATES}
