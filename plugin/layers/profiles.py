"""Map profiles: roles and expressions for layers of a known kind of data, read from files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from qgis.core import QgsExpression, QgsMapLayer, QgsVectorLayer, QgsWkbTypes

from ...robot_bridge.core.json_decoder import LARGEST_TOML, decode_json, toml_tables
from ..ui.errors import ProfileError
from ..ui.language import tr
from .layer_source import names_of
from .roles import EXPRESSIONS, ROLES, LayerExpressions, LayerSetup, setup_of

# --- Map profiles: what layers of a known kind of data are, so that a site of it is prepared in one go

GEOMETRIES = {
    "point": QgsWkbTypes.GeometryType.PointGeometry,
    "line": QgsWkbTypes.GeometryType.LineGeometry,
    "polygon": QgsWkbTypes.GeometryType.PolygonGeometry,
}


@dataclass(frozen=True)
class ProfileRule:
    """Layers that one of the ``names`` fits, with all of the ``fields``, are set up as ``setup`` says.

    A layer's name is the one that is shown or the one in its source. ``names`` are patterns with ``*`` and
    ``?``, whatever the case; none fit every layer. ``geometry`` is ``""`` or a key of :data:`GEOMETRIES`.
    """

    names: tuple[str, ...]
    fields: tuple[str, ...]
    geometry: str
    setup: LayerSetup

    def fits(self, layer: QgsMapLayer) -> bool:
        """Tell whether the rule is about ``layer``."""
        if not isinstance(layer, QgsVectorLayer):
            return False
        if not self._fits_name([name.lower() for name in names_of(layer)]):
            return False
        if self.geometry and layer.geometryType() != GEOMETRIES[self.geometry]:
            return False
        return all(layer.fields().lookupField(field) >= 0 for field in self.fields)

    def _fits_name(self, names: Sequence[str]) -> bool:
        patterns = [pattern.lower() for pattern in self.names]
        return not patterns or any(fnmatchcase(name, pattern) for name in names for pattern in patterns)

    def in_words(self) -> str:
        """Return what the rule looks for, such as ``walls, wall* with z_min, z_max``."""
        names, fields = ", ".join(self.names), ", ".join(self.fields)
        return tr("{names} with {fields}", names=names or "*", fields=fields) if fields else names


@dataclass(frozen=True)
class Profile:
    """Rules in the order of the file: the first that fits a layer counts."""

    name: str
    about: str
    rules: tuple[ProfileRule, ...]

    def sought(self) -> str:
        """Return which names and fields of layers the rules look for."""
        return "; ".join(rule.in_words() for rule in self.rules)

    def setup_for(self, layer: QgsMapLayer) -> LayerSetup | None:
        """Return how ``layer`` is set up, None where the profile has no rule for it."""
        return next((rule.setup for rule in self.rules if rule.fits(layer)), None)

    def setup_over(self, layer: QgsMapLayer) -> LayerSetup:
        """Return how ``layer`` is set up: by the profile, else as the layer keeps it itself."""
        return self.setup_for(layer) or setup_of(layer)


# --- Map profiles in files: TOML, or the same keys as JSON where Python reads no TOML (before 3.11) ---

PROFILES = Path(__file__).parents[2] / "resources" / "profiles"
SUFFIXES = (".toml", ".json")

_RULE_KEYS = ("names", "fields", "geometry", "role", *EXPRESSIONS)
_KEYS = ("name", "about", "layers")
_LONGEST_EXPRESSION = 10_000
"""characters."""


def shipped_profiles() -> list[Path]:
    """Return the files of the profiles that come with the plugin."""
    return sorted(PROFILES.glob("*.toml"))


def find_profile(text: str) -> Path:
    """Return the file that ``text`` names: a path, or the name of a profile that comes with the plugin."""
    named = PROFILES / f"{text}.toml"
    return named if named in shipped_profiles() else Path(text)


def read_profile(file: Path) -> Profile:
    """Return the profile in ``file``.

    :raises ProfileError: naming the file, the key, what is wrong with it and what is right.
    """
    content = _content(file)
    _refuse_unknown(content, _KEYS, "", file)
    layers = content.get("layers")
    if not isinstance(layers, list) or not layers:
        raise ProfileError(
            tr("{file}: layers is missing or empty: write one table [[layers]] or more.", file=file)
        )
    return Profile(
        name=_text(content, "name", "", file) or file.stem,
        about=_text(content, "about", "", file),
        rules=tuple(_rule(layer, f"layers[{k}]", file) for k, layer in enumerate(layers)),
    )


def _content(file: Path) -> Mapping[str, Any]:
    try:
        text = file.read_text(encoding="utf-8")
    except FileNotFoundError as error:
        shipped = ", ".join(path.stem for path in shipped_profiles())
        raise ProfileError(
            tr(
                "The profile {file} is not there: give the path of a file, or one of {shipped}.",
                file=file,
                shipped=shipped,
            )
        ) from error
    except (OSError, UnicodeDecodeError) as error:
        raise ProfileError(
            tr("The profile {file} cannot be read: {error}.", file=file, error=error)
        ) from error
    try:
        content = _json(text) if file.suffix.lower() == ".json" else _toml(text, file)
    except (ValueError, RecursionError) as error:
        kind = "JSON" if file.suffix.lower() == ".json" else "TOML"
        raise ProfileError(
            tr(
                "{file} is not valid {kind}: {error}. Correct that place.",
                file=file,
                kind=kind,
                error=error,
            )
        ) from error
    if not isinstance(content, Mapping):
        raise ProfileError(tr("{file} is no profile: write an object with name and layers.", file=file))
    return content


def _json(text: str) -> Any:
    if len(text) > LARGEST_TOML:
        raise ValueError(f"it has {len(text)} characters, more than {LARGEST_TOML}")
    return decode_json(text)


def _toml(text: str, file: Path) -> Mapping[str, Any]:
    try:
        return toml_tables(text)
    except ImportError as error:
        raise ProfileError(
            tr(
                "{file} cannot be read: this QGIS runs Python older than 3.11, which reads no TOML. Save "
                "the profile with the same keys as JSON and choose that file.",
                file=file,
            )
        ) from error


def _rule(content: Any, key: str, file: Path) -> ProfileRule:
    if not isinstance(content, Mapping):
        raise ProfileError(
            tr(
                "{file}: {key} is {content!r}: write a table [[layers]].",
                file=file,
                key=key,
                content=content,
            )
        )
    _refuse_unknown(content, _RULE_KEYS, f"{key}.", file)
    names, fields = (_texts(content, name, key, file) for name in ("names", "fields"))
    if not names and not fields:
        raise ProfileError(
            tr(
                '{file}: {key} fits no layer: write names = ["*building*"] or fields = ["building"].',
                file=file,
                key=key,
            )
        )
    geometry = _text(content, "geometry", f"{key}.", file)
    if geometry and geometry not in GEOMETRIES:
        raise ProfileError(
            tr(
                "{file}: {key}.geometry is {geometry!r}: write one of {geometries}.",
                file=file,
                key=key,
                geometry=geometry,
                geometries=", ".join(GEOMETRIES),
            )
        )
    return ProfileRule(names, fields, geometry, _setup(content, key, file))


def _setup(content: Mapping[str, Any], key: str, file: Path) -> LayerSetup:
    """Return the role that a rule gives to layers, and the expressions that go with it."""
    role = _text(content, "role", f"{key}.", file)
    if role not in ROLES:
        raise ProfileError(
            tr(
                "{file}: {key}.role is {role!r}: write one of {roles}.",
                file=file,
                key=key,
                role=role,
                roles=", ".join(ROLES),
            )
        )
    expressions = {name: _expression(content, name, key, file) for name in EXPRESSIONS}
    return LayerSetup(role, LayerExpressions(**expressions))


def _expression(content: Mapping[str, Any], name: str, key: str, file: Path) -> str:
    text = " ".join(_text(content, name, f"{key}.", file).split())
    if text and (problem := _expression_problem(text)):
        raise ProfileError(
            tr(
                "{file}: {key}.{name} is no QGIS expression: {error}. Correct it.",
                file=file,
                key=key,
                name=name,
                error=problem,
            )
        )
    return text


def _expression_problem(text: str) -> str:
    # QGIS goes down into each operator of a long sum, and crashes where there are some ten thousand.
    if len(text) > _LONGEST_EXPRESSION:
        return tr("it has {count} characters, more than {most}", count=len(text), most=_LONGEST_EXPRESSION)
    return QgsExpression(text).parserErrorString().strip()


def _text(content: Mapping[str, Any], name: str, prefix: str, file: Path) -> str:
    value = content.get(name, "")
    if not isinstance(value, str):
        raise ProfileError(
            tr(
                "{file}: {prefix}{name} is {value!r}: write text in quotes.",
                file=file,
                prefix=prefix,
                name=name,
                value=value,
            )
        )
    return value


def _texts(content: Mapping[str, Any], name: str, key: str, file: Path) -> tuple[str, ...]:
    value = content.get(name, [])
    texts = [value] if isinstance(value, str) else value
    if not isinstance(texts, list) or not all(isinstance(text, str) and text for text in texts):
        raise ProfileError(
            tr(
                '{file}: {key}.{name} is {value!r}: write a list of texts, such as ["walls"].',
                file=file,
                key=key,
                name=name,
                value=value,
            )
        )
    return tuple(texts)


def _refuse_unknown(content: Mapping[str, Any], known: tuple[str, ...], prefix: str, file: Path) -> None:
    for name in content:
        if name not in known:
            raise ProfileError(
                tr(
                    "{file}: {prefix}{name} is no key of a profile: known are {known}. Remove it or correct "
                    "its name.",
                    file=file,
                    prefix=prefix,
                    name=name,
                    known=", ".join(known),
                )
            )
