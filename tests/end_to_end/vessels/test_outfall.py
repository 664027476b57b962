"""The example outfall, from its mission to files that are read back."""

import shutil
from pathlib import Path

import pytest
from imc_reader import read_packet
from lxml import etree
from mmrs_auv.commands.modelled import sheets_in
from moos_reader import Helm, read, run

from auv_vessel.sheet import from_json
from mmrs_core.testing.conformance.missions import run_command

EXAMPLE = Path(__file__).parents[3] / "examples" / "outfall"


@pytest.fixture(scope="module")
def planned(tmp_path_factory):
    folder = tmp_path_factory.mktemp("outfall") / "outfall"
    shutil.copytree(EXAMPLE, folder)
    run_command("plan", folder)
    return folder


def generated(planned, target):
    out = planned.parent / target
    run_command("generate", planned, "--target", target, "-o", out, "--allow-lossy")
    return out


def test_the_vehicle_faces_the_object_wherever_it_is_found(planned):
    root = etree.parse(planned / "behaviour.xmi").getroot()
    kind = "{http://www.w3.org/2001/XMLSchema-instance}type"
    (turn,) = (
        each for each in root.iter("moves") if each.get("rule") == "align" and "HeadTo" in each.get(kind)
    )
    index = int(turn.find("heading").get("target").rpartition(".")[2])
    target = root.findall("targets")[index]
    assert (target.get(kind), target.get("description")) == ("behaviour:ObjectTarget", "marker buoy")


def test_its_controller_and_its_control_layer_know_the_same_vehicle_in_the_same_water(planned):
    sheet = from_json((generated(planned, "can-python") / "robot_Nereid.json").read_text(encoding="utf-8"))
    assert sheet == sheets_in(planned)["Nereid"]
    assert sheet.water_density == 1026.0


def test_its_plan_for_lsts_vehicles_is_read_back(planned):
    plan = read_packet((generated(planned, "imc") / "Nereid.imc").read_bytes())
    kinds = [each["data"][""] for each in plan["maneuvers"]]
    assert kinds.count("PopUp") >= 1
    assert kinds.count("Goto") > 20
    assert len(plan["transitions"]) == len(kinds)
    deepest = max(each["data"]["z"] for each in plan["maneuvers"])
    assert deepest == pytest.approx(16.8, abs=0.5)
    entities = [
        set_["name"] for each in plan["maneuvers"] for set_ in (*each["start_actions"], *each["end_actions"])
    ]
    assert {"Sidescan", "Camera", "CTD"} == set(entities)


def test_its_behaviour_file_is_read_back(planned):
    text = (generated(planned, "moos") / "Nereid.bhv").read_text()
    _, behaviours = read(text)
    depths = {float(each["depth"][0]) for kind, each in behaviours if kind == "BHV_ConstantDepth"}
    assert max(depths) == pytest.approx(16.8, abs=0.5)


@pytest.mark.thorough
def test_a_helm_carries_it_out_to_its_end(planned):
    helm = Helm((generated(planned, "moos") / "Nereid.bhv").read_text())
    assert run({"Nereid": helm}, seconds=6_000.0)
    assert helm.place == pytest.approx((0.0, 0.0), abs=2.0)
