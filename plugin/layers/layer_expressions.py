"""Expressions of a layer's role, evaluated for each feature: filter, height, label, OpenStreetMap tags."""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from operator import itemgetter
from typing import Any, NamedTuple, cast

from qgis.core import (
    NULL,
    QgsExpression,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsFeature,
    QgsFeatureRequest,
    QgsField,
    QgsFields,
    QgsHstoreUtils,
    QgsVectorLayer,
)

from ...robot_bridge.core.json_decoder import DecodingError, decode_json
from ..ui.errors import ExpressionError
from ..ui.language import tr
from .roles import RAMP, LayerExpressions, expressions_of

# --- OpenStreetMap tags that a layer keeps together in one field, read as separate fields ---
# GDAL's OSM driver gives each layer a few fields and writes all other tags into ``other_tags``: as hstore
# (``"oneway"=>"yes","width"=>"6"``), from GDAL 3.7 on as JSON if requested.

TAG_FIELDS = ("other_tags", "all_tags")
"""Fields that hold several tags, by GDAL's names."""
TAG_KEYS = (
    "access", "amenity", "barrier", "bridge", "building", "building:levels", "building_levels", "direction",
    "emergency", "height", "highway", "junction", "lanes", "layer", "man_made", "maxspeed", "min_height",
    "name", "natural", "oneway", "step_count", "surface", "tunnel", "width",
)  # fmt: skip
"""Tags relevant to an obstacle or a road; they become fields where the layer has none of these names."""
LONGEST_TEXT = 100_000
"""Limit on characters of tags of one feature; no object of OpenStreetMap has a tenth of it."""


class TaggedFields:
    """The ``fields`` of a layer: its ``own_count`` own ones, then the tags in one of these."""

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

    def values(self, feature: QgsFeature) -> list[Any]:
        """Return the attributes of ``feature``, with its tags where it has no values of its own."""
        values: list[Any] = feature.attributes()
        if not self._sources:
            return values
        tags: dict[str, str] = {}
        for source in self._sources:
            tags.update(read_tags(values[source]))
        values += [None] * (self.fields.count() - len(values))
        for key, at in self._places.items():
            if values[at] is None or values[at] == NULL:
                values[at] = tags.get(key)
        return values

    def feature(self, feature: QgsFeature, values: list[Any] | None = None) -> QgsFeature:
        """Return ``feature`` with ``values``, or those of :meth:`values`, as its attributes.

        The feature itself where the layer has no tags.
        """
        if not self._sources:
            return feature
        tagged = QgsFeature(self.fields, feature.id())
        tagged.setAttributes(self.values(feature) if values is None else values)
        tagged.setGeometry(feature.geometry())
        return tagged


def read_tags(value: Any) -> dict[str, str]:
    """Return the tags in one attribute, hstore or JSON; none where it is neither.

    QGIS parses JSON itself where the field's type says that it is JSON.
    """
    if isinstance(value, dict):
        return _texts(value)
    if not isinstance(value, str) or len(value) > LONGEST_TEXT:
        return {}
    text = value.strip()
    if not text.startswith("{"):
        return dict(QgsHstoreUtils.parse(text))
    try:
        tags = decode_json(text)
    except DecodingError:
        return {}
    return _texts(tags)


def _texts(tags: Mapping[str, Any]) -> dict[str, str]:
    return {key: str(tag) for key, tag in tags.items() if isinstance(tag, (str, int, float))}


# --- The expressions of one layer, checked once and evaluated for each feature ---

_PLAIN = (float, str, int)
_FLAGS = {"1": True, "true": True, "yes": True, "0": False, "false": False, "no": False}
DEFAULT_IS_USED = tr("the default is used")
_METRES = re.compile(r"\s*([+-]?\d+(?:[.,]\d+)?)\s*m?\s*", re.ASCII)
_NUMBER = r"(\d+(?:[.,]\d+)?)"
_FEET = re.compile(rf"""\s*(?:{_NUMBER}\s*(?:'|ft|feet))?\s*(?:{_NUMBER}\s*(?:"|''|in))?\s*""", re.ASCII)
FOOT_M, INCH_M = 0.3048, 0.0254


