"""The robots that a command works on: those of a mission, or of a behaviour."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.cli.behaviours import is_behaviour, load_behaviour
from mmrs_core.cli.session import CommandStages, Session
from mmrs_core.languages.modelset import model_in
from mmrs_core.scene import Frame, Position, RobotType


@dataclass(frozen=True, slots=True)
class CrewMember:
    """A robot.

    Attributes:
        type: None where it is unknown, as it may be in a behaviour.
        home: None where the model leaves it open.
        program: None in a mission.
    """

    name: str
    type: RobotType | None
    home: Position | None
    payload: float
    program: RobotProgram | None = None


@dataclass(frozen=True, slots=True)
class Crew:
    """All robots, in the model's order, and what surrounds them: weather and water, by attribute name."""

    members: tuple[CrewMember, ...]
    frame: Frame
    environment: Mapping[str, float]


def crew_in(session: Session, path: Path) -> Crew:
    """Return the robots of a file, or of a project: those of its behaviour, or else of its mission.

    Raises:
        UnreadableError, InvalidModelError: the models cannot be read, or are invalid.
    """
    file = model_in(path, "behaviour") if path.is_dir() else path
    if file is not None and file.is_file() and is_behaviour(session, file):
        loaded = load_behaviour(session, file)
        types = loaded.place.types
        members = [
            CrewMember(each.id, types.get(each.type_name), each.home, each.payload, each)
            for each in loaded.program.robots
        ]
        return Crew(tuple(members), loaded.program.frame, loaded.place.environment or {})
    scene = CommandStages(session, path).grounded
    members = [CrewMember(each.name, each.type, each.home, each.payload) for each in scene.robots]
    return Crew(tuple(members), scene.frame, scene.environment)
