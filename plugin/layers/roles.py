"""Layer roles: what a layer of the project is to the supervisor, kept in the layer's custom properties.

A role and its expressions travel with the project file, so that a site is prepared once and every
export, check and publication agrees on it.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

from qgis.core import QgsMapLayer, QgsProject

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
    """QGIS expressions of one layer; an empty one leaves the choice to whoever exports.

    ``height`` gives metres from the foot up (of one riser for stairs), ``estimate`` what they are taken for
    where ``height`` says nothing, such as three for each storey; ``semantics`` a label such as
    ``building,A5`` (of a road its surface, of a keepout its name), ``outdoor`` true or false, ``width`` the
    metres of a road or across a point of furniture, ``base`` the metres above the ground where a thing
    begins. ``filter`` is true of the features that count. ``template`` names the shape that a point of
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
"""The names of all expressions; each is kept in the custom property ``fleet/`` and its name."""


@dataclass(frozen=True)
class LayerSetup:
    """What a layer is to the supervisor: a role, ``""`` for none, and its expressions."""

    role: str = ""
    expressions: LayerExpressions = LayerExpressions()


def role_of(layer: QgsMapLayer) -> str:
    """Return the role of ``layer``, or ``""`` when it has none or one that is not known."""
    role = str(layer.customProperty(ROLE_PROPERTY, "") or "")
    return role if role in ROLES else ""


def set_role(layer: QgsMapLayer, role: str) -> None:
    """Give ``layer`` the role ``role``; ``""`` takes it away. Raises ValueError for an unknown one."""
    if role and role not in ROLES:
        raise ValueError(f"{role!r} is not a layer role; choose one of {', '.join(ROLES)}")
    _write(layer, ROLE_PROPERTY, role)


def expressions_of(layer: QgsMapLayer) -> LayerExpressions:
    """Return the expressions kept in ``layer``."""
    return LayerExpressions(
        **{name: str(layer.customProperty(f"fleet/{name}", "") or "") for name in EXPRESSIONS}
    )


def set_expressions(layer: QgsMapLayer, expressions: LayerExpressions) -> None:
    """Keep ``expressions`` in ``layer``; an empty one is taken away."""
    for name in EXPRESSIONS:
        _write(layer, f"fleet/{name}", getattr(expressions, name))


def setup_of(layer: QgsMapLayer) -> LayerSetup:
    """Return the role and the expressions kept in ``layer``."""
    return LayerSetup(role_of(layer), expressions_of(layer))


def keep_setup(layer: QgsMapLayer, setup: LayerSetup) -> None:
    """Keep the role and the expressions of ``setup`` in ``layer``."""
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
