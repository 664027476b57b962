"""pyecoregen makes Python modules of the languages, as of any metamodel that pyecore has."""

import subprocess
import sys
from pathlib import Path

import pytest
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
TAKEN = """
import sys
from pathlib import Path
from mmrs_core.languages.registry import MetamodelSource, registry_with
import survey

def told(ecore):  # all that such modules keep: neither order nor lower bounds
    package = registry_with([MetamodelSource("urn:mmrs:survey:1.0", ecore)]).package("urn:mmrs:survey:1.0")
    features = {
        (kind.name, kind.abstract, kind.ancestry, kind.documentation, each.name, each.type.name, each.upper)
        for kind in package.metaclasses
        for each in kind.features
    }
    return features, {(each.name, each.names) for each in package.enumerations}

assert told(survey) == told(Path(sys.argv[1]))
"""


@pytest.fixture(scope="module")
def modules(tmp_path_factory, everything):
    """Return the folder with the modules of the languages, and a function that runs code there."""
    folder = tmp_path_factory.mktemp("modules")
    generator = EcoreGenerator()
    for task in generator.tasks:
        task.formatter = str  # the usual one takes most of the time
    for name in LANGUAGES:
        generator.generate(everything.epackage(f"urn:mmrs:{name}:1.0"), str(folder))

    def run(code):
        command = [sys.executable, "-c", code, SURVEY]
        ran = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        assert (ran.returncode, ran.stderr) == (0, "")
        return folder

    return run


def test_names_are_as_before_once_modules_were_made(modules, everything):
    dependency = everything.epackage("urn:mmrs:mission:1.0").getEClassifier("TaskDependency")
    assert dependency.findEStructuralFeature("from") is not None


def test_models_made_with_modules_of_pyecoregen_are_saved_by_our_writer(modules, everything):
    folder = modules(USE)
    model = read_model(folder / "mission.xmi", everything)
    assert model.diagnostics == ()
    (root,) = model.roots
    assert (root.name, root.tasks[0].robotsWanted) == ("m", 2)
    assert root.taskDependencies[0].from_ is root.tasks[0]


def test_a_module_of_pyecoregen_is_taken_in_the_place_of_its_metamodel(modules):
    modules(TAKEN)
