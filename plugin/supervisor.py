"""The plugin: builds its parts when QGIS loads it and takes every one of them out again."""

from __future__ import annotations

from qgis.core import QgsApplication

from .processing.provider import FleetProvider


class FleetSupervisor:
    """What QGIS holds of the plugin.

    ``initProcessing`` is all that ``qgis_process`` calls; ``initGui`` adds what needs a window.
    """

    def __init__(self, iface):
        self._iface = iface
        self._provider = None

    def initProcessing(self):
        self._provider = FleetProvider()
        QgsApplication.processingRegistry().addProvider(self._provider)

    def initGui(self):
        self.initProcessing()

    def unload(self):
        if self._provider is not None:
            QgsApplication.processingRegistry().removeProvider(self._provider)
            self._provider = None
