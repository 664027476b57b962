"""Every drawing becomes a project that reads back with the same shapes, and tells of each feature once."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from counts import many
from hypothesis import given, settings
from hypothesis import strategies as st

from mmrs_core.diagnostics import Place
from mmrs_core.drawings.drawing import Geometry, MapFeature, Role
from mmrs_core.grounding.coordinates import ground_of
from mmrs_core.languages.element import containing_feature, descendants
from mmrs_core.languages.modelset import read_project
from mmrs_core.plugins import load_plugins
from mmrs_core.projects.importing import ImportOptions, imported
from mmrs_core.projects.team import robot_wanted, types_for

CONTRIBUTIONS = load_plugins().contributions
TYPE_FILE = Path(__file__).parents[3] / "examples" / "drone-and-rover" / "robots" / "yard-drone.xmi"
CENTIMETRE = 0.01
ROLES = {
    Geometry.POINT: [Role.TASK, Role.UNKNOWN],
    Geometry.LINE: [Role.TASK, Role.CORRIDOR],
    Geometry.AREA: [Role.TASK, Role.SURVEY, Role.FORBIDDEN, Role.OBSTACLE, Role.EMERGENCY_AREA],
}


@st.composite
def drawings(draw):
    """Return features in cells 200 m wide, none of which touches another, around a home."""
    latitude, longitude = draw(st.floats(-70, 70)), draw(st.floats(-179, 179))
    metre = np.array([1 / 111_200, 1 / 111_200 / np.cos(np.radians(latitude))])
    features = []
    for number in range(draw(st.integers(1, 8))):
        geometry = draw(st.sampled_from(Geometry))
        count = {
            Geometry.POINT: 1,
            Geometry.LINE: draw(st.integers(2, 6)),
            Geometry.AREA: draw(st.integers(3, 9)),
        }[geometry]
        angles = 2 * np.pi * (np.arange(count) + draw(st.floats(0, 1))) / count
        radii = np.array(draw(st.lists(st.floats(30, 90), min_size=count, max_size=count)))
        ring = np.column_stack([radii * np.sin(angles), radii * np.cos(angles) + 200 * (number + 1)]) * metre
        centre = np.array([latitude, longitude])
        rings = [ring + centre]
        role = draw(st.sampled_from(ROLES[geometry]))
        if geometry is Geometry.AREA and role in (Role.TASK, Role.SURVEY) and draw(st.booleans()):
            rings.append((ring - ring.mean(axis=0)) * 0.1 + ring.mean(axis=0) + centre)
        name = draw(st.text(max_size=12).filter(lambda text: "home" not in text.casefold()))
        features.append(
            MapFeature(geometry, tuple(rings), name=name, role=role, place=Place("d.kml", number))
        )
    return (latitude, longitude), features


def metres_between(found, wanted):
    """Return the largest distance between positions of the same index, in metres."""
    apart = (np.array(found) - wanted) * 111_200 * (1, np.cos(np.radians(wanted[0][0])))
    return float(np.abs(apart).max()) if len(found) == len(wanted) else np.inf


@settings(max_examples=many(400), deadline=None)
@given(drawings())
def test_a_project_has_the_shapes_of_its_drawing(tmp_path_factory, drawing):
    folder = tmp_path_factory.mktemp("project")
    home, features = drawing
    robot = replace(robot_wanted("A=Yard drone", ""), position=home)
    options = ImportOptions(robots=(robot,), types=types_for((robot,), [TYPE_FILE], CONTRIBUTIONS))
    result = imported(features, (), options, CONTRIBUTIONS, folder)
    assert [each.place for each in result.outcomes] == [each.place for each in features]
    assert all(each.became for each in result.outcomes)
    for file, data in result.files.items():
        file.parent.mkdir(exist_ok=True)
        file.write_bytes(data)
    models, faults = read_project(folder, registry=CONTRIBUTIONS.languages)
    assert not faults
    assert not ground_of(models.mission, models.context).faults
    by_name = {
        each.name: each
        for root in (models.mission, models.context)
        for each in descendants(root)
        if getattr(each, "name", None)
    }
    assert len({each.called for each in result.outcomes}) == len(features)
    for feature, outcome in zip(features, result.outcomes, strict=True):
        positions = [
            (each.latitude, each.longitude)
            for each in descendants(by_name[outcome.called])
            if hasattr(each, "latitude") and containing_feature(each).name != "initialPosition"
        ]
        assert metres_between(positions, np.concatenate(feature.rings)) < CENTIMETRE
