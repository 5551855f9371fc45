"""Observations as an ordinary vector layer, with their images on the map and in the map tips."""

from __future__ import annotations

from typing import Any

from qgis.core import (
    QgsEditorWidgetSetup,
    QgsExpression,
    QgsMarkerSymbol,
    QgsProject,
    QgsProperty,
    QgsRasterMarkerSymbolLayer,
    QgsRuleBasedRenderer,
    QgsSymbolLayer,
    QgsUnitTypes,
    QgsVectorLayer,
)

from ....robot_bridge.messages import ObservationReport, ObservationState, SiteReport
from ...language import tr
from ..observation_book import ObservationBook
from ..row_layer import RowLayer
from ..wall_clock import date_and_time
from .thumbnails import Thumbnails

FIELDS = (
    "observation:integer,state:string,robot:string,kind:string,object:string,label:string,height:double,"
    "radius:double,received:string,reviewed_by:string,reason:string,thumbnail:string"
)
COLOURS = {"pending": "255,179,0", "accepted": "46,125,50", "rejected": "117,117,117"}
MARKS = {"pending": "diamond", "accepted": "circle", "rejected": "cross2"}
"""A shape for each state besides its colour, for those who see no colours."""
STATES = {
    ObservationState.PENDING: tr("to be reviewed"),
    ObservationState.ACCEPTED: tr("accepted"),
    ObservationState.REJECTED: tr("rejected"),
}
PICTURES_FROM = 1000
"""The scale from which on images are on the map themselves."""
MAP_TIP = """
<b>[% "object" %]</b> [% coalesce("label", '') %]<br>[% {state} %] · [% "robot" %] · [% "received" %]
[% if("thumbnail" != '', '<br><img width="220" src="file:///' || "thumbnail" || '">', '') %]
"""


class ObservationLayer:
    """The layer *Observations*, made when there is one and taken out with the plugin."""

    def __init__(self, project: QgsProject, thumbnails: Thumbnails):
        self._thumbnails = thumbnails
        self._live = RowLayer(project, "observations", tr("Observations"), "Point", FIELDS, style)

    @property
    def layer(self) -> QgsVectorLayer | None:
        """The layer, None while there is none."""
        return self._live.layer

    def show(self, book: ObservationBook, site: SiteReport | None) -> None:
        """Write every observation."""
        self._live.show([([(one.x, one.y)], self._values(one)) for one in book], site)

    def remove(self) -> None:
        """Take the layer out of the project."""
        self._live.remove()

    def _values(self, one: ObservationReport) -> list[Any]:
        return [
            one.observation,
            one.state.value,
            one.robot,
            "image" if one.media_type else "object",
            one.object,
            one.semantics or one.label or "",
            one.height,
            one.radius,
            date_and_time(one.received_at),
            one.reviewed_by or "",
            one.reason or "",
            self._thumbnails.file(one.observation),
        ]


def style(layer: QgsVectorLayer) -> None:
    """Give a layer of observations its looks: a mark for each state, images when looked at from near."""
    root = QgsRuleBasedRenderer.Rule(None)
    pictures = QgsRuleBasedRenderer.Rule(_picture(), 0, PICTURES_FROM, "\"thumbnail\" != ''", tr("image"))
    root.appendChild(pictures)
    for state, colour in COLOURS.items():
        mark = {
            "name": MARKS[state],
            "color": f"{colour},230",
            "outline_color": "33,33,33" if state != "rejected" else colour,
            "outline_width": "0.5",
            "size": "4.2",
        }
        rule = QgsRuleBasedRenderer.Rule(
            QgsMarkerSymbol.createSimple(mark),
            filterExp=f"\"state\" = '{state}'",
            label=STATES[ObservationState(state)],
        )
        root.appendChild(rule)
    layer.setRenderer(QgsRuleBasedRenderer(root))
    layer.setMapTipTemplate(MAP_TIP.replace("{state}", _state_in_words()))
    layer.setDisplayExpression(f"\"object\" || ' · ' || {_state_in_words()}")
    field = layer.fields().indexFromName("thumbnail")
    shown = {
        "DocumentViewer": 1,
        "DocumentViewerHeight": 180,
        "DocumentViewerWidth": 220,
        "FileWidget": False,
    }
    layer.setEditorWidgetSetup(field, QgsEditorWidgetSetup("ExternalResource", shown))


def _state_in_words() -> str:
    """Return the expression of what the field ``state``, the same in all languages, is to an operator."""
    words = (f"'{state.value}', {QgsExpression.quotedString(word)}" for state, word in STATES.items())
    return f'map_get(map({", ".join(words)}), "state")'


def _picture() -> QgsMarkerSymbol:
    """Return a symbol that draws the file in field ``thumbnail``, beside its place."""
    picture = QgsRasterMarkerSymbolLayer("", 16.0)
    picture.setSizeUnit(QgsUnitTypes.RenderUnit.RenderMillimeters)
    picture.setDataDefinedProperty(
        QgsSymbolLayer.Property.PropertyName, QgsProperty.fromExpression('"thumbnail"')
    )
    picture.setVerticalAnchorPoint(QgsRasterMarkerSymbolLayer.VerticalAnchorPoint.Bottom)
    symbol = QgsMarkerSymbol()
    symbol.changeSymbolLayer(0, picture)
    return symbol
