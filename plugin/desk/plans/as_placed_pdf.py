"""The way from the cones that the desk knows to the report of them: QGIS's dialog of the algorithm."""

from __future__ import annotations

from qgis.core import QgsProject
from qgis.PyQt.QtCore import Qt

from ...errors import FleetError
from ...language import tr
from ..live_layers import MARK, live_layers

PLACED = "cones_as_placed"
"""The mark of the layer that the cones are on."""


class ReportError(FleetError):
    """The report cannot be asked for: says what to do."""


def open_report_dialog(project: QgsProject) -> None:
    """Open the dialog of ``fleet:asplacedreport`` on the layer of placed cones, which is in ``project``.

    :raises ReportError: when QGIS's Processing is switched off.
    """
    try:
        from processing import createAlgorithmDialog
    except ImportError as error:
        raise ReportError(
            tr(
                "The report is made by QGIS's Processing: switch that on in Plugins > Manage and Install "
                "Plugins."
            )
        ) from error
    layer = next(one for one in live_layers(project) if one.customProperty(MARK) == PLACED)
    dialog = createAlgorithmDialog("fleet:asplacedreport", {"INPUT": layer.id()})
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    dialog.show()
