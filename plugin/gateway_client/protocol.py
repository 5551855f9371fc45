"""The desk's JSON-RPC 2.0 conversation with the gateway: text in, text out, without a socket."""

from __future__ import annotations

import itertools
import json
import math
from typing import Any

from ...robot_bridge.core.clock import Clock
from ...robot_bridge.core.json_decoder import DOCUMENT, check_bounds
from ...robot_bridge.core.messages import administration, links, records, roads, safety
from ...robot_bridge.core.messages.administration import PROTOCOL_VERSION, Hello, SiteReport
from ...robot_bridge.core.messages.base import DESK_REQUESTS, LONGEST_OPERATOR, Role, one_line, to_json
from ...robot_bridge.core.messages.commands import GetCommands
from ...robot_bridge.core.messages.plans import GetPlans
from ...robot_bridge.core.messages.positions import PositionForm, Subscribe, View
from ...robot_bridge.core.messages.queues import GetQueue, queue_report
from ...robot_bridge.core.messages.roads import GetClosures
from ...robot_bridge.core.reconnection import FleetGateways, GatewayAddresses
from ..ui.errors import GatewayLinkError
from ..ui.language import tr
from .command_cache import command_in, commands_in
from .connection_status import DEFAULT_URL, MISREAD, misunderstood
from .fleet_state import OperatorRequest, RequestGround, RequestResult, UpdateBuffer
from .report_caches import observations_in, placements_in, plan_in, plans_in, queues_in
from .request_outbox import REPEAT_WITHIN, RequestOutbox, stops_robots
from .robot_states import table_from_rows

UNKNOWN_METHOD, WRONG_PARAMETERS = -32601, -32602
"""Error codes of JSON-RPC: robots' endpoints know no greeting, and links' endpoints another one."""
OUTDATED = -32006
OVERRIDABLE = -32007
"""The error code of a change to an object that has changed since it was read; the newer state is included."""

NEWEST_COUNTS = {
    "suspensions": administration.suspensions_report,
    "links": links.links_report,
    "geofence": safety.geofence_report,
    "nearness": safety.nearness_report,
    "closures": roads.closures_report,
    "conflicts": roads.conflicts_report,
}
"""Notifications of which only the newest counts, each a topic of the same name, and their decoders."""
EACH_COUNTS = {
    "command": ("commands", command_in),
    "queue": ("queues", queue_report),
    "plan": ("plans", plan_in),
    "placement": ("placed_cones", records.placement_report),
    "observation": ("observations", records.observation_report),
    "replanned": ("replanned", roads.replanned_robot),
}
"""Notifications about one object among many: the topic, and its decoder."""

VIEWS_FROM = 5000
"""Number of robots above which the desk receives those in its view only."""
ALL_QUEUES = "every queue"
"""The key of the request for all queues at the beginning of a link."""
ALL_PLANS = "every plan"
"""The key of the request for all cone plans at the beginning of a link; older gateways lack it."""


