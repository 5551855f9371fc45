"""Choices: scripts and QGIS's history have values, dialogs show their names."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.cone_texts import FINISHES, METHODS, OBJECTIVES, RESULT_QUALITY, TASKS
from fleet_supervisor.plugin.processing.algorithms.export_navigation_map import FORMAT_NAMES
from fleet_supervisor.plugin.processing.algorithms.road_network import ENGINE_NAMES
from fleet_supervisor.plugin.processing.common.navigation_files import FORMAT_WRITERS
from fleet_supervisor.plugin.processing.common.road_sources import QGIS
from fleet_supervisor.robot_bridge.core.assignment import job, schedules, solver
from fleet_supervisor.robot_bridge.core.roads.engines import ENGINES
from qgis.core import QgsProcessingContext, QgsProcessingParameterEnum
from qgis.gui import QgsCheckableComboBox, QgsProcessingModelerParameterWidget
from qgis.PyQt.QtWidgets import QComboBox, QDialog


class BatchAlgorithmDialog(QDialog):
    """Known to Processing, and to us, by its name."""


class ModelerParametersDialog(QDialog):
    """The modeler's, with what a widget for it asks of the dialog."""

    def __init__(self):
        from qgis.core import QgsProcessingModelAlgorithm

        super().__init__()
        self.model, self.childId, self.context = QgsProcessingModelAlgorithm(), "", QgsProcessingContext()


@pytest.fixture
def shown(provider, qgis_processing):
    """Return the wrapper of a parameter as a dialog of Processing makes it, and its widget."""
    from processing.gui.wrappers import WidgetWrapperFactory

    kept = []

    def show(algorithm: str, name: str, dialog: type[QDialog] = QDialog):
        kept.append(dialog())
        parameter = provider.algorithm(algorithm).parameterDefinition(name)
        wrapper = WidgetWrapperFactory.create_wrapper(parameter, kept[-1])
        kept.append(wrapper)
        if isinstance(wrapper, QgsProcessingModelerParameterWidget):
            return wrapper, wrapper
        return wrapper, wrapper.widget

    return show


def choices(provider):
    """Return the algorithm's name and the parameter of every choice that the plugin offers."""
    return [
        (algorithm.name(), parameter)
        for algorithm in provider.algorithms()
        for parameter in algorithm.parameterDefinitions()
        if isinstance(parameter, QgsProcessingParameterEnum)
    ]


def names_in(box: QComboBox) -> dict[str, str]:
    return {box.itemData(row): box.itemText(row) for row in range(box.count())}


def test_every_choice_shows_names_and_begins_with_its_default(provider, shown):
    every = choices(provider)
    assert len(every) >= 10
    for algorithm, parameter in every:
        wrapper, box = shown(algorithm, parameter.name())
        assert list(names_in(box)) == parameter.options()
        assert all(name and name == name.strip() for name in names_in(box).values())
        assert wrapper.parameterValue() == parameter.defaultValue()
        assert wrapper.label.text() == parameter.description()


def test_a_layout_is_shown_as_people_say_it_and_given_as_scripts_do(shown):
    wrapper, box = shown("conelayout", "LAYOUT")
    assert names_in(box)["iso3888_1"] == "Double lane change (ISO 3888-1:2018)"
    told = []
    wrapper.widgetValueHasChanged.connect(lambda *_: told.append(wrapper.parameterValue()))
    box.setCurrentIndex(box.findText("Corridor (no standard: colours, width and spacing of Formula Student)"))
    wrapper.setParameterValue("iso3888_2", QgsProcessingContext())
    assert told[0] == "corridor" and wrapper.parameterValue() == "iso3888_2"


@pytest.mark.parametrize("given", [["keepout", "svg"], "keepout,svg"])
def test_several_formats_are_ticked(shown, given):
    wrapper, box = shown("exportnavigationmap", "FORMATS")
    assert isinstance(box, QgsCheckableComboBox)
    wrapper.setParameterValue(given, QgsProcessingContext())
    assert wrapper.parameterValue() == ["keepout", "svg"]
    assert box.checkedItems() == ["Nav2 keepout mask", "SVG"]


def test_in_a_batch_the_column_has_the_label(shown):
    wrapper, box = shown("route", "BY", BatchAlgorithmDialog)
    assert names_in(box) == {"shortest": "shortest", "fastest": "fastest"}
    assert wrapper.label is None


def test_in_a_model_the_value_can_be_that_of_another_step(shown):
    wrapper, _ = shown("conelayout", "LAYOUT", ModelerParametersDialog)
    assert isinstance(wrapper, QgsProcessingModelerParameterWidget)


def test_every_value_has_a_name():
    assert set(FORMAT_NAMES) == set(FORMAT_WRITERS)
    assert set(ENGINE_NAMES) == {*ENGINES, QGIS}
    assert set(FINISHES) == set(job.FINISHES)
    assert set(TASKS) == {job.PLACE, job.COLLECT}
    assert set(OBJECTIVES) == set(schedules.OBJECTIVES)
    assert set(METHODS) == set(solver.METHODS)
    assert set(RESULT_QUALITY) == {solver.PREVIEW, solver.PYVRP, solver.PREVIEW_KEPT}
