"""A mouse, a keyboard and a camera at an X display: what a person has, and nothing more."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import numpy.typing as npt
from Xlib import XK, X
from Xlib.display import Display
from Xlib.ext import xtest

from tests.support.errors import StageError
from tests.support.picture import save_few_colours

Pixel = tuple[int, int]
Pixels = npt.NDArray[np.uint8]
LEFT, WHEEL_UP, WHEEL_DOWN = 1, 4, 5
"""Buttons, as X numbers them; a turn of the wheel is one, too."""
DRAG_STEPS = 12
"""Movements that a drag is made of."""
NAMES = {
    "Ctrl": "Control_L",
    "Shift": "Shift_L",
    "Alt": "Alt_L",
    "Enter": "Return",
    "Esc": "Escape",
    "Del": "Delete",
    "Space": "space",
}
"""What is printed on a key, where X calls it something else."""
FRAME = 0x404040
"""The colour of a dialog's frame, which a window manager would draw."""


class Screen:
    """The display ``name``, such as ``:1``, which has no window manager."""

    def __init__(self, name: str):
        self._display = Display(name)
        self._root = self._display.screen().root
        if not self._display.query_extension("XTEST"):
            raise StageError(f"the display {name} has no XTEST, so nobody can type on it; start it with Xvfb")
        # On a busy computer a key is let go late: of one letter the keyboard would make several.
        self._display.change_keyboard_control(auto_repeat_mode=X.AutoRepeatModeOff)

    # --- mouse ---

    def move(self, to: Pixel) -> None:
        """Move the mouse to a pixel."""
        self._send(X.MotionNotify, x=to[0], y=to[1])

    def click(self, at: Pixel) -> None:
        """Click with the left button."""
        self.move(at)
        self._send(X.ButtonPress, LEFT)
        self._send(X.ButtonRelease, LEFT)

    def drag(self, start: Pixel, end: Pixel) -> None:
        """Press the left button at one pixel and let it go at another."""
        with self.dragging(start, end):
            pass

    def turn_wheel(self, at: Pixel, way: int = WHEEL_UP) -> None:
        """Turn the wheel by a notch, away from the hand unless told otherwise."""
        self.move(at)
        self._send(X.ButtonPress, way)
        self._send(X.ButtonRelease, way)

    @contextmanager
    def dragging(self, start: Pixel, end: Pixel) -> Iterator[None]:
        """Press the left button at one pixel, go to another, and let go when the block ends."""
        self.move(start)
        self._send(X.ButtonPress, LEFT)
        try:
            for x, y in np.linspace(start, end, DRAG_STEPS + 1)[1:].round().astype(int).tolist():
                self.move((x, y))
            yield
        finally:
            self._send(X.ButtonRelease, LEFT)

    # --- keyboard ---

    def press(self, keys: str) -> None:
        """Press a key, with others held down: ``F8``, ``Ctrl+Shift+Z``."""
        *held, key = keys.split("+")
        with self._holding([self._keycode(name) for name in held]):
            self._tap(self._keycode(key))

    def type(self, text: str) -> None:
        """Type a text, letter by letter."""
        for letter in text:
            ((code, level), *_) = self._codes(ord(letter), letter)
            with self._holding([self._keycode("Shift")] if level else []):
                self._tap(code)

    @contextmanager
    def _holding(self, codes: list[int]) -> Iterator[None]:
        for code in codes:
            self._send(X.KeyPress, code)
        yield
        for code in reversed(codes):
            self._send(X.KeyRelease, code)

    def _tap(self, code: int) -> None:
        self._send(X.KeyPress, code)
        self._send(X.KeyRelease, code)

    def _keycode(self, name: str) -> int:
        symbol = XK.string_to_keysym(NAMES.get(name, name if len(name) > 1 else name.lower()))
        return int(self._codes(symbol, name)[0][0])

    def _codes(self, symbol: int, name: str) -> list[tuple[int, int]]:
        codes = [(code, level) for code, level in self._display.keysym_to_keycodes(symbol) if level < 2]
        if not codes:
            raise StageError(f"the virtual keyboard has no key for {name!r}")
        return codes

    # --- what a window manager does ---

    def fill(self, window: int) -> None:
        """Give a window the whole screen."""
        geometry = self._root.get_geometry()
        found = self._display.create_resource_object("window", window)
        found.configure(x=0, y=0, width=geometry.width, height=geometry.height)
        self._display.sync()

    def place(self, window: int, corner: Pixel, size: Pixel) -> None:
        """Move a window and give it a size, as one drags it by its frame."""
        found = self._display.create_resource_object("window", window)
        found.configure(x=corner[0], y=corner[1], width=size[0], height=size[1])
        self._display.sync()

    def frame(self, dialog: int) -> None:
        """Draw a line around a dialog, so that it can be told from what lies beneath."""
        found = self._display.create_resource_object("window", dialog)
        found.change_attributes(border_pixel=FRAME)
        found.configure(border_width=1)
        self._display.sync()

    def focus(self, window: int) -> None:
        """Let the keyboard write into a window."""
        self._display.set_input_focus(window, X.RevertToParent, X.CurrentTime)
        self._display.sync()

    # --- camera ---

    def look(self) -> Pixels:
        """Return what is on the screen, as rows of pixels of blue, green, red and nothing."""
        size = self._root.get_geometry()
        image = self._root.get_image(0, 0, size.width, size.height, X.ZPixmap, 0xFFFFFFFF)
        return np.frombuffer(image.data, np.uint8).reshape(size.height, size.width, 4)

    def photograph(self, path: Path) -> None:
        """Save what is on the screen as a PNG of few colours."""
        keep(self.look(), path)

    def _send(self, kind: int, detail: int = 0, *, x: int = 0, y: int = 0) -> None:
        xtest.fake_input(self._display, kind, detail, x=x, y=y)
        self._display.sync()


def keep(pixels: Pixels, path: Path) -> None:
    """Save what was seen on a screen as a PNG of few colours."""
    from osgeo import gdal

    gdal.UseExceptions()
    height, width, _ = pixels.shape
    picture = gdal.GetDriverByName("MEM").Create("", width, height, 3)
    for band, channel in enumerate((2, 1, 0), start=1):
        picture.GetRasterBand(band).WriteArray(pixels[:, :, channel])
    path.parent.mkdir(parents=True, exist_ok=True)
    save_few_colours(picture, path)
