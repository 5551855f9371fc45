"""Layer roles: what a layer of the project is to the supervisor, kept in the layer's custom properties.

A role and its expressions travel with the project file, so that a site is prepared once and every
export, check and publication agrees on it.
"""

from __future__ import annotations

from dataclasses import dataclass

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
HEIGHT_PROPERTY = "fleet/height"
SEMANTICS_PROPERTY = "fleet/semantics"
OUTDOOR_PROPERTY = "fleet/outdoor"
WIDTH_PROPERTY = "fleet/width"


@dataclass(frozen=True)
class LayerExpressions:
    """QGIS expressions of one layer; an empty one leaves the choice to whoever exports.

    ``height`` gives metres above the ground (of one riser for stairs), ``semantics`` a label such as
    ``building,A5`` (of a road its surface, of a keepout its name), ``outdoor`` true or false, ``width`` the
    metres of a road.
    """

    height: str = ""
    semantics: str = ""
    outdoor: str = ""
    width: str = ""


@dataclass(frozen=True)
class LayerSetup:
    """What a layer is to the supervisor: a role, ``""`` for none, and its expressions."""

    role: str = ""
    expressions: LayerExpressions = LayerExpressions()


def role_of(layer) -> str:
    """Return the role of ``layer``, or ``""`` when it has none or one that is not known."""
    role = str(layer.customProperty(ROLE_PROPERTY, "") or "")
    return role if role in ROLES else ""


def set_role(layer, role: str) -> None:
    """Give ``layer`` the role ``role``; ``""`` takes it away. Raises ValueError for an unknown one."""
    if role and role not in ROLES:
        raise ValueError(f"{role!r} is not a layer role; choose one of {', '.join(ROLES)}")
    _write(layer, ROLE_PROPERTY, role)


def expressions_of(layer) -> LayerExpressions:
    """Return the expressions kept in ``layer``."""
    return LayerExpressions(
        height=str(layer.customProperty(HEIGHT_PROPERTY, "") or ""),
        semantics=str(layer.customProperty(SEMANTICS_PROPERTY, "") or ""),
        outdoor=str(layer.customProperty(OUTDOOR_PROPERTY, "") or ""),
        width=str(layer.customProperty(WIDTH_PROPERTY, "") or ""),
    )


def set_expressions(layer, expressions: LayerExpressions) -> None:
    """Keep ``expressions`` in ``layer``; an empty one is taken away."""
    _write(layer, HEIGHT_PROPERTY, expressions.height)
    _write(layer, SEMANTICS_PROPERTY, expressions.semantics)
    _write(layer, OUTDOOR_PROPERTY, expressions.outdoor)
    _write(layer, WIDTH_PROPERTY, expressions.width)


def setup_of(layer) -> LayerSetup:
    """Return the role and the expressions kept in ``layer``."""
    return LayerSetup(role_of(layer), expressions_of(layer))


def keep_setup(layer, setup: LayerSetup) -> None:
    """Keep the role and the expressions of ``setup`` in ``layer``."""
    set_role(layer, setup.role)
    set_expressions(layer, setup.expressions)


def layers_with_role(project, *roles: str) -> list:
    """Return the layers of ``project`` that carry one of ``roles``, sorted by name and id."""
    found = [layer for layer in project.mapLayers().values() if role_of(layer) in roles]
    return sorted(found, key=lambda layer: (layer.name(), layer.id()))


def _write(layer, key: str, value: str) -> None:
    if value:
        layer.setCustomProperty(key, value)
    else:
        layer.removeCustomProperty(key)
