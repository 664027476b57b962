"""Another plug-in gives its own flying robots take-offs and landings by subclassing those of multicopters."""

import re
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from mmrs_multicopter.kinds import MULTICOPTER_KIND, kinematics

from mmrs_core.cli import run
from mmrs_core.cli.settings import Settings
from mmrs_core.contributions.rules import MoveSpec
from mmrs_core.hookspecs import hookimpl
from mmrs_core.languages.sources import MetamodelSource
from mmrs_core.plugins import load_plugins
from mmrs_core.transformation.kinds import straight_travel

AIRSHIP = "urn:airship:1.0"
EXAMPLE = Path(__file__).parents[3] / "examples" / "carbon-dioxide"
ECORE = """<ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore"
    name="airship" nsURI="urn:airship:1.0" nsPrefix="airship">
  <eClassifiers xsi:type="ecore:EClass" name="Airship" eSuperTypes="urn:mmrs:robot:1.0#//Robot">
    <eStructuralFeatures xsi:type="ecore:EAttribute" name="maxAltitude"
        eType="ecore:EDataType http://www.eclipse.org/emf/2002/Ecore#//EDouble"/>
    <eStructuralFeatures xsi:type="ecore:EAttribute" name="positionHold"
        eType="ecore:EDataType http://www.eclipse.org/emf/2002/Ecore#//EDouble"/>
  </eClassifiers>
  <eClassifiers xsi:type="ecore:EClass" name="TakeOff" eSuperTypes="urn:mmrs:multicopter:1.0#//TakeOff"/>
  <eClassifiers xsi:type="ecore:EClass" name="Land" eSuperTypes="urn:mmrs:multicopter:1.0#//Land"/>
</ecore:EPackage>"""


class Airships:
    """The plug-in."""

    def __init__(self, folder):
        self._ecore = folder / "airship.ecore"
        self._ecore.write_text(ECORE)

    @hookimpl
    def mmrs_metamodels(self):
        return (MetamodelSource(AIRSHIP, self._ecore, "mmrs-airship"),)

    @hookimpl
    def mmrs_robot_kinds(self):
        return (
            replace(
                MULTICOPTER_KIND,
                name="airship",
                metaclass=(AIRSHIP, "Airship"),
                kinematics=kinematics,
                launch=lambda height: (MoveSpec((AIRSHIP, "TakeOff"), {"altitude": height}),),
                recover=lambda: (MoveSpec((AIRSHIP, "Land")),),
                travel=straight_travel,
            ),
        )


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """Return the paper's example with airships instead of drones, planned."""
    folder = tmp_path_factory.mktemp("airships")
    made = Path(shutil.copytree(EXAMPLE, folder / "project"))
    mission = made / "mission.xmi"
    text = mission.read_text(encoding="utf-8")
    mission.write_text(text.replace('gridResolution="12.0"', 'gridResolution="60.0"'), encoding="utf-8")
    (file,) = (made / "robots").glob("*.xmi")
    text = file.read_text(encoding="utf-8").replace("multicopter:Drone ", "airship:Airship ")
    text = text.replace("</multicopter:Drone>", "</airship:Airship>")
    text = text.replace('xmlns:multicopter="urn:mmrs:multicopter:1.0"', f'xmlns:airship="{AIRSHIP}"')
    text = re.sub(
        r'<size xsi:type="multicopter:DroneSize"(.*?) propellers="4"\s+propellerSize="381.0"',
        r"<size\1",
        text,
    )
    file.write_text(text, encoding="utf-8")
    plugin = Airships(folder)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(Settings, "plugins", lambda settings: load_plugins(extra={"airships": plugin}))
        assert run(["plan", str(made)]) == 0
        yield made


def test_another_flying_kind_is_planned_verified_and_simulated(project):
    planned = (project / "behaviour.xmi").read_text(encoding="utf-8")
    assert planned.count('xsi:type="airship:TakeOff"') == planned.count('xsi:type="airship:Land"') >= 3
    assert run(["simulate", str(project)]) == 0


def test_a_multicopters_own_take_off_remains_a_drones(project, capsys):
    file = project / "behaviour.xmi"
    text = file.read_text(encoding="utf-8").replace('"airship:TakeOff"', '"multicopter:TakeOff"')
    file.write_text(
        text.replace("xmlns:airship=", 'xmlns:multicopter="urn:mmrs:multicopter:1.0" xmlns:airship=')
    )
    assert run(["check", str(project)]) == 1
    assert "[MUL012]" in capsys.readouterr().err
