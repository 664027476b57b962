"""`mmrs new` makes missions that validate and can be planned, by options and in a dialogue."""

import os
import pty
import sys
from itertools import combinations, cycle
from pathlib import Path
from select import select

import pytest

from mmrs_core.errors import UsageError
from mmrs_core.languages.writing import part_of
from mmrs_core.pipeline import refusals
from mmrs_core.plugins import load_plugins
from mmrs_core.projects.beginning import Beginning, TaskWanted
from mmrs_core.projects.team import RobotWanted
from mmrs_core.stages import Stages

PLACE = ("--at", "43.77,11.25")
CONTRIBUTIONS = load_plugins().contributions
TYPES = tuple(CONTRIBUTIONS.robot_types)
BEGINNING = Beginning((0.0, 0.0), CONTRIBUTIONS)
TASKS = BEGINNING.task_types()
PLACES = [(60.0, 10.0), (-60.5, -70.0), (0.0, 180.0), (-17.0, -179.9999), (36.5, -25.0), (46.55, 7.98)]
"""In the north and south, at the antimeridian, at sea and in hills."""
TEAMS = [
    *(([robot] * count, [task]) for robot in TYPES for task in TASKS for count in (1, 3)),
    *((pair, TASKS) for pair in combinations(TYPES, 2)),
    *(([robot] * 3, TASKS) for robot in TYPES),
    (TYPES, TASKS),
]
MISSIONS = [(place, *team) for place, team in zip(cycle(PLACES), TEAMS, strict=False)]
SAMPLE = [
    ("PhotoGridTask", "Freefly Astro LR1"),
    ("MeasureTask", "Amovlab P600 gas"),
    ("ObserveTask", "Clearpath Husky A300"),
    ("InspectObjectTask", "BlueROV2"),
]

UNSHIPPED = ("RelayTask",)
"""What no shipped robot does: none of these machines carries a relay."""


def tenth(missions):
    """Mark all missions but every tenth one as thorough."""
    return [
        pytest.param(*each, marks=() if number % 10 == 8 else pytest.mark.thorough)
        for number, each in enumerate(missions)
    ]


def plans(mmrs, folder, robots, tasks):
    """Make a mission and plan it; return what is wrong, if anything is."""
    options = [word for number, each in enumerate(robots) for word in ("--robot", f"R{number}={each}")]
    options += [word for each in tasks for word in ("--task", each)]
    for arguments in (("new", folder, *PLACE, *options), ("validate", folder), ("plan", folder)):
        code, _, err = mmrs(*arguments)
        if code:
            return f"{arguments[0]}: {err}"
    return ""


@pytest.mark.parametrize(("task", "robot"), SAMPLE)
def test_a_new_mission_is_valid_and_can_be_planned(mmrs, tmp_path, task, robot):
    assert plans(mmrs, tmp_path / "field", [robot], [task]) == ""


@pytest.mark.parametrize(("place", "robots", "tasks"), tenth(MISSIONS))
def test_a_new_mission_has_a_safe_plan_or_no_robot_of_it_can_do_the_task(place, robots, tasks):
    beginning = Beginning(place, CONTRIBUTIONS)
    able = [TaskWanted(task) for task in tasks if beginning.doers(TaskWanted(task), robots)[0]]
    team = [RobotWanted(f"R{number}", robot) for number, robot in enumerate(robots)]
    if not able:
        words = "carries no relay" if tasks[0] in UNSHIPPED else f"no robot of the team can do {tasks[0]}"
        with pytest.raises(UsageError, match=words):
            beginning.project(Path("new"), "new", team, [TaskWanted(tasks[0])])
        return
    made = beginning.project(Path("new"), "new", team, able)
    stages = Stages(lambda: made.models, CONTRIBUTIONS)
    assert list(refusals(stages.verdicts, stages.program)) == []
    assert len(stages.scene.tasks) == len(able)


def test_what_no_plan_can_do_safely_is_refused_before_it_is_written(mmrs, tmp_path):
    far = ("--robot", "A=BlueROV2", *["--task", "GoToTask"] * 90)
    code, _, err = mmrs("new", tmp_path / "field", *PLACE, *far)
    assert code == 2
    assert "no safe plan of all these robots and tasks: choose fewer" in " ".join(err.split())
    assert "its radio reaches 100 m" in err
    assert not (tmp_path / "field").exists()


def test_every_task_but_a_relay_can_be_done_by_a_shipped_robot_and_only_what_dives_surfaces():
    able = {task: BEGINNING.doers(TaskWanted(task), TYPES)[0] for task in TASKS}
    assert [task for task in TASKS if not able[task]] == [*UNSHIPPED]
    assert able["SurfaceTask"] == ("BlueROV2",)


def test_several_robots_have_names_of_their_own(mmrs, tmp_path):
    several = ("--robot", "Alpha=Freefly Astro LR1", "--robot", "2xAmovlab P600 gas")
    code, _, err = mmrs("new", tmp_path / "field", *PLACE, *several, "--task", "GoToTask")
    text = (tmp_path / "field" / "mission.xmi").read_text()
    assert (code, err) == (0, "")
    assert [name in text for name in ('"Alpha"', '"Bravo"', '"Charlie"')] == [True] * 3


def test_the_comments_say_what_to_check_before_a_flight(mmrs, tmp_path):
    assert plans(mmrs, tmp_path / "field", ["Freefly Astro LR1"], ["PhotoGridTask"]) == ""
    mission = (tmp_path / "field" / "mission.xmi").read_text()
    for each in ("positionError", "minimumSeparation", "reserve", "altitude", "move it to where it belongs"):
        assert each in mission
    assert "forbiddenAreas" in (tmp_path / "field" / "context.xmi").read_text()


