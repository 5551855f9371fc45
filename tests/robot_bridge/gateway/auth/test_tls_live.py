"""TLS as it is spoken: versions, ciphers, certificates that are new, old, or somebody else's."""

from __future__ import annotations

import socket
import ssl
import subprocess

import pytest

from robot_bridge.gateway.auth import certificates
from tests.support.bridge.bridge_programs import wait_until
from tests.support.operators import Desk


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    return certificates.create(tmp_path_factory.mktemp("tls") / "site", ["localhost"], ["127.0.0.1"])


@pytest.fixture(scope="module")
def bridge(files, start_bridge, sample_site, accounts_of):
    """A gateway with TLS that every computer could reach, and Ada's account."""
    return start_bridge(sample_site, options=["--certificate", files.certificate, "--key", files.key])


@pytest.fixture(scope="module")
def accounts(bridge, accounts_of):
    return accounts_of(bridge)


def trusting(files, **limits):
    context = ssl.create_default_context(cafile=files.ca)
    for name, value in limits.items():
        setattr(context, name, value)
    return context


def test_a_desk_and_a_robot_speak_over_tls(bridge, files):
    assert bridge.address.startswith("wss://127.0.0.1:")
    assert bridge.desk(ssl=trusting(files)).site["id"] == "sample"
    assert bridge.robot("r1", ssl=trusting(files)).plug_in(1)["robot"] == "r1"


@pytest.mark.parametrize("version", [ssl.TLSVersion.TLSv1_2, ssl.TLSVersion.TLSv1_3])
def test_new_versions_are_spoken_with_forward_secrecy(bridge, files, version):
    context = trusting(files, minimum_version=version, maximum_version=version)
    raw = socket.create_connection(("127.0.0.1", bridge.port))
    with context.wrap_socket(raw, server_hostname="localhost") as secure:
        name, spoken, bits = secure.cipher()
    assert name.startswith(("TLS_", "ECDHE-"))
    assert "GCM" in name or "CHACHA20" in name
    assert bits >= 128
    assert spoken in ("TLSv1.2", "TLSv1.3")


