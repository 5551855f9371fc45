"""Which ``Host`` headers the gateway's own pages are shown for."""

from __future__ import annotations

import pytest

from robot_bridge.gateway.auth.port import host_fault

OURS = ("fleet.example.org", "*.site.example")


@pytest.mark.parametrize(
    "host",
    [
        "127.0.0.1:8765",
        "localhost:8765",
        "LOCALHOST",
        "[::1]:8765",
        "192.168.1.20",
        "fleet.example.org:8765",
        "Fleet.Example.Org.",
        "gate.site.example",
    ],
)
def test_an_address_this_computer_and_its_names_are_ours(host):
    assert host_fault([host], OURS) is None


@pytest.mark.parametrize(
    "host",
    [
        "evil.example",
        "localhost.evil.example",
        "127.0.0.1.evil.example",
        "fleet.example.org.evil.example",
        "a.b.site.example",
        "site.example",
        "[::1",
        "",
        "127.0.0.1@evil.example",
    ],
)
def test_any_other_name_is_refused_and_the_setting_is_named(host):
    assert "'hosts' in [limits] of site.toml" in (host_fault([host], OURS) or "")


def test_two_hosts_are_none():
    assert "several Host headers" in (host_fault(["127.0.0.1", "evil.example"], OURS) or "")


def test_a_request_without_one_comes_from_no_browser():
    assert host_fault([], OURS) is None
