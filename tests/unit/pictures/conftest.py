"""A small scene with its plan and picture, a simulated run of two drones, and a browser."""

import subprocess
from dataclasses import replace

import pytest
from drawn_scene import SYMBOLS, plan_named, scene_named
from mmrs_multicopter.testing import MULTICOPTER, quad, two_drones

from mmrs_core.pictures.preview.from_plan import picture_of_plan
from mmrs_core.pipeline import BehaviourContext, simulate
from mmrs_core.scene import Part, Plan, Scene
from mmrs_core.testing.programs import areas

BROWSER_OPTIONS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--enable-logging=stderr",
    "--virtual-time-budget=3000",
    "--dump-dom",
)


@pytest.fixture
def scene() -> Scene:
    return scene_named({})


@pytest.fixture
def plan() -> Plan:
    return plan_named({})


@pytest.fixture
def picture(scene, plan):
    return picture_of_plan(scene, plan, SYMBOLS)


@pytest.fixture
def picture_named():
    """Return a function: the same picture with other names."""
    return lambda **names: picture_of_plan(scene_named(names), plan_named(names), SYMBOLS)


@pytest.fixture
def without_robots(picture):
    return replace(picture, robots=(), handovers=(), tasks=(), zones=())


@pytest.fixture
def in_browser(need_program, tmp_path):
    """Return a function: what a browser makes of a page, and what it complains of."""
    browser = need_program("chromium", "it shows the page as a person sees it")

    def show(markup):
        file = tmp_path / "page.html"
        file.write_text(markup, encoding="utf-8")
        command = [browser, *BROWSER_OPTIONS, f"--user-data-dir={tmp_path / 'profile'}", file.as_uri()]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120)
        return done.stdout, [line for line in done.stderr.splitlines() if "CONSOLE" in line]

    return show


@pytest.fixture(scope="session")
def types():
    """Return the type of the drones that fly in tests, by its name."""
    attributes = {"maxAltitude": 120.0}
    return {"Quad": replace(quad(), part=Part(((MULTICOPTER, "Drone"),), attributes))}


@pytest.fixture(scope="session")
def place(types):
    """Return where two drones fly."""
    return BehaviourContext(types, areas(), {})


@pytest.fixture(scope="session")
def behaviour():
    """Return what two drones do."""
    return two_drones()


@pytest.fixture(scope="session")
def run(behaviour, place, contributions):
    """Return what two drones did when that was simulated."""
    return simulate(behaviour, place, contributions)
