"""References by name: what a name leads to, how it is written, and what is said of one that leads nowhere."""

import pytest

from mmrs_core.languages.element import Hidden
from mmrs_core.languages.modelset import read_project
from mmrs_core.languages.reading import read_model, read_text
from mmrs_core.languages.references.by_name import FAR, HIDDEN, NAMELESS, SHARED, ReferenceNames
from mmrs_core.languages.writing import to_json, to_xmi


def lions(*names):
    return "".join(f'<animals xsi:type="zoo:Lion" name="{name}"/>\n' for name in names)


def faults(model):
    return [(fault.code, fault.place.line, fault.message) for fault in model.diagnostics]


# what a name leads to


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a", "a"),
        ("north lion", "north lion"),
        ("north lion", " 'north lion' "),
        ("panel #3", "panel #3"),
        ("O'Brien", "O'Brien"),
        ("phase 1: north", "phase 1: north"),
        ("/a", "'/a'"),
        ("a#b", "'a#b'"),
        ("//@animals.0", "'//@animals.0'"),
        ("'a'", "'''a'''"),
        ("Löwe\u00a01", "Löwe\u00a01"),
    ],
)
def test_a_name_leads_to_the_element_that_has_it(read_zoo, name, text):
    model = read_zoo(lions("other", name), f'star="{text}"')
    assert model.diagnostics == ()
    assert model.roots[0].star is model.roots[0].animals[1]


def test_names_in_a_list_are_quoted_where_they_hold_blanks(read_zoo):
    model = read_zoo(
        lions("a", "north lion", "it's one"), "favourites=\"'it''s one' a //@animals.1 'north lion' a\""
    )
    assert model.diagnostics == ()
    found = [each.name for each in model.roots[0].favourites]
    assert found == ["it's one", "a", "north lion", "north lion", "a"]


def test_what_eclipse_reads_means_the_same_as_before(read_zoo):
    keepers = """<keepers badge="k1"/><keepers badge="'k2'"/>"""
    model = read_zoo(f"""{keepers}<animals xsi:type="zoo:Lion" name="k1" keptBy="k1 'k2'"/>""")
    assert model.diagnostics == ()
    assert model.roots[0].animals[0].keptBy == model.roots[0].keepers


def test_the_class_decides_between_elements_of_one_name(read_zoo):
    content = lions("a") + '<animals xsi:type="wing:Parrot" name="p"><nest/></animals>'
    assert read_zoo(content, 'name="a" star="a"').roots[0].star.name == "a"


CUBS = """
<animals xsi:type="zoo:Lion" name="Leo"><cubs xsi:type="zoo:Lion" name="cub" mate="twin"/>
  <cubs xsi:type="zoo:Lion" name="twin"/></animals>
<animals xsi:type="zoo:Lion" name="Lea"><cubs xsi:type="zoo:Lion" name="cub" mate="twin"/>
  <cubs xsi:type="zoo:Lion" name="twin"/></animals>
<animals xsi:type="zoo:Lion" name="Lia" mate="cub"/>
"""


def test_the_nearest_element_of_a_name_is_meant(read_zoo):
    model = read_zoo(CUBS.replace(' mate="cub"', ""))
    assert model.diagnostics == ()
    for lion in model.roots[0].animals[:2]:
        assert lion.cubs[0].mate is lion.cubs[1]
        assert lion.cubs[1].mateOf is lion.cubs[0]


def test_a_name_of_several_elements_is_refused_with_them(read_zoo):
    model = read_zoo(CUBS)
    where = "Lion at zoo.xmi:2, Lion at zoo.xmi:4"
    assert faults(model) == [("XMI018", 6, f"mate: 'cub' is the name of {where}")]
    paths = "//@animals.0/@cubs.0 or //@animals.1/@cubs.0"
    assert model.diagnostics[0].hint == f"rename one of them, or write the path: {paths}"
    assert model.roots[0].animals[2].mate is None


def test_an_element_does_not_hide_another_of_its_name_by_itself(read_zoo):
    assert [fault.code for fault in read_zoo(lions('Leo" mate="Leo', "Leo")).diagnostics] == ["XMI018"]


