"""Files of tests that a worker reads in when their turn comes, not all of them before the first.

With ``--dist loadfile`` a whole file goes to one worker. xdist has each worker read in all files all the
same, which takes ten seconds of each; here a worker lists the files, and reads those that it is given.
"""

from __future__ import annotations

import gc
import os
from collections.abc import Callable

import pytest

SIGN = "file_by_file"
"""What a worker is told."""


def begin(config: pytest.Config, order: Callable[[list[pytest.Item]], None]) -> None:
    """Have this process do its part, where files are dealt out whole: in a worker, or in who deals them out.

    :param order: brings files into the order in which they are dealt out.
    """
    told = getattr(config, "workerinput", None)
    if told is None:
        _check_files(config)
        # One test of a file is found by the names in it.
        if config.getoption("dist", "no") == "loadfile" and not any("::" in one for one in config.args):
            config.pluginmanager.register(Dealer())
    elif SIGN in told:
        config.pluginmanager.register(Worker(order))


def _check_files(config: pytest.Config) -> None:
    """Raise UsageError for a file that is not there: workers that end for it only say that no test ran."""
    for one in config.args:
        if not (config.invocation_params.dir / one.partition("::")[0]).exists():
            raise pytest.UsageError(f"file or directory not found: {one}")


class Dealer:
    """The process that deals the files out: it learns how many tests there are as they are run."""

    def __init__(self):
        self._files = 0
        self._begun: set[str] = set()
        self._run = 0

    @pytest.hookimpl(optionalhook=True)
    def pytest_configure_node(self, node):
        node.workerinput[SIGN] = True

    @pytest.hookimpl(optionalhook=True)
    def pytest_xdist_node_collection_finished(self, ids):
        self._files = len(ids)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtestloop(self, session):
        self._session = session
        done = yield
        session.testscollected = self._run
        return done

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_logreport(self, report):
        """Guess for the percentage how many there will be: as many in each file as in those before it."""
        if report.when == "setup":
            self._begun.add(report.nodeid.partition("::")[0])
            self._run += 1
            self._session.testscollected = 1 + self._run * self._files // len(self._begun)


class File(pytest.Item):
    """A file that is not read in yet, in the list of what there is to run."""

    def __init__(self, *, folder: pytest.Collector, **named):
        super().__init__(**named)
        self._folder = folder

    def runtest(self) -> None:
        raise NotImplementedError("its tests are run in its place")

    def tests(self) -> list[pytest.Item]:
        """Read it in, and return its tests that are asked for."""
        module = pytest.Module.from_parent(self._folder, path=self.path)
        gc.disable()
        try:
            found = list(self.session.genitems(module))
        finally:
            gc.enable()
        self.config.hook.pytest_collection_modifyitems(session=self.session, config=self.config, items=found)
        return found


class Worker:
    """A process that runs the tests of the files it is given."""

    def __init__(self, order: Callable[[list[pytest.Item]], None]):
        self._order = order

    def pytest_pycollect_makemodule(self, module_path, parent):
        # What is open in the folder of the file before ends with that: this one may have no test to do it.
        session, name = parent.session, os.path.relpath(module_path, parent.config.rootpath)
        return File.from_parent(session, name=name, nodeid=name, path=module_path, folder=parent)

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_collection_modifyitems(self, items):
        """Select among tests only, and order files only."""
        files = [item for item in items if isinstance(item, File)]
        if not files:
            return (yield)
        items.clear()
        done = yield
        self._order(files)
        items[:] = files
        return done

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_protocol(self, item, nextitem):
        if not isinstance(item, File):
            return None
        session, tests = item.session, item.tests()
        place = session.items.index(item)
        for test, following in zip(tests, [*tests, nextitem][1:], strict=True):
            # xdist looks there for what it is told of.
            session.items[place] = test
            test.ihook.pytest_runtest_protocol(item=test, nextitem=following)
            if session.shouldfail or session.shouldstop:
                break
        session.items[place] = item
        return True

    @pytest.hookimpl(trylast=True)
    def pytest_sessionfinish(self):
        """Look once for what is to be removed: pytest and Python look six times at all that is not frozen."""
        gc.collect()
        gc.freeze()
