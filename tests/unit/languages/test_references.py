from pathlib import Path

import pytest

from mmrs_core.languages.reading import read_model
from mmrs_core.languages.references.hrefs import linked_file, relative_href
from mmrs_core.languages.writing import to_xmi, write_model


def codes(model):
    return [fault.code for fault in model.diagnostics]


LIONS = "".join(f'<animals xsi:type="zoo:Lion" name="{name}"/>' for name in "abc")


@pytest.mark.parametrize(
    ("text", "name"),
    [("//@animals.0", "a"), ("//@animals.2", "c"), ("#//@animals.1", "b"), ("/0/@animals.1", "b")],
)
def test_a_path_leads_to_an_element(read_zoo, text, name):
    model = read_zoo(LIONS, f'star="{text}"')
    assert model.diagnostics == ()
    assert model.roots[0].star.name == name


def test_a_path_may_lead_through_single_features_and_to_the_root(read_zoo):
    guest = '<guest xsi:type="zoo:Lion" name="g"><cubs xsi:type="zoo:Lion" name="cub"/></guest>'
    model = read_zoo(guest, 'star="//@guest/@cubs.0" anything="/"')
    assert model.roots[0].star.name == "cub"
    assert model.roots[0].anything is model.roots[0]


def test_a_path_may_name_a_key(read_zoo):
    assert read_zoo(LIONS, "star=\"//@animals[name='b']\"").roots[0].star.name == "b"


def test_many_references_keep_their_order_and_repeats(read_zoo):
    model = read_zoo(LIONS, 'favourites="//@animals.2 //@animals.0 //@animals.2"')
    assert [lion.name for lion in model.roots[0].favourites] == ["c", "a", "c"]


def test_ids_of_a_foreign_metamodel_lead_to_elements(read_zoo):
    model = read_zoo('<keepers badge="k1" deputy="k2"/><keepers badge="k2"/>')
    assert model.roots[0].keepers[0].deputy is model.roots[0].keepers[1]


def test_xmi_ids_lead_to_elements_and_are_kept(read_zoo, zoo):
    model = read_zoo('<animals xsi:type="zoo:Lion" xmi:id="_x1" name="a"/>', 'star="_x1"')
    assert model.roots[0].star.name == "a"
    text = to_xmi(model.roots, zoo)
    assert b'star="_x1"' in text
    assert b'<animals xsi:type="zoo:Lion" xmi:id="_x1" name="a"/>' in text


def test_an_id_used_twice_is_a_fault(read_zoo):
    model = read_zoo('<keepers badge="k"/>\n<keepers badge="k"/>')
    assert [(fault.code, fault.place.line) for fault in model.diagnostics] == [("XMI012", 2)]


@pytest.mark.parametrize(
    "text",
    [
        "//@animals.3",
        "//@animals.-1",
        "//@animals.99999999999999999999",
        "//@lions.0",
        "//@name",
        "//@animals.0/@",
        "/1",
        "//animals.0",
        "nobody",
        "#",
        "//@star",
        "//@animals[name='zz']",
    ],
)
def test_a_reference_that_leads_nowhere_is_a_fault_and_stays_unset(read_zoo, text):
    model = read_zoo(LIONS, f'star="{text}" name="z"')
    if text == "#":  # the root, which is no animal
        assert codes(model) == ["XMI008"]
    else:
        assert codes(model) == ["XMI006"]
    assert model.roots[0].star is None
    assert model.roots[0].name == "z"


def test_one_broken_reference_does_not_hide_the_others(read_zoo):
    model = read_zoo(LIONS, 'favourites="//@animals.0 //@animals.7 //@animals.1 //@animals.8"')
    assert codes(model) == ["XMI006", "XMI006"]
    assert [lion.name for lion in model.roots[0].favourites] == ["a", "b"]


def test_a_reference_to_the_wrong_class_is_a_fault(read_zoo):
    model = read_zoo('<keepers badge="k"/>', 'star="k"')
    assert codes(model) == ["XMI008"]
    assert "leads to the Keeper, not to a Animal" in model.diagnostics[0].message