def test_five_of_many_elements_are_listed(read_zoo):
    message = read_zoo(lions(*"aaaaaaa"), 'star="a"').diagnostics[0].message
    assert message.count("Lion at") == 5
    assert message.endswith(" and more")


# what leads nowhere


@pytest.mark.parametrize(
    ("attribute", "hint"),
    [
        ('star="north loin"', "did you mean north lion?"),
        ('star="zzz"', "write the name of a Animal, or its path, such as //@tasks.0"),
        ('favourites="north lion"', "in a list, write 'north lion'"),
        ('star="#a"', "write a, the name of the Lion"),
        ('star="/x"', "write '/x', the name of the Lion"),
    ],
)
def test_what_leads_nowhere_says_how_to_write_what_was_meant(read_zoo, attribute, hint):
    model = read_zoo(lions("a", "north lion", "/x"), attribute)
    assert {fault.code for fault in model.diagnostics} == {"XMI006"}
    assert model.diagnostics[0].hint == hint


def test_a_name_that_looks_like_a_file_says_how_to_write_it(read_zoo):
    fault = read_zoo(lions("a#b"), 'star="a#b"').diagnostics[0]
    assert (fault.code, fault.hint) == ("XMI007", "write 'a#b', the name of the Lion")


def test_a_name_of_another_class_says_so(read_zoo):
    model = read_zoo(lions("a") + '<keepers badge="k" deputy="a"/>')
    assert faults(model) == [("XMI008", 2, "deputy: leads to the Lion 'a', not to a Keeper")]


@pytest.mark.parametrize("link", ['href="a"', 'xmi:idref="a"'])
def test_a_link_is_no_name(read_zoo, link):
    model = read_zoo(lions("a") + f"<star {link}/>")
    assert [fault.code for fault in model.diagnostics] == ["XMI006"]


def test_an_element_of_a_missing_language_is_kept_by_its_name(zoo, zoo_text):
    content = '<animals xmlns:far="urn:far" xsi:type="far:Cat" name="old cat"/>'
    model = read_text(zoo_text(content, 'star="old cat"'), "a.xmi", zoo)
    assert {fault.code for fault in model.diagnostics} == {"XMI001"}
    assert isinstance(model.roots[0].star, Hidden)
    names = ReferenceNames(model.roots)
    text = to_xmi(model.roots, zoo, names=names)
    assert b"star=\"'old cat'\"" in text
    assert names.left == {HIDDEN: 1}
    assert isinstance(read_text(text, "b.xmi", zoo).roots[0].star, Hidden)


# JSON


def json_zoo(members):
    animals = '"animals": [{"$type": "zoo:Lion", "name": "a"}, {"$type": "zoo:Lion", "name": "north lion"}]'
    return f'{{"$languages": {{"zoo": "urn:test:zoo"}}, "$type": "zoo:Zoo", {members}, {animals}}}'.encode()


@pytest.mark.parametrize(
    ("members", "found"),
    [
        ('"star": "north lion"', ["north lion"]),
        (
            '"favourites": ["north lion", "//@animals.0", "a", "\'north lion\'"]',
            ["north lion", "a", "a", "north lion"],
        ),
        ('"favourites": "north lion"', ["north lion"]),
    ],
)
def test_a_text_of_json_is_one_name(zoo, members, found):
    model = read_text(json_zoo(members), "a.json", zoo)
    assert model.diagnostics == ()
    assert [each.name for each in model.roots[0].favourites or [model.roots[0].star]] == found


def test_a_containment_by_reference_is_no_name(zoo):
    model = read_text(json_zoo('"guest": {"$ref": "north lion"}'), "a.json", zoo)
    assert {fault.code for fault in model.diagnostics} == {"XMI006"}


# several files


CONTEXT = """<c:Context xmlns:c="urn:mmrs:context:1.0" xmlns:xmi="http://www.omg.org/XMI"
  xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:solar="urn:mmrs:solar:1.0">
  {}
</c:Context>"""
GROUP = '<elements xsi:type="solar:PanelGroup" name="{}" rows="1" columns="1"/>'
MISSION = """<m:Mission xmlns:m="urn:mmrs:mission:1.0" xmlns:solar="urn:mmrs:solar:1.0"
  xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" name="m">
  <tasks xsi:type="solar:ThermalRowTask" name="inspect" group="array A"/>
</m:Mission>"""


