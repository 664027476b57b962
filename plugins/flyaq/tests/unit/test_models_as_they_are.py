"""Models of dialects that are read as they are: recognised, migrated in memory, and told about."""

import pytest
from mmrs_flyaq.findings import Category
from mmrs_flyaq.plugin import mmrs_importers

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.element import descendants, is_kind, place_of
from mmrs_core.languages.reading import read_model, read_text
from mmrs_core.languages.registry import registry_with
from mmrs_core.languages.writing import to_json, to_xmi

FILES = (
    "round.xmi",
    "round.json",
    "orchard-mission.json",
    "orchard-context.json",
    "Heron.xmi",
    "drones.json",
)
OTHER = "http://www.example.org/copy/"


@pytest.fixture
def read(registry):
    return lambda file, **options: read_model(file, registry, **options)


def codes(model):
    return [fault.code for fault in model.diagnostics]


def told_of(model, code):
    return [(fault.place.line, fault.message) for fault in model.diagnostics if fault.code == code]


@pytest.mark.parametrize("name", FILES)
def test_a_model_becomes_what_mmrs_migrate_makes_of_it(read, migrated, flyaq, registry, name):
    model = read(flyaq / name)
    made = [each.element for each in migrated(flyaq / name).outputs]
    assert [to_xmi((root,), registry) for root in model.roots] == [to_xmi((each,), registry) for each in made]
    assert model.importer.name == "FLYAQ 2015"


@pytest.mark.parametrize("name", FILES)
def test_every_reason_that_mmrs_migrate_gives_is_told_once(read, migrated, flyaq, name):
    migration = migrated(flyaq / name)
    reasons = {(each.category.value, each.reason) for each in migration.findings}
    messages = [
        fault.message for fault in read(flyaq / name).diagnostics if fault.code in ("MIG005", "MIG006")
    ]
    assert len(messages) == len(reasons) == len(set(messages))
    missing = [each for each in reasons if not any(m.startswith(": ".join(each)) for m in messages)]
    # how a robot type becomes known differs: nothing is migrated beside
    assert [reason for _, reason in missing if "robot type" not in reason] == []


def test_what_was_lost_is_a_warning_and_what_was_defaulted_a_note(read, flyaq):
    faults = read(flyaq / "Heron.xmi").diagnostics
    words = {fault.message.partition(":")[0]: fault.severity.value for fault in faults}
    assert words[Category.LOST.value] == "warning"
    assert words[Category.DEFAULTED.value] == words[Category.CHANGED.value] == "note"


def test_the_same_thing_on_several_lines_is_told_with_all_of_them(read, flyaq):
    (line, message), *more = [
        each for each in told_of(read(flyaq / "round.xmi"), "MIG005") if "fluid" in each[1]
    ]
    assert more == []
    assert f"lines {line}, {line + 1}, {line + 2}, " in message


@pytest.mark.parametrize("name", FILES)
def test_every_element_has_the_line_of_what_it_was_made_of(read, flyaq, name):
    model = read(flyaq / name)
    for root in model.roots:
        for element in (root, *descendants(root)):
            assert place_of(element).file == str(flyaq / name)
            assert place_of(element).line > 0
    text = (flyaq / name).read_text().splitlines()
    named = [each for root in model.roots for each in descendants(root) if getattr(each, "name", None)]
    moves = [each for each in named if is_kind(each, "urn:mmrs:behaviour:1.0", "Move")]
    for move in moves:
        around = "".join(text[move._mmrs_line - 1 : move._mmrs_line + 3])
        assert move.name.partition("_")[0] in around


def test_way_points_around_a_circle_stand_on_its_line(read, flyaq):
    model = read(flyaq / "round.xmi")
    line = 1 + next(
        number
        for number, text in enumerate((flyaq / "round.xmi").read_text().splitlines())
        if "Circle" in text
    )
    scout = model.roots[0].robots[0]
    ring = [move for move in scout.moves if (move.name or "").startswith("around")]
    assert len(ring) > 12
    assert {move._mmrs_line for move in ring} == {move.target._mmrs_line for move in ring} == {line}


