"""Choices among fixed values: scripts give a value, dialogs show its name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from qgis.core import QgsProcessingParameterEnum


def named_choice(
    name: str, title: str, names: Mapping[str, str], default: str | Sequence[str], *, several: bool = False
) -> QgsProcessingParameterEnum:
    """Return the parameter ``name`` with the values that are the keys of ``names``, shown as these.

    QGIS stores the value, in its history and in models, too: it is the same in every language.
    """
    choice = QgsProcessingParameterEnum(
        name,
        title,
        options=list(names),
        allowMultiple=several,
        defaultValue=default,
        usesStaticStrings=True,
    )
    # By its path: only a dialog loads what needs widgets.
    widget = f"{__package__}.choice_widget.ChoiceWidget"
    choice.setMetadata({"widget_wrapper": {"class": widget, "names": dict(names)}})
    return choice
