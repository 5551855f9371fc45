"""A transaction fails, of which the gateway does not die, and everything comes to its end all the same."""

from __future__ import annotations

import pytest

from tests.support.bridge.crash_play import DRIVE_ON
from tests.support.bridge.crash_scenarios import SCENARIOS
from tests.support.bridge.mortal_database import FAILURES, Death


@pytest.mark.parametrize("scenario", SCENARIOS)
async def test_everything_comes_to_its_end_whichever_transaction_fails(scenario, play, writing, moments):
    times, while_stopped = await writing(scenario)
    for at, (done, error) in moments(scenario, times, FAILURES, while_stopped):
        failure = Death(at, done, error)
        await play(scenario, failure, DRIVE_ON)
        assert failure.has_come
