"""A language in which every text is as long as in the wordiest of real ones."""

from __future__ import annotations

import math
import re

from qgis.PyQt.QtCore import QTranslator

CONTEXT = "FleetSupervisor"
LONGER = 1.4
"""A German text beside its English one."""
_MARKUP = re.compile(r"<[^>]*>|\{[^}]*\}|%n|&(?=\w)")
_FILLER = "verlängerungswort "


def stretched(text: str) -> str:
    """Return ``text`` with as much after it as makes it :data:`LONGER`; the markup in it stays whole."""
    length = len(_MARKUP.sub("", text))
    more = math.ceil((LONGER - 1.0) * length)
    filler = (_FILLER * (more // len(_FILLER) + 1))[:more].rstrip()
    if not filler:
        return text
    at = len(text.rstrip(" …:.>"))
    at = len(text) if text.endswith(">") else at
    # A short word becomes a longer one, a longer text gets more words.
    gap = " " if length > 12 else ""
    return f"{text[:at]}{gap}{filler}{text[at:]}"


class StretchedLanguage(QTranslator):
    """Answers for the plugin's context only, as its translations do."""

    def translate(self, context, source, disambiguation=None, n=-1):
        if context != CONTEXT:
            # None, not an empty text: that would be QGIS's own text from now on.
            return None
        return stretched(source).replace("%n", str(n))

    def isEmpty(self):
        return False
