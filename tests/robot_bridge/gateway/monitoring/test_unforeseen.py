"""Errors that nobody foresaw, as the log and whoever met them are told."""

import logging
import re

from robot_bridge.core.logs import log_unforeseen

log = logging.getLogger("robot_bridge.test")


def told(secret):
    try:
        raise ValueError(secret)
    except ValueError:
        return log_unforeseen(log, "desk of Ada")


def test_the_log_says_what_happened_under_the_number_that_is_told(caplog):
    text = told("the secret")
    pattern = r"internal error ([0-9a-f]{8}); the gateway's log says more under this number"
    number = re.fullmatch(pattern, text)[1]
    assert f"desk of Ada: internal error {number}" in caplog.text
    assert "ValueError: the secret" in caplog.text


def test_each_has_a_number_of_its_own():
    assert told("a") != told("a")
