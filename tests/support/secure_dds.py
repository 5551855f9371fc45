"""A Cyclone DDS with DDS Security, and certificates for it: Debian's library under PyPI's binding.

The wheels of cyclonedds on PyPI are built without DDS Security, and so is the Fast DDS of rclpy's wheels.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

from tests.support.errors import StageError
from tests.support.peers import cached, run_peer

BINDING = "cyclonedds==0.10.2"
"""of the version that Debian 12 has."""
DEBIAN = (
    "libddsc0debian",
    "cyclonedds-dev",
    "cyclonedds-tools",
    "libcycloneddsidl0",
    "libiceoryx-binding-c2",
    "libiceoryx-posh2",
    "libiceoryx-hoofs2",
    "libiceoryx-platform2",
)
FAST_DEBIAN = (
    "libfastrtps-dev",
    "libfastrtps2.9",
    "libfastcdr-dev",
    "libfastcdr1",
    "libfoonathan-memory-dev",
    "libfoonathan-memory0.7.2",
    "libtinyxml2-9",
)
"""Fast DDS with security, which rclpy's wheels have without."""
FAST_ROBOT = Path(__file__).with_name("fast_robot.cpp")
PACKAGES = "STAGE_PACKAGES"
"""names folders of packages that come after cyclonedds's own."""
_START = (
    f'import os, sys; sys.path.extend(filter(None, os.environ.get("{PACKAGES}", "").split(os.pathsep)))\n'
)
_DOMAINS = "<domains><id_range><min>0</min><max>230</max></id_range></domains>"
_SCHEMA = 'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation='
_GOVERNANCE = f"""<?xml version="1.0" encoding="UTF-8"?>
<dds {_SCHEMA}"http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_governance.xsd">
  <domain_access_rules><domain_rule>{_DOMAINS}
    <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
    <enable_join_access_control>true</enable_join_access_control>
    <discovery_protection_kind>ENCRYPT</discovery_protection_kind>
    <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
    <rtps_protection_kind>SIGN</rtps_protection_kind>
    <topic_access_rules><topic_rule><topic_expression>*</topic_expression>
      <enable_discovery_protection>true</enable_discovery_protection>
      <enable_liveliness_protection>true</enable_liveliness_protection>
      <enable_read_access_control>true</enable_read_access_control>
      <enable_write_access_control>true</enable_write_access_control>
      <metadata_protection_kind>ENCRYPT</metadata_protection_kind>
      <data_protection_kind>ENCRYPT</data_protection_kind>
    </topic_rule></topic_access_rules>
  </domain_rule></domain_access_rules>
</dds>
"""
_PERMISSIONS = """<?xml version="1.0" encoding="UTF-8"?>
<dds {schema}"http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_permissions.xsd">
  <permissions><grant name="{name}"><subject_name>CN={name}</subject_name>
    <validity><not_before>2020-01-01T00:00:00</not_before><not_after>2045-01-01T00:00:00</not_after></validity>
    {denied}
    <allow_rule>{domains}
      <publish><topics><topic>*</topic></topics></publish>
      <subscribe><topics><topic>*</topic></topics></subscribe>
    </allow_rule>
    <default>DENY</default>
  </grant></permissions>
</dds>
"""


