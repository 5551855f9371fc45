"""What a model hands out for its cells: numbers, also where Qt 6 has enums for them."""

from __future__ import annotations

from qgis.PyQt.QtCore import Qt


def number_of(value: object) -> int:
    """Return the number of a Qt enum's member or flags, which are numbers themselves on Qt 5."""
    return int(getattr(value, "value", value))  # type: ignore[call-overload]


TO_THE_RIGHT = number_of(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
CHECKED = number_of(Qt.CheckState.Checked)
UNCHECKED = number_of(Qt.CheckState.Unchecked)
