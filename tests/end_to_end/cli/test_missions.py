"""Commands on missions: from models to everything that a demonstration leaves."""

import json
import re
import shlex
import shutil

import pytest
from lxml import etree

from mmrs_core.cli.plan import Stage
from mmrs_core.cli.settings import Settings
from mmrs_core.contributions.constraints import Constraint
from mmrs_core.hookspecs import hookimpl
from mmrs_core.plugins import load_plugins
from mmrs_core.resources import shipped

EXAMPLES = ("carbon-dioxide", "drone-and-rover", "mixed-team", "outfall", "pool", "solar-park")


@pytest.fixture
def pool(tmp_path):
    """Return a copy of the smallest example."""
    return shutil.copytree(shipped("examples") / "pool", tmp_path / "pool")


def demonstrates(mmrs, tmp_path, example):
    code, out, err = mmrs("demo", example, "--out", tmp_path / "out")
    assert (code, err) == (0, "")
    assert "logs verified" in out
    assert len(out.splitlines()) <= 45
    left = {path.relative_to(tmp_path / "out").as_posix() for path in (tmp_path / "out").rglob("*")}
    assert {"behaviour.xmi", "preview.html", "preview.svg", "controllers/mavlink-python"} <= left
    assert any(path.startswith("logs/") for path in left)
    return out


def test_an_example_can_be_demonstrated(mmrs, tmp_path):
    demonstrates(mmrs, tmp_path, "drone-and-rover")


def test_a_demonstration_is_the_same_again_and_can_be_reported_with_its_tasks_and_its_plan(mmrs, tmp_path):
    out = demonstrates(mmrs, tmp_path, "pool")
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    assert mmrs("demo", "pool", "-o", tmp_path / "out") == (0, out, "")
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before
    command = shlex.split(out.splitlines()[-1].partition("mmrs ")[2])
    code, told, err = mmrs(*command, "--json")
    assert (code, err) == (0, "")
    report = json.loads(told)["report"]
    assert report["tasks"]
    assert all(robot["planned_way"] > 0.0 for robot in report["robots"])
    assert not any("context" in line for line in report["unknown"])


def test_a_demonstration_takes_the_place_of_another_ones_whole_copy(mmrs, tmp_path):
    demonstrates(mmrs, tmp_path, "outfall")
    demonstrates(mmrs, tmp_path, "pool")
    example = shipped("examples") / "pool"
    types = {path.name for path in (tmp_path / "out" / "robots").iterdir()}
    assert types == {path.name for path in (example / "robots").iterdir()}
    assert (tmp_path / "out" / "mission.xmi").read_bytes() == (example / "mission.xmi").read_bytes()


@pytest.mark.thorough
@pytest.mark.parametrize("example", sorted({*EXAMPLES} - {"mixed-team"}))
def test_every_example_can_be_demonstrated(mmrs, tmp_path, example):
    demonstrates(mmrs, tmp_path, example)


def test_a_demonstration_tells_itself_as_one_object(mmrs, tmp_path):
    told = json.loads(mmrs("demo", "pool", "--output", tmp_path / "out", "--json")[1])
    assert told["mission"] == "Objects in the pool"
    assert told["replay"]["complaints"] == []
    assert {"robots", "tasks", "makespan", "verdicts", "ending", "files"} <= set(told)


def test_examples_are_listed(mmrs):
    out = mmrs("demo", "--list")[1]
    assert [line.split()[0] for line in out.splitlines()] == sorted(
        (*EXAMPLES, "barn", "lost-float", "pool-course", "ridge", "two-auv-survey")
    )


def test_plan_takes_the_file_of_the_mission_and_writes_the_behaviour_into_the_project(mmrs, pool):
    mission = (pool / "mission.xmi").rename(pool / "monday.xmi")
    code, out, _ = mmrs("plan", mission)
    assert code == 0
    assert f"written: {pool / 'behaviour.xmi'}" in out
    assert mmrs("check", pool)[0] == 0


def test_context_and_robot_types_can_be_named(mmrs, pool, tmp_path):
    away = tmp_path / "away"
    away.mkdir()
    context = (pool / "context.xmi").rename(away / "place.xmi")
    types = [path.rename(away / path.name) for path in sorted((pool / "robots").iterdir())]
    assert mmrs("plan", pool, "--context", context, "--robots", *types)[0] == 0


def test_the_same_seed_gives_the_same_behaviour_wherever_it_is_written(mmrs, pool, tmp_path):
    assert mmrs("plan", pool, "--seed", 7, "-o", tmp_path / "b.xmi")[0] == 0
    assert not (pool / "behaviour.xmi").exists()
    assert mmrs("plan", pool, "--seed", 7)[0] == 0
    assert (pool / "behaviour.xmi").read_bytes() == (tmp_path / "b.xmi").read_bytes()


@pytest.mark.parametrize("stage", list(Stage))
def test_every_stage_can_be_looked_at(mmrs, pool, stage):
    code, out, _ = mmrs("plan", pool, "--stop-after", stage.value, "--json")
    assert code == 0
    assert json.loads(out)["stage"] == stage.value
    assert not (pool / "behaviour.xmi").exists()


