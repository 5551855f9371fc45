"""What a gateway goes by in its first seconds: robots have driven on since what is stored of them."""

from __future__ import annotations

PATH = [(20.0, 40.0), (40.0, 40.0), (40.0, 60.0)]


async def test_a_path_that_was_driven_before_its_acknowledgement_came_is_reached(roads):
    await roads.ready()
    await roads.take()
    await roads.at(*PATH[0])
    await roads.fleet.save()
    await roads.send("a", "SetPath", points=PATH)
    (row,) = await roads.deliver()
    await roads.restart()
    await roads.ready()
    await roads.at(*PATH[-1])
    await roads.ack(row.id)
    assert (await roads.states())["a"] == "acknowledged"
    await roads.at(*PATH[-1])
    assert (await roads.states())["a"] == "reached"


async def test_a_path_that_was_driven_while_the_link_was_broken_is_reached(roads):
    await roads.ready()
    await roads.take()
    await roads.at(*PATH[0])
    await roads.send("a", "SetPath", points=PATH)
    (row,) = await roads.deliver()
    await roads.ready()
    await roads.at(*PATH[-1])
    await roads.ack(row.id)
    await roads.at(*PATH[-1])
    assert (await roads.states())["a"] == "reached"