@pytest.fixture
def park(tmp_path):
    (tmp_path / "mission.xmi").write_text(MISSION)
    (tmp_path / "context.xmi").write_text(CONTEXT.format(GROUP.format("array A") + GROUP.format("array B")))
    return tmp_path


def test_a_name_leads_into_another_file_of_the_project(park, everything):
    found, said = read_project(park, registry=everything)
    assert said == ()
    assert found.mission.tasks[0].group is found.context.elements[0]


def test_a_mission_alone_finds_the_context_beside_it(park, everything):
    model = read_model(park / "mission.xmi", everything)
    assert model.diagnostics == ()
    assert [each.file.name for each in model.linked] == ["context.xmi"]
    assert model.roots[0].tasks[0].group is model.linked[0].roots[0].elements[0]


def test_files_beside_are_not_read_where_no_name_needs_them(park, everything):
    (park / "context.xmi").write_text("no XML at all")
    mission = (park / "mission.xmi").read_text().replace(' group="array A"', "")
    (park / "mission.xmi").write_text(mission)
    assert read_model(park / "mission.xmi", everything).diagnostics == ()


def test_a_name_of_two_elements_of_the_project_is_refused(park, everything):
    (park / "context.xmi").write_text(CONTEXT.format(2 * GROUP.format("array A")))
    for said in (
        read_project(park, registry=everything)[1],
        read_model(park / "mission.xmi", everything).diagnostics,
    ):
        assert [fault.code for fault in said] == ["XMI018"]
        assert said[0].message.count("PanelGroup at") == 2


def test_a_misspelt_name_gets_one_of_another_file(park, everything):
    mission = park / "mission.xmi"
    mission.write_text(mission.read_text().replace("array A", "aray A"))
    assert read_project(park, registry=everything)[1][0].hint == "did you mean array A?"


def test_a_context_that_was_chosen_hides_the_one_beside(park, everything):
    (park / "other.xmi").write_text(CONTEXT.format(GROUP.format("array C")))
    _, said = read_project(park, context=park / "other.xmi", registry=everything)
    assert [fault.code for fault in said] == ["XMI006"]


# writing


def test_names_are_written_where_they_lead_back(read_zoo, zoo):
    content = lions("a", "north lion", "twin", "twin", "/x")
    root = read_zoo(
        content, 'star="//@animals.1" favourites="a //@animals.1 //@animals.2 //@animals.4"'
    ).roots[0]
    names = ReferenceNames([root])
    assert b"star=\"north lion\" favourites=\"a 'north lion' //@animals.2 '/x'\"" in to_xmi(
        [root], zoo, names=names
    )
    assert (names.named, names.left) == (4, {SHARED: 1})
    assert b'"favourites": ["a", "north lion", "//@animals.2", "\'/x\'"]' in to_json(
        [root], zoo, names=ReferenceNames([root])
    )
    assert b'star="//@animals.1"' in to_xmi([root], zoo)


def test_an_element_of_another_file_is_named_only_where_names_are_looked_for(park, everything):
    model = read_model(park / "mission.xmi", everything)
    others = [each.roots for each in model.linked]
    for is_near, reference, left in (
        (lambda file: file.name == "context.xmi", b'group="array A"', {}),
        (lambda file: False, b'href="context.xmi#//@elements.0"', {FAR: 1}),
    ):
        names = ReferenceNames(model.roots, others, is_near)
        assert reference in to_xmi(model.roots, everything, file=park / "mission.xmi", names=names)
        assert names.left == left


def test_an_element_without_a_name_is_counted(read_zoo, zoo):
    model = read_zoo('<guest xsi:type="zoo:Lion"/>', 'star="//@guest"')
    names = ReferenceNames(model.roots)
    to_xmi(model.roots, zoo, names=names)
    assert names.left == {NAMELESS: 1}