def test_a_type_read_before_is_known_to_a_behaviour(read, flyaq):
    alone = read(flyaq / "round.xmi")
    known = read(flyaq / "round.xmi", known=read(flyaq / "Heron.xmi").roots)
    assert any("no robot type 'Heron' is known" in message for _, message in told_of(alone, "MIG006"))
    assert told_of(known, "MIG006") == []


def test_a_copy_with_another_nsuri_is_recognised_by_its_classes_and_this_is_said(
    read, flyaq, written, registry
):
    text = (flyaq / "round.xmi").read_text()
    copy = read(written("copy.xmi", text.replace("http://www.flyaql.it/", OTHER)))
    message = f"{OTHER}behaviour: no nsURI of FLYAQ 2015; taken for it, since its classes are called the same"
    assert told_of(copy, "MIG004") == [(2, message)]
    assert to_xmi(copy.roots, registry) == to_xmi(read(flyaq / "round.xmi").roots, registry)


def test_a_copy_in_json_is_recognised_by_its_classes_too(read, flyaq, written, registry):
    text = (flyaq / "orchard-mission.json").read_text()
    copy = read(written("copy.json", text.replace("http://www.flyaq.it/", OTHER)))
    assert [message.partition(": no")[0] for _, message in told_of(copy, "MIG004")] == [
        f"{OTHER}mission",
        f"{OTHER}extension1",
        f"{OTHER}extension2",
    ]
    assert to_json(copy.roots, registry) == to_json(read(flyaq / "orchard-mission.json").roots, registry)


@pytest.mark.parametrize(("file", "told"), [("mission.ecore", 0), ("copy.ecore", 1)])
def test_a_metamodel_that_json_names_by_its_file_is_said_only_if_the_file_is_not_theirs(registry, file, told):
    text = (
        f'{{"eClass": "file:/C:/flyaq/{file}#//Mission", "name": "m",'
        ' "swarm": {"drones": [{"name": "a", "type": "Parrot"}]}}'
    )
    model = read_text(text.encode(), "m.json", registry)
    assert model.roots[0].team.robots[0].name == "a"
    assert len(told_of(model, "MIG004")) == told


def test_mmrs_migrate_takes_such_a_copy_and_says_so(migrated, flyaq, written):
    text = (flyaq / "round.xmi").read_text().replace("http://www.flyaql.it/", OTHER)
    migration = migrated(written("copy.xmi", text))
    (source,) = migration.sources
    assert source.what.endswith(f"with an nsURI of its own, {OTHER}behaviour")
    assert [output.path.name for output in migration.outputs] == ["behaviour.xmi"]


@pytest.mark.parametrize(
    "text",
    [
        '<m:Mission xmlns:m="http://other"/>',
        '<m:Mission xmlns:m="http://other"><crew name="a"/></m:Mission>',
        '<m:Mission xmlns:m="http://other" xmlns:x="http://www.w3.org/2001/XMLSchema-instance">'
        '<tasks x:type="m:Dive"/></m:Mission>',
        '<m:Mission xmlns:m="urn:mmrs:mission:2.0"><tasks/></m:Mission>',
        '<m:Mission xmlns:m="urn:mmrs:mision:1.0"><tasks/></m:Mission>',
        "<Mission><tasks/></Mission>",
        '<x:XMI xmlns:x="http://www.omg.org/XMI"/>',
    ],
    ids=["empty", "another feature", "another class", "another version", "a typo", "no nsURI", "no root"],
)
def test_what_only_looks_alike_is_not_taken_for_it(registry, text):
    model = read_text(text.encode(), "m.xmi", registry)
    assert model.importer is None
    assert not set(codes(model)) & {"MIG003", "MIG004"}


HALF = (
    '<xmi:XMI xmlns:xmi="http://www.omg.org/XMI" xmlns:f="http://www.flyaq.it/drone"'
    ' xmlns:r="urn:mmrs:robot:1.0">\n<r:Robot name="ours"/>\n<f:Drone name="theirs"/>\n</xmi:XMI>'
)


