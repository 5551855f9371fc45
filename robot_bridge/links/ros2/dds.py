"""DDS by cyclonedds: discovery of endpoints, and readers and writers of bytes under any type's name.

cyclonedds is native code and knows types at compile time. Here every topic has a type that is one octet and
the name of the real one: cyclonedds compares only names once it ignores the type information of vendors that
send it, and passes the bytes of a message unchanged.
"""

from __future__ import annotations

import logging
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal
from xml.sax.saxutils import quoteattr  # nosec B406 # writes XML, reads none

from ..ros.errors import FaultError, RosError
from ..ros.settings import LONGEST_NAME
from .interfaces import LARGEST_MESSAGE
from .security import SECURED, DdsSecurity

log = logging.getLogger(__name__)

Range = Literal["localhost", "subnet", "off"]
RANGES: tuple[Range, ...] = ("localhost", "subnet", "off")
LARGEST_DOMAIN = 232
MOST_ENDPOINTS = 50_000
"""remembered endpoints of others; a robot with Nav2 has about 500."""
MOST_PARTICIPANTS = 120
"""participants on one computer discovered without multicast."""
AT_ONCE = 64
"""messages read from one topic at a time."""
IGNORED_TYPES = "1.15,1.16"
"""Fast DDS and Cyclone DDS: their type descriptions are not compared with the one octet."""
_TYPE_HASH = re.compile(rb"typehash=(RIHS01_[0-9a-f]{64})")
_BLOCK = 100_000_000
"""nanoseconds that a write waits for room at most."""


@dataclass(frozen=True)
class DdsSettings:
    """A DDS domain: its number, and the range of discovery.

    ``interfaces`` are names or addresses of this computer's; none: loopback for ``localhost``, else the one
    that cyclonedds chooses. ``peers`` are addresses contacted individually, for networks without multicast.
    With ``security`` only authenticated participants are accepted.
    """

    domain: int = 0
    range: Range = "subnet"
    interfaces: tuple[str, ...] = ()
    peers: tuple[str, ...] = ()
    security: DdsSecurity | None = None

    def __post_init__(self) -> None:
        if not 0 <= self.domain <= LARGEST_DOMAIN:
            raise RosError(f"domain is {self.domain}; give ROS_DOMAIN_ID, from 0 to {LARGEST_DOMAIN}")
        if self.range not in RANGES:
            raise RosError(f"range is {str(self.range)[:40]!r}; give one of {', '.join(RANGES)}")

    def xml(self, *, ignores_types: bool = True) -> str:
        """Return cyclonedds's configuration of the domain; not every version supports ``ignores_types``."""
        peers = (["127.0.0.1"] if self.range == "localhost" else []) + list(self.peers)
        interfaces = self.interfaces or (("127.0.0.1",) if self.range == "localhost" else ())
        ignored = f"<IgnoreTypeInformation>{IGNORED_TYPES}</IgnoreTypeInformation>" if ignores_types else ""
        multicast = "default" if self.range == "subnet" else "false"
        return (
            '<CycloneDDS><Domain Id="any"><General>'
            f"<Interfaces>{''.join(map(_interface, interfaces))}</Interfaces>"
            f"<AllowMulticast>{multicast}</AllowMulticast></General>"
            f"<Discovery>{_peers_xml(peers)}</Discovery>"
            f"<Compatibility>{ignored}</Compatibility>"
            f"<Internal><MaxSampleSize>{LARGEST_MESSAGE} B</MaxSampleSize></Internal>"
            "</Domain></CycloneDDS>"
        )


@dataclass(frozen=True)
class Endpoint:
    """A remote reader (``wants``) or writer of a DDS topic; ``key`` and ``participant`` have 16 bytes."""

    key: bytes
    participant: bytes
    topic: str
    type_name: str
    wants: bool
    reliable: bool
    latched: bool
    type_hash: str | None = None
    """Hash of the type's definition (REP 2016), as sent by nodes since iron."""


@dataclass(frozen=True)
class Quality:
    """Reliable or best effort; ``latched`` is transient local: late joiners get the newest message."""

    reliable: bool = True
    latched: bool = False
    depth: int = 10


def quality_for(offers: Iterable[Endpoint], depth: int = 10) -> Quality:
    """Return the best quality of a reader that still matches every writer of the topic."""
    known = list(offers)
    return Quality(
        all(one.reliable for one in known), bool(known) and all(one.latched for one in known), depth
    )


