"""Fixtures for all tests."""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from functools import cache
from pathlib import Path, PurePosixPath

import pytest

IN_REAL_TIME = {
    "controllers": ("tests/end_to_end/controllers",),
    "runs": ("tests/end_to_end/run",),
    "buses": ("tests/conformance/bus", "tests/end_to_end/bus"),
    "vessels": ("tests/end_to_end/vessels", "plugins/auv/tests/manual"),
    "faults": ("tests/end_to_end/faults", "tests/end_to_end/vehicles"),
    "parts of flights": (
        "tests/unit/flight",
        "tests/unit/mmrs_runtime",
        "tests/unit/mavlink/backend/test_response.py",
        "tests/unit/runtime",
        "tests/unit/sitl",
    ),
}
"""Tests that keep to the wall clock, by group: they mostly wait; those of a group go one after another."""
TOGETHER = ("tests/conformance/emf", "tests/end_to_end/examples")
"""Folders whose tests share what is long in the making; those of other folders do so within a file."""
LONG = (
    *TOGETHER,
    "plugins/auv/tests/backend/test_rehearsed.py",
    "plugins/auv/tests/control/test_failsafe.py",
    "plugins/auv/tests/movement/test_closed_loop.py",
    "plugins/auv/tests/test_guard.py",
    "tests/documentation/test_pages.py",
    "tests/documentation/test_readme.py",
    "tests/documentation/test_tutorial.py",
    "tests/end_to_end/new_plugins/test_new_plugins.py",
)
"""What begins early, lest others wait for its end."""
AT_WORK_WITH_OTHERS = "PYTEST_XDIST_WORKER" in os.environ
GIVING_WAY = 10
"""Niceness of workers, and of the processes that they start, once they have no tests in real time left."""


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--update-golden", action="store_true", help="rewrite golden files from what is produced"
    )


def pytest_configure(config: pytest.Config) -> None:
    """Have tests, and the many processes that they start, compile each module once."""
    if os.environ.pop("PYTHONDONTWRITEBYTECODE", "") and "PYTHONPYCACHEPREFIX" not in os.environ:
        keep_bytecode_elsewhere(config)
    draw_the_same_examples_everywhere()
    take_time_for_examples()
    if AT_WORK_WITH_OTHERS and hasattr(os, "nice"):
        config.pluginmanager.register(Courtesy())


def keep_bytecode_elsewhere(config: pytest.Config) -> None:
    """Keep bytecode, also for later runs, in the user's cache, where none may be kept beside modules.

    That of modules which tests write for themselves goes at the end.
    """
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    bytecode, scratch = cache / "mmrs-tests" / "bytecode", Path(tempfile.gettempdir()).resolve()
    os.environ["PYTHONPYCACHEPREFIX"] = sys.pycache_prefix = str(bytecode)
    sys.dont_write_bytecode = False
    written = bytecode / scratch.relative_to(scratch.anchor)
    config.add_cleanup(lambda: shutil.rmtree(written, ignore_errors=True))


def draw_the_same_examples_everywhere() -> None:
    """Keep hypothesis from drawing constants out of the modules that happen to be loaded.

    Workers load different ones, so that one seed would try other examples in each run.
    """
    from hypothesis.internal.conjecture import providers

    providers._get_local_constants = lambda: providers._local_constants


def take_time_for_examples() -> None:
    """Let an example take as long as it does where the machine is busy."""
    from hypothesis import settings

    settings.register_profile("unhurried", deadline=None)
    settings.load_profile("unhurried")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Give tests with full counts time enough; have workers begin with what keeps to the wall clock."""
    for item in items:
        if item.get_closest_marker("thorough") and not item.get_closest_marker("timeout"):
            item.add_marker(pytest.mark.timeout(3600))
    if AT_WORK_WITH_OTHERS:
        items.sort(key=lambda item: rank_of(group_of(item.nodeid)))


def rank_of(group: str) -> int:
    """Return when a group of tests begins: those in real time, those that take long, all others."""
    return 0 if group in IN_REAL_TIME else 1 if group in LONG else 2


class Courtesy:
    """Has tests that only compute, those of plug-ins, too, give way to those that keep to the wall clock."""

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_setup(self, item: pytest.Item) -> None:
        if group_of(item.nodeid) not in IN_REAL_TIME:
            os.nice(GIVING_WAY - os.nice(0))


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log):
    """Give each group of tests one worker: marks of xdist 3.8 are lost with pytest 9.2."""
    if config.getoption("dist") != "loadgroup":
        return None
    from xdist.scheduler import LoadScopeScheduling

    config.option.loadscopereorder = False

    class ByGroup(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return group_of(nodeid)

    return ByGroup(config, log)


def group_of(nodeid: str) -> str:
    """Return the group of a test, whose tests one worker runs."""
    return group_of_file(nodeid.partition("::")[0])


@cache
def group_of_file(name: str) -> str:
    """Return the group of the tests of a file: their folder's, or their own."""
    path = PurePosixPath(name)
    for group, folders in (*IN_REAL_TIME.items(), *((folder, (folder,)) for folder in TOGETHER)):
        if any(path.is_relative_to(folder) for folder in folders):
            return group
    return name


@pytest.fixture
def update_golden(request: pytest.FixtureRequest) -> bool:
    return bool(request.config.getoption("--update-golden"))


@pytest.fixture(scope="session")
def need_program():
    """Return a function that skips a test where a program is absent, or fails it where peers must be."""

    def need(name: str, why: str) -> str:
        found = shutil.which(name)
        if found is None:
            message = f"{name} is not installed: {why}"
            if os.environ.get("MMRS_REQUIRE_PEERS") == "1":
                pytest.fail(message)
            pytest.skip(message)
        return found

    return need


@pytest.fixture(scope="session")
def plugins():
    """Return the installed plug-ins."""
    from mmrs_core.plugins import load_plugins

    return load_plugins()


@pytest.fixture(scope="session")
def contributions(plugins):
    """Return what the installed plug-ins contribute."""
    return plugins.contributions
