"""The pictures of observations: there as long as the desk knows what they are of."""

from __future__ import annotations

import base64
from pathlib import Path

import pytest
from fleet_supervisor.plugin.gateway_client import report_caches
from fleet_supervisor.plugin.gateway_client.connection_status import ConnectionPhase, ConnectionStatus
from fleet_supervisor.plugin.gateway_client.report_caches import ObservationCache
from fleet_supervisor.plugin.observations.observation_views import ObservationFeed, Thumbnails
from fleet_supervisor.robot_bridge.core.messages.records import observation_report
from qgis.PyQt.QtCore import QBuffer, QObject, pyqtSignal
from qgis.PyQt.QtGui import QColor, QImage

from tests.support.left_behind import slots_that_hold


@pytest.fixture
def photo(qgis_app):
    """An image as a gateway sends it."""
    image = QImage(400, 300, QImage.Format.Format_RGB32)
    image.fill(QColor(200, 30, 30))
    buffer = QBuffer()
    buffer.open(QBuffer.OpenModeFlag.WriteOnly)
    image.save(buffer, "PNG")
    return {"image": base64.b64encode(bytes(buffer.data())).decode("ascii")}


@pytest.fixture
def thumbnails(qgis_app):
    thumbnails = Thumbnails()
    yield thumbnails
    thumbnails.remove()


@pytest.fixture
def made(thumbnails, photo, wait):
    """Make the pictures of these observations."""

    failed = []
    thumbnails.failed.connect(failed.append)

    def make(*numbers):
        for number in numbers:
            assert thumbnails.make(number, photo)
        wait(lambda: failed or all(map(thumbnails.file, numbers)), 15, "the pictures")
        assert not failed

    return make


class Desk(QObject):
    """What a feed needs of a desk whose link is down."""

    link_changed, site_changed = pyqtSignal(), pyqtSignal()
    answered, observations_changed = pyqtSignal(object), pyqtSignal(list)

    def __init__(self):
        super().__init__()
        self.state = self.orders = self
        self.link, self.observations = ConnectionStatus(ConnectionPhase.CLOSED), ObservationCache()

    def tell(self, *numbers):
        told = {number: reviewed(number) for number in numbers}
        self.observations_changed.emit(self.observations.merge(told))


def reviewed(number):
    values = {"observation": number, "robot": "r1", "op": "SetObject", "object": "bin", "x": 1.0, "y": 2.0}
    return observation_report({**values, "received_at": 1.79e9 + number, "state": "rejected"})


def test_a_picture_goes_with_the_observation_that_the_desk_forgets(thumbnails, made, monkeypatch):
    monkeypatch.setattr(report_caches, "MOST_REVIEWED", 2)
    desk = Desk()
    _feed = ObservationFeed(desk, thumbnails)
    desk.tell(1, 2)
    made(1, 2)
    files = {number: Path(thumbnails.file(number)) for number in (1, 2)}
    assert all(file.exists() for file in files.values())
    desk.tell(3)
    assert (files[1].exists(), files[2].exists()) == (False, True)
    assert (thumbnails.has(1), thumbnails.has(2)) == (False, True)


def test_what_is_being_made_of_others_is_given_up(thumbnails, photo, made, wait):
    ended = []
    thumbnails.made.connect(ended.append)
    thumbnails.failed.connect(ended.append)
    thumbnails.make(1, photo)
    assert not slots_that_hold(thumbnails._tasks[1]), "let go of, the task may crash QGIS when it ends"
    thumbnails.keep({2})
    assert not thumbnails.has(1)
    made(2)
    assert ended == [2]


def test_all_pictures_are_forgotten(thumbnails, made):
    made(1, 2)
    files = [Path(thumbnails.file(number)) for number in (1, 2)]
    thumbnails.clear()
    assert not any(file.exists() for file in files)
    assert not thumbnails.has(1)