def test_more_references_than_one_are_a_fault_for_a_single_feature(read_zoo):
    assert codes(read_zoo(LIONS, 'star="//@animals.0 //@animals.1"')) == ["XMI009"]


@pytest.mark.parametrize(("first", "second"), [('mate="//@animals.1"', ""), ("", 'mateOf="//@animals.0"')])
def test_one_end_of_a_pair_is_enough(read_zoo, first, second):
    lions = (f'<animals xsi:type="zoo:Lion" name="l" {mate}/>' for mate in (first, second))
    model = read_zoo("".join(lions))
    assert model.diagnostics == ()
    one, other = model.roots[0].animals
    assert one.mate is other
    assert other.mateOf is one


def test_ends_that_contradict_each_other_are_a_fault(read_zoo):
    mates = ('mate="//@animals.1"', 'mateOf="//@animals.2"', 'mate="//@animals.0"')
    content = "".join(f'<animals xsi:type="zoo:Lion" name="l" {mate}/>' for mate in mates)
    assert set(codes(read_zoo(content))) == {"XMI013"}


def test_many_to_many_references_keep_the_order_of_each_end(read_zoo):
    model = read_zoo(
        '<animals xsi:type="zoo:Lion" name="a" keptBy="k2 k1"/>'
        '<animals xsi:type="zoo:Lion" name="b" keptBy="k1"/>'
        '<keepers badge="k1" keeps="//@animals.1 //@animals.0"/><keepers badge="k2" keeps="//@animals.0"/>'
    )
    root = model.roots[0]
    assert [keeper.badge for keeper in root.animals[0].keptBy] == ["k2", "k1"]
    assert [lion.name for lion in root.keepers[0].keeps] == ["b", "a"]


# other files


@pytest.fixture
def folder(tmp_path, zoo_text):
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "far.xmi").write_bytes(zoo_text(LIONS, 'name="far"'))

    def write(name, content, attributes='name="z"'):
        (tmp_path / name).write_bytes(zoo_text(content, attributes))
        return tmp_path / name

    return write


def test_a_reference_may_lead_into_another_file(folder, zoo):
    path = folder("near.xmi", '<star xsi:type="zoo:Lion" href="sub/far.xmi#//@animals.1"/>')
    model = read_model(path, zoo)
    assert model.diagnostics == ()
    assert model.roots[0].star.name == "b"
    assert [Path(linked.file).name for linked in model.linked] == ["far.xmi"]


def test_a_reference_into_another_file_survives_a_round_trip(folder, zoo):
    path = folder(
        "near.xmi",
        f'{LIONS}<favourites xsi:type="zoo:Lion" href="sub/far.xmi#//@animals.1"/>'
        '<favourites xsi:type="zoo:Lion" href="#//@animals.0"/>',
    )
    model = read_model(path, zoo)
    assert model.diagnostics == ()
    before = to_xmi(model.roots, zoo, file=path)
    assert b'<favourites xsi:type="zoo:Lion" href="sub/far.xmi#//@animals.1"/>' in before
    assert b'<favourites xsi:type="zoo:Lion" href="#//@animals.0"/>' in before
    write_model(model.roots, path, zoo)
    assert to_xmi(read_model(path, zoo).roots, zoo, file=path) == before


def test_an_attribute_may_refer_to_another_file(folder, zoo):
    path = folder("near.xmi", "", 'favourites="zoo:Lion sub/far.xmi#//@animals.0 sub/far.xmi#//@animals.2"')
    model = read_model(path, zoo)
    assert [lion.name for lion in model.roots[0].favourites] == ["a", "c"]


def test_files_may_refer_to_each_other_in_a_circle(folder, zoo):
    one = folder("one.xmi", f'{LIONS}<star xsi:type="zoo:Lion" href="two.xmi#//@animals.0"/>')
    folder("two.xmi", f'{LIONS}<star xsi:type="zoo:Lion" href="one.xmi#//@animals.1"/>')
    model = read_model(one, zoo)
    other = model.linked[0].roots[0]
    assert model.roots[0].star is other.animals[0]
    assert other.star is model.roots[0].animals[1]


