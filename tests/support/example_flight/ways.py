"""The two ways to fly it: generated controllers as separate programs, and `mmrs run`."""

import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

from ports import free_endpoint
from warm_python import python

from example_flight.mission import Mission

RUN = ("-W", "error", "-m", "mmrs_core", "run")


def by_controllers(mission: Mission, links: Mapping[str, str], speedup: float) -> tuple[dict[str, int], str]:
    """Start a controller for each robot, which keep their slots by Zenoh; return exit codes and words."""
    folder = mission.folder / "controllers"
    commands = controller_commands(folder, links, speedup, mission.folder / "logs")
    processes = {
        robot: subprocess.Popen(
            [python(), *command], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
        )
        for robot, command in commands.items()
    }
    return _ends(processes, mission.patience(speedup))


def controller_commands(
    folder: Path, links: Mapping[str, str], speedup: float, logs: Path
) -> dict[str, list[str]]:
    """Return what starts the generated controllers in a folder, by robot, behind the interpreter."""
    endpoint = free_endpoint()
    commands = {}
    for number, (robot, link) in enumerate(links.items()):
        bus = ("--bus-connect" if number else "--bus-listen", endpoint)
        command = [str(_script(folder, robot)), "--connect", link, "--speedup", f"{speedup:g}"]
        commands[robot] = [*command, "--log", str(logs), *(bus if len(links) > 1 else ())]
    return commands


def run_command(models: Sequence[str], links: Mapping[str, str], speedup: float, logs: Path) -> list[str]:
    """Return what starts `mmrs run` for the models, behind the interpreter."""
    connect = [part for robot, link in links.items() for part in ("--connect", f"{robot}={link}")]
    return [*RUN, *models, "--speedup", f"{speedup:g}", "--log", str(logs), *connect]


def by_run(mission: Mission, links: Mapping[str, str], speedup: float) -> tuple[dict[str, int], str]:
    """Have `mmrs run` carry it out; return exit codes and words."""
    return _run(mission, links, speedup, str(mission.folder))


def by_behaviour(mission: Mission, links: Mapping[str, str], speedup: float) -> tuple[dict[str, int], str]:
    """Have `mmrs run` carry out the behaviour that was planned before; return exit codes and words."""
    models = [str(mission.folder / "behaviour.xmi"), "--context", str(mission.folder / "context.xmi")]
    return _run(mission, links, speedup, *models, "--robots", str(mission.folder / "robots"))


def _run(
    mission: Mission, links: Mapping[str, str], speedup: float, *models: str
) -> tuple[dict[str, int], str]:
    command = [python(), *run_command(models, links, speedup, mission.folder / "logs")]
    run = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    return _ends({"all": run}, mission.patience(speedup))


def _ends(processes: Mapping[str, subprocess.Popen[str]], seconds: float) -> tuple[dict[str, int], str]:
    said = []
    try:
        for process in processes.values():
            said.append(process.communicate(timeout=seconds)[1])
    finally:
        for process in processes.values():
            process.kill()
            process.wait()
    return {name: process.returncode for name, process in processes.items()}, "\n".join(said)


def _script(folder: Path, robot: str) -> Path:
    return next(path for path in folder.glob("robot_*.py") if path.stem.lower() == f"robot_{robot.lower()}")


WAYS = {"controllers": by_controllers, "run": by_run}