_PURE = frozenset(
    (
        "abs", "ceil", "coalesce", "concat", "floor", "if", "left", "length", "lower", "max", "min", "nullif",
        "regexp_match", "regexp_replace", "regexp_substr", "replace", "right", "round", "sqrt", "strpos",
        "substr", "title", "to_int", "to_real", "to_string", "trim", "upper",
    )
)  # fmt: skip
"""Pure functions: equal arguments always give equal results."""
_MOST_KNOWN = 10_000
"""Values kept in one cache: a city repeats few different values many times."""
UNKNOWN = object()


class Memory:
    """Cache of the results of ``rules`` together, by the values of the fields that they read.

    Disabled where one of them reads more than fields.
    """

    def __init__(self, rules: Iterable[Rule | None]) -> None:
        some = [rule for rule in rules if rule is not None]
        places = sorted({place for rule in some for place in rule.places})
        self.is_used = bool(places) and all(rule.is_pure for rule in some)
        """Whether the cache is enabled."""
        self._chosen = itemgetter(*places) if self.is_used else None
        self._is_single = len(places) == 1
        self._known: dict[Any, Any] = {}

    def known(self, attributes: list[Any]) -> tuple[Any, Any]:
        """Return the cached result for ``attributes``, :data:`UNKNOWN` if none, and the key for it."""
        if self._chosen is None:
            return UNKNOWN, None
        try:
            chosen = self._chosen(attributes)
            # 1, 1.0 and true are equal, but as text they are not.
            key = (chosen, type(chosen)) if self._is_single else (chosen, *map(type, chosen))
            return self._known.get(key, UNKNOWN), key
        except (IndexError, TypeError):
            # Fewer values than fields, or unhashable lists.
            return UNKNOWN, None

    def keep(self, key: Any, value: Any) -> None:
        """Store ``value``; not by a key with a zero, which may be a negative zero in text."""
        if key is None or 0 in (key[:1] if self._is_single else key[0]):
            return
        if len(self._known) >= _MOST_KNOWN:
            self._known.clear()
        self._known[key] = value


class Rule:
    """A prepared ``expression`` that reads ``fields``.

    Where it reads nothing but fields, its results are cached by their values: evaluating one takes
    longer than all else that is done for most features.
    """

    def __init__(self, expression: QgsExpression, fields: QgsFields) -> None:
        self.expression = expression
        columns = expression.referencedColumns()
        self.places = sorted(fields.lookupField(name) for name in columns)
        """Indices of the fields that it reads."""
        self.is_pure = (
            bool(columns)
            and QgsFeatureRequest.ALL_ATTRIBUTES not in columns
            and min(self.places) >= 0
            and not expression.needsGeometry()
            and not expression.referencedVariables()
            and expression.referencedFunctions() <= _PURE
        )
        """Whether it depends on fields alone."""
        self._memory = Memory([self])
        self._field = self.places[0] if self.is_pure and expression.isField() else None

    def known(self, attributes: list[Any]) -> tuple[Any, Any]:
        """Return the cached result for ``attributes``, :data:`UNKNOWN` if none, and the key for it.

        The field's own value where the expression is only its name.
        """
        if self._field is None:
            return self._memory.known(attributes)
        try:
            value = attributes[self._field]
        except IndexError:
            return UNKNOWN, None
        return (value, None) if isinstance(value, _PLAIN) else (UNKNOWN, None)

    def keep(self, key: Any, value: Any) -> None:
        """Store ``value`` by ``key``, which :meth:`known` returned."""
        self._memory.keep(key, value)


