"""Tells when what was read of layers has to be read anew."""

from __future__ import annotations

from collections.abc import Iterable

from qgis.core import QgsVectorLayer
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QObject, pyqtSignal

_CHANGES = (
    "afterCommitChanges",
    "afterRollBack",
    "crsChanged",
    "customPropertyChanged",
    "dataChanged",
    "dataSourceChanged",
    "layerModified",
    "subsetStringChanged",
    "willBeDeleted",
)
"""Signals of a layer after which its features, or what they are, are others; older QGIS lacks some."""


class LayerWatch(QObject):
    """Watches layers from :meth:`watch` on, until they are deleted or :meth:`remove`."""

    changed = pyqtSignal()
    """A watched layer is not as it was, or is about to be deleted."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self._watched: dict[str, QgsVectorLayer] = {}

    def watch(self, layers: Iterable[QgsVectorLayer]) -> None:
        """Watch these layers besides those that are watched already."""
        for layer in layers:
            known = self._watched.get(layer.id())
            # A project that is read again brings other layers under the same ids.
            if known is None or sip.isdeleted(known):
                self._watched[layer.id()] = layer
                for name in _signals_of(layer):
                    getattr(layer, name).connect(self._tell)

    def remove(self) -> None:
        """Watch no layer any longer."""
        for layer in self._watched.values():
            if not sip.isdeleted(layer):
                for name in _signals_of(layer):
                    getattr(layer, name).disconnect(self._tell)
        self._watched.clear()

    def _tell(self, *_what: object) -> None:
        self.changed.emit()


def _signals_of(layer: QgsVectorLayer) -> list[str]:
    return [name for name in _CHANGES if hasattr(layer, name)]
