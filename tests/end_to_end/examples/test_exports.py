"""Examples in every format of map programs, read back: shapes to a centimetre, all photos, times in order."""

import json
import re
import shutil
import subprocess
from collections import Counter
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from lxml import etree
from pyproj import Geod

from mmrs_core.behaviour.earth import origin_above_ellipsoid, origin_above_sea
from mmrs_core.cli import run
from mmrs_core.cli.plan import save
from mmrs_core.contributions.drawings import reader_for
from mmrs_core.drawings.drawing import HeightReference, Role
from mmrs_core.languages.element import metaclass_of
from mmrs_core.languages.modelset import read_project
from mmrs_core.resources import shipped

pytestmark = pytest.mark.together("examples")

FORMATS = ("geojson", "kml", pytest.param("kmz", marks=pytest.mark.thorough))
"""Those that express areas, heights and times alike; the last one is the second one, packed."""
PACKED = ("geojson", "kml", "kmz")
EXAMPLES = ("carbon-dioxide", "mixed-team", "solar-park")
ACTIONS = ("behaviour:DeviceAction", "behaviour:Feedback")
TYPE, GEO = "{http://www.w3.org/2001/XMLSchema-instance}type", "mission:GeoCoordinate"
START = 1_777_626_000.0
"""2026-05-01, 9:00 UTC."""
EARTH = Geod(ellps="WGS84")


@pytest.fixture(scope="session")
def exported(taken, contributions, folder_of, tmp_path_factory):
    """Return a function: the project of an example with its behaviour, and what is read of its export."""
    folder = tmp_path_factory.mktemp("exports")

    @cache
    def export(name, form):
        project = folder / name
        if not project.exists():
            shutil.copytree(folder_of(name), project)
            save(taken(name).behaviour, project / "behaviour.xmi", contributions, None)
        file = project / f"export.{form}"
        assert (
            run(["export", str(project), "--format", form, "--start", "2026-05-01T09:00Z"], program="mmrs")
            == 0
        )
        data = file.read_bytes()
        drawing = reader_for(data, str(file), contributions.drawing_readers).read(data, str(file))
        return project, file, drawing

    return export


@pytest.fixture(params=FORMATS)
def form(request):
    return request.param


def drawn_in(file: Path) -> dict[str, list[list[tuple[float, float]]]]:
    """Return the shapes with latitudes and longitudes of every named element in a model's file, by name."""
    found: dict[str, list[list[tuple[float, float]]]] = {}
    for element in etree.parse(file).iterfind("*[@name]"):
        holders = [element, *element.iterfind("holes")]
        for holder, tag in (
            (holder, tag) for holder in holders for tag in ("shell", "points", "point", "position")
        ):
            places = holder.findall(tag)
            if places and all(place.get(TYPE) == GEO for place in places):
                degrees = [(float(p.get("latitude")), float(p.get("longitude"))) for p in places]
                found.setdefault(element.get("name"), []).append(degrees)
    return found


def off(shape, ring) -> float:
    """Return the metres from a vertex of a shape to the nearest of a ring, at most; either may be turned."""
    return max(min(EARTH.inv(b, a, d, c)[2] for c, d in ring) for a, b in shape)


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_shape_is_where_its_model_says_to_a_centimetre(exported, form, name):
    project, _, drawing = exported(name, form)
    asked = drawn_in(project / "mission.xmi") | drawn_in(project / "context.xmi")
    assert len(asked) > 3
    for element, shapes in asked.items():
        features = [each for each in drawing.features if each.name == element]
        rings = [ring.tolist() for each in features for ring in each.rings]
        for shape in shapes:
            assert min(off(shape, ring) for ring in rings if len(ring) == len(shape)) < 0.01, element


