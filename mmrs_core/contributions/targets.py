"""What code can be generated for."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mmrs_core.behaviour.program import Program
    from mmrs_core.contributions.hooks import Extensions
    from mmrs_core.contributions.rules import MoveKind, RobotKind
    from mmrs_core.contributions.samples import SampleWiring
    from mmrs_core.scene import Area, Name, Part, RobotType


@dataclass(frozen=True, slots=True)
class GeneratedFile:
    """A file to be written.

    Attributes:
        path: relative, with forward slashes.
        content: its bytes.
        once: whether the file is the user's after it was first written: it is never overwritten.
        asks: what it leaves to the user, one message each.
        note: on what it holds, in a few words; may be empty.
    """

    path: str
    content: bytes
    once: bool = False
    asks: tuple[str, ...] = ()
    note: str = ""


@dataclass(frozen=True, slots=True)
class TargetInput:
    """All that a target may use.

    Attributes:
        types: robot types by name.
        areas: of the context as drawn, and those that its elements make; empty where no context was given.
        extensions: what plug-ins contribute by hooks of plug-ins, by `Hook.sort`, then by key.
        environment: weather and water, by attribute name, as far as the context states them.
        elements: context elements of plug-ins; empty where no context was given.
        shared: what the targets of one rendering, or run, keep for each other, by the function that found it.
    """

    program: Program
    types: Mapping[str, RobotType]
    robot_kinds: Mapping[Name, RobotKind]
    move_kinds: Mapping[Name, MoveKind]
    areas: tuple[Area, ...] = ()
    extensions: Extensions = field(default_factory=dict)
    environment: Mapping[str, float] = field(default_factory=dict)
    elements: tuple[Part, ...] = ()
    shared: dict[Callable[..., object], object] = field(default_factory=dict, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class TracedStep:
    """Which move and task a place in a generated file serves.

    Attributes:
        step: position in the file, such as ``item 4``, in the terms of that kind of file.
        robot, move: identifiers.
        task, rule: as in the behaviour; may be empty.
    """

    step: str
    robot: str
    move: str
    task: str = ""
    rule: str = ""


@dataclass(frozen=True, slots=True)
class FileSpec:
    """A file of a target.

    Attributes:
        path: relative to the folder of the output, with forward slashes, nothing but ASCII.
        template: name in the target's folder of templates, or among the core's for programs in Python,
            which a target's own may extend as ``python/NAME``. One that ends in ``.jinja`` is rendered, any
            other is copied as it is; empty where the file has `data`.
        source: a file outside that folder that is copied instead of the template; None: the template.
        view: what the template sees.
        trace: which step serves which move and task, for the manifest.
        data: content of a binary file; None: what the template makes.
        once, asks, note: as in `GeneratedFile`.
    """

    path: str
    template: str
    view: Mapping[str, object] = field(default_factory=dict)
    trace: tuple[TracedStep, ...] = ()
    once: bool = False
    source: Path | None = None
    data: bytes | None = None
    asks: tuple[str, ...] = ()
    note: str = ""


@dataclass(frozen=True, slots=True)
class Target:
    """A kind of code that is generated from a behaviour.

    Attributes:
        name: kebab-case, as in ``--target``.
        description: one line.
        templates: folder of Jinja2 templates. Whatever a template writes must have passed a filter;
            a bare value is an error.
        files: what to render; paths must not collide. Raises UnsupportedError where nothing sensible
            can be written even with losses.
        refusals: each thing of the input that the target cannot express, with robot and move; when
            there is any, nothing is rendered unless lossy output is allowed.
        filters: Jinja2 filters beside the engine's own (``py``, ``py_lines``, ``json``, ``comment``,
            ``cell``, ``identifier``, ``name``), by name: each encodes a value in the language that is
            written.
        capabilities: how elements of the Behaviour Language are expressed, in a few words each, by the
            element as the table of capabilities names it, or by how its name begins: the longest
            counts. What is expressed, and what is not, is found by trying. Whatever makes no difference,
            though robots need it, has its words under its whole name: why nothing is lost.
        tried_with: class of vehicle, as in `RobotKind.vehicle`, of the robots that it is tried with, by
            `RobotKind.sample`. Default, and where no such kind is installed: the core's plain robot.
        wirings: device wirings that it is tried with, beside a device without wiring.
    """

    name: str
    description: str
    templates: Path
    files: Callable[[TargetInput], Iterable[FileSpec]]
    refusals: Callable[[TargetInput], Iterable[str]]
    filters: Mapping[str, Callable[[object], str]] = field(default_factory=dict)
    capabilities: Mapping[str, str] = field(default_factory=dict)
    tried_with: str = "ground"
    wirings: tuple[SampleWiring, ...] = ()
