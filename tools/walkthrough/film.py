"""Says what has happened, and photographs the window at each step."""

from __future__ import annotations

import time
from itertools import chain
from pathlib import Path

from tests.support.errors import StageError
from tests.support.picture import save_few_colours
from tools.walkthrough.operator_at_screen import OperatorAtScreen
from tools.walkthrough.screen import Pixels, Screen, keep
from tools.walkthrough.still_buttons import StillButtons

PAGE_DPI = "75"
"""A page of A4 is then 620 × 877 pixels."""
LOOKS = 5
"""How often it is looked whether all can be read, before what cannot is a fault."""


class Film:
    """Numbers its pictures, ``FILM-01-NAME.png``, in ``folder``; those of an earlier time go."""

    def __init__(
        self, screen: Screen, operator: OperatorAtScreen, folder: Path, name: str, buttons: StillButtons
    ):
        self._screen, self._operator, self._folder, self._name = screen, operator, folder, name
        self._buttons = buttons
        self._began = time.monotonic()
        self._shots = 0
        for old in folder.glob(f"{name}-*.png"):
            old.unlink()

    def happened(self, text: str) -> None:
        """Say what has happened."""
        print(f"{time.monotonic() - self._began:6.1f} s  {text}", flush=True)

    def shoot(self, name: str, text: str) -> None:
        """Photograph the window and say what it shows.

        :raises StageError: when a part of the plugin cannot be read or reached, a button of the panel has
            moved since the picture before, or something raised.
        """
        looked_at = self._out_of_sight(), self._operator.complaints(), self._buttons.moved()
        if faults := [*chain(*looked_at)]:
            raise StageError(f"in the picture {name!r}: " + "; ".join(faults))
        path, seen = self._next(name), self._screen.look()
        while not self._operator.is_map_drawn():
            # QGIS began to draw again meanwhile, as it does each second for the live layers.
            self._operator.wait_for_map()
            seen = self._screen.look()
        keep(seen, path)
        self.happened(f"{text}: {path.name}")

    def _out_of_sight(self) -> list[str]:
        """Return what cannot be read or reached in a window whose map is drawn."""
        found: list[str] = []
        for _ in range(LOOKS):
            self._operator.wait_for_map()
            # While it draws, QGIS shows that in its status bar, which may then be broader than the screen.
            self._operator.keep_to_the_screen()
            # It may begin to draw again at any moment: what is so each time is a fault.
            if not (found := self._operator.out_of_sight()):
                break
        return found

    def look(self) -> Pixels:
        """Return what is on the screen now, whatever it draws; raises StageError when a button has moved."""
        seen = self._screen.look()
        if moved := self._buttons.moved():
            raise StageError("; ".join(moved))
        return seen

    def keep(self, seen: Pixels, name: str, text: str) -> None:
        """Keep what was seen a moment ago as a picture, and say what it shows."""
        path = self._next(name)
        keep(seen, path)
        self.happened(f"{text}: {path.name}")

    def keep_page(self, name: str, file: Path, text: str) -> None:
        """Keep the first page of a PDF as a picture, and say what it shows."""
        from osgeo import gdal

        gdal.UseExceptions()
        # GDAL 3.6 takes the resolution from nowhere else than its settings.
        gdal.SetConfigOption("GDAL_PDF_DPI", PAGE_DPI)
        path = self._next(name)
        bands = ["-b", "1", "-b", "2", "-b", "3"]
        page = gdal.Translate("", f"PDF:1:{file}", options=["-of", "MEM", *bands])
        save_few_colours(page, path)
        self.happened(f"{text}: {path.name}")

    def _next(self, name: str) -> Path:
        self._shots += 1
        return self._folder / f"{self._name}-{self._shots:02d}-{name}.png"
