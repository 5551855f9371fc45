"""What real robots see, at a desk with a real gateway: listed, on the map, reviewed, in the next map."""

from __future__ import annotations

import base64
import json

import pytest
from fleet_supervisor.robot_bridge.core.messages.records import ObservationState
from qgis.core import QgsProject, QgsRenderContext
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QColor, QImage
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QListView
from websockets.sync.client import connect

from robot_bridge.core.robotmap.binary import decode
from tests.support.patience import BUSY


@pytest.fixture
def photo(tmp_path):
    """A red picture, larger than a thumbnail."""
    image = QImage(800, 600, QImage.Format.Format_RGB32)
    image.fill(QColor(200, 30, 30))
    image.save(str(tmp_path / "photo.png"))
    return tmp_path / "photo.png"


@pytest.fixture
def dock(plugin, iface):
    """The panel, opened as an operator opens it."""
    next(
        action for action in iface.plugins.actions() if action.objectName() == "fleet_observations"
    ).trigger()
    return (
        iface.findChild(QListView, "fleet_observation_list")
        .window()
        .findChild(object, "fleet_observation_dock")
    )


@pytest.fixture
def seen(loop, operator, photo, dock):
    """r1 has told of a bin beside it, and sent an image of it."""
    loop.start_robot("r1", (20, 8, 0), more=["--see", "24,10,bin-7", "--image", str(photo)])
    operator.connect_to(loop, ["r1"])
    operator.wait("two observations", lambda: len(operator.desk.state.observations) == 2, 20)
    return {one.op: one for one in operator.desk.state.observations}


def layer():
    found = QgsProject.instance().mapLayersByName("Observations")
    return found[0] if found else None


def rows(name="state"):
    return {f["observation"]: f[name] for f in layer().getFeatures()} if layer() else {}


def choose(dock, number):
    """Click an observation in the list."""
    dock.refresh()
    at = dock.list.visualRect(dock.model.index(dock.model.row_of(number))).center()
    QTest.mouseClick(dock.list.viewport(), Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at)
    assert dock.chosen == number


def click(button):
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)


def objects_on_map(loop):
    """Ask for a map as a robot does; return the objects on it that robots saw, by their ids."""
    with connect(f"{loop.address}/robot?robot=looker") as socket:
        maps = []
        # One after the other: a newer map makes one void that is still on its way.
        for number, (method, params) in enumerate(
            (("Ready", {"magic": 7}), ("GetMap", {"x": 24.0, "y": 10.0, "area": 400.0}))
        ):
            socket.send(json.dumps({"jsonrpc": "2.0", "id": number, "method": method, "params": params}))
            while len(maps) <= number:
                told = json.loads(socket.recv(timeout=BUSY * 10))
                if told.get("method") == "SetMap":
                    maps.append(decode(base64.b64decode(told["params"]["map"])))
                    socket.send(json.dumps({"jsonrpc": "2.0", "id": told["id"], "result": {}}))
        return {o.ext["id"]: o for o in maps[-1].obstacles if o.ext.get("src", "").startswith("observation")}


def test_objects_and_images_are_listed_and_on_the_map(seen, dock, operator):
    image, thing = seen["SendImage"].observation, seen["SetObject"].observation
    operator.wait("the layer", lambda: rows() == {image: "pending", thing: "pending"}, 5)
    operator.wait("the thumbnail", lambda: rows("thumbnail").get(image), 10)
    small = QImage(rows("thumbnail")[image])
    assert (small.width(), small.height()) == (256, 192)
    assert QColor(small.pixel(100, 100)).getRgb()[:3] == (200, 30, 30)
    assert dock.windowTitle() == "Observations (2)"
    places = {f["observation"]: f.geometry().asPoint() for f in layer().getFeatures()}
    assert (places[thing].x(), places[thing].y()) == (640444.0, 5193490.0)
    renderer = layer().renderer()
    assert renderer.symbols(QgsRenderContext())
    # The object shows the image that was taken of it.
    choose(dock, thing)
    assert not dock.form.picture.pixmap().isNull()


