"""The exception family of links."""

from ...core.errors import BridgeError


class LinkError(BridgeError):
    """A link that cannot be set up, or cannot go on; the text names file and key, and what to do."""


class FrameChangedError(LinkError):
    """The gateway serves a site of another frame than before: all that goes by the old one is wrong."""


class CommandRefusedError(Exception):
    """What a robot was told and will not do: the text is the reason that operators read."""
