"""A project of another site than the one that is served is told of, until the right one is open."""

from __future__ import annotations

import pytest
from qgis.core import QgsProject

OWN = {
    "fleet_site_crs": "EPSG:32633",
    "fleet_origin_x": 488000.0,
    "fleet_origin_y": 5190000.0,
    "fleet_rotation_deg": 0.0,
}
OTHERS = [{"fleet_origin_x": 488100.0}, {"fleet_site_crs": "EPSG:32634"}, {"fleet_rotation_deg": 12.5}]


@pytest.fixture
def project():
    project = QgsProject.instance()
    yield project
    project.setCustomVariables({})


def save(project, path, variables):
    """Write a project file with these variables, and leave the project as new."""
    project.setCustomVariables(variables)
    assert project.write(str(path))
    project.clear()
    return str(path)


def told(iface):
    return [text for text in iface.texts() if "This project is not that of site Yard" in text]


@pytest.mark.parametrize("other", OTHERS)
def test_a_project_of_another_site_is_told_of_on_connecting(project, request, iface, other):
    project.setCustomVariables({**OWN, **other})
    request.getfixturevalue("at_desk")
    assert len(told(iface)) == 1


@pytest.mark.parametrize("variables", [OWN, {**OWN, "fleet_rotation_deg": 360.0}, {}, {"fleet_origin_x": 3}])
def test_the_sites_own_project_and_one_that_says_nothing_are_not(project, request, iface, variables):
    project.setCustomVariables(variables)
    request.getfixturevalue("at_desk")
    assert told(iface) == []


def test_it_is_told_when_such_a_project_is_opened_and_over_with_the_sites_own(
    project, at_desk, iface, wait, tmp_path
):
    own, other = (
        save(project, tmp_path / f"{name}.qgz", variables)
        for name, variables in {"own": OWN, "other": {**OWN, **OTHERS[0]}}.items()
    )
    assert project.read(other)
    wait(lambda: told(iface), what="the notice")
    assert project.read(own)
    wait(lambda: not told(iface), what="the end of the notice")
