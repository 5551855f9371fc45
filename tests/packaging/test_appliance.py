"""The small computer, on a bare Debian booted by a real systemd: set up, run again, upgraded, taken away."""

from __future__ import annotations

import fcntl
import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.support.systemd_world import HAS_SYSTEMD, NO_SYSTEMD, World, world_of

HERE = Path(__file__).parent
PLACE = Path("/var/tmp/fleet-appliance-bookworm")
INSTALL = "/srv/fleet/tools/appliance/install.sh"
OFFLINE = {
    # What the program needs is in the environment that the root folder comes with.
    "PIP_NO_DEPS": "1",
    "PIP_NO_BUILD_ISOLATION": "false",  # pip takes it for the value of "isolation"
}
ASK = """
import json, ssl, sys, urllib.request
context = ssl.create_default_context(cafile="/etc/robot-bridge/tls/ca.pem")
print(urllib.request.urlopen("https://localhost:8765" + sys.argv[1], context=context).read().decode())
"""


class Computer:
    """A small computer: ``install`` runs the program there."""

    def __init__(self, world: World) -> None:
        self.world = world

    def install(self, *options: str) -> subprocess.CompletedProcess[str]:
        environment = [f"{name}={value}" for name, value in OFFLINE.items()]
        return self.world.run("env", *environment, INSTALL, *options, "--wheels", "/srv/wheels")

    def ask(self, page: str) -> str:
        """Return what the gateway answers over TLS, trusting the site's authority alone."""
        return self.world.do("/opt/robot-bridge/bin/python", "-c", ASK, page)

    def sh(self, line: str) -> str:
        return self.world.do("/bin/sh", "-c", line)


@pytest.fixture(scope="module")
def bare(tmp_path_factory, root):
    """A computer with Debian and nothing of ours."""
    if not HAS_SYSTEMD:
        pytest.skip(NO_SYSTEMD)
    if not (PLACE / ".environment").exists() and shutil.which("debootstrap") is None:
        pytest.skip("there is no debootstrap, which builds the Debian to install into; run: make setup")
    built = subprocess.run([HERE / "appliance_root.sh"], capture_output=True, text=True, check=False)
    if built.returncode != 0:
        pytest.skip(f"the Debian to install into could not be built: {built.stderr[-1000:]}")
    folder = tmp_path_factory.mktemp("appliance")
    with (
        PLACE.with_name(f"{PLACE.name}.lock").open("w") as lock,
        world_of(HERE / "appliance_in_systemd.sh", folder, root, PLACE) as world,
    ):
        fcntl.flock(lock, fcntl.LOCK_SH)  # nobody builds it anew meanwhile
        world.until(
            lambda: world.do("systemctl", "is-system-running").strip() in ("running", "degraded"),
            lambda: (folder / "said").read_text(),
        )
        yield Computer(world)


@pytest.fixture(scope="module")
def set_up(bare):
    done = bare.install("--no-maps", "--open", "5055")
    assert done.returncode == 0, done.stdout + done.stderr
    bare.said = done.stdout
    return bare


def test_one_command_sets_up_all(set_up):
    assert json.loads(set_up.ask("/healthz"))["site"]["id"] == "sample"
    assert "<html" in set_up.ask("/field")
    assert "ready: https://small.local:8765/field" in set_up.said
    assert "FAULT" not in set_up.said and "other computers, with TLS and accounts" in set_up.said
    running = "robot-bridge avahi-daemon nftables robot-bridge-backup.timer"
    assert set_up.sh(f"systemctl is-active {running}").split() == ["active"] * 4
    enabled = set_up.sh(f"systemctl is-enabled {running} chrony")
    assert enabled.split() == ["enabled"] * 5
    assert set_up.sh("systemctl --failed --no-legend") == ""
    rules = set_up.sh("nft list table inet robot_bridge")
    assert "policy drop" in rules and "tcp dport { 22, 5055, 8765 } accept" in rules
    assert set_up.sh("stat -c '%a %U' /root/robot-bridge-admin.token") == "600 root\n"
    assert set_up.sh("cat /root/robot-bridge-admin.token").startswith("fleet_op_")
    advice = re.search("another operator, as root: (.+)", set_up.said).group(1)
    assert set_up.sh(advice.replace("NAME", "Ada")).startswith("fleet_op_")
    secrets = "ca-key.pem server-key.pem /var/lib/robot-bridge-backups/*"
    assert set_up.sh(f"cd /etc/robot-bridge/tls && stat -c '%a %U' {secrets}").splitlines() == [
        "600 root",
        "600 robot-bridge",
        "600 robot-bridge",
    ]


