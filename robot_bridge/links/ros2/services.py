"""Clients of services and actions of ROS 2, over DDS.

With Fast DDS a request is the bare message, and the identity of its client is metadata that this program
cannot see: every client receives every reply. Cyclone DDS (rmw_cyclonedds) puts 16 bytes before both, the
client's number and the request's.
"""

from __future__ import annotations

import secrets
import struct
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from ..ros.errors import FaultError
from .dds import Endpoint, Participant, Quality, RawReader, RawWriter
from .interfaces import CYCLONE, ActionNames, Interfaces, ServiceNames

_HEADER = struct.Struct("<Qq")
_ENCAPSULATION = 4


Refuse = Callable[[FaultError], None]
"""Called with the fault of an unreadable message; the others are returned."""


class ServiceClient:
    """Calls one service; ``framed`` if its server uses Cyclone DDS. Replies are read by :meth:`replies`."""

    def __init__(
        self, participant: Participant, types: Interfaces, names: ServiceNames, kind: str, *, framed: bool
    ) -> None:
        self._types = types
        self._kind = kind
        self._framed = framed
        self._number = 0
        self._own = secrets.randbits(63)
        self._out: RawWriter = participant.writer(names.request, names.request_type, Quality())
        self._back: RawReader = participant.reader(names.reply, names.reply_type, Quality())

    @property
    def is_matched(self) -> bool:
        """Whether a server is matched for requests and replies."""
        return self._out.matched > 0 and self._back.matched > 0

    def call(self, request: Any) -> None:
        """Send a request."""
        data = self._types.encode(f"{self._kind}_Request", request)
        if self._framed:
            self._number += 1
            header = _HEADER.pack(self._own, self._number)
            data = data[:_ENCAPSULATION] + header + data[_ENCAPSULATION:]
        self._out.write(data)

    def replies(self, refuse: Refuse) -> list[Any]:
        """Return the received replies."""
        came = [self._unframed(data) for data in self._back.read_samples()]
        own = [data for data in came if data is not None]
        return _readable(self._types, f"{self._kind}_Response", own, refuse)

    def _unframed(self, data: bytes) -> bytes | None:
        """Return a reply without its header, None if it is another client's."""
        if not self._framed:
            return data
        end = _ENCAPSULATION + _HEADER.size
        if len(data) < end or _HEADER.unpack_from(data, _ENCAPSULATION)[0] != self._own:
            return None
        return data[:_ENCAPSULATION] + data[end:]


class ServiceServer:
    """Answers each call of a service with one reply, for nodes on Cyclone DDS.

    Calls from Fast DDS lack the header that a reply repeats, and cannot be answered.
    """

    def __init__(self, participant: Participant, names: ServiceNames) -> None:
        self._calls = participant.reader(names.request, names.request_type, Quality())
        self._replies = participant.writer(names.reply, names.reply_type, Quality())
        self._reply = b""

    def set_reply(self, reply: bytes) -> None:
        """Answer each call with ``reply``, the CDR of a response, from now on."""
        self._reply = reply

    def answer(self) -> bool:
        """Answer the received calls; return whether one could not be answered."""
        unanswered = False
        end = _ENCAPSULATION + _HEADER.size
        for call in self._calls.read_samples():
            if len(call) > end:
                header = call[_ENCAPSULATION:end]
                self._replies.write(self._reply[:_ENCAPSULATION] + header + self._reply[_ENCAPSULATION:])
            else:
                unanswered = True
        return unanswered


class ActionClient:
    """A client of one action: its three services and two topics."""

    def __init__(
        self, participant: Participant, types: Interfaces, names: ActionNames, kind: str, *, framed: bool
    ) -> None:
        self._types = types
        self.kind = kind
        self.send = ServiceClient(
            participant, types, names.send_goal, f"nav2_msgs/action/{kind}_SendGoal", framed=framed
        )
        self.cancel = ServiceClient(
            participant, types, names.cancel_goal, "action_msgs/srv/CancelGoal", framed=framed
        )
        self.result = ServiceClient(
            participant, types, names.get_result, f"nav2_msgs/action/{kind}_GetResult", framed=framed
        )
        self.status = participant.reader(names.status, names.status_type, Quality(latched=True))
        self.feedback = participant.reader(names.feedback, names.feedback_type, Quality())

    @property
    def is_matched(self) -> bool:
        """Whether the server is matched in both directions."""
        return self.send.is_matched and self.cancel.is_matched and self.status.matched > 0

    def send_goal(self, goal: bytes, **fields: Any) -> None:
        """Send a goal with the fields of its action."""
        named = f"nav2_msgs/action/{self.kind}_SendGoal_Request"
        self.send.call(self._types.make(named, goal_id=self._id(goal), **fields))

    def ask_result(self, goal: bytes) -> None:
        """Request the result of an accepted goal: the answer comes at its end."""
        named = f"nav2_msgs/action/{self.kind}_GetResult_Request"
        self.result.call(self._types.make(named, goal_id=self._id(goal)))

    def cancel_goals(self, goal: bytes | None) -> None:
        """Cancel a goal; None: all."""
        request = self._types.make("action_msgs/srv/CancelGoal_Request")
        if goal is not None:
            request.goal_info.goal_id = self._id(goal)
        self.cancel.call(request)

    def statuses(self, refuse: Refuse) -> list[Any]:
        """Return the received action_msgs/GoalStatusArray messages."""
        return _readable(self._types, "action_msgs/msg/GoalStatusArray", self.status.read_samples(), refuse)

    def newest_feedback(self, refuse: Refuse) -> tuple[bytes, Any] | None:
        """Return the newest feedback with its goal's id, or None."""
        named = f"nav2_msgs/action/{self.kind}_FeedbackMessage"
        samples = _readable(self._types, named, self.feedback.read_samples()[-1:], refuse)
        return (bytes(samples[0].goal_id.uuid), samples[0]) if samples else None

    def results(self) -> list[Any]:
        """Return the received results; those with the layout of another distribution are skipped."""
        return self.result.replies(lambda _: None)

    def _id(self, goal: bytes) -> Any:
        uuid = np.frombuffer(goal, dtype=np.uint8)
        return self._types.make("unique_identifier_msgs/msg/UUID", uuid=uuid)


def _readable(types: Interfaces, type_name: str, samples: Iterable[bytes], refuse: Refuse) -> list[Any]:
    messages = []
    for data in samples:
        try:
            messages.append(types.decode(type_name, data))
        except FaultError as error:
            refuse(error)
    return messages


def is_framed(server: Endpoint) -> bool:
    """Return whether a server's requests and replies have a header."""
    return (server.participant[0], server.participant[1]) == CYCLONE


def by_topic(endpoints: Iterable[Endpoint]) -> dict[tuple[str, bool], list[Endpoint]]:
    """Return the readers (True) and writers (False) of each DDS topic."""
    found: dict[tuple[str, bool], list[Endpoint]] = {}
    for one in endpoints:
        found.setdefault((one.topic, one.wants), []).append(one)
    return found
