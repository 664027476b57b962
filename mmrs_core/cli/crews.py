"""The robots that a command works on: those of a mission, or of a behaviour."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from mmrs_core.behaviour.as_scene import scene_of
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.cli.behaviours import is_behaviour, load_behaviour
from mmrs_core.cli.session import CommandStages, Session
from mmrs_core.languages.modelset import model_in
from mmrs_core.scene import Position, RobotType, Scene


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
    """All robots, in the model's order, and the scene of those whose types are known."""

    members: tuple[CrewMember, ...]
    scene: Scene


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
        known = [robot for robot in loaded.program.robots if robot.type_name in types]
        program = replace(loaded.program, robots=tuple(known))
        return Crew(tuple(members), scene_of(program, types, environment=loaded.place.environment))
    scene = CommandStages(session, path).grounded
    members = [CrewMember(each.name, each.type, each.home, each.payload) for each in scene.robots]
    return Crew(tuple(members), scene)