def test_what_is_not_known_is_refused_with_the_ways_out(mmrs, pool):
    mission = pool / "mission.xmi"
    mission.write_text(re.sub(r" *<acceptedUnknowns>.*</acceptedUnknowns>\n", "", mission.read_text("utf-8")))
    code, _, err = mmrs("plan", pool)
    assert code == 1
    assert "not known to be safe: give what is missing" in err
    assert "acceptedUnknowns\n  - range: unknown" in err


def test_planning_again_replaces_the_behaviour_in_its_own_form(mmrs, pool):
    assert mmrs("plan", pool, "-o", pool / "behaviour.json")[0] == 0
    assert mmrs("plan", pool)[0] == 0
    assert [path.name for path in pool.glob("behaviour.*")] == ["behaviour.json"]
    assert mmrs("check", pool)[0] == 0


def test_plan_as_json_is_one_object(mmrs, pool):
    told = json.loads(mmrs("plan", pool, "--json")[1])
    assert told["behaviour"] == (pool / "behaviour.xmi").as_posix()
    assert told["robots"][0]["length"] > 0


def test_an_infeasible_mission_ends_with_4_and_writes_nothing(mmrs, pool):
    file = pool / "mission.xmi"
    tree = etree.parse(file)
    tree.find("tasks").set("deadline", "0.5")
    tree.write(file)
    code, out, err = mmrs("plan", pool)
    assert (code, out) == (4, "")
    assert tree.find("tasks").get("name") in err
    assert not (pool / "behaviour.xmi").exists()


def test_preview_writes_into_the_project_and_draws_the_planned_file_as_it_went(mmrs, pool):
    assert mmrs("preview", pool)[0] == 0
    words = "".join(etree.parse(pool / "preview.svg").getroot().itertext())
    assert "Naiad" in words
    assert "moves " in words or "move " in words
    mmrs("plan", pool)
    assert mmrs("preview", pool / "behaviour.xmi", "-o", pool / "drawn")[0] == 0
    assert (pool / "drawn" / "preview.html").is_file()


def test_answers_of_conditions_are_wrong_usage_where_a_mission_is_drawn_as_planned(mmrs, pool):
    code, _, err = mmrs("preview", pool, "--assume", "calm=yes")
    assert code == 2
    assert "--assume goes with a behaviour" in err
    assert not (pool / "preview.html").exists()


class Clumsy:
    """A plug-in whose constraint fails on every task."""

    @hookimpl
    def mmrs_constraints(self):
        tasks = ("urn:mmrs:mission:1.0", "Task")
        return (Constraint("CLUMSY001", "t", tasks, lambda task, models: 1 / 0, "h"),)


def test_a_constraint_that_fails_is_the_plugins_fault(mmrs, pool, monkeypatch):
    monkeypatch.setattr(Settings, "plugins", lambda settings: load_plugins(extra={"clumsy": Clumsy()}))
    code, _, err = mmrs("validate", pool)
    assert code == 1
    assert "plug-in 'clumsy' of distribution 'given by the caller': constraint 'CLUMSY001' fails" in err
    assert "on /tasks[0] of " in err
    assert "internal error" not in err


@pytest.mark.parametrize("example", EXAMPLES)
def test_elements_of_a_missing_plugin_are_shown_as_unknown(mmrs, example):
    code, out, err = mmrs("show", shipped("examples") / example / "mission.xmi", "--no-plugins")
    assert code == 0
    assert re.search(r"\(unknown, of urn:mmrs:[\w-]+:1.0\)", out)
    assert "[XMI001]" in err


def test_unknown_elements_are_shown_by_name_referred_to_by_it_and_keep_their_text_in_json(mmrs, pool):
    out = mmrs("show", pool / "mission.xmi", "--no-plugins")[1]
    assert "tasks: GoToTask name=gate (unknown, of urn:mmrs:survey:1.0)" in out
    assert "from=→ gate" in out
    told = json.loads(mmrs("show", pool / "mission.xmi", "--no-plugins", "--json")[1])
    task = told["roots"][0]["tasks"][0]
    assert task["$type"] == "urn:mmrs:survey:1.0#GoToTask"
    assert 'name="gate"' in task["$xml"]


def test_a_root_of_a_missing_plugin_is_shown_as_unknown(mmrs, pool):
    file = pool / "mission.xmi"
    file.write_text('<s:PhotoGridTask xmlns:s="urn:mmrs:survey:1.0" name="&lt;floor>"/>')
    assert mmrs("show", file, "--no-plugins")[1] == (
        "PhotoGridTask name=<floor> (unknown, of urn:mmrs:survey:1.0)\n"
    )


def test_a_mistake_beside_a_missing_plugin_still_counts(mmrs, pool):
    file = pool / "mission.xmi"
    file.write_text(file.read_text().replace("<team", "<team colour='red'", 1))
    assert mmrs("show", file, "--no-plugins")[0] == 1


@pytest.mark.parametrize("command", ["plan", "validate"])
def test_without_plugins_their_tasks_are_unknown(mmrs, pool, command):
    code, _, err = mmrs(command, pool, "--no-plugins")
    assert code == 1
    assert "urn:mmrs:survey:1.0" in err
