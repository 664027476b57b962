"""The tables of capabilities hold every element of the Behaviour Language, and are true."""

import json
from dataclasses import replace

import pytest
from mmrs_multicopter.names import MULTICOPTER

from mmrs_core.behaviour.program import BEHAVIOUR
from mmrs_core.cli import run
from mmrs_core.contributions.targets import FileSpec, Target
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.capabilities.judging import capabilities_of, lost, probes
from mmrs_core.generation.planned_moves import planned_moves
from mmrs_core.generation.render import render
from mmrs_core.plugins import load_plugins
from mmrs_core.testing.programs import installed
from mmrs_mavlink.plugin import mmrs_targets

BY_NAME = {target.name: target for target in mmrs_targets()}
LANGUAGES = (BEHAVIOUR, MULTICOPTER)

TOLD_WITH = {
    "Behaviour.targets": "GeoCoordinate",
    "Robot.moves": "Start, Stop",
    "Robot.moveTransitions": "MoveTransition.",
    "Robot.policies": "LINK_LOST: HOLD",
    "Robot.launchType": "Robot: multicopter",
    "GeoCoordinate.latitude": "GeoCoordinate",
    "GeoCoordinate.longitude": "GeoCoordinate",
    "GeoCoordinate.altitude": "GeoCoordinate",
    "GeoCoordinate.depth": "Robot: auv",
    "RelativeCoordinate.x": "RelativeCoordinate",
    "RelativeCoordinate.y": "RelativeCoordinate",
    "RelativeCoordinate.z": "RelativeCoordinate",
    "RelativeCoordinate.reference": "RelativeCoordinate",
    "MoveTransition.from": "MoveTransition.to",
    "Choice.falseBranch": "Choice.conditionIdentifier, Choice.falseBranch",
    "Slot.name": "MoveTransition.waitFor",
    "Action.name": "Feedback",
    "DeviceAction.actionName": "DeviceAction: ",
    "DeviceAction.deviceId": "DeviceAction: ",
    "UnicastNotify.slot": "UnicastNotify",
    "MulticastNotify.slots": "MulticastNotify",
    "BroadcastNotify.slot": "BroadcastNotify",
    "Pair.key": "Feedback.payload",
    "Pair.value": "Feedback.payload",
}
"""Features that are told together with others."""

NOT_OF_BEHAVIOURS = {"Drone", "DroneSize"}
"""Classes of the multicopters' language that are about types of robots."""


def table_of(name):
    return capabilities_of(BY_NAME[name], installed())


@pytest.fixture(scope="module")
def features():
    """Return ``Class.feature`` for each feature of each class of the languages of behaviours."""
    registry = load_plugins().contributions.languages
    found = []
    for uri in LANGUAGES:
        for metaclass in registry.package(uri).metaclasses:
            inherited = {name for above in metaclass.supertypes for name in above.by_name}
            if metaclass.name not in NOT_OF_BEHAVIOURS:
                found += [f"{metaclass.name}.{name}" for name in metaclass.by_name if name not in inherited]
    return found


def test_every_feature_of_the_languages_of_behaviours_has_a_row(features):
    elements = [row.element for row in table_of("wpl")]
    told = {name: TOLD_WITH.get(name, name) for name in features}
    assert len(features) > 60
    assert [n for n, begin in told.items() if not any(each.startswith(begin) for each in elements)] == []


@pytest.mark.parametrize("name", sorted(BY_NAME))
def test_everything_that_is_expressed_is_told_how(name):
    silent = [
        r.element for r in table_of(name) if r.verdict != "lossy" and not r.how and "policy" not in r.group
    ]
    assert silent == []


@pytest.mark.parametrize("name", sorted(BY_NAME))
def test_rendering_does_what_the_table_says(name):
    check_table(name, every=12)


@pytest.mark.parametrize("name", sorted(BY_NAME))
@pytest.mark.thorough
def test_rendering_does_what_the_whole_table_says(name):
    check_table(name, every=1)


def check_table(name, every):
    target = without_copies(BY_NAME[name])
    tried = probes(target, installed())
    for probe, row in list(zip(tried, table_of(name), strict=True))[::every]:
        assert outcome(target, probe.given) == row.verdict.replace("no difference", "expressed"), row


def without_copies(target):
    """Return a target without the files that are the same for every behaviour."""
    return replace(target, files=lambda given: (spec for spec in target.files(given) if spec.source is None))


def outcome(target, given):
    """Return what happens to a behaviour: without losses, and with losses allowed."""
    try:
        render(target, given)
    except UnsupportedError:
        try:
            render(target, given, allow_lossy=True)
        except UnsupportedError:
            return "refused"
        return "lossy"
    return "expressed"


def test_each_element_has_one_row():
    rows = [(row.group, row.element) for row in table_of("wpl")]
    assert len(rows) == len(set(rows))


@pytest.fixture(scope="module")
def cards(tmp_path_factory):
    """Return a plug-in's target that writes the moves of robots and refuses devices."""
    templates = tmp_path_factory.mktemp("cards")
    (templates / "card.jinja").write_text("{% for m in robot.moves %}{{ m.kind | comment }}\n{% endfor %}")

    def files(given):
        for number, robot in enumerate(given.program.robots):
            yield FileSpec(f"card_{number}.txt", "card.jinja", {"robot": robot})

    def refusals(given):
        for robot in given.program.robots:
            for move in robot.moves:
                if move.after:
                    yield f"robot '{robot.id}', move '{move.id}': has actions"

    return Target("cards", "cards", templates, files, refusals, capabilities={"Land": "a line"})


@pytest.fixture(scope="module")
def rows(cards):
    return capabilities_of(cards, installed())


