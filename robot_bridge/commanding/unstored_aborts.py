"""Aborts that the database did not take, kept until it does."""

from __future__ import annotations

from collections.abc import Iterable

from ..command_life.open_command import Order
from ..messages import Abort


class UnstoredAborts:
    """The newest Abort of each robot, and of each command that was to be aborted alone.

    The Abort of an emergency stop is not among them: the stop keeps it.
    """

    def __init__(self) -> None:
        self._orders: dict[str, dict[str | None, Order]] = {}

    def keep(self, orders: Iterable[Order]) -> None:
        """Keep the Aborts among ``orders``."""
        for order in orders:
            if isinstance(order.message, Abort) and not order.is_emergency:
                self._orders.setdefault(order.robot, {})[order.aborts] = order

    def of(self, robots: Iterable[str]) -> list[Order]:
        """Return the Aborts of ``robots``."""
        return [order for robot in robots for order in self._orders.get(robot, {}).values()]

    def robots(self) -> list[str]:
        """Return the names of the robots of which there are some."""
        return list(self._orders)

    def discard(self, order: Order) -> None:
        """Forget an Abort, unless a newer one is kept in its place."""
        mine = self._orders.get(order.robot, {})
        if mine.get(order.aborts) is order:
            del mine[order.aborts]
        if not mine:
            self._orders.pop(order.robot, None)