def test_a_file_half_of_the_dialect_stays_as_it_is_with_an_error_where_the_other_half_begins(registry):
    model = read_text(HALF.encode(), "half.xmi", registry)
    assert model.importer is None
    (fault,) = model.diagnostics
    assert (fault.code, fault.place.line) == ("XMI001", 3)
    assert "'mmrs migrate'" in fault.hint


def test_a_model_that_needs_a_language_which_is_not_installed_is_refused(flyaq):
    with pytest.raises(UnreadableError, match="of FLYAQ 2015, and not migrated: ") as refused:
        read_model(flyaq / "round.xmi", registry_with((), importers=mmrs_importers()))
    assert "languages: multicopter: urn:mmrs:multicopter:1.0 is not installed" in refused.value.reason


def test_a_root_of_which_nothing_comes_is_an_error_and_the_others_are_read(registry):
    model = read_text(HALF.replace("r:Robot", "f:Rotor").encode(), "two.xmi", registry)
    assert [root.name for root in model.roots] == ["theirs"]
    message = "Rotor 'ours': not carried over: the mapping has no rule for this class"
    assert told_of(model, "MIG007") == [(2, message)]
    assert [fault.severity.value for fault in model.diagnostics if fault.code == "MIG007"] == ["error"]


def test_an_element_of_no_class_of_the_dialect_is_told_on_its_line(registry):
    text = (
        '<b:Behaviour xmlns:b="http://www.flyaq.it/behaviour" xmlns:o="urn:other"\n'
        ' xmlns:x="http://www.w3.org/2001/XMLSchema-instance" name="b">\n<drones name="a">\n'
        '<movements x:type="o:Dive" name="deep"/></drones></b:Behaviour>'
    )
    model = read_text(text.encode(), "b.xmi", registry)
    lost = [each for each in told_of(model, "MIG006") if "Dive" in each[1]]
    assert lost == [(4, "not carried over: the mapping has no rule for this class (Dive 'deep')")]


@pytest.mark.parametrize(
    ("name", "what"),
    [
        ("palette.json", "a palette of the 2015 editor: nothing to migrate"),
        ("extensions.json", "a list of task extensions of the 2015 server: nothing to migrate"),
    ],
)
def test_a_file_without_a_model_is_refused_as_mmrs_migrate_words_it(read, flyaq, migrated, name, what):
    with pytest.raises(UnreadableError) as refused:
        read(flyaq / name)
    assert (refused.value.code, refused.value.reason) == ("FIL009", what)
    assert [source.what for source in migrated(flyaq / name).sources] == [what]


def test_a_file_that_is_cut_short_is_refused_as_any_other(registry, flyaq):
    text = (flyaq / "round.xmi").read_bytes()
    with pytest.raises(UnreadableError) as refused:
        read_text(text[: len(text) // 2], "cut.xmi", registry)
    assert refused.value.code == "FIL004"


def test_metamodels_in_the_working_directory_do_not_count_for_a_text(registry, flyaq, monkeypatch):
    monkeypatch.chdir(flyaq / "workspace")  # its drone.ecore has a feature that the mapping does not know
    text = (flyaq / "workspace" / "Finch.xmi").read_bytes()
    stored = read_model(flyaq / "workspace" / "Finch.xmi", registry)
    assert set(codes(read_text(text, "Finch.xmi", registry))) <= set(codes(stored))
    elsewhere = read_text(text, "elsewhere/Finch.xmi", registry)
    assert told_of(read_text(text, "Finch.xmi", registry), "MIG006") == told_of(elsewhere, "MIG006")


def test_a_reference_to_a_file_of_the_dialect_leads_to_what_it_became(registry, flyaq, tmp_path, written):
    (tmp_path / "theirs.json").write_text((flyaq / "orchard-mission.json").read_text())
    file = written(
        "ours.xmi",
        '<m:Mission xmlns:m="urn:mmrs:mission:1.0"><taskDependencies>'
        '<from href="theirs.json#//@tasks.0"/></taskDependencies></m:Mission>',
    )
    model = read_model(file, registry)
    assert model.roots[0].taskDependencies[0].from_.name == "trees"
    assert [other.importer.name for other in model.linked] == ["FLYAQ 2015"]
