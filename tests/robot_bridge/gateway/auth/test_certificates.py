"""A site's certificate authority and the gateway's certificate, looked at with OpenSSL."""

from __future__ import annotations

import asyncio
import os
import ssl
import stat
import subprocess

import pytest

from robot_bridge.core.errors import AccessError
from robot_bridge.gateway.auth import certificates, port
from robot_bridge.gateway.auth.port import ServerFiles, ServerTls, server_files
from tests.support.patience import until


@pytest.fixture
def files(tmp_path):
    return certificates.create(tmp_path / "tls", ["gateway.example.org", "localhost"], ["127.0.0.1", "::1"])


def openssl(*words):
    return subprocess.run(["openssl", *map(str, words)], capture_output=True, text=True, check=False).stdout


def names_in(certificate):
    _, names = openssl("x509", "-in", certificate, "-noout", "-ext", "subjectAltName").splitlines()
    return names.strip().split(", ")


def test_openssl_trusts_the_gateway_through_the_site_alone(files):
    for name in (["-verify_hostname", "localhost"], ["-verify_ip", "127.0.0.1"], ["-verify_ip", "::1"]):
        said = openssl(
            "verify", "-x509_strict", "-purpose", "sslserver", "-CAfile", files.ca, *name, files.certificate
        )
        assert said.strip().endswith("OK"), said
    wrong = openssl("verify", "-CAfile", files.ca, "-verify_hostname", "other.example.org", files.certificate)
    assert not wrong.strip().endswith("OK")
    assert not openssl("verify", files.certificate).strip().endswith("OK")


def test_the_authority_signs_servers_and_no_further_authorities(files):
    ca = openssl("x509", "-in", files.ca, "-noout", "-text")
    assert "CA:TRUE, pathlen:0" in ca
    assert "Certificate Sign, CRL Sign" in ca
    server = openssl("x509", "-in", files.certificate, "-noout", "-text")
    assert "CA:FALSE" in server
    assert "TLS Web Server Authentication" in server
    assert names_in(files.certificate) == [
        "DNS:gateway.example.org",
        "DNS:localhost",
        "IP Address:127.0.0.1",
        "IP Address:0:0:0:0:0:0:0:1",
    ]


def test_keys_can_be_read_by_their_owner_alone(files):
    assert [stat.S_IMODE(file.stat().st_mode) for file in (files.ca_key, files.key)] == [0o600, 0o600]


def test_renewing_changes_key_and_certificate_and_keeps_authority_and_names(files):
    before = [file.read_bytes() for file in (files.ca, files.ca_key, files.certificate, files.key)]
    names = names_in(files.certificate)
    until = certificates.renew(files.folder, days=30)
    after = [file.read_bytes() for file in (files.ca, files.ca_key, files.certificate, files.key)]
    assert [a == b for a, b in zip(before, after, strict=True)] == [True, True, False, False]
    assert names_in(files.certificate) == names
    assert until == certificates.valid_until(files.certificate)
    assert openssl("verify", "-CAfile", files.ca, files.certificate).strip().endswith("OK")
    assert stat.S_IMODE(files.key.stat().st_mode) == 0o600


def test_certificates_that_are_trusted_already_are_not_overwritten(files):
    before = files.ca.read_bytes()
    with pytest.raises(AccessError, match="tls renew"):
        certificates.create(files.folder, ["localhost"], [])
    assert files.ca.read_bytes() == before


@pytest.mark.parametrize(
    ("names", "addresses", "says"),
    [
        ([], [], "give --name HOST, or --ip ADDRESS"),
        (["192.168.1.4"], [], "give it as --ip 192.168.1.4"),
        (["a b"], [], "is no host name"),
        (["a..b"], [], "is no host name"),
        ([], ["gateway"], "is no IP address"),
    ],
)
def test_what_is_no_name_is_named(tmp_path, names, addresses, says):
    with pytest.raises(AccessError, match=says):
        certificates.create(tmp_path / "tls", names, addresses)
    assert not (tmp_path / "tls").exists()


def test_a_folder_without_an_authority_cannot_be_renewed(tmp_path):
    with pytest.raises(
        AccessError, match=r"ca\.pem cannot be read: No such file or directory; correct .* tls create"
    ):
        certificates.renew(tmp_path)


