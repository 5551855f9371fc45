"""Map profiles in files: TOML, or the same keys as JSON where Python reads no TOML (before 3.11)."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from qgis.core import QgsExpression

from ...robot_bridge.core.decoding import decode_json
from ...robot_bridge.sites.toml_reading import LARGEST, toml_tables
from ..language import tr
from .errors import ProfileError
from .profile import GEOMETRIES, Profile, ProfileRule
from .roles import EXPRESSIONS, ROLES, LayerExpressions, LayerSetup

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
    if len(text) > LARGEST:
        raise ValueError(f"it has {len(text)} characters, more than {LARGEST}")
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