class RawReader:
    """Reads the bytes of one DDS topic; made by :meth:`Participant.reader`."""

    def __init__(self, entity: Any) -> None:
        self._entity = entity

    def read_samples(self) -> list[bytes]:
        """Return the received messages, oldest first, without waiting."""
        return [sample.data for sample in self._entity.take(AT_ONCE) if sample.sample_info.valid_data]

    @property
    def matched(self) -> int:
        """Number of matched writers."""
        return _matched(self._entity, "publications")

    def close(self) -> None:
        """Close the reader."""
        self._entity.__del__()


class RawWriter:
    """Writes the bytes of one DDS topic; made by :meth:`Participant.writer`."""

    def __init__(self, entity: Any, sample_type: Any) -> None:
        self._entity = entity
        self._sample_type = sample_type

    def write(self, data: bytes) -> bool:
        """Write a message; return false without room for it: readers do not keep up."""
        from cyclonedds.core import DDSException

        try:
            self._entity.write(self._sample_type(data))
        except DDSException as error:
            log.warning("a message of %d bytes was not written: %s", len(data), error)
            return False
        return True

    @property
    def matched(self) -> int:
        """Number of matched readers."""
        return _matched(self._entity, "subscriptions")


class Participant:
    """This program's participant in a DDS domain. Not thread-safe.

    :raises RosError: if cyclonedds is not installed or refuses the settings.
    """

    def __init__(self, settings: DdsSettings) -> None:
        try:
            from cyclonedds import builtin, core, domain
        except ModuleNotFoundError as error:
            raise RosError(
                f"{error.name} is not installed; pip install 'fleet-supervisor-robot-bridge[ros2]'"
            ) from None
        try:
            self._ignores_types = library_has(b"IgnoreTypeInformation")
            self._domain = domain.Domain(settings.domain, settings.xml(ignores_types=self._ignores_types))
            self._participant = domain.DomainParticipant(settings.domain, _shown(settings.security))
        except core.DDSException as error:
            secured = (
                ""
                if settings.security is None
                else (" Are the files of security valid, and for this domain? Cyclone DDS has said why")
            )
            raise RosError(
                f"DDS domain {settings.domain} cannot be joined ({error}); look at domain, range and "
                "interfaces of the settings: are the interfaces there, is there room for another participant?"
                f"{secured}"
            ) from None
        self._offers = builtin.BuiltinDataReader(self._participant, builtin.BuiltinTopicDcpsPublication)
        self._wants = builtin.BuiltinDataReader(self._participant, builtin.BuiltinTopicDcpsSubscription)
        self._own = self._participant.guid.bytes
        self._topics: dict[tuple[str, str], Any] = {}
        self._types: dict[str, Any] = {}
        """By name: cyclonedds 11.0.1 eats all memory after some 150 types of one name."""
        self._endpoints: dict[bytes, Endpoint] = {}
        self._full = False

    @property
    def endpoints(self) -> Iterator[Endpoint]:
        """The endpoints of others."""
        return iter(list(self._endpoints.values()))

    def discover(self) -> bool:
        """Update the endpoints of others; return whether anything changed."""
        changed = False
        for reader, wants in ((self._offers, False), (self._wants, True)):
            for sample in reader.take(1000):
                changed |= self._record(sample, wants)
        return changed

    def reader(self, topic: str, type_name: str, quality: Quality) -> RawReader:
        """Return a reader of a DDS topic; both names are those of DDS.

        :raises FaultError: if the permissions of this link do not allow that.
        """
        from cyclonedds.sub import DataReader

        with _permitted(topic, "read"):
            made = self._topic(topic, type_name)
            return RawReader(DataReader(self._participant, made, qos=_qos(quality)))

    def writer(self, topic: str, type_name: str, quality: Quality) -> RawWriter:
        """Return a writer of a DDS topic; both names are those of DDS.

        :raises FaultError: if the permissions of this link do not allow that.
        """
        from cyclonedds.pub import DataWriter

        with _permitted(topic, "write"):
            made = self._topic(topic, type_name)
            return RawWriter(DataWriter(self._participant, made, qos=_qos(quality)), made.data_type)

    def _topic(self, name: str, type_name: str) -> Any:
        from cyclonedds.topic import Topic

        key = (name, type_name)
        if key not in self._topics:
            if type_name not in self._types:
                self._types[type_name] = _octet_type(type_name, described=self._ignores_types)
            self._topics[key] = Topic(self._participant, name, self._types[type_name])
        return self._topics[key]

    def _record(self, sample: Any, wants: bool) -> bool:
        from cyclonedds.core import InstanceState

        key = sample.key.bytes
        if not sample.sample_info.valid_data or sample.sample_info.instance_state != InstanceState.Alive:
            return self._endpoints.pop(key, None) is not None
        if sample.participant_key.bytes == self._own or len(sample.topic_name) > LONGEST_NAME:
            return False
        if len(self._endpoints) >= MOST_ENDPOINTS:
            if not self._full:
                log.error(
                    "more than %d topics are offered and wanted; further ones are not seen", MOST_ENDPOINTS
                )
            self._full = True
            return False
        self._endpoints[key] = _endpoint(sample, wants)
        return True


