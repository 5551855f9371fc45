"""A script of Processing: several runs in one ``qgis_process``, one after the other.

``RUNS`` is a JSON file with a list of words for each, as ``processing_words`` takes them; ``ENDED`` becomes
one with ``status``, ``said`` and ``results`` of each.
"""

import json
from dataclasses import asdict
from pathlib import Path

from qgis.core import QgsProcessingAlgorithm, QgsProcessingParameterFile, QgsProcessingParameterString

from tests.support.inside_qgis.processing_words import run_words


class SeveralRuns(QgsProcessingAlgorithm):
    """``script:severalruns``."""

    def createInstance(self):  # noqa: N802
        return SeveralRuns()

    def name(self):
        return "severalruns"

    def displayName(self):  # noqa: N802
        return "Several runs"

    def initAlgorithm(self, configuration=None):  # noqa: N802
        self.addParameter(QgsProcessingParameterFile("RUNS", "Runs"))
        self.addParameter(QgsProcessingParameterString("ENDED", "What became of them"))

    def flags(self):
        return super().flags() | QgsProcessingAlgorithm.FlagNoThreading

    def processAlgorithm(self, parameters, context, feedback):  # noqa: N802
        runs = json.loads(Path(parameters["RUNS"]).read_text(encoding="utf-8"))
        ended = [asdict(run_words(words)) for words in runs]
        Path(parameters["ENDED"]).write_text(json.dumps(ended), encoding="utf-8")
        return {}
