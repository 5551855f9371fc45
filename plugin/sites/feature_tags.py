"""OpenStreetMap tags that a layer keeps together in one field, read as fields of their own.

GDAL's OSM driver gives each layer a few fields and writes all other tags into ``other_tags``: as hstore
(``"oneway"=>"yes","width"=>"6"``), from GDAL 3.7 on as JSON where that was asked for.
"""

from __future__ import annotations

from typing import Any

from qgis.core import NULL, QgsFeature, QgsField, QgsFields, QgsHstoreUtils

from ...robot_bridge.core.decoding import DecodingError, decode_json

TAG_FIELDS = ("other_tags", "all_tags")
"""Fields that hold several tags, as GDAL calls them."""
TAG_KEYS = (
    "access", "amenity", "barrier", "bridge", "building", "building:levels", "building_levels", "direction",
    "emergency", "height", "highway", "junction", "lanes", "layer", "man_made", "maxspeed", "min_height",
    "name", "natural", "oneway", "step_count", "surface", "tunnel", "width",
)  # fmt: skip
"""Tags that say something of an obstacle or a road; they become fields where the layer has none of them."""
LONGEST_TEXT = 100_000
"""Characters of tags of one feature; no object of OpenStreetMap has a tenth of it."""


class TaggedFields:
    """The ``fields`` of a layer: its ``own_count`` own ones, behind them the tags that one of these holds."""

    def __init__(self, fields: QgsFields) -> None:
        self.fields = QgsFields(fields)
        self.own_count = fields.count()
        self._sources = [at for name in TAG_FIELDS if (at := fields.lookupField(name)) >= 0]
        self._places: dict[str, int] = {}
        for key in TAG_KEYS if self._sources else ():
            own = fields.lookupField(key)
            self._places[key] = self.fields.count() if own < 0 else own
            if own < 0:
                # Of the tags' own type, text: types of fields have other names on Qt 6.
                field = QgsField(fields.at(self._sources[0]))
                field.setName(key)
                self.fields.append(field)

    def feature(self, feature: QgsFeature) -> QgsFeature:
        """Return ``feature`` with its tags as attributes, where it has no values of its own.

        The feature itself where the layer has no tags.
        """
        if not self._sources:
            return feature
        values = feature.attributes()
        tags: dict[str, str] = {}
        for source in self._sources:
            tags.update(read_tags(values[source]))
        values += [None] * (self.fields.count() - len(values))
        for key, at in self._places.items():
            if values[at] is None or values[at] == NULL:
                values[at] = tags.get(key)
        tagged = QgsFeature(self.fields, feature.id())
        tagged.setAttributes(values)
        tagged.setGeometry(feature.geometry())
        return tagged


def read_tags(value: Any) -> dict[str, str]:
    """Return the tags in one attribute, hstore or JSON; none where it is neither."""
    if not isinstance(value, str) or len(value) > LONGEST_TEXT:
        return {}
    text = value.strip()
    if not text.startswith("{"):
        return dict(QgsHstoreUtils.parse(text))
    try:
        tags = decode_json(text)
    except DecodingError:
        return {}
    return {key: str(tag) for key, tag in tags.items() if isinstance(tag, (str, int, float))}
