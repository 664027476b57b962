"""Choices that ask the operator, under `mmrs run` with vehicles."""

import json
import subprocess

import pytest
from fault_table.project import Pad
from patience import wait_for
from warm_python import python

from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("runs")

PATIENCE = 60.0
QUESTION = "go on?"
PLAIN = '<moveTransitions from="//@robots.0/@moves.1" to="//@robots.0/@moves.2"'
ASKING = (
    '<moveTransitions xsi:type="behaviour:Choice" conditionIdentifier="answer:go on?"'
    ' falseBranch="//@robots.0/@moves.2" from="//@robots.0/@moves.1" to="//@robots.0/@moves.2"'
)


@pytest.fixture
def asking(fleet):
    """Return vehicles whose robot asks something after its take-off, and the process that flies it."""
    flown = fleet(Pad("a", stay=1.0))
    text = flown.behaviour.read_text("utf-8")
    assert PLAIN in text
    flown.behaviour.write_text(text.replace(PLAIN, ASKING), "utf-8")
    flown.start()
    return flown


def control(fleet, *words):
    """Give an order by `mmrs control`; return the exit code and the robot's answer."""
    command = [python(), "-m", "mmrs_core", "control", *words, "--log", str(fleet.logs), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=PATIENCE)
    (reply,) = json.loads(done.stdout)["robots"]
    return done.returncode, reply


def test_the_operator_is_told_what_is_asked_and_decides(asking):
    assert wait_for(lambda: "'a': waits for an answer to 'go on?'" in asking.process.said, PATIENCE)
    _, status = control(asking, "status")
    assert (status["phase"], status["move"], status["asks"]) == ("works", "up", QUESTION)
    assert (status["mode"], status["armed"]) == ("guided", True)
    assert status["energy"] > 0.5
    assert status["place"]["height"] == pytest.approx(10.0, abs=1.0)

    code, refused = control(asking, "answer", "--question", "go on", "--says", "yes")
    assert (code, refused["why"]) == (1, "no choice asks 'go on'; there is 'go on?'")
    code, _ = control(asking, "answer", "--question", QUESTION, "--says", "yes")
    assert code == 0
    assert asking.process.end(PATIENCE) == 0, asking.process.said
    (decision,) = [line for line in asking.box("a") if line.get("what") == "CHOICE"]
    assert decision["response"] == "waits for an answer to 'go on?'"
    answered = [line for line in asking.box("a") if line["kind"] == "order"]
    assert [(line["question"], line["says"], line["confirmed"]) for line in answered] == [
        ("go on", "yes", False),
        (QUESTION, "yes", True),
    ]
    assert asking.replayed().outcome is Outcome.SUCCESS
