"""A link in a network with DDS Security: certified robots are led, and nobody else is heard or heard out."""

from __future__ import annotations

import json
import shutil
import subprocess
import urllib.request
from pathlib import Path

import pytest
import tomllib

from tests.support.bridge.bridge_programs import wait_until
from tests.support.errors import StageError
from tests.support.patience import BUSY
from tests.support.processes import Processes
from tests.support.robots.ros_nodes import own_domain
from tests.support.secure_dds import Keystore, fast_robot, secure_dds

pytest.importorskip("rosbags", reason="rosbags is not installed; run make setup")

from robot_bridge.links.base.errors import LinkError
from robot_bridge.links.ros.errors import RosError
from robot_bridge.links.ros2.adapter import load
from robot_bridge.links.ros2.dds import DdsSettings, Participant
from robot_bridge.links.ros2.security import SecuritySettings

ROBOT = Path(__file__).resolve().parents[4] / "tests" / "support" / "secure_robot.py"
DOMAIN = own_domain()
ENCLAVE = {
    "identity_ca": "identity_ca.cert.pem",
    "certificate": "cert.pem",
    "private_key": "key.pem",
    "governance": "governance.p7s",
    "permissions": "permissions.p7s",
}


@pytest.fixture(scope="module")
def keys(tmp_path_factory):
    """What the site's authority has signed."""
    keys = Keystore(tmp_path_factory.mktemp("keys") / "site")
    keys.enclave("robot")
    keys.enclave("link", never=("rt/r2/cmd_vel",))
    return keys


def settings_of(folder: Path, domain: int = DOMAIN, **changed: str) -> str:
    files = {key: str(folder / name) for key, name in ENCLAVE.items()} | changed
    lines = "\n".join(f'{key} = "{name}"' for key, name in files.items())
    return f'[ros2]\ndomain = {domain}\nrange = "localhost"\n\n[ros2.security]\n{lines}\n'


# --- The settings ---


def test_the_guides_table_can_be_used(guide, keys, tmp_path):
    table = tomllib.loads(guide("security"))["ros2"]["security"]
    for key, name in table.items():
        if key != "plugins":
            (tmp_path / name).parent.mkdir(exist_ok=True)
            shutil.copy(keys.folder / "link" / Path(name).name, tmp_path / name)
    assert set(table) == set(SecuritySettings.__struct_fields__)
    file = tmp_path / "nav2.toml"
    file.write_text(guide("security").replace(table["plugins"], "."), encoding="utf-8")
    load(file)


@pytest.mark.parametrize(
    ("key", "content", "words"),
    [
        *((key, None, "cannot be read: No such file") for key in ENCLAVE),
        ("certificate", "none", "is no PEM file"),
        ("governance", "<dds/>", "is not signed"),
        ("permissions", "<dds/>", "is not signed"),
    ],
)
def test_a_file_that_cannot_be_used_is_named_with_its_key(keys, tmp_path, key, content, words):
    bad = tmp_path / "bad"
    if content is not None:
        bad.write_text(content)
    file = tmp_path / "nav2.toml"
    file.write_text(settings_of(keys.folder / "link", **{key: str(bad)}))
    with pytest.raises(LinkError, match=rf"nav2.toml: ros2.security.{key} = '{bad}' {words}"):
        load(file)


def test_the_key_of_another_certificate_is_named(keys, tmp_path):
    file = tmp_path / "nav2.toml"
    another = keys.folder / "robot" / "key.pem"
    file.write_text(settings_of(keys.folder / "link", private_key=str(another)))
    with pytest.raises(LinkError, match=r"ros2.security.private_key = '.*' is not the key of certificate"):
        load(file)


def test_a_key_with_a_password_is_refused_and_asks_nobody(keys, tmp_path):
    locked = tmp_path / "locked.pem"
    command = ["openssl", "ec", "-aes256", "-passout", "pass:x", "-in", keys.folder / "link" / "key.pem"]
    subprocess.run([*command, "-out", locked], check=True, capture_output=True)
    file = tmp_path / "nav2.toml"
    file.write_text(settings_of(keys.folder / "link", private_key=str(locked)))
    with pytest.raises(LinkError, match=r"ros2.security.private_key.*without a password"):
        load(file)


def test_nothing_is_joined_where_cyclonedds_has_no_security(keys):
    pytest.importorskip("cyclonedds", reason="cyclonedds is not installed; run make setup")
    security = SecuritySettings(**ENCLAVE).beside(keys.folder / "link")
    with pytest.raises(RosError, match="was built without DDS Security"):
        Participant(DdsSettings(DOMAIN, "localhost", security=security))


# --- A network with it ---


@pytest.fixture(scope="module")
def dds():
    try:
        return secure_dds()
    except StageError as error:
        pytest.skip(str(error))


