"""An operator's walk through the desk, by mouse and keyboard, in QGIS Desktop on a virtual screen."""

from __future__ import annotations

STEPS = [
    "offer",
    "tour-site",
    "tour-link",
    "tour-send",
    "tour-commands",
    "address",
    "connected",
    "card",
    "selected",
    "cone-draft",
    "driving",
    "reached",
    "route-drawn",
    "route-changed",
    "route-ready",
    "route-driving",
    "aborted",
    "way-to-mouse",
    "way-shown",
    "round-keepout",
    "all-aborted",
    "emergency",
    "clear",
    "cleared",
    "nothing-to-send",
    "send-pressed",
    "conflict",
    "refused",
    "replay",
]


def test_each_step_happens_on_the_screen_and_at_the_gateway_and_nothing_is_cut_off(take_pictures):
    take_pictures("operator", STEPS, 50_000)


def test_it_says_what_is_missing(walk, tmp_path):
    done = walk("operator", PATH=str(tmp_path))
    assert done.returncode == 1
    assert "walkthrough: error: there is no display and no Xvfb to make one; run: make setup" in done.stderr


def test_a_walk_that_is_not_there_is_told(walk):
    done = walk("stroll")
    assert done.returncode == 2
    assert "there is no walk stroll; there are operator, qgis, processing" in done.stderr