def test_the_target_of_a_plugin_is_tried_in_the_same_way(rows):
    table = {row.element: row for row in rows}
    assert (table["Land"].verdict, table["Land"].how) == ("expressed", "a line")
    assert (table["Feedback"].verdict, table["Feedback"].how) == ("lossy", "has actions")
    assert table["GoTo.speed"].verdict == "no difference"


def test_what_neither_changes_the_files_nor_is_refused_nor_explained_is_lost(cards, rows):
    found = {row.element for row in lost(cards, rows)}
    assert {"GoTo.speed", "MoveTransition.waitFor", "GoTo.heading (plain robot)", "LINK_LOST: HOLD"} <= found
    assert not {"GoTo", "Feedback", "Move.task", "Behaviour.reserve", "Target.name"} & found


@pytest.mark.parametrize(
    ("words", "excused"),
    [
        ("GoTo.speed", {"GoTo.speed"}),
        ("LINK_LOST", {"LINK_LOST: HOLD", "LINK_LOST: LAND"}),
        ("", {"GoTo.speed", "LINK_LOST: HOLD"}),
        ("Heading.deviceId", {"Heading.deviceId: a device that looks aside (mount.yaw) (auv)"}),
        ("GoTo", set()),
    ],
)
def test_words_about_an_element_say_that_nothing_is_lost(cards, rows, words, excused):
    told = replace(cards, capabilities={words: "no robot needs it"})
    names = {row.element for row in lost(told, rows)}
    assert not excused & names
    assert "GoTo.distance" in names or not words


def test_what_a_move_does_on_its_way_to_another_height_is_tried(cards, tmp_path):
    (tmp_path / "card.jinja").write_text("{% for each in paths %}{{ each | comment }}\n{% endfor %}")

    def files(given):
        for number, robot in enumerate(given.program.robots):
            paths = [each.path for each in planned_moves(robot, given)]
            yield FileSpec(f"card_{number}.txt", "card.jinja", {"paths": paths})

    made = replace(cards, templates=tmp_path, files=files)
    rows = {row.element: row for row in capabilities_of(made, installed())}
    assert rows["GoTo.trajectory HORIZONTAL_FIRST"].verdict == "expressed"
    assert rows["GoTo.trajectory VERTICAL_FIRST"].verdict == "expressed"


def test_a_heading_that_is_written_is_expressed_of_devices_on_gimbals_too():
    of_gimbals = [row for row in table_of("mavlink-python") if row.element.startswith("GoTo.heading (multi")]
    assert {row.verdict for row in of_gimbals} == {"expressed"}
    assert any("gimbal" in row.element for row in of_gimbals)


def test_moves_that_plugins_have_added_get_a_row_for_themselves_and_for_each_attribute(rows):
    added = [row for row in rows if row.group == f"move of {MULTICOPTER}"]
    assert [(row.element, row.verdict) for row in added] == [
        ("GoTo", "expressed"),
        ("GoTo.trajectory HORIZONTAL_FIRST", "no difference"),
        ("GoTo.trajectory VERTICAL_FIRST", "no difference"),
        ("Land", "expressed"),
        ("TakeOff", "expressed"),
        ("TakeOff.altitude", "no difference"),
    ]


def test_a_target_is_tried_with_the_kind_that_it_is_made_for(cards):
    def refusals(given):
        for robot in given.program.robots:
            yield from (each.kind for each in robot.moves if each.metaclasses[0][0] == MULTICOPTER)

    def tried_with(vehicle):
        made = replace(cards, refusals=refusals, tried_with=vehicle)
        (probe,) = (each for each in probes(made, installed()) if each.element == "GoTo.speed")
        heights = {each.target.position[2] for each in probe.given.program.robots[0].moves if each.target}
        return {row.element: row.verdict for row in capabilities_of(made, installed())}, heights

    (flown, high), (swum, deep), (driven, level) = map(tried_with, ("copter", "sub", "unheard-of"))
    assert (flown["Robot.id"], swum["Robot.id"], driven["Robot.id"]) == (
        "lossy",
        "no difference",
        "no difference",
    )
    assert swum["Robot: multicopter"] == swum["TakeOff"] == "lossy"
    assert (high, deep, level) == ({20.0}, {-5.0}, {0.0})


def test_kinds_that_a_target_refuses_are_not_tried_further(cards):
    def refusals(given):
        return ["dives"] if any(type.metaclasses[0][1] == "AUV" for type in given.types.values()) else []

    rows = capabilities_of(replace(cards, refusals=refusals), installed())
    assert {row.verdict for row in rows if "auv" in row.element} == {"lossy"}
    assert not any("(auv)" in f"{row.group} {row.element}" for row in rows)
    assert any("(plain robot)" in row.element for row in rows)


def test_a_target_that_writes_nothing_even_with_losses_refuses(cards):
    def files(given):
        raise UnsupportedError("no kite flies")

    kites = replace(cards, files=files, refusals=lambda given: ["no kite flies"])
    row = capabilities_of(kites, installed())[0]
    assert (row.verdict, row.how) == ("refused", "no kite flies")


def test_the_command_line_prints_the_table_of_a_target(capsys):
    assert run(["--capabilities", "wpl"], program="mmrs-gen") == 0
    told = capsys.readouterr().out
    assert "NAV_TAKEOFF" in told
    assert "qgc-plan" not in told


@pytest.mark.thorough
def test_the_command_line_prints_all_tables_for_programs(capsys):
    assert run(["--capabilities", "--json"], program="mmrs-gen") == 0
    targets = json.loads(capsys.readouterr().out)["targets"]
    assert targets.keys() >= BY_NAME.keys()
    assert all(targets.values())


def test_an_unknown_target_has_no_table(capsys):
    assert run(["--capabilities", "wlp"], program="mmrs-gen") == 2
    assert "did you mean wpl?" in capsys.readouterr().err
