"""Parameters as people know them: dialogs show labels, scripts give names."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Sequence
from typing import Any

from qgis.core import QgsApplication, QgsProcessingException, QgsProcessingParameterDefinition

_NAME = re.compile(r"\b[A-Z][A-Z_]+\b")
_ASIDE = re.compile(r"\s*[(\[].*$")
"""What a label says in brackets: a unit, a default."""


def with_labels(text: str, definitions: Sequence[QgsProcessingParameterDefinition]) -> str:
    """Return ``text`` with the label of each parameter in place of its name: a dialog shows no names."""
    labels = {one.name(): _ASIDE.sub("", one.description()).strip(" :,") for one in definitions}
    return _NAME.sub(lambda name: f"“{labels[name[0]]}”" if labels.get(name[0]) else name[0], text)


def is_in_a_dialog() -> bool:
    """Tell whether people run algorithms here by dialogs, and not by the names of parameters."""
    return bool(QgsApplication.platform() == "desktop")


def problems_with_labels(check: Callable[..., tuple[bool, str]]) -> Callable[..., tuple[bool, str]]:
    """Have the problem that ``checkParameterValues`` returns name parameters as the dialog does."""

    @functools.wraps(check)
    def checked(algorithm: Any, *arguments: Any) -> tuple[bool, str]:
        fine, problem = check(algorithm, *arguments)
        if problem and is_in_a_dialog():
            problem = with_labels(problem, algorithm.parameterDefinitions())
        return fine, problem

    return checked


def errors_with_labels(work: Callable[..., Any]) -> Callable[..., Any]:
    """Have the errors of a step of an algorithm name parameters as the dialog does."""

    @functools.wraps(work)
    def worked(algorithm: Any, *arguments: Any) -> Any:
        try:
            return work(algorithm, *arguments)
        except QgsProcessingException as error:
            if not is_in_a_dialog():
                raise
            raise QgsProcessingException(with_labels(str(error), algorithm.parameterDefinitions())) from error

    return worked