@pytest.fixture(scope="module")
def network(dds, keys, start_bridge, impatient_site, tmp_path_factory):
    """A gateway, a link with credentials and one without, and robots with and without them."""
    folder = tmp_path_factory.mktemp("secured")
    intruder = Keystore(folder / "strangers").enclave("intruder")
    member, plugins = keys.folder / "robot", str(dds.plugins)
    bridge = start_bridge(impatient_site)
    address = f'[gateway]\nurl = "{bridge.address}/link"\n'
    (folder / "safe.toml").write_text(address + settings_of(keys.folder / "link", plugins=plugins))
    (folder / "open.toml").write_text(f'{address}[ros2]\ndomain = {DOMAIN}\nrange = "localhost"\n')
    environment = dds.environment()
    # A robot finds the plug-ins by their names, as it does where ROS is installed.
    beside = environment | {"LD_LIBRARY_PATH": f"{environment['LD_LIBRARY_PATH']}:{plugins}"}
    with Processes(folder / "logs") as processes:
        for name, enclave in {"r1": member, "r2": member, "intruder": intruder, "anybody": None}.items():
            options = ["--domain", str(DOMAIN), *(["--enclave", enclave] if enclave else [])]
            processes.start(name, [dds.python, ROBOT, name, *options], env=beside)
            processes.wait_for_line(name, '"up"', BUSY * 10)
        for link in ("safe", "open"):
            command = [dds.python, "-m", "robot_bridge", "link", "ros2", "--config", folder / f"{link}.toml"]
            processes.start(link, command, env=environment)
        yield bridge, processes
    bridge.end()


def events(processes, name):
    lines = processes.log(name).read_text(encoding="utf-8").splitlines()
    return [json.loads(line)["event"] for line in lines if line.startswith("{")]


def reported(desk, link):
    return next((one for one in desk.links if one["link"] == link), {})


def test_certified_robots_are_led_and_stopped_and_nobody_else_is_heard(network):
    bridge, processes = network
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    # The link without credentials shows that those without are there to be found.
    desk.wait_for_robots("r1", "r2", "anybody", seconds=30)
    desk.send("go-robot-1", "r1", "SetPosEnd", x=60.0, y=8.0)
    desk.wait_for_step("go-robot-1", "acknowledged")
    wait_until(lambda: "target" in events(processes, "r1"))
    desk.send("stop-robot-1", "r1", "Abort")
    desk.wait_for_step("stop-robot-1", "acknowledged")
    desk.wait_for_step("go-robot-1", "aborted")
    assert "speed 0" in events(processes, "r1")
    desk.send("on-robot-1", "r1", "SetPosEnd", x=desk.robots["r1"]["x"] + 1.0, y=8.0)
    desk.wait_for_step("on-robot-1", "reached", 8)
    # The other authority's robot has knocked, and was refused.
    wait_until(lambda: "Certificate not valid" in processes.log("safe").read_text(), 20)
    with urllib.request.urlopen(bridge.address.replace("ws://", "http://") + "/metrics") as page:
        text = page.read().decode()
    assert 'robot_bridge_link_robots{link="safe"} 2.0' in text
    assert 'robot_bridge_link_robots{link="open"} 1.0' in text
    assert "intruder" not in desk.robots


def test_what_the_permissions_do_not_allow_is_named_and_the_rest_is_used(network):
    bridge, _ = network
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    desk.wait_for_robots("r2", seconds=30)
    words = "r2: the permissions of this link do not let it write rt/r2/cmd_vel"
    desk.until(lambda: words in (reported(desk, "safe").get("text") or ""), 20)
    assert reported(desk, "safe")["up"] and reported(desk, "safe").get("robots", []) == []
    desk.send("go-robot-2", "r2", "SetPosEnd", x=22.0, y=8.0)
    desk.wait_for_step("go-robot-2", "reached", 8)


def test_a_robot_on_fast_dds_is_led_where_cyclone_dds_begins_the_handshake(
    dds, start_bridge, impatient_site, tmp_path
):
    try:
        robot = fast_robot()
    except StageError as error:
        pytest.skip(str(error))
    # Who begins follows from the hashes of the names: with fast0 Cyclone DDS does, with fast3 Fast DDS.
    keys = Keystore(tmp_path / "keys")
    for name in ("link", "fast0", "fast3"):
        keys.enclave(name)
    bridge, domain = start_bridge(impatient_site), own_domain()
    address = f'[gateway]\nurl = "{bridge.address}/link"\n'
    text = settings_of(keys.folder / "link", domain, plugins=str(dds.plugins))
    (tmp_path / "safe.toml").write_text(address + text)
    with Processes(tmp_path / "logs") as processes:
        for name in ("fast0", "fast3"):
            processes.start(name, [*robot, name, str(domain), keys.folder / name])
            processes.wait_for_line(name, '"up"', BUSY * 10)
        command = [dds.python, "-m", "robot_bridge", "link", "ros2", "--config", tmp_path / "safe.toml"]
        processes.start("safe", command, env=dds.environment())
        desk = bridge.desk()
        desk.ask("subscribe", {"rate": 20})
        desk.wait_for_robots("fast0", seconds=30)
        desk.send("go-fast-1", "fast0", "SetPosEnd", x=60.0, y=8.0)
        desk.wait_for_step("go-fast-1", "acknowledged")
        wait_until(lambda: "target" in events(processes, "fast0"))
        desk.send("stop-fast-1", "fast0", "Abort")
        desk.wait_for_step("stop-fast-1", "acknowledged")
        assert "speed 0" in events(processes, "fast0")
        # The other one's key cannot be read, and Cyclone DDS says so.
        wait_until(
            lambda: "Failed to convert octet sequence to ASN1" in processes.log("safe").read_text(), 20
        )
        assert "fast3" not in desk.robots
    bridge.end()
