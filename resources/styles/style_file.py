"""Writes looks as style files beside this one, with nothing else of the layer that wears them."""

from __future__ import annotations

from pathlib import Path

from qgis.core import (
    QgsFeatureRenderer,
    QgsMapLayer,
    QgsPalLayerSettings,
    QgsVectorLayer,
    QgsVectorLayerSimpleLabeling,
)

HERE = Path(__file__).resolve().parent
CATEGORY = QgsMapLayer.StyleCategory
LOOKS = CATEGORY.Symbology | CATEGORY.Labeling | CATEGORY.Rendering


def write_look(
    name: str, kind: str, renderer: QgsFeatureRenderer, labels: QgsPalLayerSettings | None = None
) -> None:
    """Write the style file ``name`` for a layer of ``kind``, as a layer in memory spells kinds and fields."""
    layer = QgsVectorLayer(kind, name, "memory")
    layer.setRenderer(renderer)
    if labels is not None:
        layer.setLabeling(QgsVectorLayerSimpleLabeling(labels))
        layer.setLabelsEnabled(True)
    write_style(layer, name)


def write_style(layer: QgsVectorLayer, name: str, categories: int = LOOKS) -> None:
    """Write those categories of the layer's style as ``name``; ends the program where that fails."""
    file = HERE / f"{name}.qml"
    message, saved = layer.saveNamedStyle(str(file), QgsMapLayer.StyleCategories(categories))
    if not saved:
        raise SystemExit(f"{file} cannot be written: {message}")
