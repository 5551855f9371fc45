"""How the layers of a site look on a photograph: sober, legible on light and dark ground."""

from __future__ import annotations

from collections.abc import Callable

from labels import letters
from qgis.core import (
    QgsCategorizedSymbolRenderer,
    QgsCentroidFillSymbolLayer,
    QgsFeatureRenderer,
    QgsFillSymbol,
    QgsLinePatternFillSymbolLayer,
    QgsLineSymbol,
    QgsMarkerSymbol,
    QgsPalLayerSettings,
    QgsProperty,
    QgsRendererCategory,
    QgsSimpleLineSymbolLayer,
    QgsSingleSymbolRenderer,
    QgsSymbolLayer,
    QgsVectorLayer,
    QgsVectorLayerSimpleLabeling,
)
from qgis.PyQt.QtGui import QColor

INK, PAPER = "26,32,44", "255,255,255"
SURFACES = {
    "asphalt": ("Asphalt", "96,142,206,46", "190,214,246,200"),
    "parking pavement": ("Parking pavement", "220,166,70,54", "255,222,150,210"),
    "slippery": ("Slippery", "60,170,210,76", "18,118,160,220"),
}
OTHER_SURFACE = ("Other", "150,150,150,70", "110,110,110,190")


def style(layer: QgsVectorLayer, look: str) -> None:
    """Give ``layer`` the renderer and labels of ``look``, one of the keys of ``LOOKS``."""
    layer.setRenderer(LOOKS[look]())
    if look in LABELS:
        layer.setLabeling(QgsVectorLayerSimpleLabeling(_labels(*LABELS[look])))
        layer.setLabelsEnabled(True)
    if look in SMALL_THINGS:
        layer.setScaleBasedVisibility(True)
        layer.setMinimumScale(SMALL_THINGS[look])


def buildings() -> QgsFeatureRenderer:
    symbol = _fill("36,44,62,48", f"{INK},235", 0.36)
    inner = _line(f"{PAPER},130", 0.25)
    inner.setOffset(0.34)
    symbol.appendSymbolLayer(inner)
    return QgsSingleSymbolRenderer(symbol)


def walls() -> QgsFeatureRenderer:
    return _cased("122,60,32,255", 0.55, f"{PAPER},190", 1.0)


def columns() -> QgsFeatureRenderer:
    return _dot("circle", "244,240,228,255", 1.5)


def litter_bins() -> QgsFeatureRenderer:
    return _dot("square", "48,140,92,255", 1.5)


def benches() -> QgsFeatureRenderer:
    return QgsSingleSymbolRenderer(_fill("164,112,66,220", f"{INK},220", 0.2))


def stairs() -> QgsFeatureRenderer:
    return _cased(f"{INK},255", 0.24, f"{PAPER},200", 0.44)


def ramps() -> QgsFeatureRenderer:
    symbol = _fill(f"{PAPER},70", f"{INK},230", 0.3)
    symbol.appendSymbolLayer(_hatch("26,32,44,120", 90.0, 1.4, 0.16))
    arrow = QgsMarkerSymbol.createSimple(
        {"name": "arrow", "color": "244,184,40,255", "outline_color": f"{INK},255", "size": "4.2"}
    )
    arrow.symbolLayer(0).setDataDefinedProperty(
        QgsSymbolLayer.Property.PropertyAngle, QgsProperty.fromExpression('90 - "up_deg"')
    )
    symbol.appendSymbolLayer(_centred(arrow))
    return QgsSingleSymbolRenderer(symbol)


def road_centrelines() -> QgsFeatureRenderer:
    symbol = _strokes(_line("26,32,44,110", 0.6), _line("255,222,120,255", 0.28))
    symbol.symbolLayer(1).setUseCustomDashPattern(True)
    symbol.symbolLayer(1).setCustomDashVector([3.0, 2.0])
    return QgsSingleSymbolRenderer(symbol)


