"""Fixtures for all tests."""

import gc
import os
import shutil
import signal
import sys
import tempfile
from pathlib import Path

import pytest
import same_examples
import shared
from _pytest.mark.expression import Expression
from whole_files import ByGroup, InWorkers

AT_WORK_WITH_OTHERS = "PYTEST_XDIST_WORKER" in os.environ
THOROUGH = "thorough"
GIVING_WAY = 10
"""Niceness of workers, and of the processes that they start, once they have no tests in real time left."""


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--update-golden", action="store_true", help="rewrite golden files from what is produced"
    )


def pytest_configure(config: pytest.Config) -> None:
    """Have tests, and the many processes that they start, compile each module once."""
    if not AT_WORK_WITH_OTHERS:
        shared.write_to_memory()
        config.add_cleanup(shared.open_folder())
    if os.environ.pop("PYTHONDONTWRITEBYTECODE", "") and "PYTHONPYCACHEPREFIX" not in os.environ:
        keep_bytecode_elsewhere(config)
    gc.set_threshold(*shared.SELDOM)
    obey_interrupts()
    same_examples.pytest_configure()
    take_examples_by_profile(config)
    if not selects_thorough(config):
        from plans_once import remember_capabilities, remember_plans, remember_plugins

        remember_plans()
        remember_plugins()
        remember_capabilities()
    if AT_WORK_WITH_OTHERS and hasattr(os, "nice"):
        config.pluginmanager.register(Courtesy())
    if AT_WORK_WITH_OTHERS and config.option.loadgroup and not any("::" in each for each in config.args):
        config.pluginmanager.register(InWorkers())


def obey_interrupts() -> None:
    """Let processes of tests obey interrupts: shells start what is in the background deaf to them."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


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


def take_examples_by_profile(config: pytest.Config) -> None:
    """Draw few examples, or very many where ``-m`` selects thorough tests; each may take its time.

    Tests with other counts than these take them from `counts`.
    """
    from hypothesis import settings

    settings.register_profile("fast", deadline=None, max_examples=30)
    settings.register_profile("thorough", deadline=None, max_examples=2000)
    settings.load_profile(THOROUGH if selects_thorough(config) else "fast")


def selects_thorough(config: pytest.Config) -> bool:
    """Return whether ``-m`` selects tests that have no other marker than ``thorough``."""
    expression = config.option.markexpr
    return not expression or Expression.compile(expression).evaluate(lambda name, **_: name == THOROUGH)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Give tests with full counts time enough."""
    thorough = selects_thorough(config)
    for item in items:
        if thorough and hasattr(getattr(item, "obj", None), "hypothesis"):
            item.add_marker(THOROUGH)
        if item.get_closest_marker(THOROUGH) and not item.get_closest_marker("timeout"):
            item.add_marker(pytest.mark.timeout(3600))


class Courtesy:
    """Has tests that only compute give way to those that keep to the wall clock."""

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_setup(self, item: pytest.Item) -> None:
        if not item.get_closest_marker("real_time"):
            os.nice(GIVING_WAY - os.nice(0))


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log):
    """Give each group of tests, or else each file, one worker."""
    return ByGroup(config, log) if config.getoption("dist") == "loadgroup" else None


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
