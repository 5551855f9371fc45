"""Underlined letters in the plugin's menu, in whatever language it is."""

from __future__ import annotations

from collections.abc import Sequence

from qgis.PyQt.QtCore import QObject
from qgis.PyQt.QtWidgets import QAction


class MenuLetters(QObject):
    """Keeps a letter of its own for each entry of a menu. :meth:`remove` ends that.

    Translations give none: what is unique in a menu depends on all of its texts. Buttons show an action's
    text without its letter.
    """

    def __init__(self, actions: Sequence[QAction], parent: QObject | None = None):
        super().__init__(parent)
        self._actions = list(actions)
        self._plain: list[str] = []
        for action in self._actions:
            action.changed.connect(self._renew)
        self._renew()

    def remove(self) -> None:
        """Watch the entries no longer; they are about to go."""
        for action in self._actions:
            action.changed.disconnect(self._renew)
        self._actions = []
        self.deleteLater()

    def _renew(self) -> None:
        plain = [action.text().replace("&", "") for action in self._actions]
        if plain == self._plain:
            return
        self._plain = plain
        for action, text in zip(self._actions, with_letters(plain), strict=True):
            action.setText(text)


def with_letters(texts: Sequence[str]) -> list[str]:
    """Return ``texts``, each with ``&`` before a letter that no other has.

    A text goes without where letters run out: earlier ones come first, and first letters of words.
    """
    places = [_places(text) for text in texts]
    taken: dict[str, int] = {}
    for number in range(len(texts)):
        _give_letter(number, places, taken, set())
    letters = {number: letter for letter, number in taken.items()}
    return [
        text[: places[number][letters[number]]] + "&" + text[places[number][letters[number]] :]
        if number in letters
        else text
        for number, text in enumerate(texts)
    ]


def _places(text: str) -> dict[str, int]:
    """Return where each letter of a text stands, first letters of words in front."""
    found = [k for k, letter in enumerate(text) if letter.isalpha()]
    found.sort(key=lambda k: k > 0 and text[k - 1].isalpha())
    places: dict[str, int] = {}
    for k in found:
        places.setdefault(text[k].casefold(), k)
    return places


def _give_letter(number: int, places: list[dict[str, int]], taken: dict[str, int], tried: set[str]) -> bool:
    """Find a letter for a text, if need be by giving others another one (augmenting paths)."""
    for letter in places[number]:
        if letter not in taken:
            taken[letter] = number
            return True
    for letter in places[number]:
        if letter not in tried:
            tried.add(letter)
            if _give_letter(taken[letter], places, taken, tried):
                taken[letter] = number
                return True
    return False
