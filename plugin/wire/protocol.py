"""The desk's JSON-RPC 2.0 conversation with the gateway: text in, text out, no socket."""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Callable
from typing import Any

from ...robot_bridge.messages import (
    PROTOCOL_VERSION,
    ClearEmergencyStop,
    CommandReport,
    EmergencyStop,
    GetCommands,
    Hello,
    RobotReport,
    SiteReport,
    Subscribe,
    command_report,
    emergency_report,
    robot_report,
    site_report,
    to_json,
)
from ..errors import LinkError
from .mailbox import Mailbox
from .outbox import Answer, Order, Outbox

Clock = Callable[[], float]


class DeskProtocol:
    """One link after the other with the same gateway: hello, subscription, commands, orders and answers.

    What is learnt goes to the mailbox. Orders wait in the outbox until the gateway answered them, across
    links; each is sent once on each link.
    """

    def __init__(self, operator: str, rate: float, url: str, mailbox: Mailbox, clock: Clock):
        self._operator = operator
        self._rate = rate
        self._url = url
        self._mailbox = mailbox
        self._clock = clock
        self._outbox = Outbox()
        self._ids = itertools.count(1)
        self._asked: dict[int, Order] = {}
        self.ready = False
        self.who = ""
        """Who this desk is to the gateway, and in which role; empty until it is known."""

    def begin(self) -> list[str]:
        """Return the first texts to send on a new link."""
        self._asked.clear()
        self.ready = False
        return [self._request(Order("hello", Hello.method, to_json(Hello(self._operator))))]

    def submit(self, order: Order) -> list[str]:
        """Return the texts to send now for a new order: none while the link is not ready."""
        if not self._outbox.put(order) or not self.ready:
            return []
        return [self._request(order)]

    def end(self) -> None:
        """Hand back every order that was not answered: nobody will ask for an answer any more."""
        for order in self._outbox.clear():
            self._mailbox.put_answer(
                Answer(
                    order,
                    error="The link was closed before the gateway answered: whether it arrived is not known. "
                    "Connect again and look in the command log.",
                )
            )

    def receive(self, text: str | bytes) -> list[str]:
        """Take in one text from the gateway and return the texts to send in turn.

        :raises LinkError: when the text is not what a gateway of this protocol sends.
        """
        try:
            message = json.loads(text)
            if not isinstance(message, dict):
                raise ValueError(f"a JSON object was expected, not {type(message).__name__}")
            if "method" in message:
                self._notified(message["method"], message.get("params") or {})
                return []
            return self._answered(message)
        except LinkError:
            raise
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise LinkError(
                f"What answers at {self._url} sent something that is not the desk's protocol: "
                f"{_start_of(text)} ({type(error).__name__}: {error}). "
                "Check that the URL leads to a Fleet Supervisor gateway of this version."
            ) from error

    def _request(self, order: Order) -> str:
        number = next(self._ids)
        self._asked[number] = order
        return json.dumps({"jsonrpc": "2.0", "id": number, "method": order.method, "params": order.params})

    def _notified(self, method: str, params: dict[str, Any]) -> None:
        if method == "positions":
            reports = [checked_robot(robot_report(values)) for values in params["robots"]]
            self._mailbox.put_robots(reports, self._clock())
        elif method == "command":
            self._mailbox.put_commands([command_report(params)])
        elif method == "emergency":
            self._mailbox.put_emergency(emergency_report(params))
        elif method == "site":
            self._mailbox.put_site(checked_site(site_report(params)))
        # Another notification is of a newer gateway and nothing that this desk asked for.

    def _answered(self, message: dict[str, Any]) -> list[str]:
        order = self._asked.pop(message.get("id", 0), None)
        if order is None:
            if "error" in message:
                raise LinkError(f"The gateway at {self._url} refused a message: {_error_text(message)}")
            return []
        if order.method == Hello.method:
            return self._welcomed(message)
        if order.method == Subscribe.method:
            if "error" in message:
                raise LinkError(f"The gateway at {self._url} sends no positions: {_error_text(message)}")
            return []
        return self._order_answered(order, message)

    def _welcomed(self, message: dict[str, Any]) -> list[str]:
        if "error" in message:
            raise LinkError(f"The gateway at {self._url} turned the desk away: {_error_text(message)}")
        result = message["result"]
        if result.get("protocol") != PROTOCOL_VERSION:
            raise LinkError(
                f"The gateway at {self._url} speaks protocol {result.get('protocol')}, this plugin protocol "
                f"{PROTOCOL_VERSION}. Update whichever of the two is older, then press Connect.",
                final=True,
            )
        self._mailbox.put_site(checked_site(site_report(result["site"])))
        self.who = ", ".join(str(result[name]) for name in ("operator", "role") if result.get(name))
        if "emergency" in result:
            self._mailbox.put_emergency(emergency_report(result["emergency"]))
        self.ready = True
        orders, too_old = self._outbox.renew(self._clock())
        for order in too_old:
            self._mailbox.put_answer(Answer(order, error=_too_old(self._clock() - order.asked_at)))
        first = [
            Order("subscribe", Subscribe.method, to_json(Subscribe(self._rate))),
            Order("get_commands", GetCommands.method, to_json(GetCommands())),
        ]
        return [self._request(order) for order in (*first, *orders)]

    def _order_answered(self, order: Order, message: dict[str, Any]) -> list[str]:
        waiting = self._outbox.answered(order.key)
        if "error" in message:
            if waiting is not None:
                self._mailbox.put_answer(Answer(order, error=_error_text(message)))
            return []
        result = message.get("result") or {}
        if order.method in (EmergencyStop.method, ClearEmergencyStop.method):
            self._mailbox.put_emergency(emergency_report(result))
        self._mailbox.put_commands(_commands_in(result))
        if waiting is not None:
            self._mailbox.put_answer(Answer(order, result=result))
        return []


