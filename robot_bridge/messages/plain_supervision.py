"""What supervisors are told, from plain JSON values: accounts, tokens, open sessions, sites."""

from __future__ import annotations

from typing import Any

from .accounts import NewToken, OperatorReport, Operators, TokenState
from .known_fields import known_fields
from .roles import Role
from .service import LinkReport, Links, Suspension, Suspensions
from .sites import SiteOffer, Sites
from .supervision import SessionReport


def operators_report(values: dict[str, Any]) -> Operators:
    """Return every account that a gateway sent as JSON."""
    return Operators([_operator_report(one) for one in values["operators"]])


def _operator_report(values: dict[str, Any]) -> OperatorReport:
    enums = {"role": Role(values["role"]), "token": TokenState(values["token"])}
    return OperatorReport(**{**known_fields(OperatorReport, values), **enums})


def new_token(values: dict[str, Any]) -> NewToken:
    """Return the token that was just made, as a gateway sent it as JSON."""
    return NewToken(**{**known_fields(NewToken, values), "role": Role(values["role"])})


def open_session(values: dict[str, Any]) -> SessionReport:
    """Return one connection of an operator, as a gateway sent it as JSON."""
    return SessionReport(**known_fields(SessionReport, values))


def suspensions_report(values: dict[str, Any]) -> Suspensions:
    """Return which robots' accounts are locked, as a gateway sent it as JSON."""
    return Suspensions([Suspension(**known_fields(Suspension, one)) for one in values["robots"]])


def links_report(values: dict[str, Any]) -> Links:
    """Return how each link is, as a gateway sent it as JSON."""
    return Links([LinkReport(**known_fields(LinkReport, one)) for one in values["links"]])


def sites_report(values: dict[str, Any]) -> Sites:
    """Return the sites that a gateway may serve, as it sent them as JSON."""
    return Sites([SiteOffer(**known_fields(SiteOffer, one)) for one in values["sites"]])