class SecureDds:
    """An environment of Python with the binding; ``python`` runs in :meth:`environment`."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.python = folder / "bin" / "python"
        self.plugins = folder / "cyclone" / "lib" / "libddsc0debian"

    def environment(self) -> dict[str, str]:
        """Return what a program needs to run there, with the packages of this environment after its own."""
        home = self.folder / "cyclone"
        packages = [folder for folder in sys.path if folder.endswith("-packages")]
        packages.append(str(Path(__file__).resolve().parents[2]))
        return {
            "CYCLONEDDS_HOME": str(home),
            "LD_LIBRARY_PATH": str(home / "lib"),
            PACKAGES: os.pathsep.join(packages),
        }


def secure_dds() -> SecureDds:
    """Return the environment; made when it is not there.

    :raises StageError: when it cannot be made: no Debian 12, no network, no compiler.
    """
    what = repr((BINDING, DEBIAN, _START, sys.version_info[:2]))
    return SecureDds(cached(f"secure-dds-{hashlib.sha256(what.encode()).hexdigest()[:12]}", _make))


def fast_robot() -> list[str | Path]:
    """Return the command of a robot on Fast DDS, which takes a name, a domain and an enclave's folder.

    Built when it is not there; an empty enclave is none.

    :raises StageError: when it cannot be made: no Debian 12, no network, no compiler.
    """
    what = repr((FAST_DEBIAN, FAST_ROBOT.read_text(encoding="utf-8")))
    folder = cached(f"fast-dds-{hashlib.sha256(what.encode()).hexdigest()[:12]}", _make_fast)
    return ["env", f"LD_LIBRARY_PATH={_libraries(folder)}", folder / "robot"]


def _make_fast(folder: Path) -> None:
    folder.mkdir()
    unpacked = folder / "debian"
    _unpack(unpacked, FAST_DEBIAN, "c++")
    includes, libraries = unpacked / "usr" / "include", _libraries(folder)
    given = ["-std=c++14", f"-I{includes}", f"-I{includes / libraries.name}", f"-L{libraries}"]
    linked = ["-lfastrtps", "-lfastcdr", f"-Wl,-rpath-link,{libraries}"]
    run_peer("c++", *given, FAST_ROBOT, "-o", folder / "robot", *linked)


def _libraries(folder: Path) -> Path:
    return folder / "debian" / "usr" / "lib" / str(sysconfig.get_config_var("MULTIARCH"))


def _unpack(folder: Path, packages: tuple[str, ...], compiler: str) -> None:
    """Unpack packages of Debian into ``folder``; raises StageError where a program for that is missing."""
    for program in ("apt-get", "dpkg-deb", compiler):
        if shutil.which(program) is None:
            raise StageError(f"DDS Security for tests needs {program}: it is taken from Debian 12")
    folder.mkdir()
    run_peer("sh", "-c", 'cd "$0" && apt-get download -q "$@"', folder, *packages)
    for package in sorted(folder.glob("*.deb")):
        run_peer("dpkg-deb", "-x", package, folder)


def _make(folder: Path) -> None:
    run_peer(sys.executable, "-m", "venv", folder)
    unpacked, home = folder / "debian", folder / "cyclone"
    _unpack(unpacked, DEBIAN, "cc")
    triplet = sysconfig.get_config_var("MULTIARCH")
    shutil.copytree(unpacked / "usr" / "lib" / triplet, home / "lib", symlinks=True)
    shutil.copytree(unpacked / "usr" / "bin", home / "bin")
    shutil.copytree(unpacked / "usr" / "include", home / "include")
    shutil.copytree(unpacked / "usr" / "include" / triplet, home / "include", dirs_exist_ok=True)
    made = SecureDds(folder)
    inside = ["env", *(f"{key}={value}" for key, value in made.environment().items()), made.python]
    run_peer(*inside, "-m", "pip", "install", "--quiet", "--no-input", "--no-binary", "cyclonedds", BINDING)
    packages = folder / "lib" / f"python{sys.version_info[0]}.{sys.version_info[1]}" / "site-packages"
    (packages / "stage.pth").write_text(_START)
    run_peer(*inside, "-c", "import cyclonedds.domain")


class Keystore:
    """An authority, and the files of those it vouches for, in ``folder``; what SROS 2 makes, by openssl."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        folder.mkdir(parents=True)
        self._key("ca.key.pem")
        self._openssl("req", "-x509", "-new", "-key", "ca.key.pem", "-subj", "/CN=ca", "-out", "ca.cert.pem")
        (folder / "governance.xml").write_text(_GOVERNANCE)
        self._sign("governance.xml", "governance.p7s")

    def enclave(self, name: str, *, never: tuple[str, ...] = ()) -> Path:
        """Return the folder of a member, with SROS 2's names; ``never`` are topics that it may not use."""
        made = self.folder / name
        made.mkdir()
        self._key(f"{name}/key.pem")
        self._openssl("req", "-new", "-key", f"{name}/key.pem", "-subj", f"/CN={name}", "-out", "request.pem")
        signed = ["-in", "request.pem", "-CA", "ca.cert.pem", "-CAkey", "ca.key.pem", "-CAcreateserial"]
        self._openssl("x509", "-req", *signed, "-out", f"{name}/cert.pem")
        topics = "".join(f"<topic>{topic}</topic>" for topic in never)
        parts = "".join(f"<{way}><topics>{topics}</topics></{way}>" for way in ("publish", "subscribe"))
        denied = f"<deny_rule>{_DOMAINS}{parts}</deny_rule>" if never else ""
        text = _PERMISSIONS.format(schema=_SCHEMA, name=name, domains=_DOMAINS, denied=denied)
        (made / "permissions.xml").write_text(text)
        self._sign(f"{name}/permissions.xml", f"{name}/permissions.p7s")
        for source, wanted in (
            ("ca.cert.pem", "identity_ca.cert.pem"),
            ("ca.cert.pem", "permissions_ca.cert.pem"),
            ("governance.p7s", "governance.p7s"),
        ):
            shutil.copy(self.folder / source, made / wanted)
        return made

    def _key(self, name: str) -> None:
        self._openssl("ecparam", "-name", "prime256v1", "-genkey", "-noout", "-out", name)

    def _sign(self, source: str, target: str) -> None:
        by = ["-signer", "ca.cert.pem", "-inkey", "ca.key.pem"]
        self._openssl("smime", "-sign", "-text", "-in", source, "-out", target, *by)

    def _openssl(self, *words: str) -> None:
        subprocess.run(["openssl", *words], cwd=self.folder, check=True, capture_output=True, timeout=60)
