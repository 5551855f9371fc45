"""The colour of each robot of a layer, as an expression of its field ``robot``."""

from __future__ import annotations

# Hues by the golden angle: neighbours in the order of names are far apart.
ROBOT_COLOUR = (
    'color_hsl((array_find(array_distinct(array_agg("robot", order_by:="robot")), "robot") * 137 + 210)'
    " % 360, 75, 42)"
)
