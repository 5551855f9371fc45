"""What the bridge's tests share: the sample site, and the rig that runs the real programs."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).with_name("rig")))


@pytest.fixture(scope="session")
def sample_site(root) -> Path:
    """The folder of the published sample site: 200 m × 160 m, reached within 0.20 m."""
    return root / "resources" / "sample_site"
