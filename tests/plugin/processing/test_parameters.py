"""The parameters of all algorithms, as QGIS takes them."""

from __future__ import annotations

import re

import pytest
from fleet_supervisor.plugin.plugin import FleetProvider
from fleet_supervisor.plugin.processing.common import algorithm as parameter_labels
from fleet_supervisor.plugin.processing.common.algorithm import FleetAlgorithm, plain_text
from osgeo import ogr
from qgis.core import (
    QgsApplication,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingFeatureSourceDefinition,
    QgsProcessingFeedback,
    QgsProject,
)


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


def test_a_command_in_a_help_can_be_pasted_into_a_shell(qgis_app):
    """A help is shown in one line, where a backslash before a blank makes that a part of the next word."""
    provider = FleetProvider()
    provider.loadAlgorithms()
    helps = [algorithm.shortHelpString() for algorithm in provider.algorithms()]
    assert any("qgis_process run" in text for text in helps)
    assert not any("\\" in text for text in helps)


def test_a_help_in_a_terminal_has_no_tags(qgis_app):
    provider = FleetProvider()
    provider.loadAlgorithms()
    texts = [plain_text(algorithm.HELP) for algorithm in provider.algorithms()]
    assert len(texts) > 10
    assert not [text for text in texts if re.search(r"</?[a-z]+>|&[a-z]+;|\n\n\n|  ", text)]
    assert any("\n\nqgis_process run" in text for text in texts)


def documented_calls(root):
    """Yield the file, the algorithm and the names of its parameters for each command in guides and help."""
    files = [
        root / "README.md",
        *(root / "docs").glob("*.md"),
        *(root / "plugin" / "processing").rglob("*.py"),
    ]
    for file in files:
        text = re.sub(r"\\+\n\s*", " ", file.read_text(encoding="utf-8"))
        text = re.sub(r"<pre>[^<]*", lambda command: " ".join(command[0].split()), text)
        for algorithm, words in re.findall(r"run fleet:(\w+)[^\n]*? -- ([^\n]+)", text):
            yield file.name, algorithm, re.findall(r'(?:^|[\s"])([A-Z][A-Z_]+)=', words)


def test_every_documented_command_has_parameters_that_there_are(qgis_app, root):
    provider = FleetProvider()
    provider.loadAlgorithms()
    calls = list(documented_calls(root))
    assert len({algorithm for _, algorithm, _ in calls}) > 10
    for file, algorithm, names in calls:
        known = {definition.name() for definition in provider.algorithm(algorithm).parameterDefinitions()}
        assert set(names) <= known, f"{file}: fleet:{algorithm}"


def test_a_dialogs_errors_name_parameters_by_their_labels_and_a_scripts_by_their_names(provider, monkeypatch):
    algorithm = provider.algorithm("exportrobotmap").create()
    context = QgsProcessingContext()
    _, by_script = algorithm.checkParameterValues({"WIDTH": 10}, context)
    assert by_script.startswith(
        "Neither CENTER nor EXTENT is given: give the centre of the window with WIDTH"
    )
    monkeypatch.setattr(parameter_labels, "is_in_a_dialog", lambda: True)
    _, in_dialog = algorithm.checkParameterValues({"WIDTH": 10}, context)
    names = {one.name() for one in algorithm.parameterDefinitions()}
    assert not names & set(re.findall(r"\w+", in_dialog))
    assert in_dialog.startswith("Neither “Centre of the window” nor “")


def test_every_parameter_for_layers_asks_which_of_a_files_layers_is_meant(provider, tmp_path):
    """QGIS takes the first: of the plugin's own site.gpkg the obstacles, in place of keepouts, say."""
    file = tmp_path / "site.gpkg"
    source = ogr.GetDriverByName("GPKG").CreateDataSource(str(file))
    for name in ("obstacles", "keepouts"):
        source.CreateLayer(name, None, ogr.wkbPolygon)
    source = None
    context, asked = QgsProcessingContext(), 0
    for algorithm in provider.algorithms():
        for one in algorithm.parameterDefinitions():
            if one.type() not in ("source", "vector", "layer", "multilayer"):
                continue
            asked += 1
            value = [str(file)] if one.type() == "multilayer" else str(file)
            for given in (value, QgsProcessingFeatureSourceDefinition(str(file), True)):
                _, said = FleetAlgorithm.checkParameterValues(algorithm, {one.name(): given}, context)
                where = f"{one.name()}: the file {file} holds 2 layers"
                assert said.startswith(where), f"{algorithm.name()}: {said}"
            gone = f"{file}|layername=keepout"
            _, said = FleetAlgorithm.checkParameterValues(algorithm, {one.name(): gone}, context)
            assert said.startswith(f"{one.name()}: the layer {gone} cannot be opened")
    assert asked > 15


def test_an_error_of_a_run_names_them_so_too(provider, monkeypatch):
    algorithm = provider.algorithm("exportrobotmap").create()
    context = QgsProcessingContext()
    context.setProject(QgsProject())

    def error():
        with pytest.raises(QgsProcessingException) as raised:
            algorithm.prepareAlgorithm(
                {"CENTER": "0,0 [EPSG:32633]", "WIDTH": 10, "HEIGHT": 10}, context, QgsProcessingFeedback()
            )
        return str(raised.value)

    assert "Give OBSTACLES, roles" in error()
    monkeypatch.setattr(parameter_labels, "is_in_a_dialog", lambda: True)
    assert "OBSTACLES" not in error() and "Give “" in error()
