"""The parameters of all algorithms, as QGIS takes them."""

from __future__ import annotations

from fleet_supervisor.plugin.processing.provider import FleetProvider
from qgis.core import QgsApplication


def test_no_algorithm_has_two_parameters_of_one_name(qgis_app):
    """QGIS takes the first and drops the second with a line in its log; its value would go to the first."""
    logged = []
    log = QgsApplication.messageLog()
    log.messageReceived.connect(lambda text, *_: logged.append(text))
    provider = FleetProvider()
    provider.loadAlgorithms()
    assert len(provider.algorithms()) > 10
    assert [text for text in logged if "uplicate" in text] == []


def test_robots_and_roads_have_a_speed_each(qgis_app):
    provider = FleetProvider()
    provider.loadAlgorithms()
    algorithm = provider.algorithm("assigncones")
    assert algorithm.parameterDefinition("ROBOT_SPEED").type() == "number"
    assert algorithm.parameterDefinition("SPEED").type() == "expression"


def test_help_is_legible_in_dark_themes(qgis_app):
    """Beneath <b> QGIS puts a dark grey of its own."""
    provider = FleetProvider()
    provider.loadAlgorithms()
    helps = [algorithm.shortHelpString() for algorithm in provider.algorithms()]
    assert any("<strong>" in text for text in helps)
    assert not any("<b>" in text for text in helps)