def road_surfaces() -> QgsFeatureRenderer:
    categories = [
        QgsRendererCategory(value, _fill(fill, edge, 0.22), label)
        for value, (label, fill, edge) in SURFACES.items()
    ]
    label, fill, edge = OTHER_SURFACE
    categories.append(QgsRendererCategory(None, _fill(fill, edge, 0.22), label))
    return QgsCategorizedSymbolRenderer("surface", categories)


def keepouts() -> QgsFeatureRenderer:
    symbol = _fill("214,40,40,40", "200,24,24,255", 0.45)
    symbol.insertSymbolLayer(1, _hatch("214,30,30,215", 45.0, 1.9, 0.4))
    return QgsSingleSymbolRenderer(symbol)


def _fill(colour: str, edge: str, width: float) -> QgsFillSymbol:
    return QgsFillSymbol.createSimple(
        {"color": colour, "outline_color": edge, "outline_width": str(width), "joinstyle": "miter"}
    )


def _line(colour: str, width: float) -> QgsSimpleLineSymbolLayer:
    red, green, blue, alpha = (int(part) for part in colour.split(","))
    return QgsSimpleLineSymbolLayer(QColor(red, green, blue, alpha), width)


def _strokes(*lines: QgsSimpleLineSymbolLayer) -> QgsLineSymbol:
    # One by one: a list given to the constructor stays Python's and is freed under QGIS.
    symbol = QgsLineSymbol()
    symbol.changeSymbolLayer(0, lines[0])
    for line in lines[1:]:
        symbol.appendSymbolLayer(line)
    return symbol


def _cased(colour: str, width: float, casing: str, casing_width: float) -> QgsFeatureRenderer:
    return QgsSingleSymbolRenderer(_strokes(_line(casing, casing_width), _line(colour, width)))


def _dot(shape: str, colour: str, size: float) -> QgsFeatureRenderer:
    """A marker in the middle of a small outline, so that it is seen at scales where the outline is not."""
    symbol = _fill(colour, f"{INK},255", 0.18)
    marker = QgsMarkerSymbol.createSimple(
        {"name": shape, "color": colour, "outline_color": f"{INK},255", "size": str(size)}
    )
    symbol.appendSymbolLayer(_centred(marker))
    return QgsSingleSymbolRenderer(symbol)


def _centred(marker: QgsMarkerSymbol) -> QgsCentroidFillSymbolLayer:
    layer = QgsCentroidFillSymbolLayer()
    layer.setSubSymbol(marker)
    return layer


def _hatch(colour: str, angle: float, distance: float, width: float) -> QgsLinePatternFillSymbolLayer:
    layer = QgsLinePatternFillSymbolLayer()
    layer.setLineAngle(angle)
    layer.setDistance(distance)
    layer.setSubSymbol(_strokes(_line(colour, width)))
    return layer


def _labels(text: str, size: float, colour: str, scale: float) -> QgsPalLayerSettings:
    format = letters(size, 0.9)
    format.setColor(QColor(*(int(part) for part in colour.split(","))))
    halo = format.buffer()
    halo.setColor(QColor(255, 255, 255, 215))
    format.setBuffer(halo)
    settings = QgsPalLayerSettings()
    settings.fieldName = text
    settings.placement = QgsPalLayerSettings.Placement.OverPoint
    settings.centroidInside = True
    settings.setFormat(format)
    settings.scaleVisibility, settings.minimumScale, settings.maximumScale = True, scale, 0
    return settings


LOOKS: dict[str, Callable[[], QgsFeatureRenderer]] = {
    look.__name__: look
    for look in (
        buildings,
        walls,
        columns,
        litter_bins,
        benches,
        stairs,
        ramps,
        road_centrelines,
        road_surfaces,
        keepouts,
    )
}
LABELS = {"buildings": ("name", 9.0, INK, 4000), "keepouts": ("name", 8.0, "160,16,16", 2500)}
"""Field, size in points, colour and the smallest scale at which a label is shown."""
SMALL_THINGS = {"columns": 2500, "litter_bins": 2500, "benches": 1500, "stairs": 4000}
