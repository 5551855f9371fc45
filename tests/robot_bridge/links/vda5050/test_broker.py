"""The connection to a real mosquitto: passwords, TLS, what it does not allow, and that it is gone."""

from __future__ import annotations

import asyncio
import contextlib
import subprocess
from pathlib import Path

import aiomqtt
import pytest

from robot_bridge.gateway.auth import certificates
from robot_bridge.links.base.errors import LinkError
from robot_bridge.links.base.settings import read_settings
from robot_bridge.links.vda5050.broker import LARGEST, Broker, check_granted
from robot_bridge.links.vda5050.messages import Topics
from robot_bridge.links.vda5050.settings import Vda5050Settings, broker_address, check
from tests.robot_bridge.links.vda5050.peers import Yard
from tests.support.databases.database_server import find_program
from tests.support.errors import StageError
from tests.support.processes import Processes

PASSWORD = "not easily guessed"


@pytest.fixture(scope="module")
def tls(tmp_path_factory):
    return certificates.create(tmp_path_factory.mktemp("tls") / "site", ["localhost"], ["127.0.0.1"])


@pytest.fixture
def yard(tmp_path):
    try:
        find_program("mosquitto", "/usr/sbin")
    except StageError as error:
        pytest.skip(str(error))
    with Processes(tmp_path / "logs") as processes:
        yield Yard(processes, tmp_path, "")


def settings_of(folder: Path, *lines: str, name: str = "yard"):
    file = folder / f"{name}.toml"
    file.write_text("\n".join(["[vda5050]", *lines]), encoding="utf-8")
    return read_settings(file, "vda5050", Vda5050Settings)


class Heard:
    """A broker's connection that notes what comes of it."""

    def __init__(self, settings, own):
        self.messages: list[tuple[str, bytes, bool]] = []
        self.changes: list[str | None] = []
        self.changed = asyncio.Event()
        subscriptions = Topics().subscriptions()
        self.broker = Broker(broker_address(settings, own), subscriptions, self)

    def receive(self, topic, payload, *, retained):
        self.messages.append((topic, payload, retained))
        self.changed.set()

    def broker_changed(self, reason):
        self.changes.append(reason)
        self.changed.set()

    async def until(self, condition):
        async with asyncio.timeout(30):
            while not condition():
                self.changed.clear()
                await self.changed.wait()


@contextlib.asynccontextmanager
async def connecting(settings, own):
    heard = Heard(settings, own)
    task = asyncio.create_task(heard.broker.run())
    try:
        yield heard
    finally:
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)


def guard(yard):
    """Have the broker ask for a password."""
    passwords = yard.folder / "passwords"
    command = [find_program("mosquitto_passwd", "/usr/bin"), "-b", "-c", passwords, "fleet", PASSWORD]
    subprocess.run(command, check=True)
    yard.broker_options = ["allow_anonymous false", f"password_file {passwords}"]
    (yard.folder / "password").write_text(f"{PASSWORD}\n", encoding="utf-8")
    return [f'broker = "mqtt://127.0.0.1:{yard.port}"', 'user = "fleet"', 'password_file = "password"']


async def test_of_a_message_beyond_all_bounds_the_beginning_is_handed_on(yard):
    yard.start_broker()
    async with connecting(*settings_of(yard.folder, f'broker = "mqtt://127.0.0.1:{yard.port}"')) as heard:
        await heard.until(lambda: heard.changes == [None])
        heard.broker.publish("uagv/v2/Acme/1/state", bytes(LARGEST + 1000), urgent=True)
        await heard.until(lambda: heard.messages)
        # One byte more than is decoded: it is refused for that.
        assert len(heard.messages[0][1]) == LARGEST + 1


