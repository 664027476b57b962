"""Built wheels carry everything they need: they run from another directory without the checkout."""

import json
import os
import subprocess
import sys
from importlib.metadata import distributions
from io import BytesIO
from pathlib import Path
from zipfile import ZipFile

import pytest
from built_wheels import build, install

from mmrs_core.generation.wheels import wheel_of
from mmrs_core.plugins import load_plugins

ROOT = Path(__file__).parents[2]
PROJECTS = (
    ROOT,
    ROOT / "runtime",
    *(folder.parent for folder in sorted(ROOT.glob("plugins/*/pyproject.toml"))),
)

QUESTION = """
import json, sys
import mmrs_core
from mmrs_core.plugins import load_plugins
from mmrs_core.resources import shipped
contributions = load_plugins().contributions
print(json.dumps({
    "core": mmrs_core.__file__,
    "packages": sorted(package.ns_uri for package in contributions.languages.packages),
    "examples": sorted(folder.name for folder in shipped("examples").iterdir() if folder.is_dir()),
    "importers": [importer.name for importer in contributions.languages.importers],
    "templates": sorted(str(target.templates) for target in contributions.targets.values()),
    "types": {key: str(each.file) for key, each in contributions.robot_types.items() if each.file.is_file()},
    "missing": [str(t.templates) for t in contributions.targets.values() if not t.templates.is_dir()],
}))
"""


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """Return a folder in which the wheels of the core and of every plug-in are installed."""
    folder = tmp_path_factory.mktemp("built")
    built = build(PROJECTS, folder / "wheels")
    assert len(built) == len(PROJECTS)
    install(built, site := folder / "site")
    return site


def run(site, directory, *command):
    environment = {**os.environ, "PYTHONPATH": str(site)}
    return subprocess.run(
        [sys.executable, *command], cwd=directory, env=environment, capture_output=True, text=True, check=True
    ).stdout


def test_wheels_find_their_metamodels_templates_and_examples(site, tmp_path):
    found = json.loads(run(site, tmp_path, "-c", QUESTION))
    assert Path(found["core"]).is_relative_to(site)
    assert {f"urn:mmrs:{name}:1.0" for name in ("mission", "context", "robot", "behaviour")} <= set(
        found["packages"]
    )
    assert {"urn:mmrs:multicopter:1.0", "urn:mmrs:auv:1.1", "urn:mmrs:survey:1.0"} <= set(found["packages"])
    assert "carbon-dioxide" in found["examples"]
    assert "FLYAQ 2015" in found["importers"]
    assert found["templates"]
    assert all(Path(folder).is_relative_to(site) for folder in found["templates"])
    assert found["missing"] == []
    assert set(found["types"]) == set(load_plugins().contributions.robot_types)
    assert all(Path(file).is_relative_to(site) for file in found["types"].values())


def test_wheels_carry_the_licence_and_name_it(site):
    licence = (ROOT / "LICENSE").read_bytes()
    described = sorted([*site.glob("mmrs_*.dist-info"), *site.glob("auv_*.dist-info")])
    assert len(described) == len(PROJECTS)
    assert [(each / "licenses" / "LICENSE").read_bytes() == licence for each in described] == [True] * len(
        PROJECTS
    )
    assert all("License-Expression: Apache-2.0\n" in (each / "METADATA").read_text() for each in described)


def test_wheels_made_without_a_build_backend_carry_the_same(site):
    found = list(distributions(path=[str(site)]))
    assert len(found) == len(PROJECTS)
    for each in found:
        with ZipFile(BytesIO(wheel_of(each.name).content)) as archive:
            held = {name: archive.read(name) for name in archive.namelist() if ".dist-info/" not in name}
        built = [file for file in each.files if file.suffix != ".pyc" and ".." not in file.parts]
        built = [file for file in built if "dist-info" not in file.parts[0] and file.parts[0] != "bin"]
        assert held == {file.as_posix(): file.read_binary() for file in built}


def test_an_installed_example_validates_from_another_directory(site, tmp_path):
    example = site / "mmrs_core" / "_shipped" / "examples" / "carbon-dioxide"
    out = run(site, tmp_path, "-m", "mmrs_core", "validate", str(example))
    assert out == f"{example}: valid (1 note)\n"


def test_wheels_carry_the_kit_of_extenders(site, tmp_path):
    run(site, tmp_path, "-m", "mmrs_core", "plugin", "new", "roof-wash", "-o", "new")
    assert (tmp_path / "new" / "mmrs_roof_wash" / "roof_wash.pyi").is_file()
    models = "from mmrs_core.testing.models import sample_tasks; print(sample_tasks().ecore.is_file())"
    assert run(site, tmp_path, "-c", models) == "True\n"
