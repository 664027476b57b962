"""Plans, plug-ins and tables of capabilities of a test run: what was found once is not sought again."""

import os
import pickle
import sys
from collections.abc import Mapping
from functools import cache
from hashlib import sha256
from importlib.metadata import entry_points
from io import BytesIO
from pathlib import Path
from time import process_time
from typing import Any

import shared

from mmrs_core import pipeline, plugins
from mmrs_core.contributions.registry import Contributions
from mmrs_core.contributions.targets import Target
from mmrs_core.diagnostics import Place
from mmrs_core.generation.capabilities import judging
from mmrs_core.generation.capabilities.judging import TargetCapability, capabilities_of
from mmrs_core.planning.effort import Effort
from mmrs_core.planning.planner import plan
from mmrs_core.plugins import Plugins, load_plugins
from mmrs_core.scene import Plan, Scene

_LONG = 0.2
"""Seconds of planning from which on a plan is worth a file."""
_FOLDER = shared.folder() / "plans"


def remember_plans() -> None:
    """Have the pipeline, and commands that are imported from now on, find plans of equal scenes."""
    _FOLDER.mkdir(exist_ok=True)
    pipeline.plan = _remembered


def remember_capabilities() -> None:
    """Have modules that are imported from now on find what installed targets do with each element."""
    judging.capabilities_of = _remembered_table


def remember_plugins() -> None:
    """Have commands find the installed plug-ins loaded, while nothing else is installed or given."""
    plugins.load_plugins = _remembered_plugins


def _remembered_plugins(extra: Mapping[str, object] | None = None, **options: bool) -> Plugins:
    if extra or plugins.entry_points is not entry_points:
        return load_plugins(extra=extra, **options)
    folders = map(os.path.abspath, sys.path)
    return _loaded(tuple(each for each in folders if any(Path(each).glob("*.*-info"))), **options)


@cache
def _loaded(_: tuple[str, ...], **options: bool) -> Plugins:
    return load_plugins(**options)


def _remembered_table(target: Target, contributions: Contributions) -> tuple[TargetCapability, ...]:
    if contributions.targets.get(target.name) != target:
        return capabilities_of(target, contributions)

    def make(file: Path) -> None:
        file.write_bytes(pickle.dumps(capabilities_of(target, contributions)))

    kinds = sha256(repr(sorted(contributions.robot_kinds)).encode()).hexdigest()
    made = shared.made_once(f"capabilities-{target.name}-{kinds}", make)
    return pickle.loads(made.read_bytes())  # type: ignore[no-any-return]


def _remembered(scene: Scene, *, seed: int = 0, effort: Effort | None = None) -> Plan:
    if effort is not None and effort.timed:
        return plan(scene, seed=seed, effort=effort)
    file = _FOLDER / sha256(_bytes_of((scene, seed))).hexdigest()
    if file.exists():
        return pickle.loads(file.read_bytes())  # type: ignore[no-any-return]
    begin = process_time()
    found = plan(scene, seed=seed, effort=effort)
    if process_time() - begin > _LONG and not (effort is not None and effort.stopped):
        beside = file.with_suffix(f".{os.getpid()}")
        beside.write_bytes(pickle.dumps(found))
        beside.rename(file)
    return found


class _ByValue(pickle.Pickler):
    """Makes the same bytes of equal scenes, whichever parts are one object, and wherever files are."""

    def reducer_override(self, value: object) -> Any:
        return (Place, ("", value.line, value.path)) if isinstance(value, Place) else NotImplemented


def _bytes_of(value: object) -> bytes:
    made = BytesIO()
    pickler = _ByValue(made)
    pickler.fast = True
    pickler.dump(value)
    return made.getvalue()
