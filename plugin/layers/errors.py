"""Errors and summed-up warnings about layers and their features."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from ..ui.errors import FleetError
from ..ui.language import tr

# --- What can be wrong with layers on their way into a site; every message says what, where and what to do


class LayerReadingError(FleetError):
    """A layer cannot be read as a whole: the export stops before it writes anything."""


class SiteCrsError(LayerReadingError):
    """A CRS cannot carry a site: none, geographic, not in metres, or a Mercator such as EPSG:3857."""


class LayerCrsError(LayerReadingError):
    """A layer's coordinates have no known place in the site's CRS."""


class PublicationError(FleetError):
    """A site cannot be published: its settings, its folder or what is there already."""


class ProfileError(FleetError):
    """A map profile cannot be read: its file, one of its keys, or one of its expressions."""


class LayerTypeError(LayerReadingError):
    """A layer cannot be opened, or holds neither lines nor polygons."""


class ExpressionError(LayerReadingError):
    """An expression for height, semantics or the outdoor flag is not one."""


# --- Warnings about features, summed up: a city has thousands that differ in nothing but the feature ---

NAMED = 5
"""How many features a warning about several names."""
MOST_KINDS = 50
"""How many kinds of warnings about one layer are told one by one."""

_QUOTED = re.compile(r"'[^']*'|\"[^\"]*\"")
_NUMBER = re.compile(r"\d+(?:[.,]\d+)*(?:e[-+]?\d+)?")


@dataclass
class SomeFeatures:
    """How many features there are, and the ids of the first."""

    count: int = 0
    first: list[int] = field(default_factory=list)

    def add(self, feature: int) -> None:
        """Count the feature with this id."""
        self.count += 1
        if len(self.first) < NAMED:
            self.first.append(feature)

    def __str__(self) -> str:
        shown = ", ".join(str(number) for number in self.first)
        if self.count > len(self.first):
            return tr("features {shown} and {more} more", shown=shown, more=self.count - len(self.first))
        return tr("features {shown}", shown=shown) if self.count > 1 else tr("feature {shown}", shown=shown)


@dataclass
class _Kind:
    """Notes that differ in numbers and quoted values only; ``notes`` are those of the first features."""

    features: SomeFeatures = field(default_factory=SomeFeatures)
    notes: list[str] = field(default_factory=list)
    alike: bool = True

    def add(self, feature: int, note: str) -> None:
        self.features.add(feature)
        if len(self.notes) < NAMED:
            self.notes.append(note)
        self.alike = self.alike and note == self.notes[0]

    def texts(self, layer: str) -> list[str]:
        """Return one warning, or one a feature where they are few and differ."""
        features = self.features
        if self.alike and features.count > 1:
            return [
                tr("Layer {layer}, {features}: {note}", layer=layer, features=features, note=self.notes[0])
            ]
        if features.count <= NAMED:
            return [
                tr("Layer {layer}, feature {id}: {note}", layer=layer, id=id, note=note)
                for id, note in zip(features.first, self.notes, strict=True)
            ]
        return [
            tr(
                "Layer {layer}, {features}; of the first: {note}",
                layer=layer,
                features=features,
                note=self.notes[0],
            )
        ]


class FeatureWarnings:
    """Warnings in the order of their kinds' first ones; many features of one kind become one warning."""

    def __init__(self) -> None:
        self._told: list[str | tuple[str, _Kind]] = []
        self._kinds: dict[str, dict[str, _Kind]] = {}
        self._others: dict[str, SomeFeatures] = {}

    def add(self, layer: str, feature: int, note: str) -> None:
        """Add ``note`` about the feature with this id."""
        kinds = self._kinds.setdefault(layer, {})
        pattern = _NUMBER.sub("0", _QUOTED.sub("''", note))
        if pattern not in kinds and len(kinds) >= MOST_KINDS:
            self._others.setdefault(layer, SomeFeatures()).add(feature)
            return
        if pattern not in kinds:
            kinds[pattern] = _Kind()
            self._told.append((layer, kinds[pattern]))
        kinds[pattern].add(feature, note)

    def add_text(self, text: str) -> None:
        """Add a warning about a layer as a whole."""
        self._told.append(text)

    def texts(self) -> list[str]:
        """Return every warning."""
        told: list[str] = []
        for one in self._told:
            told += [one] if isinstance(one, str) else one[1].texts(one[0])
        return told + [
            tr("Layer {layer}: warnings of more kinds about {features}", layer=layer, features=features)
            for layer, features in self._others.items()
        ]
