"""What a layer and the review of observations show, without a gateway."""

import dataclasses

import pytest
from fleet_supervisor.plugin.observations.observation_dock import PICTURE, ReviewForm
from fleet_supervisor.plugin.observations.observation_views import (
    FIELDS,
    observation_text,
    style_observations,
)
from fleet_supervisor.robot_bridge.core.messages.records import ObservationReport, ObservationState
from qgis.core import QgsExpression, QgsExpressionContext, QgsFeature, QgsVectorLayer
from qgis.PyQt.QtGui import QColor, QImage


@pytest.fixture
def layer(qgis_app):
    fields = "&".join(f"field={field}" for field in FIELDS.split(","))
    made = QgsVectorLayer(f"Point?crs=EPSG:32633&{fields}", "Observations", "memory")
    style_observations(made)
    return made


def context_of(layer, state):
    feature = QgsFeature(layer.fields())
    feature["object"], feature["state"], feature["thumbnail"] = "cone-7", state, ""
    context = QgsExpressionContext()
    context.setFeature(feature)
    return context


@pytest.mark.parametrize(
    ("state", "words"),
    [("pending", "to be reviewed"), ("accepted", "accepted"), ("rejected", "rejected")],
)
def test_a_state_is_told_in_the_operators_words_wherever_it_is_read(layer, state, words):
    context = context_of(layer, state)
    expression = QgsExpression(layer.displayExpression())
    assert expression.evaluate(context) == f"cone-7 · {words}", expression.evalErrorString()
    tip = QgsExpression.replaceExpressionText(layer.mapTipTemplate(), context)
    assert "<b>cone-7</b>" in tip
    assert f"<br>{words} · " in tip
    (rule,) = (
        one for one in layer.renderer().rootRule().children() if f"'{state}'" in one.filterExpression()
    )
    assert rule.label() == words


def test_no_text_of_a_robot_is_html_in_the_map_tip(layer):
    context = context_of(layer, "pending")
    feature = context.feature()
    feature["object"], feature["label"] = "<img src='http://h/x'>", "a & b <script>"
    context.setFeature(feature)
    tip = QgsExpression.replaceExpressionText(layer.mapTipTemplate(), context)
    assert "<b>&lt;img src='http://h/x'&gt;</b> a &amp; b &lt;script&gt;<br>" in tip


@pytest.mark.parametrize("size", [(640, 360), (300, 400)])
def test_no_image_makes_the_form_broader_than_it_may_be(qgis_app, tmp_path, size):
    image = QImage(*size, QImage.Format.Format_RGB32)
    image.fill(QColor(200, 30, 30))
    file = str(tmp_path / "image.png")
    image.save(file)
    form = ReviewForm()
    form.show_picture(file)
    shown = form.picture.pixmap()
    assert shown.width() <= PICTURE.width()
    assert shown.height() <= PICTURE.height()
    assert shown.width() / shown.height() == pytest.approx(size[0] / size[1], rel=0.05)
    assert "image.png" in form.picture.toolTip()
    form.show_picture("")
    assert form.picture.pixmap() is None or form.picture.pixmap().isNull()
    assert form.picture.toolTip() == ""


def test_what_is_missing_is_told_and_accepted_as_such(qgis_app):
    doubt = ObservationReport(
        *(7, "r1", "SetObject", "missing-1", 3.0, 4.0, 0.0, ObservationState.PENDING),
        label="bench",
        radius=0.8,
        doubts="furniture:14",
    )
    assert "not there any more: bench" in observation_text(doubt)
    form = ReviewForm()
    form.show_report(doubt, (), pending=False)
    assert "looks through bench (furniture:14) of its map" in form.about.text()
    assert form.accept.toolTip().startswith("It is gone")
    request = form.request(accept=True)
    assert (request.semantics, request.height, request.radius) == (None, None, None)
    form.show_report(dataclasses.replace(doubt, doubts=None), (), pending=False)
    assert form.accept.toolTip().startswith("It stands there")