@pytest.mark.parametrize(
    "offer",
    [
        ["-tls1"],
        ["-tls1_1"],
        ["-tls1_2", "-cipher", "AES128-SHA:@SECLEVEL=0"],
        ["-tls1_2", "-cipher", "ECDHE-ECDSA-AES256-SHA384:@SECLEVEL=0"],
        ["-tls1_2", "-cipher", "ECDHE-ECDSA-AES128-SHA:@SECLEVEL=0"],
        ["-tls1_2", "-cipher", "aNULL:@SECLEVEL=0"],
        ["-tls1_2", "-cipher", "eNULL:@SECLEVEL=0"],
    ],
)
def test_old_versions_and_weak_ciphers_are_refused(bridge, offer):
    cipher = [] if "-cipher" in offer else ["-cipher", "ALL:@SECLEVEL=0"]
    command = ["openssl", "s_client", "-connect", f"127.0.0.1:{bridge.port}", *offer, *cipher]
    done = subprocess.run(command, input="", capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode != 0
    assert "BEGIN CERTIFICATE" not in done.stdout
    assert "Cipher is (NONE)" in done.stdout


def test_the_same_question_with_a_good_cipher_is_answered(bridge):
    command = ["openssl", "s_client", "-connect", f"127.0.0.1:{bridge.port}", "-tls1_2"]
    command += ["-cipher", "ECDHE-ECDSA-AES128-GCM-SHA256"]
    done = subprocess.run(command, input="", capture_output=True, text=True, timeout=240, check=False)
    assert "BEGIN CERTIFICATE" in done.stdout


def test_a_client_that_does_not_know_the_authority_does_not_connect(bridge, files, tmp_path):
    other = certificates.create(tmp_path / "other", ["localhost"], ["127.0.0.1"])
    for context in (ssl.create_default_context(), trusting(other)):
        with pytest.raises(ssl.SSLCertVerificationError, match=r"certificate verify failed"):
            bridge.desk(ssl=context)


def test_a_name_that_the_certificate_is_not_for_is_refused(bridge, files):
    with (
        socket.create_connection(("127.0.0.1", bridge.port)) as raw,
        pytest.raises(ssl.SSLCertVerificationError),
    ):
        trusting(files).wrap_socket(raw, server_hostname="other.example.org")


def test_without_tls_the_port_answers_nothing(bridge):
    with socket.create_connection(("127.0.0.1", bridge.port), 5) as raw:
        raw.sendall(b"GET /desk HTTP/1.1\r\nHost: x\r\n\r\n")
        answer = b""
        while more := raw.recv(4096):
            answer += more
        assert b"HTTP" not in answer


def serial(bridge, files):
    context = trusting(files)
    raw = socket.create_connection(("127.0.0.1", bridge.port))
    with context.wrap_socket(raw, server_hostname="localhost") as secure:
        return secure.getpeercert()["serialNumber"]


def test_a_renewed_certificate_is_taken_while_everybody_stays_connected(bridge, files):
    desk = bridge.desk(ssl=trusting(files))
    before = serial(bridge, files)
    certificates.renew(files.folder)
    wait_until(lambda: serial(bridge, files) != before)
    assert desk.ask("get_positions")["robots"] is not None
    key = files.key.read_bytes()
    now = serial(bridge, files)
    # A look in the midst of the renewal may have found one file new and the other old.
    seen = bridge.output().count("the certificate in use stays")
    files.key.write_text("spoilt")
    wait_until(lambda: bridge.output().count("the certificate in use stays") > seen, 20)
    assert serial(bridge, files) == now
    files.key.write_bytes(key)


def test_the_reference_robot_drives_with_token_and_authority(bridge, files, accounts, tmp_path):
    token = tmp_path / "token"
    token.write_text(accounts.do("robots", "token", "driver"))
    token.chmod(0o600)
    desk = bridge.desk(ssl=trusting(files))
    desk.ask("subscribe", {"rate": 20})
    bridge.start_robot("driver", (20.0, 8.0, 0.0), options=["--token-file", token, "--ca", files.ca])
    desk.wait_for_robots("driver")
    desk.send("drive-over-tls", "driver", "SetPosEnd", x=24.0, y=8.0)
    desk.wait_for_step("drive-over-tls", "reached")


def test_a_robot_that_is_not_let_in_says_why(bridge, files, tmp_path, accounts, forking_command):
    token = tmp_path / "token"
    token.write_text("fleet_robot_wrong")
    token.chmod(0o600)
    accounts.do("robots", "token", "somebody")
    command = [forking_command, "robot", "--name", "r7", "--url", f"{bridge.address}/robot"]
    for options, says in (
        (["--token-file", token, "--ca", files.ca], "HTTP 401): This token is not known"),
        (["--ca", files.ca], "HTTP 401): No token came with the request"),
        ([], "CERTIFICATE_VERIFY_FAILED"),
    ):
        robot = subprocess.Popen([*command, *options], stderr=subprocess.PIPE, text=True)
        line = robot.stderr.readline()
        robot.kill()
        robot.communicate()
        assert says in line


# --- beyond this computer -------------------------------------------------------------------------------


def test_a_gateway_does_not_listen_beyond_loopback_without_tls_and_accounts(
    sample_site, files, tmp_path, forking_command
):
    def serve(*options):
        command = [forking_command, "serve", "--host", "0.0.0.0", "--port", "0", *options]
        return subprocess.run(command, capture_output=True, text=True, timeout=240, check=False)

    common = ["--site", sample_site, "--database", f"sqlite:///{tmp_path}/f.db"]
    done = serve(*common)
    assert done.returncode == 1
    assert "make certificates with 'robot-bridge tls create DIR --name HOST'" in done.stderr
    done = serve(*common, "--certificate", files.certificate, "--key", files.key)
    assert done.returncode == 1
    assert "robot-bridge operators add NAME --role supervisor" in done.stderr
    assert "listening" not in done.stdout


def test_with_both_it_does_and_robots_without_a_token_stay_outside(
    start_bridge, sample_site, files, accounts_of, refused
):
    bridge = start_bridge(sample_site, options=["--certificate", files.certificate, "--key", files.key])
    ada = accounts_of(bridge).operator("Ada", "supervisor")
    bridge.kill_gateway()
    bridge.options += ["--host", "0.0.0.0"]
    bridge.start_gateway()
    assert bridge.address.startswith("wss://0.0.0.0:")
    bridge.address = bridge.address.replace("0.0.0.0", "127.0.0.1")
    secure = {"ssl": trusting(files)}
    assert isinstance(bridge.desk(**secure, **ada), Desk)
    assert refused(lambda: bridge.robot("r1", **secure))[0] == 401
    assert refused(lambda: bridge.desk(**secure))[0] == 401
    bridge.end()
