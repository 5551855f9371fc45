"""Labels of parameters, short enough for an algorithm's dialog as QGIS opens it.

QGIS makes the dialog's page as wide as its longest label, and scrolls sideways to the buttons beside the
fields. What does not fit goes into the help of the parameter: its tool tip, and ``qgis_process help``.
"""

from __future__ import annotations

import re

from qgis.core import QgsProcessingParameterDefinition

ROOM = 54
"""Letters that fit, those of the word [optional], which QGIS adds, included."""
OPTIONAL = 11
_IN_BRACKETS = re.compile(r"^(?P<label>.+?) \((?P<note>.+)\)$")
_AFTER_COLON = re.compile(r"^(?P<label>.+?): (?P<note>.+?)(?P<unit> \[[^]]+\])?$")
_AFTER_COMMA = re.compile(r"^(?P<label>.+?), (?P<note>.+?)(?P<unit> \[[^]]+\])?$")


def fit_label(parameter: QgsProcessingParameterDefinition) -> None:
    """Shorten the label of ``parameter`` where it is too long; what is left out begins its help."""
    is_optional = bool(parameter.flags() & QgsProcessingParameterDefinition.Flag.FlagOptional)
    label, notes = shortened_label(parameter.description(), ROOM - OPTIONAL * is_optional)
    if notes:
        parameter.setDescription(label)
        parameter.setHelp(" ".join(filter(None, (*notes, parameter.help()))))


def shortened_label(text: str, room: int) -> tuple[str, list[str]]:
    """Return a label of at most ``room`` letters, if it can be, and what was left out, as sentences.

    Its remark in brackets goes first, then what follows a colon or a comma; a unit stays.
    """
    notes: list[str] = []
    for pattern in (_IN_BRACKETS, _AFTER_COLON, _AFTER_COMMA):
        found = pattern.match(text)
        if len(text) > room and found:
            note = found["note"]
            notes.insert(0, f"{note[0].upper()}{note[1:]}.")
            text = found["label"] + (found.groupdict().get("unit") or "")
    return text, notes
