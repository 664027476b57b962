"""The validator of SARIF's authors takes our logs, by the format's rules and those of code scanning."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from mmrs_core.cli import run
from mmrs_core.cli.sarif import sarif_of
from mmrs_core.diagnostics import Diagnostic, Place, Severity

EXAMPLES = Path(__file__).parents[3] / "examples"
TOOL = "node_modules/@microsoft/sarif-multitool-linux/Sarif.Multitool"
PLACE = Path(sys.prefix) / "peers" / TOOL
"""Where the gate installs it, with npm: it is not from PyPI."""
TOLD_BY_CHOICE = {"SARIF2005"}
"""There is no public page about the tool to link to."""
pytestmark = pytest.mark.peer


@pytest.fixture(scope="module")
def multitool():
    """Return a function that runs it; skip where it is absent, or fail where peers must be."""
    if not PLACE.is_file():
        message = "SARIF's multitool is not installed: npm install --prefix .venv/peers"
        message += " @microsoft/sarif-multitool-linux"
        pytest.fail(message) if os.environ.get("MMRS_REQUIRE_PEERS") == "1" else pytest.skip(message)

    def call(*arguments):
        environment = {**os.environ, "DOTNET_SYSTEM_GLOBALIZATION_INVARIANT": "1"}
        done = subprocess.run(
            [PLACE, *arguments], capture_output=True, text=True, check=False, env=environment, timeout=120
        )
        assert "error ERR" not in done.stdout, done.stdout
        return done

    return call


def read(file):
    (found,) = json.loads(file.read_text(encoding="utf-8-sig"))["runs"]
    return found


def complaints(multitool, log):
    """Return the rules that the validator finds broken, with the first words about each."""
    told = log.with_suffix(".told.sarif")
    multitool("validate", log, "--rule-kind", "Sarif;Gh", "--output", told, "--log", "ForceOverwrite")
    return {each["ruleId"]: json.dumps(each)[:600] for each in read(told).get("results", ())}


@pytest.fixture
def spoilt(tmp_path, monkeypatch):
    """Go to a folder with a project that has faults, some with quick fixes, in XMI and in JSON."""
    shutil.copytree(EXAMPLES / "mixed-team", tmp_path / "the dam")
    monkeypatch.chdir(tmp_path)
    for name, right, wrong in (
        ("mission.xmi", 'reserve="0.3"', 'reserve="30"'),
        ("mission.xmi", "photoDistance", "photoDistanse"),
        ("context.json", '"safetyDistance": 2.0', '"safetyDistance": "2,0"'),
    ):
        file = tmp_path / "the dam" / name
        if name == "context.json":
            assert run(["convert", "the dam/context.xmi", "the dam/context.json"]) == 0
            (tmp_path / "the dam" / "context.xmi").unlink()
        file.write_text(file.read_text(encoding="utf-8").replace(right, wrong), encoding="utf-8")
    return tmp_path


def test_the_faults_of_a_mission_are_told_by_the_rules(multitool, spoilt):
    assert run(["validate", "the dam", "--sarif", "out.sarif"]) == 1
    assert sum("fixes" in each for each in read(spoilt / "out.sarif")["results"]) >= 3
    found = complaints(multitool, spoilt / "out.sarif")
    assert set(found) <= TOLD_BY_CHOICE, found


def test_verdicts_are_told_by_the_rules(multitool, tmp_path):
    log = tmp_path / "out.sarif"
    assert run(["check", str(EXAMPLES / "handwritten"), "--sarif", str(log)]) == 0
    found = complaints(multitool, log)
    assert set(found) <= TOLD_BY_CHOICE, found


def test_the_validator_is_awake(multitool, spoilt):
    assert run(["validate", "the dam", "--sarif", "out.sarif"]) == 1
    file = spoilt / "out.sarif"
    log = json.loads(file.read_text(encoding="utf-8"))
    del log["runs"][0]["tool"]["driver"]["rules"][0]["fullDescription"]
    file.write_text(json.dumps(log), encoding="utf-8")
    assert "GH2012" in complaints(multitool, file)


def test_fingerprints_are_those_that_code_scanning_computes(multitool, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = "<a x='1'>\r\n\r\n \t\n  <b é='😀 y'/>\r\n  <b é='😀 y'/>\n" + "  <c n='0'/>\n" * 40 + "\n\n</a>"
    (tmp_path / "m.xmi").write_bytes(text.encode())
    lines = range(1, text.count("\n") + 2)
    faults = [Diagnostic("MML001", Severity.ERROR, "no", Place("m.xmi", line)) for line in lines]
    log = sarif_of(faults, {})
    ours = [each.pop("partialFingerprints") for each in log["runs"][0]["results"]]
    (tmp_path / "bare.sarif").write_text(json.dumps(log), encoding="utf-8")
    kind = "RollingHashPartialFingerprints"
    multitool("rewrite", "bare.sarif", "--insert", kind, "--output", "full.sarif", "--log", "ForceOverwrite")
    assert [each["partialFingerprints"] for each in read(tmp_path / "full.sarif")["results"]] == ours
