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
        self._window = None
        self._roles = None
        self._layouts = None

    @property
    def window(self):
        """The desk in the QGIS window, None before ``initGui`` and after ``unload``."""
        return self._window

    def initProcessing(self):
        provider = FleetProvider()
        # The registry deletes a provider that it does not take, as when two copies of the plugin are loaded.
        if QgsApplication.processingRegistry().addProvider(provider):
            self._provider = provider

    def initGui(self):
        self.initProcessing()
        if self._iface is None:
            return
        # Only here: qgis_process has no window, and needs nothing of what the window is made of.
        from .desk.layout_action import LayoutAction
        from .desk.window import MENU, DeskWindow
        from .roles.roles_action import RolesAction

        self._window = DeskWindow(self._iface)
        self._roles = RolesAction(self._iface, MENU)
        self._layouts = LayoutAction(self._iface, MENU)

    def unload(self):
        if self._layouts is not None:
            self._layouts.remove()
            self._layouts = None
        if self._roles is not None:
            self._roles.remove()
            self._roles = None
        if self._window is not None:
            self._window.remove()
            self._window = None
        if self._provider is not None:
            QgsApplication.processingRegistry().removeProvider(self._provider)
            self._provider = None
