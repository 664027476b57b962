from dataclasses import replace

import pytest
from mmrs_survey.names import PHOTO_GRID_TASK
from mmrs_survey.photo_check import PHOTOS_CHECK

from mmrs_core.contributions.checks import CheckInput, Status
from mmrs_core.scene import Area, AreaUse, Device, Part
from mmrs_core.testing.small_programs import ROBOT_TYPE, go, hold, program, robot, robot_type, use
from mmrs_core.transformation.kinds import MOVE_KINDS, PLAIN_ROBOT

SQUARE = ((0.0, 0.0, 0.0), (40.0, 0.0, 0.0), (40.0, 40.0, 0.0), (0.0, 40.0, 0.0))
FIELD = {"shell": SQUARE, "altitude": 20.0, "actionName": "Snap", "triggerAction": "Trigger"}
OPTICS = {"sensor.width": "12", "sensor.height": "8", "focal.length": "8"}


def trigger(metres):
    return replace(use("camera", "Trigger"), parameters=(("distance", f"{metres:g}"),))


def leg(east, begin, end, every):
    """Return the moves to and along a line to the north, on which photos are taken in passing."""
    yield go(f"to {east:g}", (east, begin, 20.0))
    passing = {"before": (trigger(every),), "after": (trigger(0.0),)}
    yield go(f"along {east:g}", (east, end, 20.0), task="field", **passing)


def across(north):
    """Return the same along a line to the west."""
    yield go(f"to {north:g} north", (30.0, north, 20.0))
    passing = {"before": (trigger(20.0),), "after": (trigger(0.0),)}
    yield go(f"along {north:g} north", (10.0, north, 20.0), task="field", **passing)


def judged(*moves, areas=(), optics=OPTICS, ways=None, **more):
    camera = Device("camera", {}, dict(optics))
    type = replace(robot_type(), devices={"camera": camera})
    given = CheckInput(
        program(robot("a", moves, home=(0.0, 0.0, 20.0), **ways or {})),
        {ROBOT_TYPE: type},
        {PLAIN_ROBOT.metaclass: PLAIN_ROBOT},
        {kind.metaclass: kind for kind in MOVE_KINDS},
        areas,
        tasks={"field": Part((PHOTO_GRID_TASK,), {**FIELD, **more})},
    )
    return [(verdict.status, verdict.message) for verdict in PHOTOS_CHECK.run(given)]


@pytest.mark.parametrize(
    ("every", "end", "more", "left"),
    [
        (20.0, 30.0, {"gridResolution": 20.0}, None),
        (25.0, 35.0, {"gridResolution": 20.0}, 200.0),
        (20.0, 25.0, {"gridResolution": 20.0}, 200.0),
        (20.0, 30.0, {}, None),
        (20.0, 30.0, {"sideOverlap": 0.5}, 400.0),
        (20.0, 30.0, {"frontOverlap": 0.5}, 800.0),
        (10.0, 35.0, {"frontOverlap": 0.5, "footprintWidth": 20.0, "footprintLength": 20.0}, 200.0),
    ],
)
def test_what_no_photo_shows_is_measured(every, end, more, left):
    moves = (*leg(10.0, 10.0, end, every), *leg(30.0, 10.0, end, every))
    ((status, message),) = judged(*moves, **more)
    if left is None:
        assert (status, message[:29]) == (Status.SAFE, "task 'field': 1600.0 m² are i")
    else:
        assert (status, message.partition(" m²")[0]) == (
            Status.VIOLATED,
            f"task 'field': {left:.1f} of 1600.0",
        )


def test_photos_of_other_tasks_and_from_where_no_robot_may_be_do_not_count():
    shut = Area("hall", AreaUse.OBSTACLE, tuple(p[:2] for p in SQUARE[:3]), 0.0, 50.0, 0.0)
    half = judged(*leg(10.0, 10.0, 30.0, 20.0), areas=(shut,), gridResolution=20.0)
    assert half[0][1].startswith("task 'field': 186.1 of 771.9 m² are not in its 2 photos")
    stray = (*leg(10.0, 10.0, 30.0, 20.0), go("else", (30.0, 20.0, 20.0), after=(use("camera", "Snap"),)))
    assert judged(*stray, gridResolution=20.0)[0][1].startswith("task 'field': 800.0 of")
    assert judged(hold("elsewhere")) == []


def test_a_photo_of_a_robot_that_holds_counts_whichever_way_it_faces():
    moves = (go("to", (20.0, 20.0, 20.0)), hold("there", task="field", after=(use("camera", "Snap"),)))
    ((_, message),) = judged(*moves, gridResolution=40.0)
    assert message.startswith("task 'field': 34")


def test_a_cross_hatch_is_photographed_in_both_directions():
    north = (*leg(10.0, 10.0, 30.0, 20.0), *leg(30.0, 10.0, 30.0, 20.0))
    ((status, message),) = judged(*north, gridResolution=20.0, crossHatch=True)
    photos = "its 4 photos in both directions, with the overlaps that it states"
    assert (status, message) == (Status.VIOLATED, f"task 'field': 1600.0 of 1600.0 m² are not in {photos}")
    both = judged(*north, *across(10.0), *across(30.0), gridResolution=20.0, crossHatch=True)
    assert both == [(Status.SAFE, f"task 'field': 1600.0 m² are in {photos.replace('4', '8')}")]
    slanted = (
        go("to", (0.0, 0.0, 20.0)),
        go("aside", (9.0, 3.0, 20.0), task="field", before=(trigger(1.0),)),
    )
    assert judged(*slanted, *north, *across(10.0), *across(30.0), gridResolution=20.0, crossHatch=True)[0][
        0
    ] == (Status.SAFE)
    held = [
        move
        for where in ((10.0, 10.0, 20.0), (30.0, 10.0, 20.0), (10.0, 30.0, 20.0), (30.0, 30.0, 20.0))
        for move in (go("to", where), hold("there", task="field", after=(use("camera", "Snap"),)))
    ]
    assert judged(*north, *held, gridResolution=30.0, crossHatch=True)[0][0] == Status.VIOLATED
    half = judged(*north, *across(10.0), gridResolution=20.0, crossHatch=True)
    assert half[0][1].startswith("task 'field': 800.0 of 1600.0 m² are not in")
    none = judged(hold("there", task="field"), gridResolution=20.0, crossHatch=True)
    assert none[0][1].startswith("task 'field': 1600.0 of 1600.0 m² are not in its 0 photos")


def test_photos_in_passing_of_one_way_are_not_made_on_another():
    moves = (
        go("choice", (10.0, 0.0, 20.0)),
        go("to it", (10.0, 10.0, 20.0), task="field", after=(trigger(20.0),)),
        go("along it", (10.0, 30.0, 20.0), task="field", after=(trigger(0.0),)),
        go("by it", (30.0, 10.0, 20.0)),
        go("past it", (30.0, 30.0, 20.0)),
    )
    ways = {"choices": {"choice": ("clear", "to it", "by it")}, "jumps": {"along it": "stop"}}
    ((_, message),) = judged(*moves, ways=ways, gridResolution=20.0)
    assert message.startswith("task 'field': 800.0 of 1600.0 m² are not in its 2 photos")


def test_what_a_photo_shows_must_be_known():
    ((status, message),) = judged(*leg(10.0, 10.0, 30.0, 20.0), optics={})
    assert (status, message) == (
        Status.UNKNOWN,
        "task 'field': device 'camera' does not state what a photo shows",
    )
