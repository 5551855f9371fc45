"""Writes looks as style files, with nothing else of the layer that wears them."""

from __future__ import annotations

from pathlib import Path

from qgis.core import QgsMapLayer, QgsVectorLayer

CATEGORY = QgsMapLayer.StyleCategory
LOOKS = CATEGORY.Symbology | CATEGORY.Labeling | CATEGORY.Rendering


def write_style(layer: QgsVectorLayer, file: Path, categories: int = LOOKS) -> None:
    """Write those categories of the layer's style; ends the program with a message where that fails."""
    message, saved = layer.saveNamedStyle(str(file), QgsMapLayer.StyleCategories(categories))
    if not saved:
        raise SystemExit(f"{file} cannot be written: {message}")
