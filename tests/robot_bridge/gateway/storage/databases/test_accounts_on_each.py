"""What a gateway goes by to see that accounts have changed, on each kind of database."""

from __future__ import annotations

from robot_bridge.gateway.auth import accounts
from robot_bridge.gateway.auth.accounts import Role
from robot_bridge.gateway.storage.database import run_once


def test_whatever_concerns_who_is_let_in_changes_the_fingerprint(url):
    def run(work, *arguments):
        return run_once(url, work, *arguments)

    steps = [
        (accounts.add_operator, "Ada", Role.VIEWER, 1.0),
        (accounts.add_operator, "Žofie", Role.VIEWER, 1.0),
        (accounts.set_role, "Ada", Role.SUPERVISOR),
        (accounts.rotate_operator, "Ada", 2.0),
        (accounts.revoke_operator, "Ada", 3.0),
        (accounts.issue_robot_token, "r1", 4.0),
        (accounts.revoke_robot_token, "r1", 5.0),
        (accounts.add_link, "vda", ["agv-*"], 6.0),
        (accounts.set_robots, "vda", ["agv-1"]),
    ]
    seen = [run(accounts.accounts_fingerprint)]
    for step in steps:
        run(*step)
        seen.append(run(accounts.accounts_fingerprint))
    assert len(set(seen)) == len(steps) + 1
    assert run(accounts.accounts_fingerprint) == seen[-1]
