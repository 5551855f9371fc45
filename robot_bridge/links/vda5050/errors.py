"""The exception family of the VDA 5050 adapter."""

from __future__ import annotations

from ...errors import BridgeError


class Vda5050Error(BridgeError):
    """Something the adapter cannot do; the text names the vehicle, topic or setting, and what to do."""


class VehicleMessageError(Vda5050Error):
    """A message of a vehicle that is not what VDA 5050 asks for; the text names the field."""
