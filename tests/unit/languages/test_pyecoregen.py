"""pyecoregen makes Python modules of the languages, as of any metamodel that pyecore has."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from pyecoregen.ecore import EcoreGenerator

from mmrs_core.languages.reading import read_model

SURVEY = Path(__file__).parents[3] / "plugins" / "survey" / "mmrs_survey" / "metamodels" / "survey.ecore"
LANGUAGES = ("robot", "mission", "context", "behaviour", "survey")
USE = """
import sys
from pathlib import Path
from pyecore.resources import URI
from mmrs_core.languages.ecore_api.resources import resource_factory
from mmrs_core.languages.registry import MetamodelSource, registry_with
import behaviour, mission, robot, survey

task = survey.PhotoGridTask(name="grid", robotsWanted=2)
place = mission.GeoCoordinate(latitude=42.0, longitude=13.0)
team = mission.Team(robots=[mission.Robot(name="r", type="Drone", home=place)])
made = mission.Mission(name="m", team=team, tasks=[task, mission.Fork(name="f")])
made.taskDependencies.append(mission.TaskDependency(from_=task, to=made.tasks[1]))
assert isinstance(task, mission.PolygonTask)
assert task.eContainer() is made
assert made.altitudeReference is robot.AltitudeReference.ELLIPSOID
assert behaviour.GoTo.eClass.ePackage.nsURI == "urn:mmrs:behaviour:1.0"
registry = registry_with([MetamodelSource("urn:mmrs:survey:1.0", Path(sys.argv[1]))])
resource = resource_factory(registry)(URI("mission.xmi"))
resource.append(made)
resource.save()
"""


def test_models_made_with_modules_of_pyecoregen_are_saved_by_our_writer(tmp_path, everything):
    uris = [f"urn:mmrs:{name}:1.0" for name in LANGUAGES]
    packages = [everything.epackage(ns_uri) for ns_uri in uris]
    generator = EcoreGenerator()
    for task in generator.tasks:
        task.formatter = str  # the usual one takes most of the time
    for package in packages:
        generator.generate(package, str(tmp_path))
    dependency = packages[1].getEClassifier("TaskDependency")
    assert dependency.findEStructuralFeature("from") is not None  # pyecoregen has given the names back
    run = subprocess.run(
        [sys.executable, "-c", USE, SURVEY], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert (run.returncode, run.stderr) == (0, "")
    model = read_model(tmp_path / "mission.xmi", everything)
    assert model.diagnostics == ()
    (root,) = model.roots
    assert (root.name, root.tasks[0].robotsWanted) == ("m", 2)
    assert root.taskDependencies[0].from_ is root.tasks[0]