class LayerRules:
    """Prepares and evaluates the expressions of ``layer``; ``warnings`` are about the layer as a whole."""

    def __init__(self, layer: str, fields: QgsFields, context: QgsExpressionContext):
        self._layer = layer
        self._tagged = TaggedFields(fields)
        self._fields = self._tagged.fields
        self._context = QgsExpressionContext(context)
        self._context.setFields(self._fields)
        self._feature, self._is_set = QgsFeature(), True
        self._values: list[Any] | None = None
        self.warnings: list[str] = []

    def rule(self, what: str, text: str) -> Rule | None:
        """Return the prepared expression, None for an empty one or one that reads fields the layer lacks.

        :raises ExpressionError: when ``text`` is not an expression.
        """
        if not text.strip():
            return None
        expression = self._parsed(what, text)
        missing = self._missing(expression)
        if missing:
            self.warnings.append(
                tr(
                    "Layer {layer}: it has no field {missing}, which the {what} expression {text!r} reads; "
                    "the default is used for all its features",
                    layer=self._layer,
                    missing=missing,
                    what=what,
                    text=text,
                )
            )
            return None
        expression.prepare(self._context)
        return Rule(expression, self._fields)

    def needed_rule(self, what: str, text: str) -> Rule | None:
        """Return the prepared expression, None for an empty one.

        :raises ExpressionError: when ``text`` is not an expression, or reads fields that the layer lacks.
        """
        if not text.strip():
            return None
        expression = self._parsed(what, text)
        missing = self._missing(expression)
        if missing:
            raise ExpressionError(
                tr(
                    "The {what} expression {text!r} for the layer {layer} reads the field {missing}, which "
                    "the layer does not have. Correct it, or write attribute('...') for a field that some "
                    "layers lack.",
                    what=what,
                    text=text,
                    layer=self._layer,
                    missing=missing,
                )
            )
        expression.prepare(self._context)
        return Rule(expression, self._fields)

    def at(self, feature: QgsFeature) -> None:
        """Set ``feature`` as the one that :meth:`value` evaluates."""
        self._feature, self._values, self._is_set = feature, None, False

    def value(
        self,
        what: str,
        rule: Rule | None,
        notes: list[str],
        otherwise: str = DEFAULT_IS_USED,
    ) -> Any:
        """Return the result of ``rule`` for the feature, None for no value; a failure becomes a note."""
        if rule is None:
            return None
        key = None
        if rule.is_pure:
            known, key = rule.known(self._attributes())
            if known is not UNKNOWN:
                return known
        if not self._is_set:
            self._context.setFeature(self._tagged.feature(self._feature, self._values))
            self._is_set = True
        value = rule.expression.evaluate(self._context)
        if rule.expression.hasEvalError():
            notes.append(
                tr(
                    "the {what} expression fails: {error}; {otherwise}",
                    what=what,
                    error=rule.expression.evalErrorString(),
                    otherwise=otherwise,
                )
            )
            return None
        # Numbers and texts first: comparing them with NULL takes longer than evaluating most expressions.
        value = None if value is None or (not isinstance(value, _PLAIN) and value == NULL) else value
        rule.keep(key, value)
        return value

    def known(self, memory: Memory) -> tuple[Any, Any]:
        """Return the result cached in ``memory`` for the feature, :data:`UNKNOWN` if none, and its key."""
        return memory.known(self._attributes()) if memory.is_used else (UNKNOWN, None)

    def metres(self, what: str, rule: Rule | None, notes: list[str]) -> float | None:
        """Return the result of ``rule`` for the feature in metres above 0, None where there is none.

        An invalid number becomes a note.
        """
        value = self.value(what, rule, notes)
        if value is None or value == "":
            return None
        metres = as_metres(value)
        if metres is None or metres <= 0:
            notes.append(
                tr(
                    "its {what} {value!r} is not a number of metres above 0; the default is used",
                    what=what,
                    value=value,
                )
            )
            return None
        return metres

    def column(self, *names: str) -> str:
        """Return the expression that reads the first existing field of ``names``, empty if none exists.

        Fields of the layer take precedence over tags in one of its fields.
        """
        return self.own_column(*names) or self._column(names)

    def own_column(self, *names: str) -> str:
        """Return as :meth:`column`, without the tags."""
        return self._column(names, self._tagged.own_count)

    def warn_of_layer(self, note: str) -> None:
        """Add a warning about the layer as a whole."""
        self.warnings.append(tr("Layer {layer}: {note}", layer=self._layer, note=note))

    def _attributes(self) -> list[Any]:
        if self._values is None:
            self._values = self._tagged.values(self._feature)
        return self._values

    def _column(self, names: Sequence[str], count: int | None = None) -> str:
        for name in names:
            index = self._fields.lookupField(name)
            if index >= 0 and (count is None or index < count):
                return QgsExpression.quotedColumnRef(self._fields.at(index).name())
        return ""

    def _parsed(self, what: str, text: str) -> QgsExpression:
        expression = QgsExpression(text)
        if expression.hasParserError():
            raise ExpressionError(
                tr(
                    "The {what} expression {text!r} for the layer {layer} is not one: {error}. Correct it.",
                    what=what,
                    text=text,
                    layer=self._layer,
                    error=expression.parserErrorString().strip(),
                )
            )
        return expression

    def _missing(self, expression: QgsExpression) -> str:
        """Return the fields that ``expression`` reads and the layer lacks, empty where there are none."""
        names = {name.lower() for name in self._fields.names()}
        columns = expression.referencedColumns() - {QgsFeatureRequest.ALL_ATTRIBUTES}
        return ", ".join(sorted(name for name in columns if name.lower() not in names))