def checked_robot(report: RobotReport) -> RobotReport:
    """Return ``report`` if its numbers are finite numbers, else raise ValueError naming the field."""
    for name in ("age", "x", "y", "theta", "v", "battery", "latency"):
        _check_number(f"{name} of robot {report.robot}", getattr(report, name), name != "age")
    return report


def checked_site(site: SiteReport) -> SiteReport:
    """Return ``site`` if its numbers are finite numbers, else raise ValueError naming the field."""
    numbers = (*site.origin, *site.bounds, site.rotation, site.stale_after, site.lost_after)
    for value in numbers:
        _check_number(f"a number of site {site.id}", value, False)
    if len(site.origin) != 2 or len(site.bounds) != 4:
        raise ValueError(f"origin or bounds of site {site.id} have the wrong length")
    return site


def _check_number(name: str, value: Any, may_miss: bool) -> None:
    if value is None and may_miss:
        return
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise ValueError(f"{name} is {value!r}, not a finite number")


def _commands_in(result: dict[str, Any]) -> list[CommandReport]:
    """Return the reports in an answer; oldest first, since get_commands answers with the newest first."""
    if "commands" in result:
        return [command_report(values) for values in reversed(result["commands"])]
    return [command_report(result)] if "command" in result else []


def _error_text(message: dict[str, Any]) -> str:
    error = message["error"]
    return str(error.get("message", error)) if isinstance(error, dict) else str(error)


def _too_old(age: float) -> str:
    return (
        f"The link was lost before the gateway answered, and {age:.0f} s later it was not repeated: a robot "
        "shall not drive off on an old order. Look in the command log and send it again if it is not there."
    )


def _start_of(text: str | bytes) -> str:
    shown = text if isinstance(text, str) else f"{len(text)} bytes"
    return repr(shown if len(shown) <= 60 else f"{shown[:60]}…")
