"""What is told to operators of many robots, and what is no file of settings."""

from __future__ import annotations

import msgspec
import pytest

from robot_bridge.links.base.adapter import MOST_FAULTS, summary
from robot_bridge.links.base.errors import LinkError
from robot_bridge.links.base.settings import LARGEST_FILE, read_settings


def test_of_many_faults_the_first_are_told_and_the_others_counted():
    assert summary([]) is None
    assert summary([f"r{n}" for n in range(MOST_FAULTS + 4)]) == "r0; r1; r2 (and 4 more)"


def test_a_file_that_is_no_file_of_settings_is_not_read(tmp_path):
    file = tmp_path / "link.toml"
    file.write_text("#" * (LARGEST_FILE + 1))
    with pytest.raises(LinkError, match="it is no file of settings"):
        read_settings(file, "none", msgspec.Struct)