def as_flag(value: Any) -> bool | None:
    """Return ``value`` as a truth value, also from text such as ``yes``; None where it is neither."""
    return _FLAGS.get(str(value).strip().lower())


def as_metres(value: Any) -> float | None:
    """Return a number of metres, also from text such as ``12,5 m``, ``25'8"`` and ``30 ft``."""
    if isinstance(value, str):
        match = _METRES.fullmatch(value)
        return _number(match[1]) if match else _from_feet(value)
    try:
        number = float(value)
    except (TypeError, ValueError):
        return None
    return number if math.isfinite(number) else None


def _from_feet(text: str) -> float | None:
    match = _FEET.fullmatch(text)
    if match is None or (match[1] is None and match[2] is None):
        return None
    return _number(match[1] or "0") * FOOT_M + _number(match[2] or "0") * INCH_M


def _number(text: str) -> float:
    return float(text.replace(",", "."))


# --- The features of a layer that count: those for which its filter is true ---


class FeatureFilter:
    """The filter ``text`` of the layer called ``layer``; an empty one keeps every feature.

    :raises ExpressionError: when ``text`` is not an expression, or reads fields that the layer lacks.
    """

    def __init__(self, layer: str, fields: QgsFields, text: str, context: QgsExpressionContext):
        self._rules = LayerRules(layer, fields, context)
        self._rule = self._rules.needed_rule("filter", text)

    @classmethod
    def of_layer(cls, layer: QgsVectorLayer, context: QgsExpressionContext) -> FeatureFilter:
        """Return the filter stored in ``layer``; ``context`` is available to it besides the layer."""
        scoped = QgsExpressionContext(context)
        scoped.appendScope(QgsExpressionContextUtils.layerScope(layer))
        return cls(layer.name(), layer.fields(), expressions_of(layer).filter, scoped)

    def keeps(self, feature: QgsFeature, notes: list[str]) -> bool:
        """Return whether ``feature`` counts; one for which the filter fails does not, with a note."""
        if self._rule is None:
            return True
        self._rules.at(feature)
        value = self._rules.value("filter", self._rule, notes, otherwise=tr("it is left out"))
        if value is None:
            return False
        flag = as_flag(value)
        if flag is None:
            notes.append(
                tr("its filter gives {value!r}, which is neither true nor false; it is left out", value=value)
            )
        return flag is True


# --- Height, foot, label and outdoor flag of each feature, by expression ---

HEIGHT_FIELDS = ("height", "height_m")
"""Fields with a height in metres, used where no expression is given."""


UNREADABLE = "\ufffd"
"""In place of bytes that are no text in the encoding of a layer."""


