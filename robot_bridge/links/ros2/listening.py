"""Readers of one robot's topics over DDS."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ...messages import SendGPS, SendPos
from ..ros.errors import FaultError
from ..ros.sensing import Sensing
from ..ros.types import READ
from .dds import Endpoint, Participant, Quality, RawReader, quality_for
from .interfaces import Interfaces
from .names import topic_to_dds, type_from_dds

Offers = Mapping[tuple[str, bool], list[Endpoint]]


@dataclass
class _Heard:
    """A topic that is read."""

    topic: str
    type_name: str
    reader: RawReader
    quality: Quality
    offers: frozenset[bytes]


class Listening:
    """Reads a robot's topics as they are offered, and hands their messages to its sensing."""

    def __init__(self, sensing: Sensing, participant: Participant, types: Interfaces) -> None:
        self._sensing = sensing
        self._participant = participant
        self._types = types
        self._heard: dict[str, _Heard] = {}
        self._camera: tuple[str, list[Endpoint]] | None = None
        """The topic of its images, and who offers it."""

    def connect(self, offers: Offers) -> None:
        """Read what is offered under the robot's names; what is offered otherwise now is read anew."""
        for kind, topic in self._sensing.topics().items():
            offered = offers.get((topic_to_dds(topic), False), [])
            if kind == "image":
                self._camera = (topic, offered) if offered else None
            elif offered:
                self._read(kind, topic, offered)
            elif self._heard.pop(kind, None) is not None:
                self._sensing.faults.pop(topic, None)

    def poll(self) -> SendPos | SendGPS | None:
        """Take in what has come; return the robot's newest position, None where none came."""
        self._watch()
        newest: SendPos | SendGPS | None = None
        for kind, heard in list(self._heard.items()):
            for data in heard.reader.read_samples():
                try:
                    message = self._types.decode(heard.type_name, data)
                except FaultError as error:
                    self._sensing.refuse(heard.topic, error)
                else:
                    newest = self._sensing.receive(kind, heard.topic, heard.type_name, message) or newest
        return newest

    def _watch(self) -> None:
        """Read images only while one is waited for: a camera sends more than a network should carry twice."""
        if self._camera is not None and self._sensing.wants_image:
            self._read("image", *self._camera)
        elif (heard := self._heard.pop("image", None)) is not None:
            heard.reader.close()

    def _read(self, kind: str, topic: str, offered: list[Endpoint]) -> None:
        keys = frozenset(one.key for one in offered)
        heard = self._heard.get(kind)
        if heard is not None and heard.offers == keys:
            return
        # Another node that publishes nonsense under the topic's name takes no robot's own away.
        strange = [one for one in offered if type_from_dds(one.type_name) not in READ[kind]]
        offered = [one for one in offered if one not in strange] or offered
        found = type_from_dds(offered[0].type_name)
        type_name = self._sensing.check_type(kind, topic, found, offered[0].type_name)
        if type_name is None:
            self._heard.pop(kind, None)
            return
        if strange:
            self._sensing.check_type(kind, topic, None, strange[0].type_name)
        elif len({one.participant for one in offered}) > 1 and kind == "position":
            self._sensing.fault(topic, f"{len(offered)} nodes publish {topic}; end all but one of them")
        elif kind != "image":
            self._sensing.faults.pop(topic, None)
        quality = quality_for(offered, depth=1 if kind == "image" else 10)
        if heard is None or heard.quality != quality or heard.type_name != type_name:
            reader = self._participant.reader(topic_to_dds(topic), offered[0].type_name, quality)
            self._heard[kind] = _Heard(topic, type_name, reader, quality, keys)
        else:
            heard.offers = keys
