"""The exception family of links."""

from ...core.errors import BridgeError


class LinkError(BridgeError):
    """A link that cannot be set up, or cannot continue; the text names file and key, with advice."""


class FrameChangedError(LinkError):
    """The gateway serves a site of another frame than before: data in the old one is wrong."""


class CommandRefusedError(Exception):
    """A robot refuses a command: the text is the reason shown to operators."""