class ObstacleValues(NamedTuple):
    """The values of one feature in a robot map.

    ``height`` is ``estimated`` where it is not given, and ``unknown`` where only the default is left.
    ``base`` is the metres above the ground at which it begins; ``height`` counts from there.
    """

    height: float
    estimated: bool
    unknown: bool
    base: float
    semantics: str
    outdoor: bool
    notes: Sequence[str]


class FeatureValues:
    """Evaluates the expressions of one layer of obstacles. Ramps have no height (paper 1, section II).

    :raises ExpressionError: when one of the expressions is invalid.
    """

    def __init__(
        self,
        layer: str,
        role: str,
        expressions: LayerExpressions,
        default_height: float,
        rules: LayerRules,
    ):
        self._layer = layer
        self._is_ramp = role == RAMP
        self._default_height = default_height
        self._rules = rules
        self._height = rules.rule("height", expressions.height or rules.column(*HEIGHT_FIELDS))
        self._estimate = rules.rule("estimate", expressions.estimate)
        self._semantics = rules.rule("semantics", expressions.semantics)
        self._outdoor = rules.rule("outdoor", expressions.outdoor)
        self._base = rules.rule("base", expressions.base)
        # Once: translating a text takes longer than evaluating most expressions.
        self._default_is_used = tr("the default is used")
        self._memory = Memory([self._height, self._estimate, self._semantics, self._outdoor, self._base])
        self._no_height = tr("the estimate is used") if self._estimate is not None else self._default_is_used

    def of(self, feature: QgsFeature) -> ObstacleValues:
        """Return the values of ``feature``; missing or unreadable ones get the default and a note."""
        self._rules.at(feature)
        values, key = self._rules.known(self._memory)
        if values is UNKNOWN:
            values = self._evaluated()
            self._memory.keep(key, values)
        return cast(ObstacleValues, values)

    def _evaluated(self) -> ObstacleValues:
        notes: list[str] = []
        height = 0.0 if self._is_ramp else self._height_of("height", self._height, notes)
        estimate = self._height_of("estimate", self._estimate, notes) if height is None else None
        known = estimate if height is None else height
        return ObstacleValues(
            height=self._default_height if known is None else known,
            estimated=height is None,
            unknown=known is None,
            base=self._base_of(notes),
            semantics=self._semantics_of(notes),
            outdoor=self._outdoor_of(notes),
            notes=tuple(notes),
        )

    def _height_of(self, what: str, rule: Rule | None, notes: list[str]) -> float | None:
        otherwise = self._no_height if rule is self._height else self._default_is_used
        value = self._rules.value(what, rule, notes, otherwise=otherwise)
        if value is None or value == "":
            return None
        height = as_metres(value)
        if height is None or height < 0:
            notes.append(
                tr(
                    "its {what} {value!r} is not a number of metres of 0 or more; {otherwise}",
                    what=what,
                    value=value,
                    otherwise=otherwise,
                )
            )
            return None
        return height

    def _base_of(self, notes: list[str]) -> float:
        value = self._rules.value("base", self._base, notes)
        if value is None or value == "":
            return 0.0
        metres = as_metres(value)
        if metres is None:
            notes.append(
                tr(
                    "its base {value!r} is not a number of metres; it is taken to stand on the ground",
                    value=value,
                )
            )
            return 0.0
        return metres

    def _semantics_of(self, notes: list[str]) -> str:
        value = self._rules.value("semantics", self._semantics, notes)
        if value is not None and UNREADABLE in str(value):
            notes.append(
                tr(
                    "its label has letters that cannot be read: set the layer's encoding (Properties > "
                    "Source), or put a .cpg file beside its shapefile"
                )
            )
        # A city has few different labels; equal ones share one object.
        return self._layer if value is None else sys.intern(str(value))

    def _outdoor_of(self, notes: list[str]) -> bool:
        value = self._rules.value("outdoor", self._outdoor, notes)
        if value is None:
            return True
        flag = as_flag(value)
        if flag is None:
            notes.append(
                tr("its outdoor flag {value!r} is neither true nor false; true is used", value=value)
            )
        return flag is not False
