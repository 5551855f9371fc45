"""Is the open project that of the site the gateway serves?"""

from __future__ import annotations

import math

from qgis.core import QgsCoordinateReferenceSystem
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.sites.frame import SiteFrame
from ..language import tr
from ..sites.project_site import own_frame
from .desk import Desk
from .placement import frame_of
from .project_watch import ProjectWatch

SAME_PLACE = 0.01
"""Metres up to which two origins are one."""
SAME_ANGLE = 1e-6
"""Radians up to which two rotations are one."""


class ProjectMatch(QObject):
    """Tells of a project whose variables have another site frame than the site that is served.

    Robots are shown where they are all the same; what is checked before a command goes out, and what raises
    alarms, are the project's own roads, keepouts and obstacles.
    """

    differs = pyqtSignal(str)
    """What to tell the operator."""
    over = pyqtSignal(str)
    """What was told is not so any more."""

    def __init__(self, desk: Desk, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self._told = ""
        self._watch = ProjectWatch(desk.project, self)
        self._watch.opened.connect(self._compare)
        desk.site_changed.connect(self._compare)

    def remove(self) -> None:
        """Compare no more."""
        self._watch.remove()

    def _compare(self) -> None:
        if self._told:
            self.over.emit(self._told)
        self._told = ""
        site, mine = self._desk.site, own_frame(self._desk.project)
        if site is None or mine is None or _is_one(mine, frame_of(site)):
            return
        self._told = tr(
            "This project is not that of site {site}: its variables have another origin, CRS or rotation. "
            "Checks and alarms go by the layers of this project: open the site's.",
            site=site.name,
        )
        self.differs.emit(self._told)


def _is_one(a: SiteFrame, b: SiteFrame) -> bool:
    crs = [QgsCoordinateReferenceSystem(frame.crs) for frame in (a, b)]
    turned = math.remainder(a.rotation - b.rotation, math.tau)
    return crs[0] == crs[1] and math.dist(a.origin, b.origin) < SAME_PLACE and abs(turned) < SAME_ANGLE
