"""``fleet:asplacedreport``: placed cones in, a PDF comparing them with their plan out."""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import Any

from qgis.core import (
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingFeatureSource,
    QgsProcessingFeedback,
    QgsProcessingMultiStepFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingParameterCrs,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterMultipleLayers,
    QgsProcessingParameterNumber,
    QgsProcessingParameterString,
)
from qgis.gui import QgsMessageBar
from qgis.utils import iface

from ...layers.crs import check_site_crs
from ...ui.language import tr, tr_count, tr_page
from ..common.algorithm import FleetAlgorithm, ParameterError, Parameters, shown_by_processing
from ..common.placed_cones import ConeDeviations, cone_deviations, read_placed_cones
from ..common.report_layout import ReportContent, write_pdf

INPUT, OUTPUT = "INPUT", "OUTPUT"
TOLERANCE, TITLE, BACKGROUND, CRS = "TOLERANCE", "TITLE", "BACKGROUND", "CRS"
NUMBERS = {
    "CONE_COUNT": tr("Cones"),
    "WITHIN_COUNT": tr("Cones within the tolerance"),
    "MEAN": tr("Mean deviation [m]"),
    "RMS": tr("Root mean square deviation [m]"),
    "P95": tr("95 % deviate at most [m]"),
    "MAX": tr("Largest deviation [m]"),
    "PAGE_COUNT": tr("Pages"),
    "WARNING_COUNT": tr("Warnings"),
}


class AsPlacedReport(FleetAlgorithm):
    """Lays out figures, histogram, map and table of placed cones."""

    GROUP = ("records", tr("Records"))
    NAME = "asplacedreport"
    TITLE = tr("As-placed report")
    SUMMARY = tr(
        "Writes a PDF of how placed cones stand against their plan: figures, histogram, map and table."
    )
    ICON = "as_placed_report.svg"
    TAGS = ("cone", "placed", "planned", "deviation", "report", "pdf", "layout", "histogram")
    HELP = tr_page("""
    <p>Compares where cones stand with where they were to stand, and writes a PDF: how many are within the
    tolerance, a histogram of the deviations, a map and a table of every cone, worst first.</p>
    <p>The cones are a layer of the GeoPackage that <i>robot-bridge placements export cones.gpkg --site
    site</i> writes, or its CSV; for a CSV, which has none, give the site's CRS. A cone stands where the
    robot was when it had reached its target, and from there the site's cone offset: the gateway's
    knowledge, no survey.</p>
    <p>On the map a cross is the plan and a circle the cone, red where it is beyond the tolerance.
    Deviations are small: the lines from the crosses are longer than they are by the factor that the map
    names. Give background layers, such as roads, to be drawn beneath.</p>
    <pre>qgis_process run fleet:asplacedreport -- INPUT="cones.gpkg|layername=placed" TOLERANCE=0.2
    OUTPUT=report.pdf</pre>
    """)

    def flags(self):
        # Print layouts must be used in the main thread.
        return super().flags() | QgsProcessingAlgorithm.Flag.FlagNoThreading

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        kinds = QgsProcessing.SourceType
        self.addParameter(QgsProcessingParameterFeatureSource(INPUT, tr("Placed cones"), [kinds.TypeVector]))
        real = QgsProcessingParameterNumber.Type.Double
        self.addParameter(
            QgsProcessingParameterNumber(
                TOLERANCE, tr("Tolerance [m]"), real, 0.20, minValue=0.001, maxValue=100
            )
        )
        self.addParameter(
            QgsProcessingParameterString(TITLE, tr("Title"), tr("Cones as placed and as planned"))
        )
        self.addParameter(
            QgsProcessingParameterMultipleLayers(
                BACKGROUND, tr("Background of the map"), kinds.TypeMapLayer, optional=True
            )
        )
        self.addParameter(
            QgsProcessingParameterCrs(CRS, tr("Site CRS (default: the layer's)"), optional=True)
        )
        self.addParameter(
            QgsProcessingParameterFileDestination(OUTPUT, tr("Report"), tr("PDF files (*.pdf)"))
        )
        for name, title in NUMBERS.items():
            self.addOutput(QgsProcessingOutputNumber(name, title))

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        source = self.parameterAsSource(parameters, INPUT, context)
        if source is None:
            raise QgsProcessingException(self.invalidSourceError(parameters, INPUT))
        with shown_by_processing(feedback):
            steps = QgsProcessingMultiStepFeedback(2, feedback)
            read = read_placed_cones(source, steps)
            if read is None:
                return {}
            cones, odd = read
            _warn_of_odd(odd, feedback)
            tolerance = self.parameterAsDouble(parameters, TOLERANCE, context)
            figures = cone_deviations(cones, tolerance)
            report = ReportContent(
                title=self.parameterAsString(parameters, TITLE, context),
                cones=sorted(cones, key=lambda cone: -cone.deviation),
                figures=figures,
                tolerance=tolerance,
                crs=self._crs(parameters, context, source),
                background=self.parameterAsLayerList(parameters, BACKGROUND, context),
            )
            file = Path(self.parameterAsFileOutput(parameters, OUTPUT, context))
            steps.setCurrentStep(1)
            pages = write_pdf(report, file, context.transformContext(), steps)
            if pages is None:
                return {}
        self._written = file
        _report(figures, tolerance, feedback)
        numbers = (*vars(figures).values(), pages, int(odd > 0))
        return {OUTPUT: str(file), **dict(zip(NUMBERS, numbers, strict=True))}

    def postProcessAlgorithm(self, context: QgsProcessingContext, feedback: QgsProcessingFeedback):
        # For algorithms in the window's thread QGIS's dialog shows neither the log nor the result.
        if iface is not None and getattr(self, "_written", None):
            announce(iface.messageBar(), self._written)
        return super().postProcessAlgorithm(context, feedback)

    def _crs(self, parameters: Parameters, context: QgsProcessingContext, source: QgsProcessingFeatureSource):
        crs = self.parameterAsCrs(parameters, CRS, context)
        if not crs.isValid():
            crs = source.sourceCrs()
        if not crs.isValid():
            raise ParameterError(
                tr(
                    "The CRS of the placed cones is not known, as of a CSV: give CRS, the site's, such as "
                    "EPSG:32633."
                )
            )
        # Otherwise deviations in degrees would be reported as metres.
        check_site_crs(crs)
        return crs


def announce(bar: QgsMessageBar, file: Path) -> None:
    """Show the location of the report in the window's message bar; a click opens it."""
    link = f'<a href="{file.as_uri()}">{escape(str(file))}</a>'
    bar.pushSuccess(tr("As-placed report"), tr("It is written: {link}", link=link))


def _warn_of_odd(odd: int, feedback: QgsProcessingFeedback) -> None:
    if odd:
        feedback.pushWarning(
            tr_count(
                odd,
                "1 feature has no planned or no placed position; it is left out.",
                "%n features have no planned or no placed position; they are left out.",
            )
        )


def _report(figures: ConeDeviations, tolerance: float, feedback: QgsProcessingFeedback) -> None:
    feedback.pushInfo(
        tr_count(
            figures.count,
            "{within} of 1 cone is within {tolerance:g} m; it is {most:.3f} m off.",
            "{within} of %n cones are within {tolerance:g} m; the worst is {most:.3f} m off.",
            within=figures.within,
            tolerance=tolerance,
            most=figures.most,
        )
    )