def test_an_accepted_object_is_in_the_next_map_with_what_the_operator_wrote(seen, dock, loop, operator):
    number = seen["SetObject"].observation
    choose(dock, number)
    dock.form.semantics.setFocus()
    QTest.keyClick(dock.form.semantics.lineEdit(), Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
    QTest.keyClicks(dock.form.semantics.lineEdit(), "litter bin")
    dock.form.height_m.setValue(1.1)
    dock.form.radius.setValue(0.4)
    click(dock.form.accept)
    operator.wait(
        "the review",
        lambda: operator.desk.state.observations.get(number).state is ObservationState.ACCEPTED,
        5,
    )
    told = operator.desk.state.observations.get(number)
    assert (told.semantics, told.height, told.radius, told.reviewed_by) == ("litter bin", 1.1, 0.4, "anna")
    operator.wait("the layer", lambda: rows().get(number) == "accepted", 5)
    bin_7 = objects_on_map(loop)["bin-7"]
    assert bin_7.semantics == "litter bin"
    assert bin_7.height[0] == pytest.approx(1.1)
    # What is done leaves the list, and the next one that waits is looked at.
    operator.wait("the next", lambda: dock.chosen == seen["SendImage"].observation, 5)
    assert dock.model.row_of(number) is None


def test_a_rejected_object_is_on_no_map_and_a_review_can_be_revised(seen, dock, loop, operator):
    number = seen["SetObject"].observation
    choose(dock, number)
    dock.form.reason.setText("only a shadow")
    click(dock.form.reject)
    operator.wait(
        "the review",
        lambda: operator.desk.state.observations.get(number).state is ObservationState.REJECTED,
        5,
    )
    assert operator.desk.state.observations.get(number).reason == "only a shadow"
    assert objects_on_map(loop) == {}
    click(dock.reviewed)
    choose(dock, number)
    assert "State: rejected, by anna." in dock.form.about.text()
    click(dock.form.accept)
    operator.wait(
        "the other way",
        lambda: operator.desk.state.observations.get(number).state is ObservationState.ACCEPTED,
        5,
    )
    assert "bin-7" in objects_on_map(loop)


def test_an_image_is_reviewed_without_attributes(seen, dock, operator):
    number = seen["SendImage"].observation
    choose(dock, number)
    assert not dock.form.height_m.isEnabled()
    click(dock.form.accept)
    operator.wait(
        "the review",
        lambda: operator.desk.state.observations.get(number).state is ObservationState.ACCEPTED,
        5,
    )


def test_a_double_click_goes_there_and_choosing_reviews_nothing(seen, dock, operator):
    number = seen["SetObject"].observation
    choose(dock, number)
    at = dock.list.visualRect(dock.list.currentIndex()).center()
    QTest.mouseDClick(dock.list.viewport(), Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at)
    centre = operator.canvas.center()
    assert (round(centre.x()), round(centre.y())) == (640444, 5193490)
    assert operator.canvas.extent().height() < 100
    assert operator.desk.state.observations.get(number).state is ObservationState.PENDING


def test_without_a_link_a_review_is_refused_and_nothing_written_is_lost(seen, dock, operator):
    number = seen["SetObject"].observation
    choose(dock, number)
    dock.form.reason.setText("keep me")
    operator.desk.close_link()
    said = []
    operator.desk.messages.posted.connect(lambda text, _: said.append(text))
    click(dock.form.accept)
    assert "NOT reviewed" in said[0]
    assert dock.form.reason.text() == "keep me"
    assert dock.form.accept.isEnabled()


def test_nothing_is_left_after_unload(seen, dock, operator, plugin, photo):
    operator.wait("the thumbnail", lambda: any(rows("thumbnail").values()), 10)
    (file,) = [name for name in rows("thumbnail").values() if name]
    plugin.unload()
    assert layer() is None
    assert QImage(file).isNull()