@pytest.mark.parametrize("name", EXAMPLES)
def test_each_path_is_as_simulated_and_its_times_rise(exported, form, name, taken):
    tracks = taken(name).run.tracks
    paths = {each.name: each for each in exported(name, form)[2].features if each.role is Role.PATH}
    for robot, samples in tracks.items():
        if robot not in paths:
            assert len({sample.position for sample in samples}) == 1
            continue
        times = paths[robot].times
        assert np.all(np.diff(times) >= 0.0)
        assert times - START == pytest.approx([sample.time for sample in samples], abs=0.0011)


@pytest.mark.parametrize("name", ["carbon-dioxide", "solar-park"])
def test_there_is_a_point_for_each_action_that_the_behaviour_commands(exported, form, name):
    project, _, drawing = exported(name, form)
    model = etree.parse(project / "behaviour.xmi")
    asked = [each for each in model.iter("preActions", "postActions") if each.get(TYPE) in ACTIONS]
    done = Counter(each.role for each in drawing.features if each.role in (Role.PHOTO, Role.ACTION))
    assert sum(done.values()) == len(asked) > 30


def test_the_dive_is_as_deep_as_the_task_asks(exported, form, taken):
    frame = taken("mixed-team").scene.frame
    zero = {HeightReference.ELLIPSOID: origin_above_ellipsoid, HeightReference.SEA_LEVEL: origin_above_sea}
    (dive,) = (
        each
        for each in exported("mixed-team", form)[2].features
        if each.role is Role.PATH and each.name == "Otter"
    )
    surface = zero[dive.reference](frame) + frame.surface
    assert max(dive.heights[0]) == pytest.approx(surface, abs=0.01)
    assert min(dive.heights[0]) < surface - 7.9


@pytest.mark.parametrize("form", PACKED)
def test_gdal_reads_every_feature(exported, form, need_program):
    ogrinfo = need_program("ogrinfo", "it reads what is exported as QGIS does")
    _, file, drawing = exported("mixed-team", form)
    shown = subprocess.run([ogrinfo, "-ro", "-so", "-al", file], capture_output=True, text=True, check=True)
    assert "ERROR" not in shown.stdout + shown.stderr
    counts = dict(re.findall(r"Layer name: (.+)\n(?:.*\n)*?Feature Count: (\d+)", shown.stdout))
    asked = Counter(each.folders[0] for each in drawing.features)
    if form in ("kml", "kmz"):
        assert {layer: int(counts[layer]) for layer in asked} == asked
    else:
        assert sum(map(int, counts.values())) == asked.total()


def attributes_of(project, contributions):
    """Return the class and all attributes of each task with a shape, by name."""
    models, faults = read_project(project, registry=contributions.languages)
    assert not faults
    return {
        task.name: (
            kind.name,
            {
                each.name: str(getattr(task, each.attribute))
                for each in kind.features
                if not each.is_reference
            },
        )
        for task in models.mission.tasks
        if (kind := metaclass_of(task)).name not in ("Fork", "Join")
    }


@pytest.mark.parametrize("form", [*PACKED, "gpx"])
def test_tasks_are_imported_with_their_types_and_all_attributes(form, contributions, tmp_path, capsys):
    project, again = (
        Path(shutil.copytree(shipped("examples") / "mixed-team", tmp_path / "dam")),
        tmp_path / "again",
    )
    assert run(["export", str(project), "--format", form, "--only", "tasks", "--only", "homes"]) == 0
    robots = {"Rover": "Crawler", "Hawk": "Camera drone", "Kite": "Camera drone", "Otter": "Inspection AUV"}
    options = [part for name, kind in robots.items() for part in ("--robot", f"{name}={kind}")]
    options += [part for file in (project / "robots").iterdir() for part in ("--robots", str(file))]
    assert run(["import", str(project / f"export.{form}"), "-o", str(again), *options]) == 0
    assert attributes_of(again, contributions) == attributes_of(project, contributions)
    capsys.readouterr()
    assert run(["import", str(project / f"export.{form}"), "--into", str(project), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    same = ["the same is there already", *(f"it is the home of {name} already" for name in robots)]
    assert {each["left_because"] for each in told["features"]} == set(same)
    assert told["files"] == []