def test_an_empty_project_says_what_goes_where(mmrs, tmp_path):
    code, out, _ = mmrs("new", tmp_path / "field", "--empty")
    assert code == 0
    assert "next: copy robot types" in out
    assert "taskDependencies: from one task" in (tmp_path / "field" / "mission.xmi").read_text()
    code, _, err = mmrs("validate", tmp_path / "field")
    assert code == 1
    assert "robots" in err


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        ((*PLACE, "--robot", "2xFreefly Astro", "--task", "GoToTask"), 2, "Freefly Astro LR1: quadcopter"),
        ((*PLACE, "--robot", "A=BlueROV2", "--task", "PhotoGrid"), 2, "did you mean PhotoGridTask"),
        ((*PLACE, "--robot", "A=Freefly Astro LR1", "--task", "YoYoTask"), 2, "BlueROV2 can"),
        (
            (*PLACE, "--robot", "A=BlueROV2", "--task", "FollowPipelineTask"),
            2,
            "refers to elements of the context",
        ),
        ((*PLACE, "--robot", "A=BlueROV2", "--task", "YoYoTask:pitsch=3"), 2, "YoYoTask: pitsch"),
        ((*PLACE, "--robot", "99xBlueROV2", "--task", "GoToTask"), 2, "1 to 20 robots"),
        (("--at", "1e300, 3", "--robot", "A=BlueROV2", "--task", "GoToTask"), 2, "not a position"),
        (("--at", "90, 0", "--robot", "A=BlueROV2", "--task", "GoToTask"), 2, "go to 85 degrees"),
        ((*PLACE, "--robot", "A=BlueROV2"), 2, "--task: missing"),
        (("--empty", "--task", "GoToTask"), 2, "--empty goes without"),
    ],
)
def test_what_cannot_be_is_refused_and_nothing_is_written(mmrs, tmp_path, options, code, words):
    found, _, err = mmrs("new", tmp_path / "field", *options)
    assert found == code
    assert words in " ".join(err.split())
    assert not (tmp_path / "field").exists()


@pytest.mark.parametrize("name", ["../../etc", '"/><x>', "-->", "a\x1b[2J", "\u202egnp", "x" * 500])
def test_names_can_break_no_file_out_of_the_project(mmrs, tmp_path, name):
    folder = tmp_path / "within" / "field"
    code, _, _ = mmrs("new", folder, *PLACE, "--robot", f"{name}=BlueROV2", "--task", "GoToTask")
    written = {each.relative_to(tmp_path).as_posix() for each in tmp_path.rglob("*") if each.is_file()}
    files = ("mission.xmi", "context.xmi", "robots/bluerov2.xmi")
    assert written == ({f"within/field/{each}" for each in files} if code == 0 else set())
    assert code or mmrs("validate", folder)[0] == 0


def test_a_folder_with_content_is_left_alone(mmrs, tmp_path):
    (tmp_path / "notes.txt").write_text("mine")
    code, _, err = mmrs("new", tmp_path, "--empty")
    assert code == 2
    assert "exists and is not empty" in err
    assert [each.name for each in tmp_path.iterdir()] == ["notes.txt"]


def test_a_disk_that_is_full_leaves_no_project(mmrs, tmp_path, monkeypatch):
    def full(file, text):
        if file.name == "context.xmi":
            raise OSError(28, "No space left on device", str(file))
        return part_of(file, text)

    monkeypatch.setattr("mmrs_core.languages.writing.part_of", full)
    code, _, err = mmrs("new", tmp_path / "field", "--empty")
    assert code == 3
    assert "no space left" in err
    assert not (tmp_path / "field").exists()


PATIENCE = 60.0
"""Seconds after which a key is pressed again."""


def in_a_terminal(folder, answers):
    """Run `mmrs new` in a terminal of its own; answer each question; return exit code and what it showed.

    A key is pressed again where nothing happens for long: an interrupt is lost that comes after Python has
    shown a prompt and before it waits for the answer.
    """
    process, terminal = pty.fork()
    if process == 0:
        os.execv(sys.executable, [sys.executable, "-m", "mmrs_core", "new", str(folder)])
    shown, left, last = b"", list(answers), b""
    while True:
        if not select([terminal], [], [], PATIENCE)[0]:
            os.write(terminal, last)
        try:
            got = os.read(terminal, 4096)
        except OSError:
            break
        if not got:
            break
        shown += got
        if left and shown.endswith(b": "):
            last = left.pop(0)
            os.write(terminal, last)
    os.close(terminal)
    return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]), shown.decode()


def test_the_dialogue_asks_again_until_an_answer_is_one(tmp_path):
    answers = [
        b"11.25E\n",
        b"111, 43\n",
        b"43.77, 11.25\n",
        b"99\n",
        b"Hawk=Freefly Astro LR1\n",
        b"?\n",
        b"\n",
    ]
    code, shown = in_a_terminal(tmp_path / "field", answers)
    assert code == 0, shown
    for each in (
        "1/3",
        "2/3",
        "3/3",
        "latitude comes first",
        "numbers go from 1",
        "no task type '?'",
        "next:",
    ):
        assert each in shown
    mission = (tmp_path / "field" / "mission.xmi").read_text()
    assert 'name="Hawk"' in mission
    assert "survey:PhotoGridTask" in mission


@pytest.mark.parametrize(("key", "code"), [(b"\x03", 130), (b"\x04", 2)])
def test_ending_the_dialogue_writes_nothing(tmp_path, key, code):
    found, shown = in_a_terminal(tmp_path / "field", [b"43.77, 11.25\n", key])
    assert found == code, shown
    assert not (tmp_path / "field").exists()
