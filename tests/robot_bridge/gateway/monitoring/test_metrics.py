"""What Prometheus reads."""

from prometheus_client.parser import text_string_to_metric_families

from robot_bridge.gateway.monitoring import Counters, MetricReading, Metrics


def samples(metrics):
    families = text_string_to_metric_families(metrics.page().decode())
    return {(s.name, tuple(s.labels.values())): s.value for family in families for s in family.samples}


def test_what_was_counted_is_on_the_page():
    counters = Counters()
    metrics = Metrics(counters)
    counters.requests["sql", "SendPos"] += 3
    counters.requests["websocket", "Ready"] += 1
    counters.failures["save"] += 2
    metrics.database.observe(0.003)
    found = samples(metrics)
    assert found["robot_bridge_requests_total", ("sql", "SendPos")] == 3
    assert found["robot_bridge_requests_total", ("websocket", "Ready")] == 1
    assert found["robot_bridge_task_failures_total", ("save",)] == 2
    assert found["robot_bridge_database_transaction_seconds_bucket", ("0.002",)] == 0
    assert found["robot_bridge_database_transaction_seconds_bucket", ("0.005",)] == 1
    assert found["process_resident_memory_bytes", ()] > 1e6


def test_numbers_are_looked_up_when_somebody_asks():
    robots = {("fresh",): 1.0}
    metrics = Metrics(Counters())
    metrics.add([MetricReading("robot_bridge_robots", "Robots by state.", ("state",), lambda: robots)])
    robots["lost",] = 2.0
    assert samples(metrics)["robot_bridge_robots", ("lost",)] == 2.0


def test_two_gateways_in_one_process_keep_their_numbers_apart():
    first, second = Counters(), Counters()
    pages = Metrics(first), Metrics(second)
    first.steps["reached"] += 1
    assert samples(pages[0])["robot_bridge_command_steps_total", ("reached",)] == 1
    assert ("robot_bridge_command_steps_total", ("reached",)) not in samples(pages[1])
