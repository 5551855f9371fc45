"""The plugin's texts in the language of QGIS.

What people read goes through :func:`tr`. Modules do so when they are imported, too: :class:`Language` is made
before any of them. Texts of the gateway, of robots and of the bridge's packages, and the protocol's names,
are shown as they come.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from qgis.core import QgsApplication
from qgis.PyQt.QtCore import QCoreApplication, QLocale, QTranslator

CONTEXT = "FleetSupervisor"
"""The context of every text of the plugin in its .ts files: the same text is the same word everywhere."""
FOLDER = Path(__file__).parents[2] / "resources" / "translations"
FILES = "fleet_supervisor_"
"""What the names of the files begin with; the language follows."""


def tr(text: str, /, **values: object) -> str:
    """Return ``text`` in the language of QGIS, with its ``{placeholders}`` filled in when values are given.

    ``text`` is a literal: the files of translations are made from the source.
    """
    translated = QCoreApplication.translate(CONTEXT, text)
    return translated.format(**values) if values else translated


def tr_page(text: str, /) -> str:
    """Return a text of several paragraphs in the language of QGIS; line breaks in ``text`` are blanks.

    In one line, because QGIS takes every line break of a help for the end of a paragraph.
    """
    return tr(" ".join(text.split()))


def tr_count(number: int, one: str, many: str, /, **values: object) -> str:
    """Return the text for a number of things: ``one`` of them, or ``many`` with ``%n`` for the number.

    Only ``many`` is translated; its translations have as many forms as the language.
    """
    translated = QCoreApplication.translate(CONTEXT, many, None, number)
    if translated == many.replace("%n", str(number)) and number == 1:
        translated = one
    return translated.format(**values) if values else translated


def first_of(texts: Sequence[str], most: int = 3, count: int | None = None) -> list[str]:
    """Return the first ``most`` of ``texts`` and how many more there are: hundreds fit into no sentence.

    ``count`` is how many there are in all where ``texts`` are only some of them.
    """
    shown = list(texts[:most])
    more = max(len(texts), count or 0) - len(shown)
    return [*shown, tr("and {more} more", more=more)] if more > 0 else shown


class Language:
    """The translator that QGIS asks for the plugin's texts, from its making until it is removed."""

    def __init__(self, locale: str | None = None, folder: Path = FOLDER):
        """Take the translation for ``locale``, by default that of QGIS; without one texts stay English."""
        file = QTranslator()
        self.found = file.load(QLocale(locale or QgsApplication.locale()), FILES, "", str(folder))
        self._translator = QTranslator()
        if self.found:
            # Out of memory: Qt maps a file that it loads, and ends QGIS when somebody writes into that. The
            # translator reads from these very bytes as long as it is there.
            self._texts = Path(file.filePath()).read_bytes()
            self._translator.loadFromData(self._texts)
            QCoreApplication.installTranslator(self._translator)

    def remove(self) -> None:
        """Let QGIS ask this translator no more."""
        QCoreApplication.removeTranslator(self._translator)
