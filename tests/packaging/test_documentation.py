"""The guides as a site: built without a warning, with the API in it, and nothing from elsewhere."""

from __future__ import annotations

import importlib.util
import re
import subprocess
import sys

import pytest

from tools.documentation.github_markdown import on_page_markdown

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("mkdocs") is None, reason="the extra docs is not installed"
)
LOADED = re.compile(r"<(?:script|link|img|iframe)\b[^>]*\b(?:src|href)=\"?((?:https?:)?//[^\" >]+)")


@pytest.fixture(scope="module")
def site(root, tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "tools.documentation", "--output", folder]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "WARNING" not in done.stderr
    return folder


def test_every_guide_is_a_page_of_it_and_in_its_menu(site, root):
    menu = (root / "mkdocs.yml").read_text(encoding="utf-8")
    guides = [guide.relative_to(root) for guide in (root / "docs").glob("*.md")]
    assert [guide for guide in guides if not (site / guide.with_suffix(".html")).is_file()] == []
    assert [guide for guide in guides if f"- {guide}\n" not in menu] == []


def test_no_page_loads_anything_from_elsewhere(site):
    pages = {page: page.read_text(encoding="utf-8") for page in site.rglob("*.html")}
    assert len(pages) > 40
    assert {page.name: found for page, text in pages.items() if (found := LOADED.findall(text))} == {}
    # The theme's script fetches what draws diagrams from elsewhere, if there is one.
    assert not [page for page, text in pages.items() if 'class="mermaid"' in text]
    styles = "".join(file.read_text(encoding="utf-8") for file in site.rglob("*.css"))
    assert not re.search(r"url\(\"?(https?:)?//", styles)


def test_the_api_and_the_search_hold_what_the_code_says(site):
    text = (site / "docs" / "api.html").read_text(encoding="utf-8")
    names = ("core.robotmap.model.Border", "protocol.codec", "links.base.adapter", "core.messages.robots")
    for name in names:
        assert f'id="robot_bridge.{name}"' in text
    assert "The rectangle that a map covers" in text
    assert "geofence" in (site / "search" / "search_index.json").read_text(encoding="utf-8")


def test_markdown_of_github_is_said_in_that_of_python():
    page = "Text:\n- a\n- b\n  on\n- c\n```json desk-sends\n- code\n```\n"
    assert on_page_markdown(page) == "Text:\n\n- a\n- b\n  on\n- c\n```json\n- code\n```\n"