async def test_a_password_opens_it_and_a_wrong_one_is_named(yard):
    lines = guard(yard)
    yard.start_broker()
    async with connecting(*settings_of(yard.folder, *lines)) as heard:
        await heard.until(lambda: heard.changes == [None])
        heard.broker.publish("uagv/v2/Acme/1/state", b"{}", urgent=True)
        await heard.until(lambda: heard.messages == [("uagv/v2/Acme/1/state", b"{}", False)])

    (yard.folder / "password").write_text("wrong", encoding="utf-8")
    async with connecting(*settings_of(yard.folder, *lines)) as heard:
        await heard.until(lambda: heard.changes)
        assert "ot authori" in heard.changes[0] or "password" in heard.changes[0].lower()

    (yard.folder / "password").unlink()
    async with connecting(*settings_of(yard.folder, *lines)) as heard:
        await heard.until(lambda: heard.changes)
        assert "password_file" in heard.changes[0] and "cannot be read" in heard.changes[0]


def test_a_subscription_that_the_broker_does_not_allow_is_named():
    """Mosquitto's own lists grant every subscription and fulfil none that is not allowed; others refuse."""
    check_granted("uagv/v2/+/+/state", (1,))
    with pytest.raises(aiomqtt.MqttError, match=r"does not allow to subscribe to uagv/v2/\+/\+/state"):
        check_granted("uagv/v2/+/+/state", (0x80,))


async def test_tls_trusts_the_sites_authority_alone(yard, tls):
    encrypted = [f"certfile {tls.certificate}", f"keyfile {tls.key}"]
    yard.broker_options = [*encrypted, "allow_anonymous true"]
    yard.start_broker()
    address = f'broker = "mqtts://127.0.0.1:{yard.port}"'
    async with connecting(*settings_of(yard.folder, address, f'ca = "{tls.ca}"')) as heard:
        await heard.until(lambda: heard.changes == [None])
    async with connecting(*settings_of(yard.folder, address)) as heard:
        await heard.until(lambda: heard.changes)
        assert "CERTIFICATE_VERIFY_FAILED" in heard.changes[0] or "certificate" in heard.changes[0]


async def test_a_broker_that_is_gone_is_named_and_waited_for(yard):
    lines = [f'broker = "mqtt://127.0.0.1:{yard.port}"']
    async with connecting(*settings_of(yard.folder, *lines)) as heard:
        await heard.until(lambda: heard.changes)
        assert f"broker 127.0.0.1:{yard.port}: " in heard.changes[0]
        heard.broker.publish("uagv/v2/Acme/1/order", b"old", urgent=False)
        yard.start_broker()
        await heard.until(lambda: heard.changes[-1] is None)
        heard.broker.publish("uagv/v2/Acme/1/state", b"new", urgent=False)
        await heard.until(lambda: heard.messages)
        assert [payload for _, payload, _ in heard.messages] == [b"new"]


WRONG = [
    ('broker = "http://127.0.0.1"', "vda5050.broker = 'http://127.0.0.1': write mqtt://HOST:1883"),
    ('broker = "mqtt://a:b@127.0.0.1"', "vda5050.broker"),
    ('broker = "mqtt://127.0.0.1:99999"', "vda5050.broker"),
    ('ca = "ca.pem"', "write mqtts:// for what certificates are for"),
    ('broker = "mqtts://127.0.0.1"\nca = "none.pem"', "vda5050.ca: "),
    ('broker = "mqtts://127.0.0.1"\ncertificate = "none.pem"', "vda5050.certificate: "),
    ('password_file = "x"', "vda5050.user is missing"),
    ('interface = "a/b"', "vda5050.interface is 'a/b'"),
    ("base_length_m = 0.0", "vda5050.base_length_m = 0.0"),
    ("max_speed = -1.0", "vda5050.max_speed = -1.0"),
    ("base_lenght_m = 5.0", "did you mean base_length_m?"),
    ('[[vda5050.vehicles]]\nmanufacturer = "A"\nserial = "1"\nrobot = "a b"', "no robot can be called 'a b'"),
    ('[vda5050.maps.hall]\ncsr = "utm"', "csr"),
]


@pytest.mark.parametrize(("lines", "words"), WRONG)
def test_settings_that_cannot_be_used_are_named(tmp_path, lines, words):
    with pytest.raises(LinkError) as caught:
        check(*settings_of(tmp_path, lines))
    assert str(tmp_path / "yard.toml") in str(caught.value)
    assert words in str(caught.value)
