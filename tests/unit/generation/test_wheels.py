import subprocess
import sys
from io import BytesIO
from pathlib import Path
from zipfile import ZipFile

import pytest
from hatchling.builders.wheel import WheelBuilder

from mmrs_core.errors import MmrsError
from mmrs_core.generation.wheels import wheel_of

SURVEY = Path(__file__).parents[3] / "plugins" / "survey"

PROJECT = """
[build-system]
build-backend = "{backend}"
[tool.hatch.build.targets.wheel]
{table}
"""


def held(wheel: bytes) -> dict[str, bytes]:
    """Return what a wheel holds, without its metadata."""
    with ZipFile(BytesIO(wheel)) as archive:
        return {name: archive.read(name) for name in archive.namelist() if ".dist-info/" not in name}


@pytest.fixture
def in_place(tmp_path, monkeypatch):
    """Return what makes a distribution ``kite`` that is installed in place, from its folder."""
    monkeypatch.syspath_prepend(tmp_path)
    described = tmp_path / "kite-1.0.dist-info"
    described.mkdir()
    (described / "METADATA").write_text("Metadata-Version: 2.4\nName: kite\nVersion: 1.0\n")
    (described / "WHEEL").write_text("Root-Is-Purelib: true\n")
    (described / "RECORD").write_text("kite-1.0.dist-info/METADATA,,\n")
    origin = '{"dir_info": {"editable": true}, "url": "%s"}'
    (described / "direct_url.json").write_text(origin % (tmp_path / "a kite").as_uri())

    def make(table='packages = ["src/kite"]', backend="hatchling.build"):
        (tmp_path / "a kite" / "src" / "kite").mkdir(parents=True)
        (tmp_path / "a kite" / "src" / "kite" / "__init__.py").write_text("STRING = 40.0\n")
        project = PROJECT.format(backend=backend, table=table)
        (tmp_path / "a kite" / "pyproject.toml").write_text(project)
        return tmp_path / "a kite"

    wheel_of.cache_clear()
    yield make
    wheel_of.cache_clear()


def test_a_wheel_has_the_files_that_the_build_backend_puts_into_it(tmp_path):
    (built,) = WheelBuilder(str(SURVEY)).build(directory=str(tmp_path), versions=["standard"])
    wheel = wheel_of("mmrs-survey")
    assert wheel.name == Path(built).name
    assert held(wheel.content) == held(Path(built).read_bytes())


def test_two_builds_are_equal_byte_by_byte(in_place):
    folder = in_place()
    first = wheel_of("kite").content
    for path in folder.rglob("*.py"):
        path.touch()
    wheel_of.cache_clear()
    assert wheel_of("kite").content == first


def test_a_wheel_of_a_copy_has_the_files_and_metadata_of_the_one_that_was_installed(tmp_path, monkeypatch):
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet", "install", "--no-index"]
    wheel = wheel_of("mmrs-survey")
    (tmp_path / wheel.name).write_bytes(wheel.content)
    site = tmp_path / "site"
    subprocess.run([*pip, "--no-deps", "--target", site, tmp_path / wheel.name], check=True)
    monkeypatch.syspath_prepend(site)
    wheel_of.cache_clear()
    assert wheel_of("mmrs-survey") == wheel


def test_a_project_is_found_in_a_folder_with_spaces_and_its_source_folder_and_caches_are_left_out(in_place):
    cache = in_place() / "src" / "kite" / "__pycache__"
    cache.mkdir()
    (cache / "loops.py311.nbi").touch()
    assert held(wheel_of("kite").content) == {"kite/__init__.py": b"STRING = 40.0\n"}


def test_a_distribution_that_is_not_installed_is_named():
    with pytest.raises(MmrsError, match=r"^distribution no-such-thing: is not installed"):
        wheel_of("no-such-thing")


def test_a_distribution_with_compiled_parts_is_refused():
    with pytest.raises(MmrsError, match=r"^distribution numpy: has compiled parts"):
        wheel_of("numpy")


@pytest.mark.parametrize(
    "project",
    [{"backend": "setuptools.build_meta"}, {"table": ""}, {"table": 'packages = ["kite"]\nexclude = ["a"]'}],
)
def test_a_project_that_is_built_in_another_manner_is_refused(in_place, project):
    in_place(**project)
    with pytest.raises(MmrsError, match=r"pyproject\.toml: does not say .* install it without --editable"):
        wheel_of("kite")


def test_a_missing_file_is_named(in_place):
    in_place(table='packages = ["lost"]')
    with pytest.raises(MmrsError, match=r"^distribution kite: .*lost is missing$"):
        wheel_of("kite")
