"""What the plugin asks of QGIS is there in QGIS 4 on Qt 6, held against stubs: no Debian builds that yet."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest
from flake8_qgis import Plugin

from tools.qgis4_types import PACKAGE, complaints

QT_6 = ("QGS103", "QGS104", "QGS107", "QGS4")
WRONG = {
    "an_argument": ("QtWidgets import QWidget", "QWidget().setFixedWidth(3.5)", '"float"; expected "int"'),
    "an_overload": ("QtGui import QPainter", "QPainter().drawPoint(0.5, 2)", 'of "QPainter" matches'),
    "a_method": (
        "QtGui import QFont, QFontMetrics",
        "QFontMetrics(QFont()).width('a')",
        '"QFontMetrics" has no attribute "width"',
    ),
    "a_method_of_what_may_be_none": (
        "QtGui import QPainter",
        "def paint(painter: QPainter | None):\n    painter.matrix()",
        '"QPainter" of "QPainter | None" has no attribute "matrix"',
    ),
    "a_drop": (
        "QtGui import QDropEvent",
        "def dropEvent(self, event: QDropEvent):\n    event.pos()",
        '"QDropEvent" has no attribute "pos"',
    ),
    "a_comparison": (
        "QtCore import Qt",
        "def ticked(state: int) -> bool:\n    return state == Qt.CheckState.Checked",
        "Non-overlapping equality check",
    ),
    "an_enum_as_a_number": (
        "QtCore import Qt",
        "int(Qt.Orientation.Vertical)",
        'argument type "Orientation"',
    ),
    "an_enum_and_a_number": (
        "QtCore import Qt",
        "Qt.WindowState.WindowActive | 4",
        '("WindowState" and "int")',
    ),
    "an_enum_among_numbers": (
        "QtCore import Qt",
        "def pressed(button: Qt.MouseButton) -> bool:\n    return button in (1, 2)",
        'element type: "MouseButton"',
    ),
    "an_operand": ("QtCore import QPoint", "QPoint(1, 2) + 3", '("QPoint" and "int")'),
    "an_index": ("QtCore import QPoint", "QPoint(1, 2)[0]", '"QPoint" is not indexable'),
    "an_enum": ("core import Qgis", "Qgis.GeometryType.Dot", '"type[GeometryType]" has no attribute "Dot"'),
    "a_class": ("core import QgsMapLayerRegistry", "", 'has no attribute "QgsMapLayerRegistry"'),
    "gone_from_qgis": ("core import QgsProject", "QgsProject.instance().visibilityPresets()", '"QgsProject"'),
}
"""What is imported of qgis or qgis.PyQt, what is done with it, and what is said of that."""
RIGHT = {
    "an_old_name": ("core import QgsWkbTypes", "QgsWkbTypes.GeometryType.PointGeometry"),
    "a_moved_class": ("QtWidgets import QAction", "QAction().trigger()"),
    "a_subclass": (
        "QtCore import QEvent, QObject",
        "def eventFilter(watched: QObject, event: QEvent):\n    return event.key()",
    ),
    "flags": ("core import QgsMapLayer", "QgsMapLayer.StyleCategories()"),
}


@pytest.fixture(scope="module")
def found(root, tmp_path_factory) -> list[str]:
    """What is found in the plugin, in what makes its styles and its sample site, and in the samples above."""
    samples = tmp_path_factory.mktemp("samples")
    for name, (imported, text, *_) in (WRONG | RIGHT).items():
        package = "qgis.PyQt" if imported.startswith("Qt") else "qgis"
        (samples / f"{name}.py").write_text(f"from {package}.{imported}\n{text}\n", encoding="utf-8")
    return complaints(root, samples)


def test_all_that_the_plugin_asks_of_qgis_is_there(root, found):
    assert [line for line in found if line.startswith((PACKAGE, str(root)))] == []


@pytest.mark.parametrize("name", WRONG)
def test_what_is_not_there_is_found(found, name):
    said = [line for line in found if Path(line.split(":")[0]).stem == name]
    assert any(WRONG[name][2] in line for line in said), said or "nothing"


@pytest.mark.parametrize("name", RIGHT)
def test_what_is_there_is_not_named(found, name):
    assert [line for line in found if Path(line.split(":")[0]).stem == name] == []


def test_what_the_stubs_do_not_know_works(root):
    """Run on PyQt6 in a process of its own: what the check lets pass though the stubs do not have it."""
    program = """
from pathlib import Path
from PyQt6.QtCore import QByteArray, QDataStream, QIODevice, QLineF, QTranslator
from PyQt6.QtGui import QColor, QImage, QPainter, QPainterPath

pixels = bytearray(4 * 8 * 8)
image = QImage(memoryview(pixels), 8, 8, 32, QImage.Format.Format_ARGB32_Premultiplied)
painter = QPainter(image)
painter.setPen(QColor("red"))
painter.drawLines([QLineF(0, 0, 7, 0), QLineF(0, 7, 7, 7)])
painter.end()
assert QImage(image).pixelColor(3, 7) == QColor("red")

data, path, copy = QByteArray(), QPainterPath(), QPainterPath()
path.lineTo(3, 4)
QDataStream(data, QIODevice.OpenModeFlag.WriteOnly) << path
QDataStream(data) >> copy
assert copy == path

translator, texts = QTranslator(), Path(TEXTS).read_bytes()
assert translator.loadFromData(texts)
assert translator.translate("FleetSupervisor", "Connect") == "Kapcsolódás"
"""
    texts = root / "resources" / "translations" / "fleet_supervisor_hu.qm"
    program = program.replace("TEXTS", repr(str(texts)))
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_no_rule_of_flake8_qgis_on_qt_6_is_broken(root):
    files = [root / "__init__.py", *(root / "plugin").rglob("*.py"), *(root / "resources").rglob("*.py")]
    assert len(files) > 100
    assert [fault for file in files for fault in broken_rules(file)] == []


@pytest.mark.parametrize(
    ("statement", "rule"),
    [
        ("from PyQt5.QtCore import Qt", "QGS103"),
        ("dialog.exec_()", "QGS107"),
        ("from qgis.PyQt.QtCore import QRegExp\nQRegExp('a')", "QGS406"),
        ("from qgis.PyQt.QtCore import QVariant\nQVariant()", "QGS410"),
        ("from qgis.PyQt.QtCore import QVariant\nQVariant.Int", "QGS402"),
    ],
)
def test_a_broken_rule_is_found(tmp_path, statement, rule):
    (tmp_path / "tool.py").write_text(statement + "\n", encoding="utf-8")
    assert any(f": {rule} " in fault for fault in broken_rules(tmp_path / "tool.py"))


def broken_rules(file: Path) -> list[str]:
    """Return what flake8-qgis finds: rules on Qt 6, and on importing and running Qt by ways that are in both.

    By the plugin itself: flake8 looks for all that is wrong, and chooses from it afterwards.
    """
    found = Plugin(ast.parse(file.read_text(encoding="utf-8"))).run()
    return [f"{file}:{line}: {text}" for line, _, text, _ in found if text.startswith(QT_6)]
