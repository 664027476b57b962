"""What people wrote is never overwritten by what commands write."""

import os
import shutil

import pytest

from mmrs_core.cli.settings import Settings
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.hookspecs import hookimpl
from mmrs_core.plugins import load_plugins
from mmrs_core.resources import shipped

INPUTS = ("mission.xmi", "context.xmi", "robots/sub.xmi", "robots/../mission.xmi")


@pytest.fixture
def pool(tmp_path):
    """Return a copy of the smallest example, its type of robot in a file of a known name."""
    folder = shutil.copytree(shipped("examples") / "pool", tmp_path / "pool")
    next((folder / "robots").iterdir()).rename(folder / "robots" / "sub.xmi")
    return folder


def contents(folder):
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("input", INPUTS)
def test_plan_does_not_overwrite_an_input(mmrs, pool, input):
    before = contents(pool)
    code, _, err = mmrs("plan", pool, "-o", pool / input, "--force")
    assert code == 2
    assert str(pool / input) in err
    assert contents(pool) == before


def test_plan_names_a_folder_that_does_not_exist_before_it_searches(mmrs, pool, tmp_path, monkeypatch):
    searched = []
    monkeypatch.setattr("mmrs_core.planning.planner.plan", lambda *_, **__: searched.append(1))
    code, _, err = mmrs("plan", pool, "--time-limit", "600", "-o", tmp_path / "none" / "x.xmi")
    assert code == 3
    assert f"{tmp_path / 'none'}: no such file or directory" in err
    assert not searched


@pytest.mark.parametrize("link", [os.symlink, os.link])
def test_plan_does_not_overwrite_an_input_through_a_link(mmrs, pool, tmp_path, link):
    link(pool / "mission.xmi", tmp_path / "out.xmi")
    before = contents(pool)
    assert mmrs("plan", pool, "-o", tmp_path / "out.xmi", "--force")[0] == 2
    assert contents(pool) == before


def test_plan_writes_nothing_among_the_types_of_robot(mmrs, pool):
    code, _, err = mmrs("plan", pool, "-o", pool / "robots" / "behaviour.xmi")
    assert code == 2
    assert "robot types" in err
    assert not (pool / "robots" / "behaviour.xmi").exists()


def test_plan_replaces_a_behaviour_written_by_hand_only_when_forced(mmrs, pool):
    shutil.copy(shipped("examples") / "handwritten" / "behaviour.xmi", pool)
    before = contents(pool)
    code, _, err = mmrs("plan", pool)
    assert code == 2
    assert "written by hand" in err
    assert "--force" in err
    assert contents(pool) == before
    assert mmrs("plan", pool, "--force")[0] == 0
    assert b"rule=" in (pool / "behaviour.xmi").read_bytes()


def test_plan_replaces_what_it_planned_before(mmrs, pool):
    assert mmrs("plan", pool)[0] == 0
    assert mmrs("plan", pool, "--seed", "3")[0] == 0


def test_plan_does_not_replace_a_file_that_is_no_behaviour(mmrs, pool):
    (pool / "notes.txt").write_text("call the harbour master")
    assert mmrs("plan", pool, "-o", pool / "notes.txt")[0] == 2
    assert (pool / "notes.txt").read_text() == "call the harbour master"


def test_demo_does_not_replace_a_behaviour_written_by_hand(mmrs, project):
    before = contents(project)
    code, _, err = mmrs("demo", "pool", "--out", project)
    assert code == 2
    assert "choose another folder" in err
    assert contents(project) == before


@pytest.mark.parametrize("name", ["mission.xmi", "context.xmi", "robots/mine.xmi"])
def test_demo_does_not_replace_models_that_are_no_copies_of_an_example(mmrs, pool, name):
    file = pool / name
    file.write_text(file.read_text() + " " if file.exists() else "<mine/>")
    before = contents(pool)
    code, _, err = mmrs("demo", "drone-and-rover", "--out", pool)
    assert code == 2
    assert name in err
    assert "choose another folder" in err
    assert contents(pool) == before


def test_preview_does_not_draw_over_an_input(mmrs, pool):
    (pool / "preview.svg").symlink_to("mission.xmi")
    before = contents(pool)
    code, _, err = mmrs("preview", pool)
    assert code == 2
    assert "preview.svg" in err
    assert contents(pool) == before


def test_simulate_does_not_log_over_an_input(mmrs, project, tmp_path):
    mmrs("simulate", project, "-o", tmp_path / "logs")
    log = next((tmp_path / "logs").iterdir())
    log.unlink()
    log.symlink_to(project / "behaviour.xmi")
    before = contents(project)
    assert mmrs("simulate", project, "-o", tmp_path / "logs")[0] == 2
    assert contents(project) == before


def test_generate_does_not_write_over_an_input_even_when_forced(mmrs, project, tmp_path):
    arguments = ("generate", project, "--target", "mavlink-python", "-o", tmp_path / "out", "--force")
    assert mmrs(*arguments)[0] == 0
    written = next(path for path in sorted((tmp_path / "out").rglob("*")) if path.is_file())
    written.unlink()
    written.symlink_to(project / "behaviour.xmi")
    before = contents(project)
    assert mmrs(*arguments)[0] == 2
    assert contents(project) == before


class Strict:
    """A plug-in that finds fault with every behaviour."""

    @hookimpl
    def mmrs_constraints(self):
        def never(robot, models):
            yield Finding(robot, f"'{robot.id}' is never good enough")

        robots = ("urn:mmrs:behaviour:1.0", "Robot")
        return (Constraint("STRICT001", "No robot is good enough.", robots, never, "give up"),)


@pytest.mark.parametrize("command", ["plan", "demo"])
def test_no_behaviour_is_written_that_breaks_a_constraint(mmrs, pool, tmp_path, monkeypatch, command):
    monkeypatch.setattr(Settings, "plugins", lambda settings: load_plugins(extra={"strict": Strict()}))
    out = {"plan": (pool,), "demo": ("pool", "--out", tmp_path / "out")}[command]
    code, _, err = mmrs(command, *out)
    assert code == 1
    assert "is never good enough [STRICT001]" in err
    assert not (pool / "behaviour.xmi").exists()
    assert not (tmp_path / "out").exists()
