"""How the parts of the fleet panel share its height, so that what comes and goes moves no button."""

from __future__ import annotations

from qgis.PyQt.QtCore import QSize, Qt
from qgis.PyQt.QtGui import QResizeEvent
from qgis.PyQt.QtWidgets import QSizePolicy, QSplitter, QVBoxLayout, QWidget

from .connection_panel import ConnectionPanel
from .emergency_banner import EmergencyBanner
from .robots.robot_table import RobotTable

GAP = 4
"""Pixels between two parts."""
SHARE = 0.45
"""Of the height that nothing needs, the upper part's, until the operator moves the splitter."""


class LinkAndRobots(QWidget):
    """The link, and the robots beneath it; needs one height whether the link's fields are folded or not."""

    def __init__(self, link: ConnectionPanel, table: RobotTable):
        super().__init__()
        self._link, self._table = link, table
        # It gives way to the fields to the last pixel.
        table.setMinimumHeight(0)
        table.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Ignored)
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.setSpacing(GAP)
        rows.addWidget(link)
        rows.addWidget(table, 1)

    def minimumSizeHint(self) -> QSize:
        folded = self._link.height_without_fields() + GAP + self._table.least_height()
        least = max(folded, self._link.height_with_fields())
        return QSize(super().minimumSizeHint().width(), least)

    def sizeHint(self) -> QSize:
        return QSize(super().sizeHint().width(), self.minimumSizeHint().height())


class ListsWithReserve(QWidget):
    """The lists at the bottom, with room for the ``banner`` that is shown beneath them while it is hidden.

    The banner lies outside, where nothing is scrolled: it takes its room from here.
    """

    def __init__(self, lists: QWidget, banner: EmergencyBanner):
        super().__init__()
        self._banner = banner
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.addWidget(lists)
        banner.toggled.connect(self.updateGeometry)

    def minimumSizeHint(self) -> QSize:
        needs = super().minimumSizeHint()
        return QSize(needs.width(), needs.height() + self.reserve)

    def sizeHint(self) -> QSize:
        return self.minimumSizeHint()

    @property
    def reserve(self) -> int:
        """Pixels of height that are kept for the banner; none while it is shown."""
        return self._banner.sizeHint().height() + GAP if self._banner.isHidden() else 0


class SharingSplitter(QSplitter):
    """Two parts that share the height of a window that is made higher; the lower one alone gives way."""

    def __init__(self, upper: QWidget, lists: ListsWithReserve):
        super().__init__(Qt.Orientation.Vertical)
        self._lists, self._share = lists, SHARE
        self.setChildrenCollapsible(False)
        self.addWidget(upper)
        self.addWidget(lists)
        self.setStretchFactor(0, 0)
        self.setStretchFactor(1, 1)
        self.splitterMoved.connect(self._moved)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        least, free = self._least(), self._free()
        upper = least + round(self._share * free)
        if upper != self.sizes()[0]:
            self.setSizes([upper, self.height() - self.handleWidth() - upper])

    def _least(self) -> int:
        return self.widget(0).minimumSizeHint().height()

    def _free(self) -> int:
        """Pixels of height that neither part needs; as many while the banner is shown."""
        needs = self._least() + self._lists.minimumSizeHint().height() + self.handleWidth()
        return max(0, self.height() - needs)

    def _moved(self) -> None:
        self._share = (self.sizes()[0] - self._least()) / max(1, self._free())
