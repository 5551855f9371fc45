"""Many who knock at once with tokens that are not known, while the accounts cannot be read."""

from __future__ import annotations

import asyncio

from websockets.asyncio.client import connect
from websockets.exceptions import InvalidStatus

from robot_bridge.core.sites.settings_tables import LimitSettings
from robot_bridge.gateway.auth.accounts import TokenKind, new_token
from robot_bridge.gateway.auth.authorisation import AuthGate
from robot_bridge.gateway.auth.port import listen
from robot_bridge.gateway.storage.database import Database
from tests.support.bridge.bridge_accounts import bearing


async def status_of(address: str) -> int:
    try:
        async with connect(address, **bearing(new_token(TokenKind.OPERATOR))):
            return 101
    except InvalidStatus as error:
        return error.response.status_code


async def test_nobody_is_said_to_be_unknown_while_the_accounts_cannot_be_read(tmp_path):
    database = Database(f"sqlite:///{tmp_path}/away/fleet.db")
    gate = AuthGate(database, LimitSettings(), may_be_open=False)

    async def admit(visitor, request):
        return await gate.admit(visitor, request, TokenKind.OPERATOR, None, 1000)

    async def serve(visitor):
        await visitor.wait_closed()

    server = await listen(gate, "127.0.0.1", 0, None, admit, serve)
    async with server:
        address = f"ws://127.0.0.1:{next(iter(server.sockets)).getsockname()[1]}"
        assert await asyncio.gather(*(status_of(address) for _ in range(10))) == [503] * 10
    await database.close()