def _endpoint(sample: Any, wants: bool) -> Endpoint:
    from cyclonedds.core import Policy

    reliability = _policy(sample.qos, Policy.Reliability)
    durability = _policy(sample.qos, Policy.Durability)
    return Endpoint(
        sample.key.bytes,
        sample.participant_key.bytes,
        sample.topic_name,
        sample.type_name,
        wants,
        reliability is not None and reliability != Policy.Reliability.BestEffort,
        durability is not None and durability != Policy.Durability.Volatile,
        _type_hash(_policy(sample.qos, Policy.Userdata)),
    )


def _type_hash(declared: Any) -> str | None:
    found = _TYPE_HASH.search(b"" if declared is None else declared.data)
    return None if found is None else found[1].decode("ascii")


def _policy(qos: Any, policy: Any) -> Any:
    """Return one policy of cyclonedds's Qos, which has no get(); None if it is absent."""
    return qos[policy] if policy in qos else None  # noqa: SIM401


def _qos(quality: Quality) -> Any:
    from cyclonedds.core import Policy, Qos

    return Qos(
        Policy.Reliability.Reliable(_BLOCK) if quality.reliable else Policy.Reliability.BestEffort,
        Policy.Durability.TransientLocal if quality.latched else Policy.Durability.Volatile,
        Policy.History.KeepLast(quality.depth),
    )


def library_has(word: bytes) -> bool:
    """Return whether Cyclone DDS's library was built with the feature that ``word`` names."""
    from cyclonedds import __library__

    return word in Path(__library__.library_path).read_bytes()


def _shown(security: DdsSecurity | None) -> Any:
    """Return the Qos of a participant that shows its certificate; None without one."""
    from cyclonedds.core import Policy, Qos

    if security is None:
        return None
    if not library_has(SECURED):
        raise RosError(
            "security is set, and the cyclonedds that is installed was built without DDS Security, as all "
            "its wheels on PyPI are; install one that has it (docs/links-ros2.md, DDS Security)"
        )
    return Qos(*(Policy.Property(key, value) for key, value in security.properties().items()))


@contextmanager
def _permitted(topic: str, verb: str) -> Iterator[None]:
    from cyclonedds.core import DDSException

    try:
        yield
    except DDSException as error:
        if error.code != DDSException.DDS_RETCODE_NOT_ALLOWED_BY_SECURITY:
            raise
        raise FaultError(f"the permissions of this link do not let it {verb} {topic}") from None


def _matched(entity: Any, side: str) -> int:
    """Return the number of matched endpoints; Cyclone DDS 0.10 has that only in its C API."""
    if hasattr(entity, f"get_matched_{side}"):
        return len(getattr(entity, f"get_matched_{side}")())
    from cyclonedds.internal import DDS

    return max(0, int(getattr(DDS._dll_handle, f"dds_get_matched_{side}")(entity._ref, None, 0)))


def _octet_type(type_name: str, *, described: bool) -> Any:
    """Return a type of cyclonedds that is one octet, under ``type_name``, whose samples are bytes.

    One that is not ``described`` is compared only by name: others know it as another type.
    """
    from cyclonedds.idl import make_idl_struct, types

    made: Any = make_idl_struct("Octet", type_name, {"first": types.uint8}, dataclassify=False)
    if not described:
        made.__idl__.fill_type_data = _nothing
    made.__init__ = _keep
    made.serialize = _data
    made.deserialize = made.deserialize_key = classmethod(_made_of)
    return made


def _nothing() -> None:
    """Describe nothing."""


def _keep(sample: Any, data: bytes = b"") -> None:
    sample.data = data


def _data(sample: Any, *_of: Any, **_more: Any) -> Any:
    return sample.data


def _made_of(cls: Any, data: bytes, *_of: Any, **_more: Any) -> Any:
    return cls(data)


def _interface(name: str) -> str:
    by = "address" if name.replace(".", "").isdigit() or ":" in name else "name"
    return f"<NetworkInterface {by}={quoteattr(name)}/>"


def _peers_xml(peers: list[str]) -> str:
    if not peers:
        return "<ParticipantIndex>auto</ParticipantIndex>"
    peer_tags = "".join(f"<Peer address={quoteattr(peer)}/>" for peer in peers)
    return (
        f"<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>{MOST_PARTICIPANTS}"
        f"</MaxAutoParticipantIndex><Peers>{peer_tags}</Peers>"
    )
