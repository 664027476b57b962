import os
import subprocess
import sys
from importlib.metadata import version

import pytest
from mmrs_multicopter.testing import target_input, two_drones

from mmrs_core.errors import MmrsError
from mmrs_core.generation.deployment import deployment_of, fetch
from mmrs_core.generation.render import render
from mmrs_core.generation.wheels import wheel_of
from mmrs_core.generation.writing import write
from mmrs_mavlink.plugin.controllers import MAVLINK_PYTHON

PIP = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet", "install", "--no-index"]


@pytest.fixture
def folder(tmp_path):
    """Return a folder of controllers."""
    write(render(MAVLINK_PYTHON, target_input(two_drones())), tmp_path / "controllers")
    return tmp_path / "controllers"


def test_controllers_run_on_nothing_but_python_and_the_wheels_beside_them(folder, tmp_path):
    lines = (folder / "requirements.txt").read_text("ascii").splitlines()
    wheels = [line.partition("[")[0] for line in lines if line.startswith("./")]
    subprocess.run([*PIP, "--no-deps", "--target", tmp_path / "site", *wheels], cwd=folder, check=True)
    done = subprocess.run(
        [sys.executable, "-S", "fleet.py", "--dry-run", "--speedup", "5000"],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(tmp_path / "site")},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr


def test_files_are_programs_and_what_they_need_and_the_same_each_time(folder):
    loose = {each.name for each in folder.rglob("*.py")}
    assert loose == {"robot_alpha.py", "robot_beta.py", "fleet.py"}
    wheel_of.cache_clear()
    again = render(MAVLINK_PYTHON, target_input(two_drones()))
    assert all((folder / file.path).read_bytes() == file.content for file in again)


def test_what_comes_from_elsewhere_is_pinned_to_the_versions_that_are_installed(folder):
    lines = (folder / "requirements.txt").read_text("ascii").splitlines()
    pins = dict(line.split("==") for line in lines if "==" in line)
    assert {"pymavlink", "lxml", "eclipse-zenoh"} <= pins.keys()
    assert pins == {name: version(name) for name in pins}
    assert not {name for name in pins if name.startswith("mmrs")}
    assert not any("://" in line for line in lines)


def test_controllers_pull_in_neither_the_core_nor_its_libraries():
    needed = deployment_of("mmrs-runtime[bus]", "mmrs-mavlink").libraries
    assert not {"mmrs-core", "pyecore", "shapely", "jinja2", "numpy"} & set(needed)


def test_an_extra_is_left_out_where_not_all_of_it_is_installed(tmp_path, monkeypatch):
    described = tmp_path / "kite-1.0.dist-info"
    described.mkdir()
    (described / "METADATA").write_text(
        "Metadata-Version: 2.4\nName: kite\nVersion: 1.0\nProvides-Extra: tail\n"
        'Requires-Dist: no-such-tail>=1; extra == "tail"\n'
    )
    monkeypatch.syspath_prepend(tmp_path)
    deployment_of.cache_clear()
    assert deployment_of("kite[tail]").carried == ("kite",)
    (described / "METADATA").write_text("Name: kite\nVersion: 1.0\nRequires-Dist: no-such-string\n")
    deployment_of.cache_clear()
    with pytest.raises(MmrsError, match=r"^distribution no-such-string: is not installed"):
        deployment_of("kite")


def test_wheels_for_a_platform_are_downloaded_beside_the_others(tmp_path, monkeypatch):
    (tmp_path / "elsewhere").mkdir()
    wheel = wheel_of("sortedcontainers")
    (tmp_path / "elsewhere" / wheel.name).write_bytes(wheel.content)
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    monkeypatch.setenv("PIP_FIND_LINKS", str(tmp_path / "elsewhere"))
    pin = f"sortedcontainers=={version('sortedcontainers')}\n"
    (tmp_path / "requirements.txt").write_text(f"# nothing==1\n./wheels/ours-1.0-py3-none-any.whl\n{pin}")
    fetch(tmp_path, ["manylinux2014_aarch64"])
    assert [each.name for each in (tmp_path / "wheels").iterdir()] == [wheel.name]
    (tmp_path / "requirements.txt").write_text("no-such-thing==1.0\n")
    with pytest.raises(MmrsError, match=r"^--wheels linux_armv7l: No matching distribution .*no-such-thing"):
        fetch(tmp_path, ["linux_armv7l"])


def test_a_target_without_requirements_has_no_wheels_to_download(tmp_path):
    with pytest.raises(MmrsError, match=r"has no requirements\.txt"):
        fetch(tmp_path, ["linux_armv7l"])
