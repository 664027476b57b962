"""Files of tests as what workers of pytest-xdist share out among themselves.

Each worker lists the files, but imports only those that it runs: all workers together collect each test once.
The files of one group run in one worker; those in real time come first, then those that take long.
"""

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from _pytest.runner import runtestprotocol
from xdist.scheduler import LoadScopeScheduling

_MARK = re.compile(r'mark\.(real_time|together|long)\b(?:\("([^"]+)"\))?')
_RANKS = {"real_time": 0, "together": 1, "long": 1}
_WORTH_A_REPORT = 0.01
"""Seconds of a test's setup or teardown from which on ``--durations`` lists it."""


@cache
def _mark_of(file: Path) -> tuple[int, str | None]:
    """Return the rank of a file, and its group if it belongs to one, as its marks declare."""
    found = _MARK.search(file.read_text(encoding="utf-8"))
    return (_RANKS[found[1]], found[2]) if found else (2, None)


class WholeFile(pytest.Item):
    """All tests of a file, which are collected when it is their turn."""

    following: pytest.Item | None = None

    def runtest(self) -> None:
        """Collect the tests of the file and run them; report each by itself."""
        place = self.session.items.index(self)
        items = self._collected()
        if not items:
            self.session._setupstate.teardown_exact(self.following)
            return
        try:
            for item, following in zip(items, [*items[1:], self.following], strict=True):
                self.session.items[place] = item  # xdist looks up there what is reported
                self.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
                if self.session.shouldfail or self.session.shouldstop:
                    break
        finally:
            self.session.items[place] = self

    def _collected(self) -> list[pytest.Item]:
        assert self.parent is not None
        module = pytest.Module.from_parent(self.parent.parent, path=self.path)
        items = list(self.session.genitems(module))
        hook = self.config.hook.pytest_collection_modifyitems
        hook(session=self.session, config=self.config, items=items)
        return items


class _Unopened(pytest.File):
    """A file whose tests are not collected yet."""

    def collect(self) -> Iterator[WholeFile]:
        yield WholeFile.from_parent(self, name="*")


class InWorkers:
    """Has workers list files in place of tests, and open each when it is its turn."""

    @pytest.hookimpl(tryfirst=True)
    def pytest_pycollect_makemodule(self, module_path: Path, parent: pytest.Collector) -> pytest.File:
        return _Unopened.from_parent(parent, path=module_path)

    @pytest.hookimpl(wrapper=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> Iterator[None]:
        """Keep files from being deselected: their tests may be, later on."""
        files = [item for item in items if isinstance(item, WholeFile)]
        items[:] = [item for item in items if not isinstance(item, WholeFile)]
        yield
        items[:] = [*sorted(files, key=lambda file: _mark_of(file.path)[0]), *items]

    @pytest.hookimpl(tryfirst=True)
    def pytest_itemcollected(self, item: pytest.Item) -> None:
        if isinstance(item, WholeFile):
            item.add_marker(pytest.mark.timeout(0))

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_protocol(self, item: pytest.Item, nextitem: pytest.Item | None) -> bool:
        """Run a file, or a test of one; report what counts, since a report costs as much as a short test."""
        if isinstance(item, WholeFile):
            item.following = nextitem
            item.runtest()
            return True
        for report in runtestprotocol(item, nextitem=nextitem, log=False):
            if report.when == "call" or not report.passed or report.duration > _WORTH_A_REPORT:
                item.ihook.pytest_runtest_logreport(report=report)
        return True


class ByGroup(LoadScopeScheduling):
    """Gives each group of files, or else each file, to one worker."""

    def __init__(self, config: pytest.Config, log: Any) -> None:
        super().__init__(config, log)
        config.option.loadscopereorder = False
        self._ended = 0

    def _split_scope(self, nodeid: str) -> str:
        file = nodeid.partition("::")[0]
        return _mark_of(self.config.rootpath / file)[1] or file

    def _reschedule(self, node: Any) -> None:
        """Keep one file ahead of the one that runs: what else is queued could wait for a long one."""
        while not node.shutting_down and not (
            self.workqueue and self._pending_of(self.assigned_work[node]) > 1
        ):
            super()._reschedule(node)

    def remove_node(self, node: Any) -> str | None:
        """Give the files of a worker that crashed to others, but for the one that crashed it."""
        units = self.assigned_work[node].values()
        crashed = next((file for unit in units for file, ended in unit.items() if not ended), None)
        for unit in units:
            if crashed in unit:
                unit[crashed] = True
        super().remove_node(node)
        return crashed

    def mark_test_complete(self, node: Any, item_index: int, duration: float = 0) -> None:
        super().mark_test_complete(node, item_index, duration)
        self._ended += 1
        reporter = self.config.pluginmanager.getplugin("terminalreporter")
        if reporter and self.collection:
            share = min(1, (self._ended + len(self.nodes)) / len(self.collection))
            reporter._session.testscollected = round(reporter.reported_progress / share)
