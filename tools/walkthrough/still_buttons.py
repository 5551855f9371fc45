"""The buttons of the fleet panel and where they are: none may move while the panel stands where it was."""

from __future__ import annotations

from tools.walkthrough.window import Window

PANEL = "fleet_dock"


class StillButtons:
    """Remembers where each button of the panel was seen at first, as long as the panel keeps its place."""

    def __init__(self, window: Window):
        self._window = window
        self._panel: list[int] = []
        self._were: dict[str, list[int]] = {}

    def moved(self) -> list[str]:
        """Return in words which buttons are elsewhere than before; with another place of the panel none."""
        seen = self._window.ask("buttons", name=PANEL)
        if seen["rect"] != self._panel:
            # The whole panel was moved or sized: where its buttons are now is where they have to stay.
            self._panel, self._were = seen["rect"], {}
        moved = [
            f"the button {name} moved from {self._were[key]} to {at}"
            for key, (name, at) in seen["buttons"].items()
            if self._were.get(key, at) != at
        ]
        self._were |= {key: at for key, (_, at) in seen["buttons"].items()}
        return moved
