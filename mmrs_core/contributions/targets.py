"""What code can be generated for."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from mmrs_core.behaviour.program import Program
from mmrs_core.contributions.rules import MoveKind, RobotKind
from mmrs_core.scene import Area, Name, Policy, RobotType


@dataclass(frozen=True, slots=True)
class GeneratedFile:
    """A file to be written: a relative path with forward slashes, and its bytes."""

    path: str
    content: bytes


@dataclass(frozen=True, slots=True)
class TargetInput:
    """All that a target may use.

    Attributes:
        types: robot types by name.
        areas: of the context as drawn, empty where no context was given.
        policies: of the mission.
    """

    program: Program
    types: Mapping[str, RobotType]
    robot_kinds: Mapping[Name, RobotKind]
    move_kinds: Mapping[Name, MoveKind]
    areas: tuple[Area, ...] = ()
    policies: tuple[Policy, ...] = ()
    position_error: float = 0.0


@dataclass(frozen=True, slots=True)
class FileSpec:
    """A file of a target: its path, the template in the target's folder, and what the template sees."""

    path: str
    template: str
    view: Mapping[str, object]


@dataclass(frozen=True, slots=True)
class Target:
    """A kind of code that is generated from a behaviour.

    Attributes:
        name: kebab-case, as in ``--target``.
        description: one line for people.
        templates: folder of Jinja2 templates.
        files: what to render; paths must not collide.
        refusals: each thing of the input that the target cannot express, with robot and move; when
            there is any, nothing is rendered unless lossy output is allowed.
        filters: Jinja2 filters beside the engine's own, by name.
    """

    name: str
    description: str
    templates: Path
    files: Callable[[TargetInput], Iterable[FileSpec]]
    refusals: Callable[[TargetInput], Iterable[str]]
    filters: Mapping[str, Callable[[object], str]] = field(default_factory=dict)