def test_faults_of_a_linked_file_are_its_own(folder, zoo):
    folder("two.xmi", LIONS, 'bogus="1"')
    model = read_model(folder("one.xmi", '<star xsi:type="zoo:Lion" href="two.xmi#//@animals.0"/>'), zoo)
    assert model.diagnostics == ()
    assert codes(model.linked[0]) == ["XMI004"]


def test_the_root_of_another_file_may_be_contained_and_stays_there(folder, zoo, tmp_path):
    lion = '<zoo:Lion xmlns:zoo="urn:test:zoo" name="guest"/>'
    (tmp_path / "lion.xmi").write_text(lion)
    path = folder("one.xmi", '<guest xsi:type="zoo:Lion" href="lion.xmi#/"/>')
    model = read_model(path, zoo)
    assert model.diagnostics == ()
    assert model.roots[0].guest is model.linked[0].roots[0]
    assert b'<guest xsi:type="zoo:Lion" href="lion.xmi#/"/>' in to_xmi(model.roots, zoo, file=path)


@pytest.mark.parametrize(
    "href",
    [
        "../outside.xmi#/",
        "%2e%2e/outside.xmi#/",
        "sub/../../outside.xmi#/",
        "link.xmi#/",
        "/etc/hostname#/",
        "file:///etc/hostname#/",
        "file:two.xmi#/",
        "http://127.0.0.1:1/two.xmi#/",
        "platform:/resource/p/two.xmi#/",
        "C:/two.xmi#/",
        "\\\\server\\two.xmi#/",
        "a%00b.xmi#/",
        "loop.xmi#/",
    ],
)
def test_a_reference_never_leaves_the_folder(folder, zoo, tmp_path, href):
    outside = tmp_path / "outside.xmi"
    outside.write_text('<zoo:Lion xmlns:zoo="urn:test:zoo" name="secret"/>')
    inner = tmp_path / "project"
    (inner / "sub").mkdir(parents=True)
    (inner / "link.xmi").symlink_to(outside)
    (inner / "loop.xmi").symlink_to(inner / "loop.xmi")
    path = folder("project/one.xmi", f'<star xsi:type="zoo:Lion" href="{href}"/>')
    model = read_model(path, zoo)
    assert codes(model) in (["XMI007"], ["XMI016"])
    assert model.linked == ()
    assert model.roots[0].star is None


def test_a_wider_root_lets_references_go_up(folder, zoo, tmp_path):
    (tmp_path / "p").mkdir()
    path = folder("p/one.xmi", '<star xsi:type="zoo:Lion" href="../sub/far.xmi#//@animals.0"/>')
    assert read_model(path, zoo, root=tmp_path).roots[0].star.name == "a"


def test_a_missing_file_is_a_fault_at_the_reference(folder, zoo):
    model = read_model(folder("one.xmi", '\n<star href="gone.xmi#/"/>'), zoo)
    assert [(fault.code, fault.place.line) for fault in model.diagnostics] == [("XMI016", 2)]


def test_an_unreadable_file_is_read_once_however_many_references_lead_there(folder, zoo, monkeypatch):
    from mmrs_core.languages import reading

    opened = []
    monkeypatch.setattr(reading, "read_bytes", lambda path: opened.append(path) or path.read_bytes())
    path = folder("one.xmi", '<favourites href="sub/bad.xmi#/"/>' * 5)
    (path.parent / "sub" / "bad.xmi").write_text("junk")
    assert codes(read_model(path, zoo)) == ["XMI016"] * 5
    assert len(opened) == 2


def test_a_text_that_is_no_file_cannot_refer_to_files(read_zoo):
    assert codes(read_zoo('<star href="two.xmi#/"/>')) == ["XMI007"]


def test_strange_file_names_survive_as_hrefs(tmp_path):
    target = tmp_path / "a b%20c#d?.xmi"
    href = relative_href(target, tmp_path)
    assert href == "a%20b%2520c%23d%3F.xmi"
    assert linked_file(href, tmp_path, tmp_path.resolve()) == target.resolve()
