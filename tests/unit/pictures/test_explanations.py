import json
from dataclasses import replace

import pytest
from plain_scenes import robot, scene, task, visit

from mmrs_core.cli.plan_words import explanation_lines, explanation_summary
from mmrs_core.planning.explaining import Alternative, explain
from mmrs_core.planning.planner import plan

TEXT = [
    "",
    "What determines the mission time",
    "  'Brezza' finishes last, at 2:09: 0:42 after 'Alba'",
    "  no plan ends before 1:27, so this one is within 48 % of the best possible",
    "  from  to    robot   task    time spent",
    "  0:00  0:42  Alba    gate    transit 0:30, launch 0:12",
    "  0:42  1:24  Brezza  roof    transit 0:30, launch 0:12",
    "  1:24  2:09  Brezza  return  transit 0:30, landing 0:15",
    "",
    "Limits",
    "  binding: dependencies",
    "  limit         mission would end without it  margin",
    "  dependencies  0:42 sooner                   'Brezza' waits for 'gate' of 'Alba'",
    "  deadlines     no sooner                     'gate' ends 18 s before its deadline",
    "  robotsWanted  no sooner",
    "  charge        no sooner                     'Brezza' uses up to 87 of the 1200 s of a charge (7 %)",
    "",
    "Why these robots",
    "  each alternative was planned, with all other tasks as they are",
    "  task  robots  alternative     mission ends  task ends   robots busy",
    "  gate  Alba    Cirro instead   as planned    as planned  0:02 longer",
    "                Brezza instead  0:14 later    0:06 later  1:13 shorter",
    "  roof  Brezza  Cirro instead   0:02 later    0:01 later  0:02 longer",
    "",
    "What robots cannot do",
    "  'Alba' cannot do 'roof': has no work for it",
    "",
    "Robots without a task",
    "  'Cirro' would not make the mission end sooner: at best it would take 'gate' (Cirro instead)",
]


def test_an_explanation_reads_well_and_is_json():
    team = [robot("Alba"), robot("Brezza", (60.0, 0.0, 0.0)), robot("Cirro", (5.0, 0.0, 0.0))]
    works = {
        "gate": visit((-300.0, 0.0, 20.0)),
        "roof": {"Brezza": visit((100.0, 300.0, 20.0)), "Cirro": visit((100.0, 300.0, 20.0))},
    }
    tasks = {"gate": task("gate", wanted=1, deadline=60.0)}
    whole = scene(team, works, after=[("gate", "roof")], tasks=tasks)
    explanation = explain(whole, plan(whole))
    assert list(explanation_lines(explanation)) == TEXT
    assert "lastRobot" in json.dumps(explanation_summary(explanation), allow_nan=False)


@pytest.mark.parametrize(
    ("bound", "planned", "said"),
    [
        (30.0, 0.0, "no plan ends before 0:30, so this one is at most 2.89 times the best possible"),
        (
            100.0,
            120.0,
            "by the planner's times this one ends at 2:00: no plan ends before 1:40,"
            " so this one is within 20 % of the best possible",
        ),
        (120.0, 120.0, "by the planner's times this one ends at 2:00: no plan ends sooner"),
        (0.0, 120.0, "how much sooner another plan could end is not known"),
    ],
)
def test_an_explanation_always_compares_a_plan_with_its_bound(bound, planned, said):
    whole = scene([robot("Alba")], {"gate": visit((-300.0, 0.0, 20.0))})
    found = replace(explain(whole, plan(whole)), lower_bound=bound, planned=planned)
    assert list(explanation_lines(found))[3] == f"  {said}"


def test_an_alternative_that_ends_sooner_before_robots_wait_to_keep_apart_says_so():
    """Neither is it said to be no sooner, nor that a longer search would find it."""
    team = [robot("Alba"), robot("Brezza", (60.0, 0.0, 0.0))]
    whole = scene(team, {"gate": visit((-300.0, 0.0, 20.0))}, minimum_separation=5.0)
    found = explain(whole, plan(whole))
    sooner = Alternative(("Brezza",), -76.0, -76.0, 5.0)
    assert explanation_summary(found)["alternativesBeforeSeparation"]
    tasks = tuple(replace(each, alternatives=(sooner,)) for each in found.tasks)
    lines = list(explanation_lines(replace(found, tasks=tasks, idle={"Brezza": ("gate", sooner)})))
    assert lines[lines.index("Why these robots") + 1] == (
        "  each alternative was planned, with all other tasks as they are;"
        " times are those before robots wait to keep their distance"
    )
    assert "  an alternative would end sooner without these waits, and may end later with them" in lines
    assert lines[-1] == (
        "  'Brezza' would make the mission end 1:16 sooner, at best with 'gate' (Brezza instead),"
        " before robots wait to keep their distance"
    )