def test_a_gateway_needs_both_files_and_they_must_belong_together(files, tmp_path):
    with pytest.raises(AccessError, match="give both"):
        server_files(files.certificate, None)
    assert server_files(None, None) is None
    other = certificates.create(tmp_path / "other", ["localhost"], [])
    with pytest.raises(AccessError, match="belong to each other"):
        ServerTls(ServerFiles(files.certificate, other.key))
    with pytest.raises(AccessError, match=r"none\.pem cannot be read"):
        ServerTls(ServerFiles(tmp_path / "none.pem", files.key))
    files.key.write_text("no key")
    with pytest.raises(AccessError, match="cannot be used"):
        ServerTls(ServerFiles(files.certificate, files.key))


def test_an_encrypted_key_is_refused_and_nobody_is_asked_for_a_password(files):
    subprocess.run(
        [
            "openssl",
            "pkey",
            "-in",
            files.key,
            "-aes256",
            "-passout",
            "pass:x",
            "-out",
            files.key.with_suffix(".enc"),
        ],
        check=True,
    )
    with pytest.raises(AccessError, match="encrypted"):
        ServerTls(ServerFiles(files.certificate, files.key.with_suffix(".enc")))


def test_a_new_certificate_that_cannot_be_used_changes_nothing(files, caplog):
    server = ServerTls(ServerFiles(files.certificate, files.key))
    good = files.key.read_bytes()
    files.key.write_text("no key")
    assert not server.reload()
    assert "the certificate in use stays" in caplog.text
    files.key.write_bytes(good)
    assert server.reload()


def test_what_is_renewed_belongs_to_whom_it_did(files):
    owner = (65534, 65534) if os.geteuid() == 0 else (os.geteuid(), os.getegid())
    os.chown(files.key, *owner)
    files.key.chmod(0o640)
    before = files.key.read_bytes()
    certificates.renew(files.folder)
    status = files.key.stat()
    assert files.key.read_bytes() != before
    assert (status.st_uid, status.st_gid, stat.S_IMODE(status.st_mode)) == (*owner, 0o640)


@pytest.fixture
async def watched(files, monkeypatch):
    """A gateway's TLS that looks at its files all the time."""
    monkeypatch.setattr(port, "WATCH_INTERVAL", 0.01)
    found = ServerTls(ServerFiles(files.certificate, files.key))
    watching = asyncio.create_task(found.watch())
    yield found
    watching.cancel()


async def test_a_key_is_looked_at_again_when_its_rights_have_changed(watched, files, monkeypatch):
    reloads = []
    monkeypatch.setattr(watched, "reload", lambda: reloads.append(1))
    files.key.chmod(0o400)
    await until(lambda: reloads, 7.5)


async def test_a_gateway_that_runs_for_long_is_warned_before_its_certificate_ends(
    watched, files, caplog, monkeypatch
):
    certificates.renew(files.folder, days=5)
    await until(lambda: "holds for 4 days more" in caplog.text, 7.5)
    caplog.clear()
    monkeypatch.setattr(port, "WARN_INTERVAL", 0.0)
    await until(lambda: "holds for 4 days more" in caplog.text, 7.5)


def test_old_versions_and_weak_ciphers_are_off(files):
    context = ServerTls(ServerFiles(files.certificate, files.key)).context
    assert context.minimum_version == ssl.TLSVersion.TLSv1_2
    names = [cipher["name"] for cipher in context.get_ciphers()]
    assert names
    assert all(
        name.startswith(("TLS_", "ECDHE-")) and ("GCM" in name or "CHACHA20" in name) for name in names
    )


def test_a_certificate_that_is_about_to_expire_is_warned_of(files, caplog):
    certificates.renew(files.folder, days=5)
    ServerTls(ServerFiles(files.certificate, files.key))
    assert "tls renew" in caplog.text


def test_a_key_that_others_can_read_is_warned_of(files, caplog):
    files.key.chmod(0o644)
    ServerTls(ServerFiles(files.certificate, files.key))
    assert "chmod 600" in caplog.text
