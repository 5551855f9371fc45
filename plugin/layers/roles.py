"""Layer roles: the use of a project's layer for robots, stored in the layer or given by a map profile.

A role and its expressions are stored in the project file, so that a site is prepared once and every
export, check and publication agrees on it. A profile gives by names and fields the roles of layers of a known
kind of data.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from qgis.core import QgsExpression, QgsMapLayer, QgsProject, QgsProviderRegistry, QgsVectorLayer, QgsWkbTypes

from ...robot_bridge.core.json_decoder import LARGEST_TOML, decode_json, toml_tables
from ..ui.errors import ProfileError
from ..ui.language import tr

# --- Settings stored in a layer's custom properties ---

OBSTACLE = "obstacle"
STAIRS = "stairs"
RAMP = "ramp"
FURNITURE = "furniture"
ROAD_CENTRELINE = "road_centreline"
ROAD_SURFACE = "road_surface"
KEEPOUT = "keepout"
ORTHOPHOTO = "orthophoto"

ROLES = (OBSTACLE, STAIRS, RAMP, FURNITURE, ROAD_CENTRELINE, ROAD_SURFACE, KEEPOUT, ORTHOPHOTO)
OBSTACLE_ROLES = (OBSTACLE, STAIRS, RAMP, FURNITURE)
ROAD_AND_AREA_ROLES = (ROAD_CENTRELINE, ROAD_SURFACE, KEEPOUT)
PUBLISHED_ROLES = (*OBSTACLE_ROLES, *ROAD_AND_AREA_ROLES)

ROLE_PROPERTY = "fleet/role"


@dataclass(frozen=True)
class LayerExpressions:
    """QGIS expressions of one layer; an empty one leaves the choice to the user who exports.

    ``height`` gives metres from the foot up (of one riser for stairs), ``estimate`` the metres assumed
    where ``height`` gives none, such as three for each storey; ``semantics`` a label such as
    ``building,A5`` (of a road its surface, of a keepout its name), ``outdoor`` true or false, ``width`` the
    metres of a road or across a point of furniture, ``base`` the metres above the ground where an object
    begins. ``filter`` is true for the features that count. ``template`` names the shape that a point of
    furniture stands for, ``rotation`` the degrees that it is turned clockwise.
    """

    height: str = ""
    semantics: str = ""
    outdoor: str = ""
    width: str = ""
    estimate: str = ""
    base: str = ""
    filter: str = ""
    template: str = ""
    rotation: str = ""


EXPRESSIONS = tuple(field.name for field in fields(LayerExpressions))
"""The names of all expressions; each is stored in the custom property ``fleet/`` and its name."""


@dataclass(frozen=True)
class LayerSetup:
    """The setup of a layer: a role, ``""`` for none, and its expressions."""

    role: str = ""
    expressions: LayerExpressions = LayerExpressions()


def role_of(layer: QgsMapLayer) -> str:
    """Return the role of ``layer``, or ``""`` when it has none or an unknown one."""
    role = str(layer.customProperty(ROLE_PROPERTY, "") or "")
    return role if role in ROLES else ""


def set_role(layer: QgsMapLayer, role: str) -> None:
    """Set the role of ``layer``; ``""`` removes it. Raises ValueError for an unknown one."""
    if role and role not in ROLES:
        raise ValueError(f"{role!r} is not a layer role; choose one of {', '.join(ROLES)}")
    _write(layer, ROLE_PROPERTY, role)


def expressions_of(layer: QgsMapLayer) -> LayerExpressions:
    """Return the expressions stored in ``layer``."""
    return LayerExpressions(
        **{name: str(layer.customProperty(f"fleet/{name}", "") or "") for name in EXPRESSIONS}
    )


def set_expressions(layer: QgsMapLayer, expressions: LayerExpressions) -> None:
    """Store ``expressions`` in ``layer``; an empty one is removed."""
    for name in EXPRESSIONS:
        _write(layer, f"fleet/{name}", getattr(expressions, name))


def setup_of(layer: QgsMapLayer) -> LayerSetup:
    """Return the role and the expressions stored in ``layer``."""
    return LayerSetup(role_of(layer), expressions_of(layer))


def keep_setup(layer: QgsMapLayer, setup: LayerSetup) -> None:
    """Store the role and the expressions of ``setup`` in ``layer``."""
    set_role(layer, setup.role)
    set_expressions(layer, setup.expressions)


def layers_with_role(project: QgsProject, *roles: str) -> list:
    """Return the layers of ``project`` that carry one of ``roles``, sorted by name and id."""
    found = [layer for layer in project.mapLayers().values() if role_of(layer) in roles]
    return sorted(found, key=lambda layer: (layer.name(), layer.id()))


def _write(layer: QgsMapLayer, key: str, value: str) -> None:
    if value:
        layer.setCustomProperty(key, value)
    else:
        layer.removeCustomProperty(key)


# --- The names of a layer ---


def plain_name(layer: QgsVectorLayer) -> str:
    """Return the layer's name; the one inside its file where it is only named after the file.

    qgis_process names layers like ``campus.gpkg|layername=walls`` so: all layers of a file alike.
    """
    inside, path = _source_of(layer)
    called_as_file = bool(inside and path) and layer.name() == Path(path).stem
    return inside if called_as_file else layer.name()


def names_of(layer: QgsVectorLayer) -> list[str]:
    """Return the names of the layer: the one that is shown, and the one in its file or database.

    QGIS's browser shows ``campus — walls`` for the layer ``walls`` of ``campus.gpkg``. A file of one layer
    may have no name for it: then it is the file's.
    """
    inside, path = _source_of(layer)
    return list(dict.fromkeys(name for name in (plain_name(layer), inside or Path(path).stem) if name))


def _source_of(layer: QgsVectorLayer) -> tuple[str, str]:
    """Return the layer's name in its source, and the source's path; each empty where there is none."""
    parts = QgsProviderRegistry.instance().decodeUri(layer.providerType(), layer.source())
    # In a database the name of the table is the layer's.
    inside = parts.get("layerName") or parts.get("table") or ""
    return str(inside), str(parts.get("path") or "")


# --- Map profiles: setups for layers of a known kind of data, so that a site of it is prepared at once

GEOMETRIES = {
    "point": QgsWkbTypes.GeometryType.PointGeometry,
    "line": QgsWkbTypes.GeometryType.LineGeometry,
    "polygon": QgsWkbTypes.GeometryType.PolygonGeometry,
}


@dataclass(frozen=True)
class ProfileRule:
    """Layers that match one of the ``names``, with all of the ``fields``, get the setup ``setup``.

    A layer's name is the one that is shown or the one in its source. ``names`` are patterns with ``*`` and
    ``?``, ignoring case; an empty list matches every layer. ``geometry`` is ``""`` or a key of
    :data:`GEOMETRIES`.
    """

    names: tuple[str, ...]
    fields: tuple[str, ...]
    geometry: str
    setup: LayerSetup

    def fits(self, layer: QgsMapLayer) -> bool:
        """Return whether the rule applies to ``layer``."""
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
        """Return the rule's condition as text, such as ``walls, wall* with z_min, z_max``."""
        names, fields = ", ".join(self.names), ", ".join(self.fields)
        return tr("{names} with {fields}", names=names or "*", fields=fields) if fields else names


@dataclass(frozen=True)
class Profile:
    """Rules in the order of the file: the first that fits a layer counts."""

    name: str
    about: str
    rules: tuple[ProfileRule, ...]

    def sought(self) -> str:
        """Return the names and fields of layers that the rules match."""
        return "; ".join(rule.in_words() for rule in self.rules)

    def setup_for(self, layer: QgsMapLayer) -> LayerSetup | None:
        """Return the setup of ``layer``, None where the profile has no rule for it."""
        return next((rule.setup for rule in self.rules if rule.fits(layer)), None)

    def setup_over(self, layer: QgsMapLayer) -> LayerSetup:
        """Return the setup of ``layer``: from the profile, else as stored in the layer."""
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
    """Return the file for ``text``: a path, or the name of a profile that comes with the plugin."""
    named = PROFILES / f"{text}.toml"
    return named if named in shipped_profiles() else Path(text)


def read_profile(file: Path) -> Profile:
    """Return the profile in ``file``.

    :raises ProfileError: naming the file, the key, the error and the valid form.
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
    """Return the role and the expressions that a rule gives to layers."""
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
    # QGIS recurses into each operator of a long sum, and crashes where there are some ten thousand.
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