def test_a_second_run_changes_nothing(set_up):
    look = (
        "touch -d '1 second ago' /tmp/now; "
        "find /etc /root /var/lib/robot-bridge/site -type f | sort | xargs sha256sum; "
        "nft list table inet robot_bridge; systemctl show robot-bridge -p MainPID -p NRestarts"
    )
    before = set_up.sh(look)
    done = set_up.install()
    assert done.returncode == 0, done.stdout + done.stderr
    assert set_up.sh("find /opt -newer /tmp/now -type f ! -name '*.pyc'") == ""
    assert set_up.sh(look) == before


def test_another_version_comes_with_upgrade_and_goes_where_it_does_not_work(set_up):
    rows = "/var/lib/robot-bridge/fleet.db"
    set_up.sh("sed -i 's/^version = .*/version = \"7.7.7\"/' /srv/fleet/pyproject.toml")
    refused = set_up.install()
    assert refused.returncode == 1 and "install.sh --upgrade" in refused.stderr
    done = set_up.install("--upgrade")
    assert done.returncode == 0, done.stdout + done.stderr
    assert json.loads(set_up.ask("/healthz"))["version"] == "7.7.7"

    set_up.sh("sed -i 's/7.7.7/8.8.8/' /srv/fleet/pyproject.toml")
    set_up.sh("echo 'raise ImportError(\"broken\")' >> /srv/fleet/robot_bridge/gateway/app.py")
    failed = set_up.install("--upgrade")
    assert failed.returncode == 1
    assert "the old one runs on" in failed.stderr and "broken" in failed.stderr, failed.stdout + failed.stderr
    assert json.loads(set_up.ask("/healthz"))["version"] == "7.7.7"
    assert set_up.sh(f"ls {rows} /opt").split() == [rows, "/opt:", "robot-bridge"]
    assert set_up.sh("systemctl is-active robot-bridge") == "active\n"


def test_what_is_wrong_is_named_with_what_to_do(set_up):
    for options, said in {
        ("--database", "oracle"): "Give sqlite or postgresql.",
        ("--site", "/nowhere"): "Give the folder of a published site",
        ("--port",): "--port needs a value",
        ("--open", "ssh"): "Give a number from 1 to 65535.",
        ("--fly",): "there is no option --fly",
        ("--database", "postgresql"): "this site is kept in sqlite",
    }.items():
        done = set_up.world.run(INSTALL, *options)
        assert done.returncode == 1 and said in done.stderr, options


def test_it_is_taken_away_but_for_the_data_and_then_with_it(set_up):
    done = set_up.install("--remove")
    assert done.returncode == 0, done.stdout + done.stderr
    gone = "/opt/robot-bridge* /etc/systemd/system/robot-bridge* /etc/avahi/services/robot*"
    assert set_up.sh(f"ls -d {gone}") == ""
    assert set_up.sh("nft list tables") == "table inet filter\n"
    assert "nftables.d" not in set_up.sh("cat /etc/nftables.conf")
    assert set_up.sh("systemctl --failed --no-legend; pgrep -u robot-bridge") == ""
    kept = "/etc/robot-bridge /var/lib/robot-bridge /var/lib/robot-bridge-backups"
    assert set_up.sh(f"ls -d {kept}").split() == kept.split()
    done = set_up.install("--purge")
    assert done.returncode == 0, done.stdout + done.stderr
    assert set_up.sh(f"ls -d {kept} /root/robot-bridge*; getent passwd robot-bridge") == ""
