"""Subscriptions to one robot's topics over rosbridge."""

from __future__ import annotations

from dataclasses import dataclass

from ...messages import SendGPS, SendPos
from ..ros.errors import FaultError
from ..ros.sensing import Sensing
from .connection import Inbox, RosbridgeConnection, Subscription
from .decoding import convert
from .graph import Graph
from .messages import READABLE
from .settings import RosbridgeSettings


@dataclass
class _Heard:
    """A topic that is read."""

    topic: str
    type_name: str
    inbox: Inbox


class Listening:
    """Reads a robot's topics while they are there, and hands their messages to its sensing."""

    def __init__(
        self, sensing: Sensing, settings: RosbridgeSettings, connection: RosbridgeConnection
    ) -> None:
        self._sensing = sensing
        self._settings = settings
        self._connection = connection
        self._heard: dict[str, _Heard] = {}
        self._camera: tuple[str, str] | None = None
        """The topic of its images, and its type."""

    def connect(self, network: Graph) -> None:
        """Read what is offered under the robot's names now; what has another type now is read anew."""
        for kind, topic in self._sensing.topics().items():
            told = network.topics.get(topic)
            if kind == "image":
                self._camera = None if told is None else (topic, told)
                continue
            known = self._heard.get(kind)
            if told is None or (known is not None and known.type_name == told):
                # A topic that is gone stays asked for: the server tells it as soon as it is there again.
                continue
            self._read(kind, topic, told)

    def poll(self) -> SendPos | SendGPS | None:
        """Take in what has come; return the robot's newest position, None where none came."""
        self._watch()
        newest: SendPos | SendGPS | None = None
        for kind, heard in list(self._heard.items()):
            for content in heard.inbox.drain():
                where = f"{heard.topic} ({heard.type_name})"
                try:
                    message = convert(content, READABLE[heard.type_name], where)
                except FaultError as error:
                    self._sensing.refuse(heard.topic, error)
                else:
                    newest = self._sensing.receive(kind, heard.topic, heard.type_name, message) or newest
        return newest

    def _watch(self) -> None:
        """Read images only while one is waited for: a camera sends more than a network should carry."""
        if self._camera is not None and self._sensing.wants_image:
            if "image" not in self._heard:
                self._read("image", *self._camera)
        elif (heard := self._heard.pop("image", None)) is not None:
            self._connection.unsubscribe(heard.topic)

    def _read(self, kind: str, topic: str, told: str) -> None:
        """Read a topic of which rosapi has told the type."""
        if self._heard.pop(kind, None) is not None:
            self._connection.unsubscribe(topic)
        type_name = self._sensing.check_type(kind, topic, told, told)
        if type_name is not None:
            if kind != "image":
                self._sensing.faults.pop(topic, None)
            inbox = self._connection.subscribe(topic, self._wanted(kind, type_name))
            self._heard[kind] = _Heard(topic, type_name, inbox)

    def _wanted(self, kind: str, type_name: str) -> Subscription:
        own = self._settings
        if kind in ("tf", "tf_static"):
            # Each message has other frames: none may be left out.
            return Subscription(type_name, compression=own.compression)
        return Subscription(type_name, own.throttle_ms, own.queue_length, own.compression)
