"""Translation of the plugin's texts to the language of QGIS, and times and ages as text.

Texts for people go through :func:`tr`. Modules call it on import, too: :class:`Language` must be created
before any of them. Texts of the gateway, of robots and of the bridge's packages, and the protocol's names,
are shown unchanged.
"""

from __future__ import annotations

import html
import time
from collections.abc import Sequence
from pathlib import Path

from qgis.core import QgsApplication
from qgis.PyQt.QtCore import QCoreApplication, QLocale, QTranslator

CONTEXT = "FleetSupervisor"
"""The context of every text of the plugin in its .ts files: equal texts have equal translations."""
FOLDER = Path(__file__).parents[2] / "resources" / "translations"
FILES = "fleet_supervisor_"
"""Prefix of the files' names; the language follows."""


def tr(text: str, /, **values: object) -> str:
    """Return ``text`` in the language of QGIS, with its ``{placeholders}`` filled in when values are given.

    ``text`` must be a literal: the translation files are made from the source.
    """
    translated = QCoreApplication.translate(CONTEXT, text)
    return translated.format(**values) if values else translated


def tr_page(text: str, /) -> str:
    """Return a text of several paragraphs in the language of QGIS; line breaks in ``text`` become blanks.

    In one line, because QGIS treats every line break of a help as the end of a paragraph.
    """
    return tr(" ".join(text.split()))


def tr_count(number: int, one: str, many: str, /, **values: object) -> str:
    """Return the text for a number of objects: ``one`` of them, or ``many`` with ``%n`` for the number.

    Only ``many`` is translated; its translations have as many forms as the language.
    """
    translated = QCoreApplication.translate(CONTEXT, many, None, number)
    if translated == many.replace("%n", str(number)) and number == 1:
        translated = one
    return translated.format(**values) if values else translated


def first_of(texts: Sequence[str], most: int = 3, count: int | None = None) -> list[str]:
    """Return the first ``most`` of ``texts`` and the number of the others: hundreds fit into no sentence.

    ``count`` is the total number where ``texts`` are only some of them.
    """
    shown = list(texts[:most])
    more = max(len(texts), count or 0) - len(shown)
    return [*shown, tr("and {more} more", more=more)] if more > 0 else shown


class Language:
    """The translator for the plugin's texts, installed in QGIS until it is removed."""

    def __init__(self, locale: str | None = None, folder: Path = FOLDER):
        """Load the translation for ``locale``, by default that of QGIS; without one texts stay English."""
        file = QTranslator()
        self.found = file.load(QLocale(locale or QgsApplication.locale()), FILES, "", str(folder))
        self._translator = QTranslator()
        if self.found:
            # From memory: Qt maps a file that it loads, and ends QGIS when somebody writes to that. The
            # translator reads from these very bytes as long as it exists.
            self._texts = Path(file.filePath()).read_bytes()
            self._translator.loadFromData(self._texts)
            QCoreApplication.installTranslator(self._translator)

    def remove(self) -> None:
        """Uninstall the translator from QGIS."""
        QCoreApplication.removeTranslator(self._translator)


# --- Times and ages as text ---


def plain_tip(text: str) -> str:
    """Return ``text`` as a tool tip that shows it as it is: Qt reads what looks like HTML in one as HTML.

    Texts of robots and of other operators are among them.
    """
    if "<" not in text and "&lt;" not in text:
        return text
    escaped = html.escape(text).replace("\n", "<br>")
    return f'<p style="white-space: pre-wrap">{escaped}</p>'


def time_of_day(at: float | None, now: float | None = None) -> str:
    """Return a time, seconds since 1970, as in ``12:03:04``; empty for None.

    A stop of last night must not read as one of today: where ``now``, by default the current time, is on
    another day, the date precedes the time.
    """
    return _formatted(at, now, "%Y-%m-%d %H:%M:%S")


def short_time(at: float | None, now: float | None = None) -> str:
    """Return a time as :func:`time_of_day` does, on another day as in ``11-21 12:03``: for narrow columns.

    Their tool tips show :func:`date_and_time`.
    """
    return _formatted(at, now, "%m-%d %H:%M")


def date_and_time(at: float | None) -> str:
    """Return a time, seconds since 1970, as in ``2026-11-21 12:03:04``; empty for None.

    For texts that are read on another day, such as the rows of a layer.
    """
    return "" if at is None else time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(at))


def _formatted(at: float | None, now: float | None, on_another_day: str) -> str:
    if at is None:
        return ""
    then = time.localtime(at)
    is_today = then[:3] == time.localtime(now)[:3]
    return time.strftime("%H:%M:%S" if is_today else on_another_day, then)


def age_in_words(seconds: float) -> str:
    """Return an age as in ``12.3 s``, ``5 min``, ``2.0 h`` or ``3.0 d``."""
    if seconds < 99.95:
        return f"{seconds:.1f} s"
    if seconds < 3570:
        return f"{seconds / 60:.0f} min"
    return f"{seconds / 3600:.1f} h" if seconds < 48 * 3600 else f"{seconds / 86400:.1f} d"


def last_seen_in_words(state: str, seconds: float, link: object) -> str:
    """Return a robot's ``state``, the time since its last message, and its link."""
    return tr("{state}, last heard {age} ago over {link}", state=state, age=age_in_words(seconds), link=link)