class GatewayProtocol:
    """A sequence of links with gateways of one fleet: hello, subscription, requests and answers.

    Reports are added to the buffer, and the fleet's other addresses to ``addresses``. Requests wait in the
    outbox until a gateway has answered them, across links; each is sent once on each link. The gateways of a
    fleet share its database, and know by their ids those that another has done. ``database`` identifies the
    fleet whose addresses were known before the first link, if any were.
    """

    def __init__(
        self,
        operator: str,
        rate: float,
        addresses: GatewayAddresses,
        buffer: UpdateBuffer,
        clock: Clock,
        database: str = "",
    ):
        self._operator = operator
        self._rate = rate
        self._addresses = addresses
        self._database = database
        self._buffer = buffer
        self._clock = clock
        self._outbox = RequestOutbox()
        self._ids = itertools.count(1)
        self._pending: dict[int, OperatorRequest] = {}
        self._sent: set[str] = set()
        self._sent_before: set[str] = set()
        """Orders without an answer, by their keys: those sent on this link, and on one that was lost."""
        self._gateway_ahead: float | None = None
        """Seconds by which the gateway's clock for deadlines is ahead of ours; None where it has none."""
        self._stop: str | None = None
        """The id of the last known emergency stop, whoever made it."""
        self._ground: RequestGround | None = None
        """The context of places and names at the gateway; None until one has greeted."""
        self._view: dict[str, Any] | None = None
        """The view that the window wants to receive, None for every robot."""
        self._knows_views = False
        self.ready = self._has_ended = False
        self.operator, self.role = "", ""
        """The desk's account and role at the gateway; empty until known."""
        self.names: dict[str, str] = {}
        """The names of gateways that have greeted this desk, by their URLs, where several serve the fleet."""

    @property
    def _url(self) -> str:
        return self._addresses.current

    def begin(self) -> list[str]:
        """Return the first texts to send on a new link."""
        self._pending.clear()
        self._sent_before = {key for key in self._sent_before | self._sent if key in self._outbox}
        self._sent.clear()
        self._gateway_ahead = None
        self.ready = False
        # A name that the gateway would refuse must not lock out the operator.
        name = one_line(self._operator.strip(), LONGEST_OPERATOR)
        return [self._request(OperatorRequest.of("hello", Hello(name)))]

    def submit(self, order: OperatorRequest) -> list[str]:
        """Return the texts to send now for a new request: none while the link is not ready.

        A subscription remains in force, also on later links; a gateway that knows no views gets none.
        """
        if order.method == Subscribe.method:
            self._view = order.params.get("view")
            return [self._subscription()] if self.ready and self._knows_views else []
        if not self._outbox.add(order) or not self.ready:
            if self._has_ended:
                self.end()
            return []
        # The window may not know yet which gateway has greeted since its last poll.
        self._hand_back_foreign()
        return [self._request(order)] if order.key in self._outbox else []

    @property
    def has_stop(self) -> bool:
        """Whether something that stops robots waits for a link, or for its answer."""
        return self._outbox.has_stop

    def end_link(self) -> None:
        """Send nothing until the next link has been greeted."""
        self.ready = False

    def refuse_largest(self) -> None:
        """Hand back the largest request: the gateway ended the link over its size, and would do so again."""
        order, size = self._outbox.largest()
        if order is not None:
            text = tr(
                "the gateway takes no message as large as this one of {size} kB. Ask for less at once, or "
                "have largest_message_bytes raised in the site's settings.",
                size=-(-size // 1000),
            )
            self._buffer.add_answer(RequestResult(order, error=text))

    def _hand_back_foreign(self) -> None:
        """Hand back requests made in another context than the gateway's: their places are others here."""
        for order in self._outbox.without_ground(self._ground):
            self._buffer.add_answer(RequestResult(order, error=_other_ground()))

    def end(self) -> None:
        """Hand back every unanswered request, and from now on each at once: there is no link."""
        self.ready, self._has_ended = False, True
        for order in self._outbox.clear():
            self._buffer.add_answer(
                RequestResult(
                    order,
                    error=tr(
                        "The link was closed before the gateway answered: whether it arrived is not known. "
                        "Connect again and look in the command log."
                    ),
                )
            )

    def receive(self, text: str) -> list[str]:
        """Receive one text from the gateway and return the texts to send in reply.

        :raises GatewayLinkError: when a gateway would not send it, or there can be no link.
        """
        try:
            # NaN and infinities are reported by the code that reads them.
            check_bounds(text, DOCUMENT)
            message = json.loads(text)
            if not isinstance(message, dict):
                raise ValueError(f"a JSON object was expected, not {type(message).__name__}")
            if "method" in message:
                self._notified(message["method"], message.get("params") or {})
                return []
            return self._answered(message)
        except MISREAD as error:
            raise misunderstood(self._url, text, error) from error

    def _request(self, order: OperatorRequest) -> str:
        number = next(self._ids)
        self._pending[number] = order
        if order.key in self._outbox:
            self._sent.add(order.key)
        frame = {"jsonrpc": "2.0", "id": number, "method": order.method, "params": order.params}
        if order.ground is not None and self._gateway_ahead is not None:
            frame["deadline"] = round(order.requested_at + REPEAT_WITHIN + self._gateway_ahead, 3)
        return json.dumps(frame)

    def _subscription(self) -> str:
        params = to_json(Subscribe(self._rate, PositionForm.COLUMNS))
        if self._knows_views and self._view is not None:
            params["view"] = self._view
        return self._request(OperatorRequest("subscribe", Subscribe.method, params))

    def _notified(self, method: str, params: dict[str, Any]) -> None:
        if method == "positions":
            self._buffer.add(robots=table_from_rows(params["robots"], self._clock.steady(), params))
        elif method == "site":
            site = checked_site(administration.site_report(params))
            self._ground = RequestGround.of(site, self._database)
            self._buffer.add(site=site)
        elif method == "gateways":
            self._learn(params["gateways"])
        elif method == "emergency":
            self._learn_stop(safety.emergency_report(params))
        elif method in NEWEST_COUNTS:
            self._buffer.add(**{method: NEWEST_COUNTS[method](params)})
        elif method in EACH_COUNTS:
            topic, decode = EACH_COUNTS[method]
            self._buffer.add(**{topic: [decode(params)]})
        # Another notification belongs to a newer gateway and was not requested by this desk.

    def _answered(self, message: dict[str, Any]) -> list[str]:
        order = self._pending.pop(message.get("id", 0), None)
        if order is None:
            if "error" in message:
                raise GatewayLinkError(
                    tr(
                        "The gateway at {url} refused a message: {error}",
                        url=self._url,
                        error=_error_text(message),
                    )
                )
            return []
        if order.method == Hello.method:
            return self._welcomed(message)
        if order.method == Subscribe.method:
            if "error" in message:
                raise GatewayLinkError(
                    tr(
                        "The gateway at {url} sends no positions: {error}",
                        url=self._url,
                        error=_error_text(message),
                    )
                )
            return []
        return self._order_answered(order, message)

    def _welcomed(self, message: dict[str, Any]) -> list[str]:
        """Take in the answer to hello; return the first frames."""
        self._check_welcome(message)
        self._learn_welcome(message["result"])
        self.ready = True
        self._hand_back_foreign()
        return self._first_frames()

    def _check_welcome(self, message: dict[str, Any]) -> None:
        """Raise GatewayLinkError unless the gateway admits this desk and speaks its protocol."""
        if "error" in message:
            if _code(message) == UNKNOWN_METHOD:
                raise GatewayLinkError(
                    tr(
                        "No operator can connect at {url}: what answers there knows no desk, as the address "
                        "of robots does not. A gateway's desk has the path /desk, as in {default_url}. "
                        "Correct the URL, then press Connect.",
                        url=self._url,
                        default_url=DEFAULT_URL,
                    ),
                    final=True,
                )
            raise GatewayLinkError(
                tr(
                    "The gateway at {url} turned the desk away: {error}",
                    url=self._url,
                    error=_error_text(message),
                ),
                final=_code(message) == WRONG_PARAMETERS,
            )
        theirs = message["result"].get("protocol")
        if theirs != PROTOCOL_VERSION:
            raise GatewayLinkError(
                tr(
                    "The gateway at {url} speaks protocol {theirs}, this plugin protocol {ours}. "
                    "Update whichever of the two is older, then press Connect.",
                    url=self._url,
                    theirs=theirs,
                    ours=PROTOCOL_VERSION,
                ),
                final=True,
            )

    def _learn_welcome(self, result: dict[str, Any]) -> None:
        database = str(result.get("database") or "")
        self._check_fleet(database)
        self._learn(result.get("gateways"))
        if result.get("gateway"):
            self.names[self._url] = one_line(str(result["gateway"]), LONGEST_OPERATOR)
        site = checked_site(administration.site_report(result["site"]))
        self._ground = RequestGround.of(site, database)
        self._buffer.add(site=site, greeting_of=database)
        self.operator, self.role = (str(result.get(name) or "") for name in ("operator", "role"))
        if "emergency" in result:
            self._learn_stop(safety.emergency_report(result["emergency"]))
        self._choose_view(result)
        self._set_clock(result)

    def _first_frames(self) -> list[str]:
        """Return what is sent first: stops, the subscription and queries, and what waited for a link."""
        # First those too old, as their stops may be: of them nobody knows whether they were done.
        orders, too_old = self._outbox.renew(now := self._clock.steady())
        for order in too_old:
            self._buffer.add_answer(RequestResult(order, error=_too_old(order, now)))
        for order in self._outbox.withdraw_void():
            self._buffer.add_answer(RequestResult(order, error=_made_void()))
        orders = [order for order in orders if order.key in self._outbox]
        first = [
            OperatorRequest.of("get_commands", GetCommands()),
            OperatorRequest.of("get_closures", GetClosures()),
            OperatorRequest.of(ALL_QUEUES, GetQueue()),
            OperatorRequest.of(ALL_PLANS, GetPlans()),
        ]
        stops = [self._request(order) for order in orders if stops_robots(order)]
        others = (*first, *(order for order in orders if not stops_robots(order)))
        return [*stops, self._subscription(), *map(self._request, others)]

    def _choose_view(self, result: dict[str, Any]) -> None:
        """Start with a view where there are many robots; the window then requests the one that it shows."""
        robots = result.get("robots")
        self._knows_views = isinstance(robots, int)
        if self._view is None and self._knows_views and robots > VIEWS_FROM:
            self._view = to_json(View(tuple(result["site"]["bounds"])))

    def _set_clock(self, values: dict[str, Any]) -> None:
        """Set the offset of the gateway's clock for deadlines; a reading is a moment old, so none is late."""
        now = values.get("now")
        if now is not None:
            _check_number("the gateway's clock", now)
            self._gateway_ahead = now - self._clock.steady()

    def _learn_stop(self, report: safety.EmergencyReport) -> None:
        """Apply a report of the emergency stop; a new one, cleared by now or not, makes void what waits."""
        if report.stop != self._stop:
            self._outbox.overtake(None)
        self._stop = report.stop
        if report.cleared_at is not None and (done := self._outbox.stop_made(report.stop)) is not None:
            # It arrived, and sent again it would be another stop.
            self._buffer.add_answer(RequestResult(done, result=to_json(report)))
        self._buffer.add(emergency=report)

    def _learn(self, reported: object) -> None:
        """Learn other addresses of the fleet, and have them kept for the next session."""
        self._addresses.learn(reported)
        others = tuple(one for one in self._addresses.known if one != self._addresses.given)
        self._buffer.add(gateways=FleetGateways(self._database, others))

    def _check_fleet(self, database: str) -> None:
        """Raise GatewayLinkError for a gateway that another one reported, and that now serves another fleet.

        The one that the operator gave may have another database than before: that is shown instead.
        """
        if not self._addresses.is_given and database != self._database:
            raise GatewayLinkError(
                tr(
                    "The gateway at {url} serves another fleet than the gateway that named it. Connect to "
                    "it yourself if that is what you want.",
                    url=self._url,
                ),
                final=True,
            )
        if database != self._database:
            self._addresses.forget()
        self._database = database

    def _order_answered(self, order: OperatorRequest, message: dict[str, Any]) -> list[str]:
        waiting = self._outbox.answered(order.key)
        may_be_done = order.key in self._sent_before and _changes_something(order)
        self._sent.discard(order.key)
        self._sent_before.discard(order.key)
        if "error" in message:
            self._set_clock(_data(message))
            outdated = _code(message) == OUTDATED
            if outdated:
                newer = _data(message)
                self._buffer.add(queues=queues_in(newer), plans=plans_in(newer))
            if order.key == ALL_PLANS and _code(message) == UNKNOWN_METHOD:
                self._buffer.add(is_driving=False)
            if waiting is not None:
                found = _found(message) if _code(message) == OVERRIDABLE else ()
                text = _error_text(message)
                text = f"{text}. {_sent_twice()}" if may_be_done else text
                self._buffer.add_answer(
                    RequestResult(
                        order, error=text, outdated=outdated, overridable=found, may_be_done=may_be_done
                    )
                )
            return []
        result = message.get("result") or {}
        if order.method in (safety.EmergencyStop.method, safety.ClearEmergencyStop.method):
            self._learn_stop(safety.emergency_report(result))
        if order.method == GetClosures.method:
            self._buffer.add(closures=roads.closures_report(result))
        self._buffer.add(
            queues=queues_in(result),
            are_all_queues=order.key == ALL_QUEUES,
            plans=plans_in(result),
            is_driving=True if order.key == ALL_PLANS else None,
            commands=commands_in(result),
            placed_cones=placements_in(result),
            observations=observations_in(result),
        )
        if waiting is not None:
            self._buffer.add_answer(RequestResult(order, result=result))
        return []


def _changes_something(order: OperatorRequest) -> bool:
    request = DESK_REQUESTS.get(order.method)
    return request is not None and request.least_role is not Role.VIEWER


def checked_site(site: SiteReport) -> SiteReport:
    """Return ``site`` if its numbers are finite, else raise ValueError naming the field."""
    numbers = (*site.origin, *site.bounds, site.rotation, site.stale_after, site.lost_after)
    for value in numbers:
        _check_number(f"a number of site {site.id}", value)
    if len(site.origin) != 2 or len(site.bounds) != 4:
        raise ValueError(f"origin or bounds of site {site.id} have the wrong length")
    return site


def _check_number(name: str, value: Any) -> None:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise ValueError(f"{name} is {value!r}, not a finite number")


def _error_text(message: dict[str, Any]) -> str:
    error = message["error"]
    return str(error.get("message", error)) if isinstance(error, dict) else str(error)


def _code(message: dict[str, Any]) -> Any:
    error = message["error"]
    return error.get("code") if isinstance(error, dict) else None


def _data(message: dict[str, Any]) -> dict[str, Any]:
    """Return the data of an error besides its text."""
    error = message["error"]
    data = error.get("data") if isinstance(error, dict) else None
    return data if isinstance(data, dict) else {}


def _found(message: dict[str, Any]) -> tuple[str, ...]:
    """Return the findings against a request that can be overridden."""
    return tuple(str(text) for text in message["error"]["data"]["found"])


def _other_ground() -> str:
    return tr(
        "Another site, or another fleet, is served now than when this was asked for, and the same numbers "
        "are other places there: it was not sent to it. Look at the map, and ask for it again if it is still "
        "needed."
    )


def _sent_twice() -> str:
    return tr(
        "It was sent before on a link that was lost, and may have been done then: look before you ask again."
    )


def _made_void() -> str:
    return tr(
        "The link was lost before the gateway answered, and it was not sent again: robots were asked to stop "
        "after it. If it had arrived before, the command log shows it, and the stop ends it."
    )


def _too_old(order: OperatorRequest, now: float) -> str:
    age = now - order.requested_at
    if stops_robots(order):
        return tr(
            "The link was lost before the gateway answered, and {age:.0f} s later it was not repeated: the "
            "robot may be doing something else by now. Look at the robot, and ask again if it shall still "
            "stop.",
            age=age,
        )
    return tr(
        "The link was lost before the gateway answered, and {age:.0f} s later it was not repeated: a "
        "robot shall not drive off on an old order. Look in the command log and send it again if it is "
        "not there.",
        age=age,
    )
