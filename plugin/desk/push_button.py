"""A button with all that it needs from its beginning."""

from __future__ import annotations

from collections.abc import Callable

from qgis.PyQt.QtWidgets import QPushButton


def push_button(
    name: str, text: str, tip: str = "", pressed: Callable[[], object] | None = None
) -> QPushButton:
    """Return a button that is found by ``name``, shows ``text`` and ``tip`` and calls ``pressed``."""
    button = QPushButton(text)
    button.setObjectName(name)
    button.setToolTip(tip)
    if pressed is not None:
        # The signal says whether the button is checked, which nobody asks.
        button.clicked.connect(lambda _=False: pressed())
    return button
