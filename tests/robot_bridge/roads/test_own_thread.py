"""Objects that belong to one thread are made, used and let go there, whoever asks."""

from __future__ import annotations

import gc
import subprocess
import sys
import threading

import pytest

from robot_bridge.roads.engines.own_thread import OwnThread

ROUTE = """
import threading
import numpy as np
from robot_bridge.roads.centrelines import centrelines
from robot_bridge.roads.network import build_network
from robot_bridge.roads.routes import Router

roads = centrelines([np.array([[0.0, 0.0], [100.0, 0.0]])], width=[4.0], surface=["asphalt"])
made = []
thread = threading.Thread(target=lambda: made.append(Router(build_network(roads))))
thread.start()
thread.join()
print(made[0].engine_name, made[0].route((10, 0), (60, 0)).metres)
"""


def test_what_is_kept_is_made_used_and_let_go_in_that_thread():
    threads = []

    class Noted:
        def __init__(self):
            threads.append(threading.current_thread())

        def __del__(self):
            threads.append(threading.current_thread())

    own = OwnThread("noted")
    own.run(lambda kept: kept.update(it=Noted()))
    own.run(lambda kept: threads.append(threading.current_thread()))
    del own
    gc.collect()
    assert len(threads) == 3
    assert set(threads) != {threading.current_thread()}
    assert len(set(threads)) == 1
    assert not threads[0].is_alive()


def test_what_goes_wrong_there_is_told_here_and_the_next_work_is_done():
    own = OwnThread("wrong")
    with pytest.raises(KeyError, match="nothing"):
        own.run(lambda kept: kept["nothing"])
    assert own.run(lambda kept: 5) == 5


def test_a_router_made_in_one_thread_is_asked_in_another_and_ends_without_a_word(root):
    pytest.importorskip("routingkit_cch", reason="the package has wheels for x86_64 alone")
    done = subprocess.run(
        [sys.executable, "-c", ROUTE], capture_output=True, text=True, cwd=root, check=False, timeout=60
    )
    assert done.stdout.startswith("contraction hierarchies")
    assert float(done.stdout.split()[-1]) == pytest.approx(50.0)
    assert done.stderr == ""
    assert done.returncode == 0
