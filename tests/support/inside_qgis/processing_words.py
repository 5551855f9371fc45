"""Runs algorithms by the words that ``qgis_process run`` is given, inside a QGIS that runs already.

A ``qgis_process`` of its own takes 2 s of processor time to come up, whatever it is to run.
"""

from __future__ import annotations

import sys
import traceback
from collections.abc import Sequence
from dataclasses import dataclass, field
from unittest import mock

from qgis.core import QgsApplication, QgsProcessingContext, QgsProcessingFeedback, QgsProject

PROJECT = "--PROJECT_PATH="


class _Console(QgsProcessingFeedback):
    """Keeps what ``qgis_process`` would print."""

    def __init__(self) -> None:
        super().__init__(False)
        self.lines: list[str] = []
        self.progressChanged.connect(lambda percent: self.lines.append(f"{int(percent) // 10 * 10}..."))

    def pushWarning(self, warning: str) -> None:  # noqa: N802
        self.lines.append(f"WARNING:\t{warning}")

    def reportError(self, error: str, *_: object) -> None:  # noqa: N802
        self.lines.append(f"ERROR:\t{error}")

    def pushInfo(self, info: str) -> None:  # noqa: N802
        self.lines.append(info)


@dataclass
class Run:
    """A run that has ended: the exit status, what was said, and the outputs as lines of text."""

    status: int
    said: str
    results: str = field(default="")


def values_in(words: Sequence[str]) -> dict[str, str | list[str]]:
    """Return the values of parameters; a name that comes again has a list of them."""
    values: dict[str, str | list[str]] = {}
    for word in words:
        name, _, value = word.partition("=")
        before = values.get(name)
        if before is None:
            values[name] = value
        else:
            values[name] = [*(before if isinstance(before, list) else [before]), value]
    return values


def run_words(words: Sequence[str]) -> Run:
    """Run what ``run ALGORITHM [--PROJECT_PATH=FILE] -- NAME=VALUE …`` says.

    A project is opened for the run and closed after it; without one the algorithm has none, as in
    ``qgis_process``.
    """
    (verb, algorithm, *options), given = words[: words.index("--")], words[words.index("--") + 1 :]
    if verb != "run" or not all(option.startswith(PROJECT) for option in options):
        raise ValueError(f"cannot do this by words: {words}")
    context, console, project = QgsProcessingContext(), _Console(), QgsProject.instance()
    unseen: list[str] = []

    def note(*error) -> None:
        unseen.extend(traceback.format_exception(*error))

    try:
        for option in options:
            if not project.read(option[len(PROJECT) :]):
                raise ValueError(f"{option} cannot be read")
            context.setProject(project)
        with mock.patch.object(sys, "excepthook", note):
            results = _results(algorithm, values_in(given), context, console)
    finally:
        if options:
            project.clear()
    said = "\n".join([*console.lines, *unseen])
    if results is None or unseen:
        return Run(1, said)
    return Run(0, said, "\n".join(f"{name}:\t{value}" for name, value in results.items()))


def _results(algorithm, values, context, console) -> dict | None:
    known = QgsApplication.processingRegistry().algorithmById(algorithm)
    if known is None:
        raise ValueError(f"there is no algorithm {algorithm}")
    fine, why = known.checkParameterValues(values, context)
    fine, why = known.canExecute() if fine else (fine, why)
    if not fine:
        console.reportError(why)
        return None
    results, fine = known.run(values, context, console)
    return results if fine else None
