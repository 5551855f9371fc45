"""An operator at the screen: finds what to click, clicks it, and looks until something has happened."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from robot_bridge.core.sites.frame import SiteFrame
from tests.support.errors import StageError
from tools.walkthrough.screen import WHEEL_DOWN, Pixel, Screen
from tools.walkthrough.window import Window

POLL_S, SELDOM_S = 0.05, 0.2
"""Seconds between two looks: for a second, and after that."""
PATIENCE_S = 60.0
"""How long anything may take: other work may share the computer."""

EDGE = 4
"""Pixels by which the edge of a panel may be missed."""
HEAD_TICK = (28, 10)
"""Where the tick of a group is that can be folded, from its corner; pixels."""
ROW = 12
"""Pixels of the height of a row that have to be seen to click it."""

Place = tuple[float, float]
"""Metres in the site frame."""


class OperatorAtScreen:
    """Knows the window by what it shows, and changes it by mouse and keyboard only."""

    def __init__(self, screen: Screen, window: Window, frame: SiteFrame):
        self._screen, self._window, self.frame = screen, window, frame

    # --- looking ---

    def wait(self, what: str, condition: Callable[[], Any], seconds: float = PATIENCE_S) -> Any:
        """Look until ``condition`` returns something that holds, and return that.

        :raises StageError: when it does not hold within ``seconds``.
        """
        began = time.monotonic()
        while not (found := condition()):
            waited = time.monotonic() - began
            if waited > seconds:
                raise StageError(f"{what} did not happen within {seconds:.0f} s; {self.desk()}")
            time.sleep(POLL_S if waited < 1.0 else SELDOM_S)
        return found

    def desk(self) -> dict[str, Any]:
        """Return what the fleet panel shows."""
        return dict(self._window.ask("desk"))

    def widget(self, name: str) -> dict[str, Any]:
        """Return how a widget stands, by its object name."""
        return dict(self._window.ask("widget", name=name))

    def text(self, name: str) -> str:
        """Return what a widget says, nothing while it is not to be seen."""
        return str(self.widget(name).get("text", ""))

    def tip(self, name: str) -> str:
        """Return what a widget says to who holds the mouse over it."""
        return str(self.widget(name).get("tip", ""))

    def state_of(self, robot: str) -> str:
        """Return the state that the log shows for the newest command of ``robot``."""
        rows = self.desk()["commands"]
        return next((row["state"] for row in rows if row["what"].startswith(f"{robot} ")), "")

    def wait_for_state(self, robot: str, state: str, seconds: float = PATIENCE_S) -> None:
        """Look at the log until the newest command of ``robot`` has come to ``state``."""
        self.wait(f"{state} in the log for {robot}", lambda: self.state_of(robot) == state, seconds)

    def wait_for_text(self, name: str, pattern: str) -> re.Match[str]:
        """Look at a widget until it reads as ``pattern`` wants."""
        return self.wait(
            f"{name} reading {pattern!r}, not {self.text(name)!r}",
            lambda: re.search(pattern, self.text(name)),
        )

    def wait_for_widget(self, name: str) -> None:
        """Look until a widget is to be seen."""
        self.wait(f"{name} being there", lambda: self.widget(name)["visible"])

    def wait_for_map(self) -> None:
        """Look until the map has been drawn."""
        self.wait("drawing the map", self.is_map_drawn)

    def wait_for_new_map(self) -> None:
        """Look until there is a map in place of the welcome page, and it has been drawn."""
        self.wait("the map being there", lambda: self._window.ask("map")["visible"])
        self.wait_for_map()

    def is_shown(self, place: Place) -> bool:
        """Tell whether a place of the site is on the part of the map that is shown."""
        return bool(self._where(place)["shown"])

    def is_map_drawn(self) -> bool:
        """Tell whether the map is drawn at this moment, to its end."""
        return not self._window.ask("map")["drawing"]

    def layers(self) -> dict[str, int]:
        """Return the project's vector layers, with how many of their features are selected."""
        return dict(self._window.ask("layers"))

    def counts(self) -> dict[str, int]:
        """Return how many features each of the project's vector layers has."""
        return dict(self._window.ask("counts"))

    def labels(self) -> list[str]:
        """Return the labels that are drawn on the map."""
        return list(self._window.ask("labels"))

    def replayed(self) -> dict[str, Any]:
        """Return what QGIS's temporal controller shows, and whether it plays."""
        return dict(self._window.ask("time"))

    def out_of_sight(self) -> list[str]:
        """Return what of the plugin cannot be read or reached."""
        return list(self._window.ask("out_of_sight"))

    def messages(self) -> list[str]:
        """Return what stands in QGIS's message bar, as it is written there."""
        return list(self._window.ask("messages"))

    def complaints(self) -> list[str]:
        """Return the exceptions that QGIS logged."""
        return list(self._window.ask("complaints"))

    # --- mouse ---

    def click(self, name: str) -> None:
        """Click a widget, by its object name, as soon as it can be used."""
        self._screen.click(_middle(self._still(name)))

    def tick_head(self, name: str) -> None:
        """Tick a group of fields in its head."""
        x, y, _, _ = self._still(name)
        self._screen.click((x + HEAD_TICK[0], y + HEAD_TICK[1]))
        self.wait(f"{name} being ticked", lambda: self.widget(name)["checked"])

    def scroll_to(self, name: str, panel: str) -> None:
        """Turn the wheel over the edge of ``panel`` until a widget in it can be seen."""

        def seen() -> bool:
            found = self.widget(name)
            if found["visible"] and found["on_top"] and found["rect"][3] > ROW:
                return True
            x, y, _, height = self.widget(panel)["rect"]
            self._screen.turn_wheel((x + EDGE, y + height - ROW), WHEEL_DOWN)
            return False

        self.wait(f"{name} being scrolled to", seen)

    def drag_in(self, name: str, start: tuple[float, float], end: tuple[float, float]) -> None:
        """Drag in a widget from one place to another, both in parts of its width and height."""
        x, y, width, height = self._still(name)
        (left, top), (right, bottom) = start, end
        begin = round(x + left * width), round(y + top * height)
        self._screen.drag(begin, (round(x + right * width), round(y + bottom * height)))

    def click_along(self, name: str, share: float, *, edge: int) -> None:
        """Click the line in a widget, which begins and ends ``edge`` pixels inside, at ``share`` of it."""
        x, y, width, height = self._still(name)
        self._screen.click((round(x + edge + share * (width - 2 * edge)), y + height // 2))

    def click_button(self, text: str) -> None:
        """Click a button by what it reads, as those that have no name."""
        self._click_seen(f"the button {text!r}", lambda: self._window.ask("button", text=text))

    def click_beside(self, label: str) -> None:
        """Click the button beside a field without a name, by the label above it."""
        self._screen.click(_middle(self._field(label, "button")))

    def click_tab(self, name: str, text: str) -> None:
        """Click a tab by what it begins with."""
        self._click_seen(f"the tab {text!r}", lambda: self._window.ask("tab", name=name, text=text))

    def click_panel_tab(self, text: str) -> None:
        """Click the tab of a panel that lies over others."""
        self._click_seen(f"the panel's tab {text!r}", lambda: self._window.ask("panel_tab", text=text))

    def click_row(self, name: str, *path: str) -> None:
        """Click a row of a table or tree by what its first column reads, from the root on."""
        self._screen.click(_middle(self._row(name, *path)))

    def click_cell(self, name: str, row: str, column: int) -> None:
        """Click a cell of a table, by what the first column reads."""
        self._screen.click(_middle(self._row(name, row, column=column)))

    def double_click_row(self, name: str, *path: str) -> None:
        """Click a row of a table or tree twice."""
        at = _middle(self._row(name, *path))
        self._screen.click(at)
        self._screen.click(at)

    def drag_row_to_map(self, name: str, *path: str) -> None:
        """Drag a row of a tree onto the map, and let go over its middle."""
        start = _middle(self._row(name, *path))
        end = _middle(self._window.ask("map")["rect"])
        with self._screen.dragging(start, end):
            self.wait("the map taking what is dragged", lambda: self._would_be_dropped(end))

    def open_row(self, name: str, *path: str) -> None:
        """Open a row of a tree by the keyboard, so that what is in it is to be seen."""
        self.click_row(name, *path)
        self._screen.press("Right")

    def wait_for_row(self, name: str, *path: str) -> None:
        """Look until a row is to be seen."""
        self._row(name, *path)

    def _would_be_dropped(self, at: Pixel) -> bool:
        # QGIS asks what is under the mouse when that moves, and it moved before QGIS began to listen.
        for x in (at[0] + 1, at[0]):
            self._screen.move((x, at[1]))
        return bool(self._window.ask("drag"))

    def _row(self, name: str, *path: str, column: int = 0) -> list[int]:
        return self._at_rest(
            f"the row {' > '.join(path)} of {name} being there",
            lambda: self._window.ask("row", name=name, path=path, column=column),
        )

    def choose_from_menu(self, *entries: str) -> None:
        """Click through the menus, from the menu bar on."""
        for entry in entries:
            self._click_seen(
                f"the menu's entry {entry!r}", lambda entry=entry: self._window.ask("entry", text=entry)
            )

    def close_panel(self, name: str) -> None:
        """Click the cross of one of QGIS's panels."""
        self._click_seen(f"the cross of {name}", lambda: self._window.ask("panel", name=name)["cross"])
        self.wait(f"{name} closing", lambda: not self.widget(name)["visible"])

    def widen_panel(self, name: str, width: int) -> None:
        """Drag the edge of a panel at the left of the map until it is ``width`` pixels wide."""
        x, y, now, height = self._at_rest(
            f"the panel {name}", lambda: self._window.ask("panel", name=name)["rect"]
        )
        edge = (x + now + 2, y + height // 2)
        with self._screen.dragging(edge, (edge[0] + width - now, edge[1])):
            # Let go at once, QGIS would forget the last of the way.
            self.wait(f"{name} being {width} px wide", lambda: self._width_of(name) >= width - EDGE)

    def _width_of(self, name: str) -> int:
        return int(self._window.ask("panel", name=name)["rect"][2])

    def click_map(self, place: Place) -> None:
        """Click a place of the site on the map."""
        self._screen.click(self._pixel(place))

    def places_to_click(self, place: Place, name: str) -> tuple[Pixel, Pixel]:
        """Return where a place of the site is on the screen, and a widget: to be clicked without a look."""
        return self._pixel(place), _middle(self._still(name))

    def click_at_once(self, *pixels: Pixel) -> None:
        """Click one pixel after the other, whatever is there by now."""
        for pixel in pixels:
            self._screen.click(pixel)

    def point_at_map(self, place: Place) -> None:
        """Rest the mouse on a place of the site on the map."""
        self._screen.move(self._pixel(place))

    def zoom_in(self, place: Place) -> None:
        """Turn the wheel over a place, which stays where it is on the screen."""
        before = self._window.ask("map")["scale"]
        self._screen.turn_wheel(self._pixel(place))
        self.wait("the map being larger", lambda: self._window.ask("map")["scale"] < 0.9 * before)
        self.wait_for_map()

    def drag_on_map(self, start: Place, end: Place) -> None:
        """Drag from one place of the site to another on the map."""
        self._screen.drag(self._pixel(start), self._pixel(end))

    # --- keyboard ---

    def press(self, keys: str) -> None:
        """Press a key, with others held down: ``F8``, ``Ctrl+Shift+Z``."""
        self._screen.press(keys)

    def type(self, text: str) -> None:
        """Type a text where the keyboard is."""
        self._screen.type(text)

    def write(self, name: str, text: str) -> None:
        """Click a field and type ``text`` in place of what stands there."""
        self.click(name)
        self.wait(f"the keyboard being in {name}", lambda: self.widget(name)["focus"])
        self._screen.press("Ctrl+A")
        self._screen.type(text)
        self.wait(f"{name} reading {text!r}", lambda: self.text(name) == text)

    def fill_in(self, label: str, text: str) -> None:
        """Type ``text`` into a field without a name, by the label above it."""
        self._screen.click(_middle(self._field(label, "field")))
        self._screen.press("Ctrl+A")
        self._screen.type(text)
        self._wait_for_field(label, text)

    def choose_in(self, label: str, text: str) -> None:
        """Choose an entry of a list without a name, by the label above it, by its first letters."""
        self._screen.click(_middle(self._field(label, "field")))
        self._screen.type(text)
        self._screen.press("Enter")
        self._wait_for_field(label, text)

    def _wait_for_field(self, label: str, text: str) -> None:
        def reads() -> bool:
            field = self._window.ask("field", label=label, of="field")
            return field is not None and field["text"].startswith(text)

        self.wait(f"{label!r} reading {text!r}", reads)

    def _field(self, label: str, of: str) -> list[int]:
        return self._at_rest(
            f"the {of} of {label!r} being there",
            lambda: (self._window.ask("field", label=label, of=of) or {}).get("rect"),
        )

    # --- what a window manager does ---

    def take_the_screen(self) -> None:
        """Let the QGIS window fill the screen, and have the keyboard."""
        main = self._window.ask("window")["main"]
        self._screen.fill(main)
        self._screen.focus(main)

    def keep_to_the_screen(self) -> None:
        """Let the QGIS window fill the screen again, no more and no less."""
        self._screen.fill(self._window.ask("window")["main"])

    def wait_for_dialog(self, name: str) -> None:
        """Look until a dialog, or a part of one, is there: the dialog is framed and has the keyboard."""
        self.wait_for_widget(name)
        self.wait_for_window()

    def wait_for_window(self) -> None:
        """Look until a window is over the main one: it is framed and has the keyboard."""
        dialog = self.wait("a window over the main one", lambda: self._window.ask("window")["dialog"])
        self._screen.frame(dialog)
        self._screen.focus(dialog)

    def place_dialog(self, corner: Pixel, size: Pixel) -> None:
        """Move the window over the main one, and make it as large as it is worked with."""
        over = self.wait("a window over the main one", lambda: self._window.ask("window")["dialog"])
        self._screen.place(over, corner, size)

    def close_dialog(self) -> None:
        """Close the window over the main one by Esc."""
        over = self.wait("a window over the main one", lambda: self._window.ask("window")["dialog"])
        self._screen.focus(over)
        self._screen.press("Esc")
        self.wait_for_no_dialog()

    def wait_for_no_dialog(self) -> None:
        """Look until no dialog is there; the QGIS window has the keyboard again."""
        self.wait("the dialog closing", lambda: self._window.ask("window")["dialog"] is None)
        self._screen.focus(self._window.ask("window")["main"])

    # --- where ---

    def _still(self, name: str) -> list[int]:
        """Return where a widget is once it can be used, is covered by nothing, and has come to rest."""

        def where() -> list[int] | None:
            found = self.widget(name)
            usable = found["visible"] and found["enabled"] and found["on_top"]
            return list(found["rect"]) if usable else None

        try:
            return self._at_rest(f"{name} being there to be clicked", where)
        except StageError as error:
            raise StageError(f"{error}; {name}: {self.widget(name)}") from error

    def _click_seen(self, what: str, where: Callable[[], list[int] | None]) -> None:
        self._screen.click(_middle(self._at_rest(f"{what} being there", where)))

    def _at_rest(self, what: str, where: Callable[[], list[int] | None]) -> list[int]:
        """Return where something is once two looks after another find it at the same place."""
        before: list[int] | None = None

        def same_again() -> list[int] | None:
            nonlocal before
            earlier, before = before, where()
            return before if before == earlier else None

        return list(self.wait(what, same_again))

    def _pixel(self, place: Place) -> Pixel:
        # A panel that has just opened or closed moves the map.
        self._at_rest("the map being at rest", lambda: self._where(place)["at"])
        found = self._where(place)
        if not found["shown"]:
            raise StageError(f"the map does not show {place} (metres of the site), so it cannot be clicked")
        return found["at"][0], found["at"][1]

    def _where(self, place: Place) -> dict[str, Any]:
        x, y = self.frame.to_crs(np.array([place]))[0].tolist()
        return dict(self._window.ask("place", x=x, y=y, crs=self.frame.crs))


def _middle(rect: list[int]) -> Pixel:
    x, y, width, height = rect
    return x + width // 2, y + height // 2
